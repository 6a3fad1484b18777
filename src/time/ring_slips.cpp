// Friction circles that slip, and what small disturbances of the state do to them.

#include <algorithm>
#include <cmath>

#include "arcslip/time/ring_motion.hpp"
#include "arcslip/time/ring_tangent.hpp"

namespace arcslip {
namespace {

/// Of the closing displacement, 0 where there is none.
SlipTangent::Row closing_row(const VaryingForces::Circle& circle, const Matrix& x) {
  if (circle.g < 0) return SlipTangent::Row::Zero(x.cols());
  return x.row(circle.g);
}

}  // namespace

void RingMotion::begin_slips(const RingState& state, Index order) {
  slips_.clear();
  segment_.slip.setZero(2 * std::ssize(varying_.circles), order + 1);
  for (const VaryingForces::Circle& circle : varying_.circles) {
    const RingPlace place = place_of(circle.element, state.position, state.velocity);
    const Complex pull(place.x - state.memory(memory_place(circle.element, 0)),
                       place.y - state.memory(memory_place(circle.element, 1)));
    const Complex way = pull == 0.0 ? Complex(place.x_rate, place.y_rate) : pull;
    slips_.emplace_back(*family(circle.element).law->circle(), std::polar(1.0, std::arg(way)));
  }
}

/// Adds their forces of the order m, where x has that order of the displacements that vary.
void RingMotion::take_slips(Index m, const Vector& x, Vector& local) {
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    const VaryingForces::Circle& circle = varying_.circles[i];
    const Family& kind = family(circle.element);
    const auto rate = [&](Index place) {
      return static_cast<double>(m + 1) * varying_.motion.row(place).dot(segment_.position.col(m + 1));
    };
    double normal = m == 0 ? kind.law->circle()->normal_force : 0;
    if (circle.g >= 0) normal += kind.law->circle()->normal_stiffness * x(circle.g);
    const Complex force = kind.factor * slips_[i].take({rate(circle.x), rate(circle.y)}, normal);
    segment_.slip(2 * static_cast<Index>(i), m) = force.real();
    segment_.slip(2 * static_cast<Index>(i) + 1, m) = force.imag();
    local(circle.x) += force.real();
    local(circle.y) += force.imag();
  }
}

/// Whether the last terms of their directions are nothing.
bool RingMotion::slips_end() const {
  constexpr double negligible = 1e-17;
  return std::all_of(slips_.begin(), slips_.end(),
                     [](const SlipSeries& slip) { return slip.last() < negligible; });
}

/// To where they are at the end of a step, as which `state` has its displacements.
void RingMotion::move_sliders(double ratio, RingState& state) const {
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    const Index element = varying_.circles[i].element;
    const RingCircle& circle = *family(element).law->circle();
    const RingPlace place = place_of(element, state.position, state.velocity);
    const double far =
        circle.friction * (circle.normal_force + circle.normal_stiffness * place.g) / circle.stiffness;
    const Complex n = slips_[i].direction(ratio);
    state.memory(memory_place(element, 0)) = place.x - far * n.real();
    state.memory(memory_place(element, 1)) = place.y - far * n.imag();
  }
}

std::vector<SlipTangent> RingTangent::slips_of(const Stretch& stretch, const Columns& columns) const {
  std::vector<SlipTangent> slips;
  for (std::size_t i = 0; i < stretch.slips.size(); ++i) {
    const Index element = stretch.forces.circles[i].element;
    slips.emplace_back(stretch.slips[i], columns.memory.row(motion_.memory_place(element, 0)),
                       columns.memory.row(motion_.memory_place(element, 1)));
  }
  return slips;
}

void RingTangent::finish_slips(const Stretch& stretch, const std::vector<SlipTangent>& slips,
                               Columns& columns) const {
  if (slips.empty()) return;
  const Matrix x = stretch.forces.motion * columns.position;
  for (std::size_t i = 0; i < slips.size(); ++i) {
    const VaryingForces::Circle& circle = stretch.forces.circles[i];
    SlipTangent::Row z_x;
    SlipTangent::Row z_y;
    slips[i].finish(x.row(circle.x), x.row(circle.y), closing_row(circle, x), z_x, z_y);
    columns.memory.row(motion_.memory_place(circle.element, 0)) = z_x;
    columns.memory.row(motion_.memory_place(circle.element, 1)) = z_y;
  }
}

/// Adds what they make of the next term of x.
void RingTangent::take_slips(const Stretch& stretch, const Matrix& x, std::vector<SlipTangent>& slips,
                             Matrix& local) const {
  SlipTangent::Row force_x;
  SlipTangent::Row force_y;
  for (std::size_t i = 0; i < slips.size(); ++i) {
    const VaryingForces::Circle& circle = stretch.forces.circles[i];
    const double factor = motion_.family(circle.element).factor;
    slips[i].take(x.row(circle.x), x.row(circle.y), closing_row(circle, x), force_x, force_y);
    local.row(circle.x) += factor * force_x;
    local.row(circle.y) += factor * force_y;
  }
}

}  // namespace arcslip
