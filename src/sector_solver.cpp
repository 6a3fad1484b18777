#include "arcslip/sector_solver.hpp"

#include <fmt/format.h>
#include <klu.h>

#include <new>
#include <numbers>
#include <stdexcept>

namespace arcslip {
namespace {

constexpr double worst_growth = 1e-3;  // of the pivots' growth when they were chosen

double* numbers_of(Complex* values) { return reinterpret_cast<double*>(values); }

}  // namespace

/// Owns what KLU allocates.
struct SectorSolver::Factors {
  explicit Factors(ComplexSparseMatrix& pattern) {
    klu_defaults(&common);
    common.btf = 0;  // a sector is one block, whose diagonal must stay where it is
    symbolic = klu_analyze(static_cast<int>(pattern.rows()), pattern.outerIndexPtr(), pattern.innerIndexPtr(),
                           &common);
    check_memory();
  }
  ~Factors() {
    klu_z_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;

  void check_memory() const {
    if (common.status == KLU_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status < 0) throw std::length_error("sector: more entries than indices can count");
  }

  bool factor_with_old_pivots(ComplexSparseMatrix& matrix) {
    if (numeric == nullptr) return false;
    ++quick;
    const int done = klu_z_refactor(matrix.outerIndexPtr(), matrix.innerIndexPtr(),
                                    numbers_of(matrix.valuePtr()), symbolic, numeric, &common);
    return done != 0 && common.status == KLU_OK && regular() &&
           growth(matrix) >= worst_growth * chosen_growth;
  }

  bool factor_with_new_pivots(ComplexSparseMatrix& matrix) {
    ++full;
    klu_z_free_numeric(&numeric, &common);
    numeric = klu_z_factor(matrix.outerIndexPtr(), matrix.innerIndexPtr(), numbers_of(matrix.valuePtr()),
                           symbolic, &common);
    check_memory();
    if (numeric == nullptr || common.status != KLU_OK || !regular()) return false;
    chosen_growth = growth(matrix);
    return true;
  }

  bool regular() {
    klu_z_rcond(symbolic, numeric, &common);
    return common.status == KLU_OK && common.rcond > 0;
  }

  /// Reciprocal growth of the entries in the elimination: small where the pivots are bad.
  double growth(ComplexSparseMatrix& matrix) {
    klu_z_rgrowth(matrix.outerIndexPtr(), matrix.innerIndexPtr(), numbers_of(matrix.valuePtr()), symbolic,
                  numeric, &common);
    return common.rgrowth;
  }

  void solve(ComplexMatrix& columns) {
    klu_z_solve(symbolic, numeric, static_cast<int>(columns.rows()), static_cast<int>(columns.cols()),
                numbers_of(columns.data()), &common);
  }

  void solve_transposed(ComplexMatrix& columns) {
    constexpr int conjugate = 0;
    klu_z_tsolve(symbolic, numeric, static_cast<int>(columns.rows()), static_cast<int>(columns.cols()),
                 numbers_of(columns.data()), conjugate, &common);
  }

  klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  double chosen_growth = 1;
  int full = 0;
  int quick = 0;
};

SectorSolver::SectorSolver(const FiniteSector& sector, Complex forward, const Loss& loss)
    : reduction_(sector), loss_(loss), outputs_(sector.outputs) {
  reduction_.set_forward(forward);
  check_mass(sector, reduction_);
  for (const Index dof : sector.contacts) contacts_.push_back(reduction_.reduced_dof(dof));
  dynamic_stiffness_ = reduction_.stiffness();
  slope_ = dynamic_stiffness_;
  const auto m = std::ssize(contacts_);
  const auto p = std::ssize(outputs_);
  right_.resize(reduction_.size(), m + 1);
  product_.resize(reduction_.size(), m + 1);
  left_.resize(reduction_.size(), m);
  response_ = {ComplexMatrix(m, m), ComplexMatrix(m, m), ComplexVector(m),
               ComplexVector(m),    ComplexMatrix(p, m), ComplexVector(p)};
  factors_ = std::make_unique<Factors>(dynamic_stiffness_);
}

SectorSolver::~SectorSolver() = default;

int SectorSolver::full_factorisations() const { return factors_->full; }
int SectorSolver::quick_factorisations() const { return factors_->quick; }

void SectorSolver::assemble(double eta) {
  const double two_pi = 2 * std::numbers::pi;
  const double w = two_pi * eta;
  const Complex k(1, loss_.at(eta));
  const Complex k_eta(0, loss_.viscous);
  const double m_eta = -2 * two_pi * w;
  const Complex* stiffness = reduction_.stiffness().valuePtr();
  const Complex* mass = reduction_.mass().valuePtr();
  const Index count = dynamic_stiffness_.nonZeros();
  for (Index i = 0; i < count; ++i) {
    dynamic_stiffness_.valuePtr()[i] = k * stiffness[i] - w * w * mass[i];
    slope_.valuePtr()[i] = k_eta * stiffness[i] + m_eta * mass[i];
  }
  if (reduction_.damping().size() == 0) return;
  const Complex* damping = reduction_.damping().valuePtr();
  for (Index i = 0; i < count; ++i) {
    dynamic_stiffness_.valuePtr()[i] += Complex(0, w) * damping[i];
    slope_.valuePtr()[i] += Complex(0, two_pi) * damping[i];
  }
}

void SectorSolver::set_right_hand_sides() {
  left_.setZero();
  for (Index i = 0; i < left_.cols(); ++i) left_(contacts_[static_cast<std::size_t>(i)], i) = 1;
  right_.leftCols(left_.cols()) = left_;
  right_.rightCols<1>() = reduction_.load();
}

void SectorSolver::collect() {
  const Index m = left_.cols();
  for (Index i = 0; i < m; ++i) {
    const Index dof = contacts_[static_cast<std::size_t>(i)];
    response_.compliance.row(i) = right_.row(dof).head(m);
    response_.free(i) = right_(dof, m);
  }
  for (Index i = 0; i < std::ssize(outputs_); ++i) {
    const Index dof = outputs_[static_cast<std::size_t>(i)];
    const Complex factor = reduction_.factor(dof);
    response_.output_compliance.row(i) = factor * right_.row(reduction_.reduced_dof(dof)).head(m);
    response_.output_free(i) = factor * right_(reduction_.reduced_dof(dof), m);
  }
  product_.noalias() = slope_ * right_;
  response_.compliance_eta.noalias() = -left_.transpose() * product_.leftCols(m);
  response_.free_eta.noalias() = -left_.transpose() * product_.col(m);
}

const SectorResponse& SectorSolver::at(double eta) {
  assemble(eta);
  if (!factors_->factor_with_old_pivots(dynamic_stiffness_) &&
      !factors_->factor_with_new_pivots(dynamic_stiffness_)) {
    throw std::domain_error(fmt::format("the dynamic stiffness of the sector is singular at eta = {}", eta));
  }
  set_right_hand_sides();
  factors_->solve(right_);
  factors_->solve_transposed(left_);
  collect();
  return response_;
}

}  // namespace arcslip
