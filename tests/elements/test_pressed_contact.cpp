#include "arcslip/elements/pressed/pressed_contact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "arcslip/elements/jenkins.hpp"
#include "catch.hpp"
#include "pressed_motions.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// Harmonics of both forces in the second period of a march.
struct Marched {
  ComplexVector tangential;
  ComplexVector normal;
};

Marched marched(const PressedSettings& s, const ComplexVector& r, const ComplexVector& g, int samples) {
  Marched out{ComplexVector::Zero(r.size()), ComplexVector::Zero(r.size())};
  std::vector<Complex> turns(static_cast<std::size_t>(samples));
  for (int i = 0; i < samples; ++i)
    turns[static_cast<std::size_t>(i)] = std::polar(1.0, two_pi * i / samples);
  double f = 0;
  double last = 0;
  double last_closing = 0;
  for (int i = 0; i < 2 * samples; ++i) {
    double slid = 0;
    double closed = 0;
    for (Index h = 0; h < r.size(); ++h) {
      const Complex turn = turns[static_cast<std::size_t>(h * (i % samples) % samples)];
      slid += std::real(r(h) * turn);
      closed += std::real(g(h) * turn);
    }
    const double closing = s.normal_force + s.normal_stiffness * closed;
    const double press = std::max(0.0, closing);
    // of a step in which the parts touch again only what follows counts
    const double part = last_closing < 0 && closing > 0 ? closing / (closing - last_closing) : 1;
    last_closing = closing;
    f = std::clamp(f + s.tangential_stiffness * part * (slid - last), -s.friction * press,
                   s.friction * press);
    last = slid;
    if (i < samples) continue;
    for (Index h = 0; h < r.size(); ++h) {
      const Complex turn = std::conj(turns[static_cast<std::size_t>(h * (i % samples) % samples)]);
      out.tangential(h) += f * turn * (h == 0 ? 1.0 : 2.0) / double(samples);
      out.normal(h) += press * turn * (h == 0 ? 1.0 : 2.0) / double(samples);
    }
  }
  return out;
}

/// f and N, one behind the other.
ComplexVector both(const PressedForce& force) {
  ComplexVector sum(2 * force.tangential.size());
  sum << force.tangential, force.normal;
  return sum;
}

}  // namespace

TEST_CASE("Friction under varying normal load has the harmonics of published loops", "[pressed]") {
  for (const PublishedLoop& row : published_loops()) {
    CAPTURE(row.X, row.n1, row.phi);
    ComplexVector r = ComplexVector::Zero(4);
    ComplexVector g = ComplexVector::Zero(4);
    r(1) = row.X;
    g(1) = std::polar(row.n1, -row.phi);
    const PressedSettings settings{.75, 2, 2.5, 2.5 * row.n0};
    const PressedForce force = pressed_force(settings, from_zero_to(3), r, g, false);
    CHECK(std::abs(force.tangential(0) - row.f[0]) < 1e-7);
    for (int h = 1; h <= 3; ++h) {
      const auto at = static_cast<std::size_t>(2 * h);
      CHECK(std::abs(force.tangential(h) - Complex(row.f[at - 1], -row.f[at])) < 1.5e-7);  // as printed
    }
    CHECK_THAT(force.energy, WithinAbs(-pi * row.X * row.f[2], 1e-5));
    CHECK((force.apart_fraction > 0) == (row.n1 > row.n0));
    ComplexVector both(8);
    both << r, g;
    CHECK_THAT(extreme_press(settings, from_zero_to(3), both, 1, false),
               WithinAbs(2.5 * std::max(0.0, row.n0 - row.n1), 1e-12));
    CHECK_THAT(extreme_press(settings, from_zero_to(3), both, 1, true),
               WithinAbs(2.5 * (row.n0 + row.n1), 1e-12));
  }
}

TEST_CASE("Under a constant normal load it is a Jenkins element", "[pressed]") {
  RandomSystems draw(5);
  const std::vector<int> orders{1, 3, 5};
  for (int i = 0; i < 100; ++i) {
    CAPTURE(i);
    HarmonicVector r(3);
    for (Index a = 0; a < 3; ++a)
      r(a) = std::polar(draw.uniform(0.5, 1) / double(1 + 2 * a), draw.uniform(-pi, pi));
    const double threshold = draw.uniform(0.05, 0.4);
    ElementForce known;
    Jenkins(2, 1).force(orders, r, threshold, true, true, known);
    const PressedForce force =
        pressed_force({0.5, 2, 0, 4 * threshold}, orders, ComplexVector(r), ComplexVector::Zero(3), true);
    CHECK((force.tangential - known.harmonics).norm() < 1e-12);
    CHECK((force.tangential_by_sliding.linear - known.linear).norm() < 1e-12 * 100);
    CHECK((force.tangential_by_sliding.conjugate - known.conjugate).norm() < 1e-12 * 100);
    CHECK_THAT(force.energy, WithinAbs(known.energy, 1e-12));
    CHECK((4 * threshold * force.tangential_by[PressedForce::normal_force] - known.by_log_load).norm() <
          1e-10);
  }
}

TEST_CASE("Friction under varying normal load is that of a march in time", "[pressed]") {
  RandomSystems draw(17);
  double apart = 0;
  double slip = 0;
  for (const int highest : {1, 3, 7}) {
    for (int i = 0; i < 70; ++i) {
      CAPTURE(highest, i);
      const PressedSettings settings = random_pressed(draw);
      const ComplexVector r = random_course(draw, highest, 1);
      const ComplexVector g = random_course(draw, highest, 0.5);
      const PressedForce force = pressed_force(settings, from_zero_to(highest), r, g, false);
      const Marched other = marched(settings, r, g, 1 << 16);
      apart += force.apart_fraction;
      slip += force.slip_fraction;
      CHECK((force.normal - other.normal).norm() < 1e-5);
      const bool never_slips = force.slip_fraction == 0 && force.apart_fraction == 0;
      const Index from = never_slips ? 1 : 0;  // a march begins elsewhere and may settle at another offset
      CHECK((force.tangential - other.tangential).tail(highest + 1 - from).norm() < 1e-5);
      CHECK(force.energy > -1e-13);
    }
  }
  CHECK(apart > 20);
  CHECK(slip > 20);
}

TEST_CASE("Derivatives of friction under varying normal load are exact", "[pressed]") {
  RandomSystems draw(3);
  int near = 0;
  for (const int highest : {1, 3, 7}) {
    const std::vector<int> orders = from_zero_to(highest);
    for (int i = 0; i < 40; ++i) {
      CAPTURE(highest, i);
      const PressedSettings s = random_pressed(draw);
      const ComplexVector r = random_course(draw, highest, 1);
      const ComplexVector g = random_course(draw, highest, 0.5);
      const ComplexVector dr = random_course(draw, highest, 1);
      const ComplexVector dg = random_course(draw, highest, 1);
      const double ds[] = {draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1),
                           draw.uniform(-1, 1)};
      const auto difference = [&](double step) {
        const auto moved = [&](double by) {
          const PressedSettings t{s.friction + by * ds[0], s.tangential_stiffness + by * ds[1],
                                  s.normal_stiffness + by * ds[2], s.normal_force + by * ds[3]};
          return both(pressed_force(t, orders, r + by * dr, g + by * dg, false));
        };
        return ComplexVector((8.0 * (moved(step) - moved(-step)) - (moved(2 * step) - moved(-2 * step))) /
                             (12 * step));
      };
      const PressedForce force = pressed_force(s, orders, r, g, true);
      const auto along = [](const HarmonicDerivative& by, const ComplexVector& way) {
        return ComplexVector(by.linear * way + by.conjugate * way.conjugate());
      };
      ComplexVector exact(2 * (highest + 1));
      exact << along(force.tangential_by_sliding, dr) + along(force.tangential_by_closing, dg),
          along(force.normal_by_closing, dg);
      for (std::size_t k = 0; k < 4; ++k) {
        exact.head(highest + 1) += ds[k] * force.tangential_by[k];
        exact.tail(highest + 1) += ds[k] * force.normal_by[k];
      }
      const ComplexVector fine = difference(2e-5);
      if ((fine - difference(1e-5)).norm() > 1e-9) {  // beside a transition
        ++near;
        continue;
      }
      CHECK((exact - fine).norm() < 2e-9);
    }
  }
  CHECK(near < 24);
}

TEST_CASE("Second derivatives of friction under varying normal load are those of differences", "[pressed]") {
  RandomSystems draw(7);
  int near = 0;
  int told = 0;
  for (const int highest : {1, 3, 7}) {
    const std::vector<int> orders = from_zero_to(highest);
    const Index n = highest + 1;
    for (int i = 0; i < 30; ++i) {
      CAPTURE(highest, i);
      const PressedSettings s = random_pressed(draw);
      const auto jet = [&](double number) { return Jet(number, draw.uniform(-1, 1), draw.uniform(-1, 1)); };
      const PressedElement element({jet(s.friction), jet(s.tangential_stiffness), jet(s.normal_stiffness),
                                    jet(0.3 * s.normal_force), jet(0.7 * s.normal_force)});
      HarmonicVector x(2 * n);
      x << random_course(draw, highest, 1), random_course(draw, highest, 0.5);
      Element::Way way{HarmonicVector(2 * n), draw.uniform(-1, 1), 0};
      way.motion << random_course(draw, highest, 1), random_course(draw, highest, 1);
      const auto at = [&](double by) {
        ElementForce force;
        element.force(orders, x + by * way.motion, std::exp(by * way.log_load), true, true, force);
        ComplexMatrix all(2 * n, 4 * n + 1);
        all << force.linear, force.conjugate, force.by_log_load;
        return all;
      };
      const auto difference = [&](double step) {
        return ComplexMatrix((8.0 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step));
      };
      const ComplexMatrix fine = difference(2e-5);
      if ((fine - difference(1e-5)).norm() > 1e-7 * (1 + fine.norm())) {  // beside a transition
        ++near;
        continue;
      }
      if (element.border(orders, x, nullptr, 1, true).value > 0) continue;  // it would stick
      ElementForce here;
      element.force(orders, x, 1, true, true, here);
      const ElementForce change = element.change(here, orders, x, 1, true, way);
      ++told;
      ComplexMatrix exact(2 * n, 4 * n + 1);
      exact << change.linear, change.conjugate, change.by_log_load;
      CHECK((exact - fine).norm() < 1e-6 * (1 + fine.norm()));
      // By the setting derivatives change as by what it is, whose part of the force changes with the motion.
      const ElementForce by_setting = element.change(here, orders, x, 1, true, {way.motion * 0, 0, 1});
      const HarmonicVector mixed = by_setting.linear * way.motion +
                                   by_setting.conjugate * way.motion.conjugate() +
                                   way.log_load * by_setting.by_log_load;
      CHECK((mixed - change.by_setting).norm() < 1e-6 * (1 + mixed.norm()));
    }
  }
  CHECK(near < 24);
  CHECK(told > 40);
}

TEST_CASE("Where an arc is born second derivatives of friction are those of one side", "[pressed]") {
  // At N_0 = 1 the parts only just touch all the time; slip there begins and ends elsewhere.
  const std::vector<int> orders = from_zero_to(1);
  const auto change = [&](double normal_force) {
    const PressedElement element({.5, 1, 1, normal_force, 0});
    HarmonicVector x(4);
    x << 0, Complex(2, .3), 0, 1;
    HarmonicVector way(4);
    way << .1, Complex(.2, .3), .1, Complex(.3, -.2);
    ElementForce here;
    element.force(orders, x, 1, true, true, here);
    return element.change(here, orders, x, 1, true, {way}).linear;
  };
  const ComplexMatrix touching = change(1);
  CHECK((touching - change(1 + 1e-9)).norm() < 1e-4 * touching.norm());
  CHECK((touching - change(1 - 1e-9)).norm() > 1e-2 * touching.norm());
}

TEST_CASE("Friction under varying normal load stands what coincides", "[pressed]") {
  const std::vector<int> orders = from_zero_to(2);
  const auto force = [&](PressedSettings s, std::vector<Complex> r, std::vector<Complex> g) {
    return pressed_force(s, orders, Eigen::Map<ComplexVector>(r.data(), 3),
                         Eigen::Map<ComplexVector>(g.data(), 3), true);
  };
  // never touches, never moves, only grazes lift-off, slips at the very threshold
  CHECK(force({.5, 1, 1, -2}, {1, 1, 0}, {0, 1, 0}).tangential.norm() == 0);
  CHECK(force({.5, 1, 1, -2}, {1, 1, 0}, {0, 1, 0}).apart_fraction == 1);
  const PressedForce rest = force({.5, 1, 1, 2}, {.7, 0, 0}, {0, 0, 0});
  CHECK(std::abs(rest.tangential(0) - 0.7) < 1e-15);
  CHECK(rest.normal(0) == Complex(2));
  const PressedForce pulled = force({.5, 1, 1, 2}, {3, 0, 0}, {0, 0, 0});
  CHECK(std::abs(pulled.tangential(0) - 1.0) < 1e-15);
  const PressedForce grazes = force({.5, 1, 1, 1}, {0, 1, 0}, {0, 1, 0});
  const PressedForce apart = force({.5, 1, 1, 1 - 1e-9}, {0, 1, 0}, {0, 1, 0});
  CHECK((grazes.tangential - apart.tangential).norm() < 1e-8);
  CHECK(grazes.tangential.allFinite());
  CHECK(grazes.tangential_by_closing.linear.allFinite());
  const PressedForce border = force({.5, 1, 0, 2}, {0, 1, 0}, {0, 0, 0});
  CHECK((border.tangential - ComplexVector::Unit(3, 1)).norm() < 1e-12);
  // stuck for ever: without residual friction as long as it holds so, else at the bound
  const PressedForce stuck = force({.5, 1, 0, 4}, {.5, 1, 0}, {0, 0, 0});
  CHECK(std::abs(stuck.tangential(0) - 0.5) < 1e-15);
  CHECK(stuck.slip_fraction == 0);
  const PressedForce loaded = force({.5, 1, 0, 4}, {5, 1, 0}, {0, 0, 0});
  CHECK(std::abs(loaded.tangential(0) - 1.0) < 1e-14);  // its greatest force is at the limit
  CHECK(std::abs(loaded.tangential(1) - 1.0) < 1e-14);
  CHECK_THROWS_AS(force({.5, 0, 0, 4}, {5, 1, 0}, {0, 0, 0}), std::invalid_argument);
}

TEST_CASE("A mass between friction and its normal force moves as integrated in time", "[pressed]") {
  // m = 1, sliding x, closing y, K = [1 .2; .2 1.5], C = .05 K, w = 1.1, load (1, .6 e^{.5j}), preload 1
  const PressedSettings settings{.5, .6, .8, 1};
  constexpr Index count = 17;
  const std::vector<int> orders = from_zero_to(count - 1);
  const Eigen::Matrix2d K{{1, .2}, {.2, 1.5}};
  ComplexVector d = ComplexVector::Zero(2 * count);  // x, then y
  double error = 1;
  for (int i = 0; i < 40 && error > 1e-12; ++i) {
    const PressedForce force = pressed_force(settings, orders, d.head(count), d.tail(count), true);
    ComplexVector residual(2 * count);
    residual << force.tangential, force.normal;
    residual(count) -= 1;
    residual(1) -= 1;
    residual(count + 1) -= std::polar(.6, .5);
    ComplexMatrix linear = ComplexMatrix::Zero(2 * count, 2 * count);
    ComplexMatrix conjugate = linear;
    linear << force.tangential_by_sliding.linear, force.tangential_by_closing.linear,
        ComplexMatrix::Zero(count, count), force.normal_by_closing.linear;
    conjugate << force.tangential_by_sliding.conjugate, force.tangential_by_closing.conjugate,
        ComplexMatrix::Zero(count, count), force.normal_by_closing.conjugate;
    for (Index h = 0; h < count; ++h) {
      const double w = 1.1 * double(h);
      const Eigen::Matrix2cd Z = K * Complex(1, .05 * w) - w * w * Eigen::Matrix2d::Identity();
      for (Index a : {0, 1}) {
        for (Index b : {0, 1}) {
          residual(h + a * count) += Z(a, b) * d(h + b * count);
          linear(h + a * count, h + b * count) += Z(a, b);
        }
      }
    }
    Matrix jacobian(4 * count, 4 * count);
    jacobian << (linear + conjugate).real(), -(linear - conjugate).imag(), (linear + conjugate).imag(),
        (linear - conjugate).real();
    Vector rest(4 * count);
    rest << residual.real(), residual.imag();
    const Vector step = jacobian.partialPivLu().solve(rest);
    d.real() -= step.head(2 * count);
    d.imag() -= step.tail(2 * count);
    error = step.norm();
  }
  CHECK(error < 1e-12);
  const double integrated[] = {.211893, 4.305776, .086827, -.021505, 1.335933, .004833};
  for (Index h = 0; h < 3; ++h) {  // 16 harmonics are off by 5e-6
    CAPTURE(h);
    CHECK_THAT(h == 0 ? d(0).real() : std::abs(d(h)), WithinAbs(integrated[h], 1e-5));
    CHECK_THAT(h == 0 ? d(count).real() : std::abs(d(count + h)), WithinAbs(integrated[h + 3], 1e-5));
  }
}
