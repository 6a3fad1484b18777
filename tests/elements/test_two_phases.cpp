// Forces under two frequencies against a slider that is marched along the same motion, against the loop of
// one frequency, and their derivatives against differences.

#include <cmath>
#include <random>
#include <vector>

#include "arcslip/elements/jenkins.hpp"
#include "arcslip/elements/memoryless.hpp"
#include "arcslip/elements/two_phases.hpp"
#include "catch.hpp"

namespace arcslip::testing::two_phases {
namespace {

std::vector<Line> lines(bool odd, int most_k, int most_l) {
  std::vector<Line> all;
  for (int k = odd ? 1 : 0; k <= most_k; k += odd ? 2 : 1) {
    for (int l = k == 0 ? 0 : -most_l; l <= most_l; ++l) all.push_back({k, l});
  }
  return all;
}

/// Of amplitude 2 or so in (1, 0), falling with k and l.
ComplexVector motion(const std::vector<Line>& all, std::mt19937& random) {
  std::normal_distribution<double> normal;
  ComplexVector x(std::ssize(all));
  for (Index a = 0; a < x.size(); ++a) {
    const Line& line = all[static_cast<std::size_t>(a)];
    const double size = 1.5 / (1 + 2.0 * line.k * line.k + 3.0 * line.l * line.l);
    x(a) = size * Complex(normal(random), line == Line{0, 0} ? 0 : normal(random));
    if (line == Line{1, 0}) x(a) = 2;
  }
  return x;
}

double value(const std::vector<Line>& all, const ComplexVector& x, double first, double second) {
  double sum = 0;
  for (Index a = 0; a < x.size(); ++a) {
    const Line& line = all[static_cast<std::size_t>(a)];
    sum += std::real(x(a) * std::polar(1.0, line.k * first + line.l * second));
  }
  return sum;
}

/// The same coefficients by samples.
ComplexVector marched(const std::vector<Line>& all, const ComplexVector& x, double k, double s, double ratio,
                      int places, int settling = 4, int samples = 1 << 14) {
  ComplexVector sum = ComplexVector::Zero(x.size());
  for (int place = 0; place < places; ++place) {
    const double p = two_pi * place / places;
    double slider = 0;
    for (int i = -settling * samples; i < samples; ++i) {
      const double theta = two_pi * (i + 0.5) / samples - pi;
      const double at = value(all, x, theta, p + ratio * theta);
      slider = std::clamp(slider, at - s, at + s);
      if (i < 0) continue;
      for (Index a = 0; a < x.size(); ++a) {
        const Line& line = all[static_cast<std::size_t>(a)];
        const double share = (line == Line{0, 0} ? 1.0 : 2.0) / samples / places;
        sum(a) += share * k * (at - slider) * std::polar(1.0, -line.k * theta - line.l * (p + ratio * theta));
      }
    }
  }
  return sum;
}

/// Re x and Im x moved one after the other, x_00 along its real part.
template <class Force>
void check_derivatives(const std::vector<Line>& all, const ComplexVector& x, const LineForce& found,
                       const Force& force) {
  constexpr double step = 1e-6;
  for (Index b = 0; b < x.size(); ++b) {
    for (const Complex way : {Complex(1, 0), Complex(0, 1)}) {
      if (all[static_cast<std::size_t>(b)] == Line{0, 0} && way.imag() != 0) continue;
      ComplexVector ahead = x;
      ComplexVector back = x;
      ahead(b) += step * way;
      back(b) -= step * way;
      const ComplexVector rate = (force(ahead) - force(back)) / (2 * step);
      const ComplexVector told = found.linear.col(b) * way + found.conjugate.col(b) * std::conj(way);
      CHECK((rate - told).norm() < 1e-7);
    }
  }
}

}  // namespace

TEST_CASE("A slider under two frequencies does what it does in time", "[two_phases]") {
  std::mt19937 random(3);
  for (const bool odd : {true, false}) {
    for (const double ratio : {0.37, -1.23, 0.01}) {
      const std::vector<Line> all = lines(odd, 3, 2);
      const TwoPhases phases(all, 12);
      const ComplexVector x = motion(all, random);
      LineForce found;
      phases.slide(1.7, 0.6, x, ratio, true, found);
      const auto force = [&](const ComplexVector& at) {
        LineForce moved;
        phases.slide(1.7, 0.6, at, ratio, false, moved);
        return moved.force;
      };
      CHECK((found.force - force(x)).norm() < 1e-12);
      CHECK((found.force - marched(all, x, 1.7, 0.6, ratio, 12)).norm() < 1e-6 * found.force.norm());
      check_derivatives(all, x, found, force);
      constexpr double step = 1e-6;
      const auto at = [&](double threshold, double rate) {
        LineForce moved;
        phases.slide(1.7, threshold, x, rate, false, moved);
        return moved.force;
      };
      CHECK(((at(0.6, ratio + step) - at(0.6, ratio - step)) / (2 * step) - found.by_ratio).norm() < 1e-7);
      const double more = 0.6 * step;
      CHECK(((at(0.6 + more, ratio) - at(0.6 - more, ratio)) / (2 * step) - found.by_log_load).norm() < 1e-7);
    }
  }
}

TEST_CASE("A slider keeps what a beat left it with until the next one moves it", "[two_phases]") {
  const std::vector<Line> all{{1, -1}, {1, 0}, {1, 1}};
  const TwoPhases phases(all, 16);
  ComplexVector x(3);
  x << Complex(0.5, 0.1), 1, Complex(0.52, 0.02);  // up to 2.0, down to 0.1
  LineForce found;
  for (const double ratio : {0.021, 1.979}) {
    phases.slide(1.7, 0.6, x, ratio, true, found);
    CHECK((found.force - marched(all, x, 1.7, 0.6, ratio, 16, 60, 1 << 11)).norm() <
          1e-5 * found.force.norm());
  }
}

TEST_CASE("Without a second frequency a slider is the loop of the first", "[two_phases]") {
  const std::vector<Line> all = lines(true, 5, 1);
  const TwoPhases phases(all, 8);
  ComplexVector x = ComplexVector::Zero(std::ssize(all));
  HarmonicVector harmonics(3);
  harmonics << 2, Complex(0.2, -0.3), Complex(-0.05, 0.1);
  for (Index a = 0; a < x.size(); ++a) {
    const Line& line = all[static_cast<std::size_t>(a)];
    if (line.l == 0) x(a) = harmonics(line.k / 2);
  }
  const Jenkins contact(1.7, 0.3);
  ElementForce loop;
  contact.force(std::vector<int>{1, 3, 5}, harmonics, 2, true, true, loop);
  LineForce found;
  REQUIRE(contact.in_two_phases(phases, 2, x, 0.3, true, found));
  for (Index a = 0; a < x.size(); ++a) {
    const Line& line = all[static_cast<std::size_t>(a)];
    CHECK(std::abs(found.force(a) - (line.l == 0 ? loop.harmonics(line.k / 2) : Complex(0))) < 1e-12);
    if (line.l == 0) CHECK(std::abs(found.by_log_load(a) - loop.by_log_load(line.k / 2)) < 1e-12);
  }
}

TEST_CASE("A cubic spring under two frequencies has the lines of its polynomial", "[two_phases]") {
  std::mt19937 random(5);
  const std::vector<Line> all = lines(true, 3, 2);
  const TwoPhases phases(all, 12);
  const ComplexVector x = motion(all, random);
  LineForce found;
  REQUIRE(cubic_spring(0.8, 1)->in_two_phases(phases, 1, x, 0.4, true, found));
  const auto force = [&](const ComplexVector& at) {
    ComplexVector sum = ComplexVector::Zero(at.size());
    constexpr int count = 40;
    for (int i = 0; i < count * count; ++i) {
      const double first = two_pi * (i / count) / count;
      const double second = two_pi * (i % count) / count;
      const double here = value(all, at, first, second);
      for (Index a = 0; a < at.size(); ++a) {
        const Line& line = all[static_cast<std::size_t>(a)];
        sum(a) +=
            2 * 0.8 / count / count * here * here * here * std::polar(1.0, -line.k * first - line.l * second);
      }
    }
    return sum;
  };
  CHECK((found.force - force(x)).norm() < 1e-12);
  check_derivatives(all, x, found, force);
}

}  // namespace arcslip::testing::two_phases
