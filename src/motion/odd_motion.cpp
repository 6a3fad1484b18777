#include "arcslip/motion/odd_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "motion/isolated_zeros.hpp"
#include "motion/odd_turns.hpp"

namespace arcslip {
namespace {

/// Calls `use` with each h and r_h e^{jh theta}.
template <class Use>
void each_harmonic(std::span<const int> orders, const HarmonicVector& coefficients, double theta,
                   const Use& use) {
  OddTurns turns(theta);
  for (std::size_t a = 0; a < orders.size(); ++a)
    use(static_cast<double>(orders[a]),
        Turned::of(coefficients(static_cast<Index>(a))) * turns.to(orders[a]));
}

/// Derivatives of a motion at one theta.
struct Local {
  double first = 0;
  double second = 0;
  double third = 0;
};

/// Calls `use` with them at each of `count` angles that part half a period evenly, the first at `begin`.
template <class Use>
void each_place(const OddMotion& motion, double begin, int count, const Use& use) {
  struct Part {
    double h;
    Turned velocity;  // h r_h e^{jh theta}, which is to be turned by j
    Turned step;      // of theta
  };
  std::array<Part, most_harmonics> all;
  std::size_t filled = 0;
  OddTurns step(pi / count);
  each_harmonic(motion.orders(), motion.coefficients(), begin, [&](double h, const Turned& part) {
    all[filled++] = {h, {h * part.real, h * part.imag}, step.to(static_cast<int>(h))};
  });
  for (int i = 0; i < count; ++i) {
    Local here;
    for (Part& part : std::span(all.data(), filled)) {
      const double bend = part.h * part.velocity.imag;
      here.first -= part.velocity.imag;
      here.second -= part.h * part.velocity.real;
      here.third += part.h * bend;
      part.velocity = part.velocity * part.step;
    }
    use(i, here);
  }
}

/// Of some angles within half a period the one where the motion is steepest.
double steepest(const OddMotion& motion) {
  constexpr int candidates = 8;
  double angle = 0;
  double slope = -1;
  each_place(motion, 0, candidates, [&](int i, const Local& here) {
    if (std::abs(here.first) > slope)
      std::tie(angle, slope) = std::pair(i * pi / candidates, std::abs(here.first));
  });
  return angle;
}

}  // namespace

OddMotion::OddMotion(std::span<const int> orders, const HarmonicVector& coefficients)
    : orders_(orders), coefficients_(coefficients) {}

double OddMotion::value(double theta) const {
  double sum = 0;
  each_harmonic(orders_, coefficients_, theta, [&](double /*h*/, const Turned& part) { sum += part.real; });
  return sum;
}

OddMotion::Slopes OddMotion::slopes(double theta) const {
  Slopes sum{0, 0};
  each_harmonic(orders_, coefficients_, theta, [&](double h, const Turned& part) {
    sum.first -= h * part.imag;
    sum.second -= h * h * part.real;
  });
  return sum;
}

double OddMotion::change(double theta, double step) const {
  OddTurns halves(0.5 * step);
  double sum = 0;
  each_harmonic(orders_, coefficients_, theta + 0.5 * step, [&](double h, const Turned& part) {
    sum -= 2 * halves.to(static_cast<int>(h)).imag * part.imag;
  });
  return sum;
}

OddMotion::Way OddMotion::onward(double step) const {
  OddTurns halves(0.5 * step);
  Way sum{0, 0};
  for (std::size_t a = 0; a < orders_.size(); ++a) {
    const Turned half = halves.to(orders_[a]);
    const Turned middle = Turned::of(coefficients_(static_cast<Index>(a))) * half;
    sum.change -= 2 * half.imag * middle.imag;
    sum.first -= orders_[a] * (middle * half).imag;
  }
  return sum;
}

Angles OddMotion::turning_points() const {
  double fourth = 0;  // bound of |d4r/dtheta4|
  int highest = 1;
  for (std::size_t a = 0; a < orders_.size(); ++a) {
    const Complex r = coefficients_(static_cast<Index>(a));
    const double square = static_cast<double>(orders_[a]) * orders_[a];
    fourth += square * square * (std::abs(r.real()) + std::abs(r.imag()));
    highest = std::max(highest, orders_[a]);
  }
  Angles found;
  if (!(fourth > 0)) return found;
  if (orders_.size() == 1) {
    const double apart = pi / orders_.front();
    const double first = std::fmod(-std::arg(coefficients_(0)) / orders_.front(), apart);
    for (int i = 0; i < orders_.front(); ++i) found.push(first + (first < 0 ? i + 1 : i) * apart);
    return found;
  }
  const auto slope = [&](double theta) {
    const Slopes here = slopes(theta);
    return std::pair(here.first, here.second);
  };
  const int cells = 2 * highest + 2;
  const double width = pi / cells;
  const double half = 0.5 * width;
  double low = steepest(*this);  // from where no turning point is counted at both ends
  each_place(*this, low + half, cells, [&](int /*i*/, const Local& middle) {
    const double bend = std::abs(middle.third) + half * fourth;  // bound of |d3r/dtheta3| in the cell
    const double least =
        std::abs(middle.first) -
        half * (std::abs(middle.second) + half * (std::abs(middle.third) / 2 + half * fourth / 6));
    if (!(least > 0)) isolate_zeros(slope, bend, low, width, 1, [&](double theta) { found.push(theta); });
    low += width;
  });
  return found;
}

OddMotion::Maximum OddMotion::maximum(const Angles& turns) const {
  Maximum best{0, 0};
  for (int i = 0; i < turns.count; ++i) {
    const double here = value(turns[i]);
    if (std::abs(here) > best.value) best = {here > 0 ? turns[i] : turns[i] + pi, std::abs(here)};
  }
  return best;
}

}  // namespace arcslip
