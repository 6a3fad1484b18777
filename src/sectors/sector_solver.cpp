#include "arcslip/sectors/sector_solver.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "sectors/complex_factors.hpp"

namespace arcslip {

void SectorMotions::fill(Index contacts, Index outputs, const Complex& value) {
  compliance.setConstant(contacts, contacts, value);
  free.setConstant(contacts, value);
  output_compliance.setConstant(outputs, contacts, value);
  output_free.setConstant(outputs, value);
  load_motion.setConstant(contacts + 1, value);
}

SectorSolver::SectorSolver(const FiniteSector& sector, Complex forward, const Loss& loss)
    : reduction_(sector), loss_(loss), outputs_(sector.outputs) {
  reduction_.set_forward(forward);
  check_mass(sector, reduction_);
  for (std::size_t i = 0; i < sector.contacts.size(); ++i) {
    const Index other = sector.against_of(i);
    contacts_.push_back({reduction_.reduced_dof(sector.contacts[i]),
                         other == FiniteSector::ground ? other : reduction_.reduced_dof(other)});
  }
  dynamic_stiffness_ = reduction_.stiffness();
  slope_ = dynamic_stiffness_;
  const auto m = std::ssize(contacts_);
  const auto p = std::ssize(outputs_);
  right_.resize(reduction_.size(), m + 1);
  product_.resize(reduction_.size(), m + 1);
  left_.resize(reduction_.size(), m + 1);
  if (sector.feels_rotation()) speed_slope_ = dynamic_stiffness_;
  for (SectorMotions* motions :
       std::initializer_list<SectorMotions*>{&response_, &response_.by_eta, &response_.by_speed})
    motions->fill(m, p, 0);
  response_.damping.resize(m + 1, m + 1);
  factors_ = std::make_unique<ComplexFactors>(dynamic_stiffness_);
}

SectorSolver::~SectorSolver() = default;

int SectorSolver::factorisations() const { return factors_->factorisations(); }

void SectorSolver::assemble(double eta) {
  const double w = two_pi * eta;
  const auto [k, m] = MatrixFactors<double>(eta, loss_);
  const Complex k_eta(0, loss_.viscous);
  const Complex m_eta(-2 * two_pi * w, two_pi * two_pi * loss_.mass);
  const Complex* stiffness = reduction_.stiffness().valuePtr();
  const Complex* mass = reduction_.mass().valuePtr();
  const Index count = dynamic_stiffness_.nonZeros();
  for (Index i = 0; i < count; ++i) {
    dynamic_stiffness_.valuePtr()[i] = k * stiffness[i] + m * mass[i];
    slope_.valuePtr()[i] = k_eta * stiffness[i] + m_eta * mass[i];
  }
  if (reduction_.damping().size() == 0) return;
  const Complex* damping = reduction_.damping().valuePtr();
  for (Index i = 0; i < count; ++i) {
    dynamic_stiffness_.valuePtr()[i] += Complex(0, w) * damping[i];
    slope_.valuePtr()[i] += Complex(0, two_pi) * damping[i];
  }
}

/// Adds Omega^2 K_2 + j w* Omega G with Omega = 2 pi times the speed.
void SectorSolver::turn(double eta, double speed) {
  const double w = two_pi * eta;
  const double omega = two_pi * speed;
  const auto& gyroscopic = reduction_.gyroscopic();
  const auto& stiffness = reduction_.stiffness_speed2();
  speed_slope_.coeffs().setZero();
  if (gyroscopic.size() != 0) {
    dynamic_stiffness_.coeffs() += Complex(0, w * omega) * gyroscopic.coeffs();
    slope_.coeffs() += Complex(0, two_pi * omega) * gyroscopic.coeffs();
    speed_slope_.coeffs() += Complex(0, two_pi * w) * gyroscopic.coeffs();
  }
  if (stiffness.size() != 0) {
    dynamic_stiffness_.coeffs() += Complex(omega * omega) * stiffness.coeffs();
    speed_slope_.coeffs() += Complex(2 * two_pi * omega) * stiffness.coeffs();
  }
}

void SectorSolver::set_right_hand_sides() {
  left_.setZero();
  for (Index i = 0; i < contacts(); ++i) {
    const auto [dof, against] = contacts_[static_cast<std::size_t>(i)];
    left_(dof, i) = 1;
    if (against != FiniteSector::ground) left_(against, i) = -1;
  }
  right_ = left_;
  right_.rightCols<1>() = reduction_.load();
  left_.rightCols<1>() = reduction_.load().conjugate();
}

void SectorSolver::collect() {
  const Index m = contacts();
  for (Index i = 0; i < m; ++i) {
    const auto [dof, against] = contacts_[static_cast<std::size_t>(i)];
    response_.compliance.row(i) = right_.row(dof).head(m);
    response_.free(i) = right_(dof, m);
    if (against == FiniteSector::ground) continue;
    response_.compliance.row(i) -= right_.row(against).head(m);
    response_.free(i) -= right_(against, m);
  }
  for (Index i = 0; i < std::ssize(outputs_); ++i) {
    const Index dof = outputs_[static_cast<std::size_t>(i)];
    const Complex factor = reduction_.factor(dof);
    response_.output_compliance.row(i) = factor * right_.row(reduction_.reduced_dof(dof)).head(m);
    response_.output_free(i) = factor * right_(reduction_.reduced_dof(dof), m);
  }
}

/// From Z' X.
void SectorSolver::collect_slopes(const ComplexSparseMatrix& slope, SectorMotions& slopes) {
  const Index m = contacts();
  product_.noalias() = slope * right_;
  slopes.compliance.noalias() = -left_.leftCols(m).transpose() * product_.leftCols(m);
  slopes.free.noalias() = -left_.leftCols(m).transpose() * product_.col(m);
  slopes.load_motion.noalias() = -product_.transpose() * left_.col(m);
  if (outputs() == 0) return;
  factors_->solve(product_);
  for (Index i = 0; i < outputs(); ++i) {
    const Index dof = outputs_[static_cast<std::size_t>(i)];
    const auto row = -reduction_.factor(dof) * product_.row(reduction_.reduced_dof(dof));
    slopes.output_compliance.row(i) = row.head(m);
    slopes.output_free(i) = row(m);
  }
}

/// Im Z = (beta eta + delta) K + w* (C + 2 pi mu M), itself Hermitian but for what is gyroscopic in C and
/// does no work.
void SectorSolver::collect_works(double eta) {
  const auto [k, m] = MatrixFactors<double>(eta, loss_);
  product_.setZero();
  if (k.imag() != 0) product_.noalias() += reduction_.stiffness() * (k.imag() * right_);
  if (m.imag() != 0) product_.noalias() += reduction_.mass() * (m.imag() * right_);
  if (reduction_.damping().size() != 0) product_.noalias() += reduction_.damping() * (two_pi * eta * right_);
  response_.damping.noalias() = right_.adjoint() * product_;
  response_.load_motion.noalias() = right_.transpose() * reduction_.load().conjugate();
}

const SectorResponse& SectorSolver::at(double eta, double speed) {
  assemble(eta);
  const bool turns = speed_slope_.size() != 0;
  if (turns) turn(eta, speed);
  if (!factors_->factor(dynamic_stiffness_)) {
    throw std::domain_error(fmt::format("the dynamic stiffness of the sector is singular at eta = {}", eta));
  }
  set_right_hand_sides();
  factors_->solve(right_);
  factors_->solve_transposed(left_);
  collect();
  collect_slopes(slope_, response_.by_eta);
  if (turns) collect_slopes(speed_slope_, response_.by_speed);
  factors_->release();
  collect_works(eta);
  return response_;
}

}  // namespace arcslip
