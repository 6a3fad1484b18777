#include "arcslip/motion/odd_motion.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "motion/isolated_zeros.hpp"

namespace arcslip {
namespace {

/// Calls `use` with each h, its coefficient and e^{jh theta}.
template <class Use>
void each_harmonic(std::span<const int> orders, const HarmonicVector& coefficients, double theta,
                   const Use& use) {
  const Complex turn = std::polar(1.0, theta);
  const Complex two_turns = turn * turn;
  Complex power = turn;
  int reached = 1;
  for (std::size_t a = 0; a < orders.size(); ++a) {
    if (reached > orders[a]) {
      power = turn;
      reached = 1;
    }
    for (; reached < orders[a]; reached += 2) power *= two_turns;
    use(static_cast<double>(orders[a]), coefficients(static_cast<Index>(a)), power);
  }
}

}  // namespace

OddMotion::OddMotion(std::span<const int> orders, const HarmonicVector& coefficients)
    : orders_(orders), coefficients_(coefficients) {}

double OddMotion::value(double theta) const {
  double sum = 0;
  each_harmonic(orders_, coefficients_, theta,
                [&](double /*h*/, Complex r, Complex power) { sum += std::real(r * power); });
  return sum;
}

OddMotion::Slopes OddMotion::slopes(double theta) const {
  Slopes sum{0, 0};
  each_harmonic(orders_, coefficients_, theta, [&](double h, Complex r, Complex power) {
    const Complex part = r * power;
    sum.first -= h * part.imag();
    sum.second -= h * h * part.real();
  });
  return sum;
}

double OddMotion::change(double theta, double step) const {
  const double half = 0.5 * step;
  double sum = 0;
  each_harmonic(orders_, coefficients_, theta + half, [&](double h, Complex r, Complex power) {
    sum -= 2 * std::sin(h * half) * std::imag(r * power);
  });
  return sum;
}

/// Of some angles within half a period the one where the motion is steepest.
double OddMotion::steepest() const {
  constexpr int candidates = 8;
  double angle = 0;
  double slope = -1;
  for (int i = 0; i < candidates; ++i) {
    const double here = std::abs(slopes(i * pi / candidates).first);
    if (here > slope) std::tie(angle, slope) = std::pair(i * pi / candidates, here);
  }
  return angle;
}

Angles OddMotion::turning_points() const {
  double third = 0;  // bound of |d3r/dtheta3|
  for (std::size_t a = 0; a < orders_.size(); ++a)
    third += std::pow(orders_[a], 3) * std::abs(coefficients_(static_cast<Index>(a)));
  Angles found;
  if (!(third > 0)) return found;
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
  // From where no turning point is counted at both ends.
  isolate_zeros(slope, third, steepest(), pi, 4, [&](double theta) { found.push(theta); });
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
