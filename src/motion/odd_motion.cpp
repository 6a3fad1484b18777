#include "arcslip/motion/odd_motion.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "motion/bracketed_newton.hpp"

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

/// The zero of dr/dtheta between two angles at which its signs differ, where dr/dtheta `rises` or falls.
double OddMotion::turning_point(double low, double high, bool rises) const {
  return bracketed_newton(
      [&](double theta) {
        const Slopes at = slopes(theta);
        return std::pair(at.first, at.second);
      },
      0.5 * (low + high), low, high, rises);
}

Angles OddMotion::turning_points() const {
  double third = 0;  // bound of |d3r/dtheta3|
  for (std::size_t a = 0; a < orders_.size(); ++a)
    third += std::pow(orders_[a], 3) * std::abs(coefficients_(static_cast<Index>(a)));
  Angles found;
  if (!(third > 0)) return found;

  struct Cell {
    double low;
    double high;
  };
  constexpr int parts = 4;
  constexpr double narrow = 1e-8;
  const double begin = steepest();  // no turning point is counted at both ends
  std::array<Cell, 64> open;  // what is not searched, the leftmost last: halving 1 down to 1e-8 leaves 27
  std::size_t count = 0;
  for (int i = parts; i-- > 0;) open[count++] = {begin + i * pi / parts, begin + (i + 1) * pi / parts};
  while (count > 0) {
    const Cell cell = open[--count];
    const double middle = 0.5 * (cell.low + cell.high);
    const double width = 0.5 * (cell.high - cell.low);
    const Slopes at = slopes(middle);
    if (std::abs(at.first) > (std::abs(at.second) + 0.5 * third * width) * width) continue;
    if (std::abs(at.second) > third * width || width < narrow) {  // one zero at most
      const double low = slopes(cell.low).first;
      if (low == 0) {
        found.push(cell.low);
      } else if (low * slopes(cell.high).first < 0) {
        found.push(turning_point(cell.low, cell.high, low < 0));
      }
      continue;
    }
    open[count++] = {middle, cell.high};
    open[count++] = {cell.low, middle};
  }
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
