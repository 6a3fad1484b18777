#include "arcslip/assembly/rigid_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/motion/swing.hpp"

namespace arcslip {
namespace {

constexpr double rounding = 1e-9;  // of rigid modes, which iterations find, and of what they move

[[noreturn]] void refuse(bool is_base, const char* why) {
  throw std::invalid_argument(fmt::format("nothing holds the {} at rest, which the harmonic 0, the mean, {}",
                                          is_base ? "base" : "damper", why));
}

}  // namespace

RigidMotions::RigidMotions(const HarmonicSystem& system, const Coordinates& coordinates)
    : moves_(coordinates.size(), 0), held_(coordinates.size(), 0) {
  if (place_of_mean(system.orders) == std::ssize(system.orders)) return;
  order_ = place_of_mean(system.orders);
  const auto place = static_cast<std::size_t>(order_);
  for (const bool is_base : {false, true}) {
    const ContactModes& structure = (is_base ? system.base : system.damper)[place];
    const auto& modes = structure.modes();
    const bool is_free = std::any_of(modes.begin(), modes.end(), [](const ContactMode& mode) {
      return mode.is_rigid() && !(mode.shape.isZero(0) && mode.load == 0.0);
    });
    if (!is_free) continue;
    if (structure.is_solved()) refuse(is_base, "needs where the structure is solved for and no sum of modes");
    if (system.one_way) refuse(is_base, "needs where contacts do not act back");
    add(structure, is_base, coordinates);
  }
  if (count() > 0) parts_ = pseudo_inverse(moves_);
}

void RigidMotions::add(const ContactModes& structure, bool is_base, const Coordinates& coordinates) {
  ComplexMatrix all(coordinates.size(), std::ssize(structure.modes()));
  ComplexMatrix held = ComplexMatrix::Zero(all.rows(), all.cols());
  for (Index i = 0; i < all.rows(); ++i) {
    const Coordinate& one = coordinates[i];
    for (Index k = 0; k < all.cols(); ++k)
      all(i, k) = one.move(is_base) * structure.modes()[static_cast<std::size_t>(k)].shape(one.dof);
    if (coordinates.element(coordinates.element_of(i)).holds_mean(one.part, false)) held.row(i) = all.row(i);
  }
  double largest = 0;
  for (Index k = 0; k < all.cols(); ++k) {
    if (structure.modes()[static_cast<std::size_t>(k)].is_rigid())
      largest = std::max(largest, all.col(k).norm());
  }
  for (Index k = 0; k < all.cols(); ++k) {
    const ContactMode& mode = structure.modes()[static_cast<std::size_t>(k)];
    if (!mode.is_rigid()) continue;
    ComplexVector like(count());
    if (count() > 0) like = shortest(held_, ComplexVector(held.col(k)));
    if ((held.col(k) - held_ * like).norm() <= rounding * largest) {
      check_load(structure, mode.load, like);
      continue;
    }
    all_.push_back({is_base, static_cast<std::size_t>(k)});
    moves_.conservativeResize(Eigen::NoChange, count());
    held_.conservativeResize(Eigen::NoChange, count());
    load_.conservativeResize(count());
    moves_.col(count() - 1) = all.col(k);
    held_.col(count() - 1) = held.col(k);
    load_(count() - 1) = mode.load;
  }
}

/// Of a motion that does to elements what others do, `like` times them.
void RigidMotions::check_load(const ContactModes& structure, const Complex& load,
                              const ComplexVector& like) const {
  double all = load_.squaredNorm();
  for (const ContactMode& mode : structure.modes()) all += std::norm(mode.load);
  if (std::abs(load - like.dot(load_)) > rounding * std::sqrt(all))
    throw std::invalid_argument("nothing holds base and damper against the mean of the load");
}

ComplexVector RigidMotions::at(const ContactModes& structure, bool is_base, Index dof) const {
  ComplexVector moves = ComplexVector::Zero(count());
  for (Index k = 0; k < count(); ++k) {
    const Motion& one = all_[static_cast<std::size_t>(k)];
    if (one.is_base == is_base) moves(k) = structure.modes()[one.mode].shape(dof);
  }
  return moves;
}

Vector RigidMotions::of_each(double base, double damper) const {
  Vector values(count());
  for (Index k = 0; k < count(); ++k) values(k) = all_[static_cast<std::size_t>(k)].is_base ? base : damper;
  return values;
}

ComplexMatrix RigidMotions::loose(const std::function<bool(Index coordinate)>& is_held) const {
  if (count() == 0) return {};
  ComplexMatrix rows = held_;
  for (Index i = 0; i < rows.rows(); ++i) {
    if (!is_held(i)) rows.row(i).setZero();
  }
  return kernel_of(rows, rounding);
}

std::string RigidMotions::name(const ComplexMatrix& motions) const {
  const auto has = [&](bool is_base) {
    return (of_each(is_base ? 1 : 0, is_base ? 0 : 1).asDiagonal() * motions).norm() >
           rounding * motions.norm();
  };
  return has(true) ? (has(false) ? "base and damper" : "the base") : "the damper";
}

}  // namespace arcslip
