#include "sectors/turning_modes.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

/// Z with its slopes.
struct ModalStiffness {
  ModalStiffness(const SectorModes& modes, const Loss& loss, double eta, double speed) {
    const auto r = std::ssize(modes.frequencies);
    z.setZero(r, r);
    by_eta = by_speed = z;
    if (modes.gyroscopic.size() != 0) {
      z += Complex(0, eta * speed) * modes.gyroscopic;
      by_eta += Complex(0, speed) * modes.gyroscopic;
      by_speed += Complex(0, eta) * modes.gyroscopic;
    }
    if (modes.stiffness_speed2.size() != 0) {
      z += speed * speed * modes.stiffness_speed2;
      by_speed += 2 * speed * modes.stiffness_speed2;
    }
    losses.resize(r);
    for (Index k = 0; k < r; ++k) {
      const ModalDenominator d(eta, modes.frequencies[static_cast<std::size_t>(k)], loss);
      z(k, k) += d.value;
      by_eta(k, k) += d.by_eta;
      losses(k) = d.value.imag();
    }
  }

  ComplexMatrix z;
  ComplexMatrix by_eta;
  ComplexMatrix by_speed;
  Vector losses;
};

/// Of contacts, outputs and the load under what moves the modes so, a column each.
SectorMotions motions_of(const SectorModes& modes, Index m, const ComplexMatrix& of_modes) {
  const Index p = modes.shapes.rows() - m;
  const ComplexMatrix seen = modes.shapes * of_modes;
  SectorMotions motions;
  motions.compliance = seen.topLeftCorner(m, m);
  motions.free = seen.col(m).head(m);
  motions.output_compliance = seen.bottomLeftCorner(p, m);
  motions.output_free = seen.col(m).tail(p);
  motions.load_motion = (modes.loads.adjoint() * of_modes).transpose();
  return motions;
}

/// That of the modes under a force on each contact and the load.
ComplexMatrix driven_modes(const SectorModes& modes, Index contacts,
                           const std::function<ComplexMatrix(const ComplexMatrix&)>& solver) {
  ComplexMatrix drive(std::ssize(modes.frequencies), contacts + 1);
  drive << modes.shapes.topRows(contacts).adjoint(), modes.loads;
  drive = solver(drive);
  if (!drive.allFinite()) throw std::domain_error("the dynamic stiffness of the modes is singular");
  return drive;
}

}  // namespace

ComplexVector modal_denominators(const SectorModes& modes, const Loss& loss, double eta) {
  ComplexVector denominators(std::ssize(modes.frequencies));
  for (Index k = 0; k < denominators.size(); ++k) {
    const auto mode = static_cast<std::size_t>(k);
    denominators(k) = ModalDenominator(eta, modes.frequencies[mode], loss).value;
    if (mode < modes.free_squares.size())
      denominators(k) += Complex(1, loss.at(eta)) * modes.free_squares[mode];
  }
  return denominators;
}

SectorMotions modal_motions(const SectorModes& modes, Index contacts, const Loss& loss, double eta,
                            double speed) {
  const ModalStiffness stiffness(modes, loss, eta, speed);
  return motions_of(modes, contacts, driven_modes(modes, contacts, solver_of(stiffness.z)));
}

ModalSolves::ModalSolves(std::shared_ptr<const SectorModes> modes, Index contacts, const Loss& loss,
                         std::size_t kept)
    : SectorSolves(kept), modes_(std::move(modes)), contacts_(contacts), loss_(loss) {}

SectorResponse ModalSolves::solved(double eta, double speed) const {
  const ModalStiffness stiffness(*modes_, loss_, eta, speed);
  const auto solver = solver_of(stiffness.z);
  const ComplexMatrix motion = driven_modes(*modes_, contacts_, solver);
  SectorResponse response;
  static_cast<SectorMotions&>(response) = motions_of(*modes_, contacts_, motion);
  response.by_eta = motions_of(*modes_, contacts_, -solver(stiffness.by_eta * motion));
  response.by_speed = motions_of(*modes_, contacts_, -solver(stiffness.by_speed * motion));
  response.damping = motion.adjoint() * stiffness.losses.asDiagonal() * motion;
  return response;
}

namespace {

/// Omega^2 K_2 and H = j Omega G, or what stands for them with Omega^2 and Omega as factors.
ComplexMatrix scaled(const ComplexMatrix& matrix, const Complex& factor, Index size) {
  return matrix.size() == 0 ? ComplexMatrix::Zero(size, size) : ComplexMatrix(factor * matrix);
}

/// Adds so much of the identity that the matrix is definite although a motion of it meets no stiffness.
void make_definite(ComplexMatrix& stiffness, double speed) {
  constexpr double least = 1e-13;  // of the largest eta^2
  constexpr double most = 1e-9;
  const double most_stiff = stiffness.diagonal().real().cwiseAbs().maxCoeff();
  const double largest = most_stiff > 0 ? most_stiff : 1;
  for (double part = 0; part <= most; part = std::max(10 * part, least)) {
    ComplexMatrix shifted = stiffness;
    shifted.diagonal().array() += part * largest;
    if (!is_definite(shifted)) continue;
    stiffness = std::move(shifted);
    return;
  }
  throw SectorError(fmt::format(
      "the stiffness K + Omega^2 K_2 is not positive definite at a speed of {:g}, where nothing holds the "
      "sector",
      speed));
}

}  // namespace

TurningModes turning_modes(const SectorModes& modes, Index contacts, const Rotation& rotation) {
  const auto r = static_cast<Index>(modes.frequencies.size());
  const bool follows = rotation.per_eta != 0;
  const double speed = follows ? rotation.per_eta : rotation.fixed;
  ComplexMatrix stiffness = ComplexMatrix::Zero(r, r);
  for (Index k = 0; k < r; ++k)
    stiffness(k, k) =
        modes.frequencies[static_cast<std::size_t>(k)] * modes.frequencies[static_cast<std::size_t>(k)];
  const ComplexMatrix by_speed2 = scaled(modes.stiffness_speed2, speed * speed, r);
  const ComplexMatrix coriolis = scaled(modes.gyroscopic, Complex(0, speed), r);
  if (!follows) stiffness += by_speed2;
  make_definite(stiffness, rotation.fixed);
  ComplexMatrix a = stiffness;
  ComplexMatrix b = ComplexMatrix::Identity(r, r) - by_speed2 - coriolis;
  if (!follows) {
    a = ComplexMatrix::Identity(2 * r, 2 * r);
    a.topLeftCorner(r, r) = stiffness;
    b.setZero(2 * r, 2 * r);
    b.topLeftCorner(r, r) = -coriolis;
    b.topRightCorner(r, r).setIdentity();
    b.bottomLeftCorner(r, r).setIdentity();
  }
  const auto found = pencil(b, a);
  if (!found) throw SectorError("the modes of the sector that turns were not found");
  TurningModes turning{follows ? 2 : 1, {}, modes.frequencies, found->vectors.topRows(r)};
  const ComplexMatrix shapes = modes.shapes.topRows(contacts) * turning.motion;
  const ComplexVector loads = turning.motion.adjoint() * modes.loads;
  for (Index k = 0; k < found->values.size(); ++k)
    turning.modes.push_back({found->values(k), shapes.col(k), loads(k)});
  return turning;
}

std::shared_ptr<const TurningModes> KnownTurning::at(const Rotation& rotation) const {
  const std::scoped_lock lock(mutex_);
  auto& known = known_[{rotation.fixed, rotation.per_eta}];
  if (known == nullptr)
    known = std::make_shared<const TurningModes>(turning_modes(*modes_, contacts_, rotation));
  return known;
}

}  // namespace arcslip
