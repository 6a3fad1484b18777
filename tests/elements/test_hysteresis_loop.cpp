#include <boost/math/differentiation/autodiff.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "arcslip/elements/contact.hpp"
#include "arcslip/elements/hysteresis_loop.hpp"
#include "catch.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

HarmonicVector harmonics(const std::vector<Complex>& values) {
  return Eigen::Map<const ComplexVector>(values.data(), std::ssize(values));
}

HarmonicVector force_of(const std::vector<int>& orders, const HarmonicVector& r, double S) {
  const OddMotion motion(orders, r);
  HarmonicVector force;
  HysteresisLoop(motion, S).force(force);
  return force;
}

/// A motion whose harmonics fall off, with an amplitude above S for most draws.
HarmonicVector random_motion(RandomSystems& draw, const std::vector<int>& orders, double decay) {
  HarmonicVector r(std::ssize(orders));
  for (std::size_t a = 0; a < orders.size(); ++a)
    r(static_cast<Index>(a)) =
        std::polar(draw.uniform(0.5, 1) * std::pow(orders[a], -decay), draw.uniform(-pi, pi));
  return r;
}

/// The settled force at `samples` instants, marched in small steps by the law of the Jenkins element.
std::vector<double> marched(const OddMotion& motion, double S, int samples) {
  std::vector<double> force(static_cast<std::size_t>(samples));
  double f = 0;
  double last = motion.value(0);
  for (int i = 0; i < 2 * samples; ++i) {  // the second period is settled
    const double r = motion.value(2 * pi * i / samples);
    f = std::clamp(f + r - last, -S, S);
    last = r;
    force[static_cast<std::size_t>(i % samples)] = f;
  }
  return force;
}

}  // namespace

TEST_CASE("The loop of a harmonic motion has the harmonics of the closed form", "[harmonics]") {
  // Caughey, J. Appl. Mech. 27 (1960) 640: k = 2, slip force 3, X = 5; cosines and sines of the force
  const std::vector<int> orders{1, 3, 5, 7};
  const double k = 2;
  const HarmonicVector force = k * force_of(orders, harmonics({5, 0, 0, 0}), 1.5);
  const double cosines[] = {2.523157877343, 0.653488258, -0.224799961, 0.038686505};
  const double sines[] = {-2.673803043944, 0.606062023, 0.148021737, -0.096538041};
  for (Index a = 0; a < 4; ++a) {
    CAPTURE(a);
    const double digits = a == 0 ? 1e-12 : 6e-10;  // as they are printed
    CHECK_THAT(force(a).real(), WithinAbs(cosines[a], digits));
    CHECK_THAT(-force(a).imag(), WithinAbs(sines[a], digits));
  }
  const HarmonicVector r = harmonics({5, 0, 0, 0});
  const OddMotion motion(orders, r);
  CHECK_THAT(k * HysteresisLoop(motion, 1.5).energy(), WithinRel(42.0, 1e-14));
}

TEST_CASE("In full slip the force is a square wave, at the threshold all of the motion", "[harmonics]") {
  const std::vector<int> orders{1, 3};
  const HarmonicVector slip = 2 * force_of(orders, harmonics({1e30, 0}), 1.5);
  // tmdsimpy tests/nlforces/test_jenkins_hysteretic_aft.py: sines -4 Fs/pi and -4 Fs/(3 pi), Fs = 3
  CHECK_THAT(-slip(0).imag(), WithinRel(-3.819718634205, 1e-12));
  CHECK_THAT(-slip(1).imag(), WithinRel(-1.273239544735, 1e-12));
  const HarmonicVector stuck = harmonics({Complex(0.3, -0.4), 0});
  CHECK((force_of(orders, stuck, 0.5) - stuck).norm() < 1e-15);
}

TEST_CASE("With one harmonic the loop is the coefficient phi, from R = S to R = 1e12 S", "[harmonics]") {
  const std::vector<int> orders{1};
  for (double ratio = 1; ratio < 2e12; ratio *= ratio < 1.5 ? 1.0123 : 2.7) {
    const Complex r = std::polar(0.7, 0.4);
    const double S = 0.7 / ratio;
    const HarmonicVector one = harmonics({r});
    const OddMotion motion(orders, one);
    const HysteresisLoop loop(motion, S);
    HarmonicVector force;
    ComplexMatrix linear;
    ComplexMatrix conjugate;
    loop.force(force);
    loop.derivative(linear, conjugate);
    const HarmonicCoefficient phi = slip_coefficient(std::log(ratio));
    CAPTURE(ratio);
    const double rounding =
        1e-14 * std::sqrt(ratio);  // of the turning point's neighbourhood, 1/sqrt(ratio) wide
    CHECK(std::abs(force(0) / r - phi.phi) <= rounding * std::abs(phi.phi));
    // f = phi(R) r: df = (phi + phi'/2) dr + phi'/2 (r/R)^2 conj(dr)
    CHECK(std::abs(linear(0, 0) - phi.phi - 0.5 * phi.phi_log) <=
          1e-13 * std::abs(phi.phi) + rounding * 1e-2);
    CHECK(std::abs(conjugate(0, 0) - 0.5 * phi.phi_log * r * r / std::norm(r)) <=
          1e-13 * std::abs(phi.phi) + rounding * 1e-2);
    CHECK_THAT(loop.energy(),
               WithinRel(dissipated_energy(std::log(ratio)) * S * S, 1e-12) || WithinAbs(0, 1e-15));
  }
}

TEST_CASE("The loop of any odd motion is what small steps of the slider give", "[harmonics]") {
  RandomSystems draw(3);
  const std::vector<int> orders{1, 3, 5, 7, 9, 11, 13};
  constexpr int samples = 1 << 15;
  int inner = 0;
  for (int i = 0; i < 40; ++i) {
    const HarmonicVector r = random_motion(draw, orders, draw.uniform(0, 2));
    const OddMotion motion(orders, r);
    const double amplitude = motion.maximum().value;
    const double S = amplitude * draw.log_uniform(1e-3, 0.99);
    const HysteresisLoop loop(motion, S);
    HarmonicVector force;
    loop.force(force);
    inner += loop.slips() > 1 ? 1 : 0;
    const std::vector<double> steps = marched(motion, S, samples);
    double energy = 0;
    for (std::size_t at = 0; at < steps.size(); ++at) {
      const double next = steps[(at + 1) % steps.size()];
      energy += 0.5 * (steps[at] + next) *
                (motion.value(2 * pi * static_cast<double>(at + 1) / samples) -
                 motion.value(2 * pi * static_cast<double>(at) / samples));
    }
    CAPTURE(i, S / amplitude);
    for (std::size_t a = 0; a < orders.size(); ++a) {
      Complex sum = 0;
      for (std::size_t at = 0; at < steps.size(); ++at)
        sum += steps[at] * std::polar(2.0 / samples, -2 * pi * orders[a] * static_cast<double>(at) / samples);
      // steps of 2e-4 see a turn of curvature 1e3 to 2e-5 of the amplitude
      CHECK(std::abs(force(static_cast<Index>(a)) - sum) < 3e-5 * amplitude);
    }
    CHECK_THAT(loop.energy(), WithinAbs(energy, 1e-3 * amplitude * S));
    // the same from the harmonics: pi sum h Im(f_h conj(r_h))
    double power = 0;
    for (std::size_t a = 0; a < orders.size(); ++a)
      power += pi * orders[a] * std::imag(force(static_cast<Index>(a)) * std::conj(r(static_cast<Index>(a))));
    CHECK_THAT(loop.energy(), WithinAbs(power, 1e-12 * amplitude * amplitude));
  }
  CHECK(inner > 10);
}

TEST_CASE("A slip that has only just begun where the motion turns back is found", "[harmonics]") {
  const std::vector<int> orders{1, 3, 5};
  RandomSystems draw(9);
  int begun = 0;
  for (int i = 0; i < 300; ++i) {
    const HarmonicVector r = random_motion(draw, orders, 0.7);
    const OddMotion motion(orders, r);
    const Angles turns = motion.turning_points();
    for (int k = 0; k + 1 < turns.count; ++k) {
      const double S = 0.5 * std::abs(motion.value(turns[k + 1]) - motion.value(turns[k]));
      if (!(S < motion.maximum().value)) continue;
      const HarmonicVector below = force_of(orders, r, S * (1 - 2e-16 * draw.uniform(1, 40)));
      const HarmonicVector above = force_of(orders, r, S * (1 + 1e-14));
      begun += static_cast<int>(HysteresisLoop(motion, S * (1 - 1e-14)).slips() !=
                                HysteresisLoop(motion, S * (1 + 1e-14)).slips());
      CHECK_THAT((below - above).norm(), WithinAbs(0, 1e-12));  // continuous in S
    }
  }
  CHECK(begun > 100);
}

TEST_CASE("The derivative of the loop is that of automatic differentiation", "[harmonics]") {
  // The force of a motion that turns twice a period, in closed form, by dual numbers through both angles.
  using Dual = boost::math::differentiation::autodiff_fvar<double, 1>;
  const std::vector<int> orders{1, 3, 5};
  RandomSystems draw(7);
  for (int i = 0; i < 20; ++i) {
    HarmonicVector r = random_motion(draw, orders, 3.5);
    const double S = draw.log_uniform(1e-3, 0.3);
    const OddMotion motion(orders, r);
    REQUIRE(motion.turning_points().count == 1);
    ComplexMatrix linear;
    ComplexMatrix conjugate;
    const HysteresisLoop loop(motion, S);
    loop.derivative(linear, conjugate);
    for (Index moved = 0; moved < 6; ++moved) {
      std::vector<Dual> x;
      for (Index k = 0; k < 6; ++k) {
        const double part = k % 2 == 0 ? r(k / 2).real() : r(k / 2).imag();
        x.push_back(k == moved ? boost::math::differentiation::make_fvar<double, 1>(part) : Dual(part));
      }
      const auto sum = [&](const Dual& theta, int derivative) {  // r and its slopes
        Dual total = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          const double h = orders[a];
          const Dual angle = h * theta + 0.5 * pi * derivative;
          total += std::pow(h, derivative) * (x[2 * a] * cos(angle) - x[2 * a + 1] * sin(angle));
        }
        return total;
      };
      Dual turn = motion.maximum().angle;
      for (int step = 0; step < 3; ++step) turn -= sum(turn, 1) / sum(turn, 2);
      const double from = static_cast<double>(turn);
      double low = from;
      double high = from + pi;
      while (high - low > 1e-13) {
        const double middle = 0.5 * (low + high);
        (static_cast<double>(sum(Dual(middle), 0) - sum(turn, 0)) + 2 * S > 0 ? low : high) = middle;
      }
      Dual onset = low;
      for (int step = 0; step < 3; ++step) onset -= (sum(onset, 0) - sum(turn, 0) + 2 * S) / sum(onset, 1);
      const Dual offset = S - sum(turn, 0);
      for (std::size_t a = 0; a < 3; ++a) {
        const double h = orders[a];
        // int e^{jm theta} from `low` to `high`
        const auto integral = [](double m, const Dual& begin, const Dual& end, Dual& real, Dual& imaginary) {
          if (m == 0) {
            real = end - begin;
            imaginary = 0;
            return;
          }
          real = (sin(m * end) - sin(m * begin)) / m;
          imaginary = (cos(m * begin) - cos(m * end)) / m;
        };
        Dual force_real = 0;
        Dual force_imaginary = 0;
        Dual real;
        Dual imaginary;
        for (std::size_t b = 0; b < 3; ++b) {
          integral(orders[b] - h, turn, onset, real, imaginary);
          force_real += 0.5 * (x[2 * b] * real - x[2 * b + 1] * imaginary);
          force_imaginary += 0.5 * (x[2 * b] * imaginary + x[2 * b + 1] * real);
          integral(-orders[b] - h, turn, onset, real, imaginary);
          force_real += 0.5 * (x[2 * b] * real + x[2 * b + 1] * imaginary);
          force_imaginary += 0.5 * (x[2 * b] * imaginary - x[2 * b + 1] * real);
        }
        integral(-h, turn, onset, real, imaginary);
        force_real += offset * real;
        force_imaginary += offset * imaginary;
        integral(-h, onset, turn + pi, real, imaginary);
        force_real -= S * real;
        force_imaginary -= S * imaginary;
        const Complex expected = Complex(force_real.derivative(1), force_imaginary.derivative(1)) * (2 / pi);
        const Index column = moved / 2;
        const Complex found =
            moved % 2 == 0 ? linear(static_cast<Index>(a), column) + conjugate(static_cast<Index>(a), column)
                           : Complex(0, 1) * (linear(static_cast<Index>(a), column) -
                                              conjugate(static_cast<Index>(a), column));
        CAPTURE(i, moved, a);
        CHECK(std::abs(found - expected) < 1e-10);
      }
    }
  }
}

TEST_CASE("Turning points may meet to rounding, two in an inflection or three", "[harmonics]") {
  const std::vector<int> orders{1, 3, 5};
  RandomSystems draw(3);
  int found = 0;
  for (int i = 0; i < 800; ++i) {
    // dr/dtheta and d2r/dtheta2 vanish at theta = 0, in every fourth draw d3r/dtheta3 as well
    const bool three = i % 4 == 0;
    HarmonicVector r(3);
    r(2) = three ? 0 : Complex(draw.uniform(-1, 1), draw.uniform(-0.3, 0.3));
    r(1) = {draw.uniform(-1, 1), three ? 0 : draw.uniform(-1, 1)};
    const double apart = draw.log_uniform(1e-18, 1e-6) * (i % 2 == 0 ? 1 : -1);
    r(0) = {-9 * r(1).real() - 25 * r(2).real(), apart - 3 * r(1).imag() - 5 * r(2).imag()};
    const double theta = draw.uniform(-3, 3);
    for (Index a = 0; a < 3; ++a) r(a) *= std::polar(1.0, -orders[static_cast<std::size_t>(a)] * theta);
    const OddMotion motion(orders, r);
    const double top = motion.maximum().value;
    double sampled = 0;
    for (int k = 0; k < 1000; ++k) sampled = std::max(sampled, motion.value(k * pi / 1000));
    for (int k = 0; k < 1000; ++k) sampled = std::max(sampled, -motion.value(k * pi / 1000));
    CHECK_THAT(top, WithinRel(sampled, 3e-4));  // 25 (pi/1000)^2 of what the harmonics sum up to
    const HysteresisLoop loop(motion, top * draw.uniform(0.01, 0.9));
    found += loop.slips();
    CHECK(loop.energy() > 0);
  }
  CHECK(found >= 800);
}

TEST_CASE("Turning points are found whatever harmonics a motion has", "[harmonics]") {
  RandomSystems draw(11);
  for (int i = 0; i < 50; ++i) {
    const std::vector<int> orders =
        i % 2 == 0 ? std::vector<int>{1, 3, 5, 7, 9} : std::vector<int>{1, 21, 63};
    const HarmonicVector r = random_motion(draw, orders, draw.uniform(0, 3));
    const OddMotion motion(orders, r);
    const Angles found = motion.turning_points();
    int changes = 0;
    constexpr int samples = 20'000;
    for (int at = 0; at < samples; ++at) {
      changes += motion.slopes(found[0] + 1e-6 + pi * at / samples).first *
                             motion.slopes(found[0] + 1e-6 + pi * (at + 1) / samples).first <
                         0
                     ? 1
                     : 0;
    }
    CAPTURE(i);
    CHECK(found.count == changes);
    for (int at = 0; at < found.count; ++at)
      CHECK_THAT(motion.slopes(found[at]).first, WithinAbs(0, 1e-11));  // slopes reach 1e2, each to rounding
  }
}
