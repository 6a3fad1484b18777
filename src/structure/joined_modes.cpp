// The modes of several structures on springs.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "arcslip/dense.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {
namespace {

/// eta of a mode of a structure that turns.
double frequency_of(double inverse, int power) { return power == 1 ? 1 / inverse : 1 / std::sqrt(inverse); }

constexpr double no_mass = 1e-14;  // of the largest 1/lambda: what rounding leaves of a motion without mass

/// Structures that turn, with what displaces the springs: of x, the modes of all of them,
///   (I + R^H diag(springs) R) x = lambda diag(mu) x,   R their relative motions.
struct TurningWhole {
  std::vector<std::shared_ptr<const TurningModes>> parts;
  std::vector<Loss> losses;
  ComplexMatrix relative;

  Index count() const {
    Index count = 0;
    for (const auto& part : parts) count += std::ssize(part->modes);
    return count;
  }

  /// Damping ratio of a mode at eta.
  double damping(const ComplexVector& x, double eta) const {
    double lost = 0;
    Index first = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const TurningModes& part = *parts[i];
      const ComplexVector motion = part.motion * x.segment(first, std::ssize(part.modes));
      for (Index k = 0; k < motion.size(); ++k)
        lost += std::norm(motion(k)) * losses[i].part(eta, part.frequencies[static_cast<std::size_t>(k)]);
      first += std::ssize(part.modes);
    }
    return lost / parts.front()->power;
  }

  std::vector<JoinedMode> joined(const Vector& springs) const {
    Vector inverses(relative.cols());
    Index column = 0;
    for (const auto& part : parts) {
      for (const TurningModes::Mode& mode : part->modes) inverses(column++) = mode.inverse;
    }
    ComplexMatrix stiffness = relative.adjoint() * springs.asDiagonal() * relative;
    stiffness.diagonal().array() += 1;
    const ComplexMatrix mass = inverses.cast<Complex>().asDiagonal();
    const Pencil<ComplexMatrix> found = pencil(mass, stiffness).value();
    const double largest = found.values.maxCoeff();
    std::vector<JoinedMode> modes;
    for (Index k = relative.cols(); k-- > 0;) {  // the largest 1/lambda is the lowest frequency
      const double inverse = found.values(k);
      if (!(inverse > no_mass * largest)) break;
      const double eta = frequency_of(inverse, parts.front()->power);
      const ComplexVector x = found.vectors.col(k);
      modes.push_back({eta, damping(x, eta), relative * x, x});
    }
    return modes;
  }
};

TurningWhole turning_whole(const std::vector<const ContactModes*>& structures, const Vector& springs,
                           const MovedSprings& moved) {
  TurningWhole whole;
  std::vector<ContactVector> columns;
  for (const ContactModes* structure : structures) {
    const auto modes = structure->turning_modes();
    if (modes == nullptr) continue;
    whole.parts.push_back(modes);
    whole.losses.push_back(structure->loss());
    for (const TurningModes::Mode& mode : modes->modes)
      columns.push_back(moved(mode.shape, structure == structures.front()));
  }
  whole.relative.resize(springs.size(), std::ssize(columns));
  for (Index i = 0; i < std::ssize(columns); ++i)
    whole.relative.col(i) = columns[static_cast<std::size_t>(i)];
  return whole;
}

}  // namespace

std::vector<ContactMode> TurningModes::resonances() const {
  double largest = 0;
  for (const Mode& mode : modes) largest = std::max(largest, mode.inverse);
  std::vector<ContactMode> found;
  for (const Mode& mode : modes) {
    if (!(mode.inverse > no_mass * largest)) continue;
    const double eta = frequency_of(mode.inverse, power);
    const double factor = power == 1 ? std::numbers::sqrt2 * eta : eta;  // 1 - mu lambda is about
    found.push_back({eta, factor * mode.shape, factor * mode.load});     // (eta_k^2 - eta^2)/factor^2
  }
  std::sort(found.begin(), found.end(),
            [](const ContactMode& a, const ContactMode& b) { return a.frequency < b.frequency; });
  return found;
}

std::vector<JoinedMode> joined_modes(const std::vector<const ContactModes*>& structures,
                                     const Vector& springs) {
  return joined_modes(structures, springs, [](const ContactVector& shape, bool is_first) -> ContactVector {
    return is_first ? shape : -shape;
  });
}

std::vector<JoinedMode> joined_modes(const std::vector<const ContactModes*>& structures,
                                     const Vector& springs, const MovedSprings& moved) {
  if (const TurningWhole whole = turning_whole(structures, springs, moved); whole.relative.cols() > 0)
    return whole.joined(springs);
  Index count = 0;
  for (const ContactModes* structure : structures) count += static_cast<Index>(structure->modes().size());
  if (count == 0) return {};  // all held
  // In modal coordinates: diag(eta_k^2) + B^H diag(springs) B, where B gives the relative motions.
  ComplexMatrix relative(springs.size(), count);
  Vector squares(count);
  Index column = 0;
  for (const ContactModes* structure : structures) {
    for (const ContactMode& mode : structure->modes()) {
      relative.col(column) = moved(mode.shape, structure == structures.front());
      squares(column++) = mode.influence.square(mode.frequency);
    }
  }
  ComplexMatrix stiffness = relative.adjoint() * springs.asDiagonal() * relative;
  stiffness.diagonal() += squares;
  const Pencil<ComplexMatrix> found = pencil(stiffness).value();
  std::vector<JoinedMode> modes;
  for (Index k = 0; k < count; ++k) {
    const double frequency = std::sqrt(std::max(0.0, found.values(k)));
    const auto motion = found.vectors.col(k);
    double losses = 0;  // sum |x|^2 Im d
    Index row = 0;
    for (const ContactModes* structure : structures) {
      for (const ContactMode& mode : structure->modes())
        losses += std::norm(motion(row++)) *
                  (structure->loss().part(frequency, mode.frequency) + mode.influence.part(frequency).imag());
    }
    modes.push_back(
        {frequency, frequency > 0 ? losses / (2 * frequency * frequency) : 0, relative * motion, motion});
  }
  return modes;
}

}  // namespace arcslip
