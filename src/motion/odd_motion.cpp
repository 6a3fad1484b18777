#include "arcslip/motion/odd_motion.hpp"

#include <algorithm>
#include <cmath>
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

/// The angles of a half period at which derivatives are known without a sine: i pi/lattice_size.
constexpr std::size_t lattice_size = 32;
using LatticeValues = std::array<double, lattice_size>;

/// e^{jh theta} at these angles.
struct LatticeTurns {
  LatticeValues cosine;
  LatticeValues sine;
};

/// Of an odd h: they are the same of h + 2 lattice_size.
const LatticeTurns& lattice_turns(int h) {
  static const auto all = [] {
    std::array<LatticeTurns, lattice_size> turns;
    for (std::size_t k = 0; k < lattice_size; ++k) {
      for (std::size_t i = 0; i < lattice_size; ++i) {
        const auto place = static_cast<double>((2 * k + 1) * i % (2 * lattice_size));
        turns[k].cosine[i] = std::cos(place * pi / lattice_size);
        turns[k].sine[i] = std::sin(place * pi / lattice_size);
      }
    }
    return turns;
  }();
  return all[static_cast<std::size_t>(h) / 2 % lattice_size];
}

/// Derivatives of a motion there, the first to the fourth.
struct Lattice {
  LatticeValues first{};
  LatticeValues second{};
  LatticeValues third{};
  LatticeValues fourth{};

  Lattice(std::span<const int> orders, const HarmonicVector& coefficients) {
    for (std::size_t a = 0; a < orders.size(); ++a) {
      const LatticeTurns& turns = lattice_turns(orders[a]);
      const double h = orders[a];
      const Complex speed = Complex(0, h) * coefficients(static_cast<Index>(a));
      for (std::size_t i = 0; i < lattice_size; ++i) {
        const double real = speed.real() * turns.cosine[i] - speed.imag() * turns.sine[i];
        const double imaginary = speed.real() * turns.sine[i] + speed.imag() * turns.cosine[i];
        first[i] += real;
        second[i] -= h * imaginary;
        third[i] -= h * h * real;
        fourth[i] += h * h * h * imaginary;
      }
    }
  }

  /// The first derivative at the i-th of a whole period's angles.
  double slope(std::size_t i) const { return i < lattice_size ? first[i] : -first[i - lattice_size]; }

  /// Where the motion is steepest.
  std::size_t steepest() const {
    const auto less = [](double a, double b) { return std::abs(a) < std::abs(b); };
    return static_cast<std::size_t>(std::max_element(first.begin(), first.end(), less) - first.begin());
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
  const Lattice lattice(orders_, coefficients_);
  const auto slope = [&](double theta) {
    const Slopes here = slopes(theta);
    return std::pair(here.first, here.second);
  };
  constexpr double apart = pi / lattice_size;
  const std::size_t begin = lattice.steepest();  // so that no turning point is counted at both ends
  for (std::size_t i = begin; i < begin + lattice_size; i += 2) {
    const std::size_t middle = (i + 1) % lattice_size;
    const double third =
        std::abs(lattice.third[middle]) +
        (std::abs(lattice.fourth[middle]) + 0.5 * fifth * apart) * apart;  // all over the cell
    if (keeps_from_zero(lattice.first[middle], lattice.second[middle], third, apart)) continue;
    const AngleCell cell{static_cast<double>(i) * apart, static_cast<double>(i + 2) * apart, lattice.slope(i),
                         lattice.slope(i + 2)};
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
