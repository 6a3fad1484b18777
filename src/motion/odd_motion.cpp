#include "arcslip/motion/odd_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/lattice.hpp"

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

/// Of a half period.
constexpr std::size_t half_lattice = lattice_size / 2;

/// The rate of a motion there.
struct RateLattice : Lattice<half_lattice> {
  RateLattice(std::span<const int> orders, const HarmonicVector& coefficients) {
    for (std::size_t a = 0; a < orders.size(); ++a) {
      const Complex rate = Complex(0, orders[a]) * coefficients(static_cast<Index>(a));
      add(orders[a], rate.real(), rate.imag());
    }
  }

  /// At the i-th of a whole period's angles.
  double rate(std::size_t i) const { return i < half_lattice ? value[i] : -value[i - half_lattice]; }

  /// Where the motion is steepest.
  std::size_t steepest() const {
    const auto less = [](double a, double b) { return std::abs(a) < std::abs(b); };
    return static_cast<std::size_t>(std::max_element(value.begin(), value.end(), less) - value.begin());
  }
};

/// Sum of h^power |r_h|.
double bound(std::span<const int> orders, const HarmonicVector& coefficients, int power) {
  double sum = 0;
  for (std::size_t a = 0; a < orders.size(); ++a)
    sum += std::pow(orders[a], power) * std::abs(coefficients(static_cast<Index>(a)));
  return sum;
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

OddMotion::Departure::Departure(const OddMotion& motion, double theta)
    : orders_(motion.orders_), turned_(motion.coefficients_.size()) {
  Index a = 0;
  each_harmonic(orders_, motion.coefficients_, theta,
                [&](double /*h*/, Complex r, Complex power) { turned_(a++) = r * power; });
}

OddMotion::Departure::Way OddMotion::Departure::after(double step) const {
  Way way{0, 0};
  each_harmonic(orders_, turned_, 0.5 * step, [&](double h, Complex r, Complex half) {
    const Complex part = r * half;
    way.change -= 2 * half.imag() * part.imag();
    way.slope -= h * (part * half).imag();
  });
  return way;
}

double OddMotion::Departure::bend() const {
  double sum = 0;
  for (std::size_t a = 0; a < orders_.size(); ++a) {
    const double h = orders_[a];
    sum -= h * h * turned_(static_cast<Index>(a)).real();
  }
  return sum;
}

Angles OddMotion::turning_points() const {
  Angles found;
  const double fifth = bound(orders_, coefficients_, 5);  // of |d5r/dtheta5|
  if (!(fifth > 0)) return found;
  if (orders_.size() == 1) {
    const double apart = pi / orders_.front();
    const double first = std::fmod(-std::arg(coefficients_(0)) / orders_.front(), apart);
    for (int i = 0; i < orders_.front(); ++i) found.push(first + (first < 0 ? i + 1 : i) * apart);
    return found;
  }
  const RateLattice lattice(orders_, coefficients_);
  const auto slope = [&](double theta) {
    const Slopes here = slopes(theta);
    return std::pair(here.first, here.second);
  };
  const std::size_t begin = lattice.steepest();  // so that no turning point is counted at both ends
  for (std::size_t i = begin; i < begin + half_lattice; i += 2) {
    const std::size_t middle = (i + 1) % half_lattice;
    const double third = lattice.bound_round(middle, fifth);
    if (lattice.keeps_from_zero(middle, third)) continue;
    const AngleCell cell{static_cast<double>(i) * lattice_width, static_cast<double>(i + 2) * lattice_width,
                         lattice.rate(i), lattice.rate(i + 2)};
    isolate_zeros(slope, third, cell, [&](double theta) { found.push(theta); });
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
