// Friction in a plane against closed forms, the contact in one direction, marches in time and differences.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "arcslip/elements/circle/circle_contact.hpp"
#include "arcslip/elements/jenkins.hpp"
#include "catch.hpp"
#include "plane_motions.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using Course = PressedArcs::Course;

namespace {

/// Along a line at an angle of the plane.
ComplexVector along_line(const ComplexVector& r, double angle, const ComplexVector& g) {
  return joined(std::cos(angle) * r, std::sin(angle) * r, g);
}

/// Harmonics of both components of the force in the last of many periods of radial return: where it slips
/// little they settle slowly.
ComplexVector marched(const PressedSettings& s, const ComplexVector& motion, Index samples) {
  const Index n = motion.size() / 3;
  ComplexMatrix turns(samples, n);
  for (Index i = 0; i < samples; ++i) {
    for (Index h = 0; h < n; ++h)
      turns(i, h) = std::polar(1.0, two_pi * double(i * h % samples) / double(samples));
  }
  const Vector x = (turns * motion.head(n)).real();
  const Vector y = (turns * motion.segment(n, n)).real();
  const Vector press = s.normal_force + s.normal_stiffness * (turns * motion.tail(n)).real().array();
  ComplexVector out = ComplexVector::Zero(2 * n);
  constexpr Index periods = 40;
  Complex force = 0;
  for (Index i = 1; i <= periods * samples; ++i) {
    const Index here = i % samples;
    const Index last = (i - 1) % samples;
    const double part = press(last) < 0 && press(here) > 0 ? press(here) / (press(here) - press(last)) : 1;
    force += s.tangential_stiffness * part * Complex(x(here) - x(last), y(here) - y(last));
    const double limit = s.friction * std::max(0.0, press(here));
    if (std::abs(force) > limit) force *= limit / std::abs(force);
    if (i <= (periods - 1) * samples) continue;
    for (Index h = 0; h < n; ++h) {
      const Complex turn = std::conj(turns(here, h)) * ((h == 0 ? 1.0 : 2.0) / double(samples));
      out(h) += force.real() * turn;
      out(n + h) += force.imag() * turn;
    }
  }
  return out;
}

/// By the derivatives of a force.
ComplexVector change(const CircleForce& force, const ComplexVector& way,
                     const std::vector<double>& settings) {
  const Index n = way.size();
  ComplexVector sum = force.linear.leftCols(n) * way + force.conjugate.leftCols(n) * way.conjugate();
  for (std::size_t s = 0; s < settings.size(); ++s) sum += settings[s] * force.by[s];
  return sum;
}

}  // namespace

TEST_CASE("A circular orbit meets the closed form of the friction circle", "[circle]") {
  const std::vector<int> orders{1};
  for (const double x : {1e-6, 1e-3, 0.1, 0.4, 0.6, 0.8, 0.95, 0.999, 1 - 1e-6, 1 - 1e-8}) {
    CAPTURE(x);
    const double k = 2, R = 1.3;
    ComplexVector motion(2);
    motion << R * std::polar(1.0, 0.4), R * std::polar(1.0, 0.4 - pi / 2);
    const CircleForce force = circle_force({0.5, k, 0, 2 * k * x * R}, orders, motion, true, Course::slips);
    const Complex phi(x * x, x * std::sqrt((1 - x) * (1 + x)));
    CHECK((force.harmonics.head(2) - k * phi * motion).norm() < 1e-11);
    CHECK_THAT(force.energy / (two_pi * k * R * R), WithinAbs(phi.imag(), 1e-11));
    CHECK_THAT(force.slip_fraction, WithinAbs(1, 1e-9));
    // by R, and by N: d phi/dx
    const Complex by_x(2 * x, (1 - 2 * x * x) / std::sqrt((1 - x) * (1 + x)));
    const double steep = 1 / std::sqrt((1 - x) * (1 + x));
    const ComplexVector by_radius =
        force.linear.topLeftCorner(2, 2) * motion + force.conjugate.topLeftCorner(2, 2) * motion.conjugate();
    CHECK((by_radius - k * (phi - x * by_x) * motion).norm() < 1e-9 * steep * steep);
    CHECK((force.by[PressedForce::normal_force].head(2) * 2.0 * k * R - k * by_x * motion).norm() <
          1e-9 * steep * steep);
  }
}

TEST_CASE("Published harmonics of friction in a plane are met", "[circle]") {
  // x = 3.75 cos + .4 cos 2 + .5 cos 3, N = 3.75 + 2.5 g: a march of 2^22 samples, to the digits given
  ComplexVector x(4), y(4), g(4);
  x << 0, 3.75, 0.4, 0.5;
  y << 0, Complex(1.5, -1.2), Complex(0, 0.3), 0.2;
  g << 0, Complex(0.5, 0.3), 0.2, 0;
  const CircleForce force =
      circle_force({0.75, 2, 2.5, 3.75}, from_zero_to(3), joined(x, y, g), false, Course::any);
  const Complex expected[] = {{0.747992, 0},         {1.638994, 2.588210}, {0.373185, 0.311161},
                              {0.818921, -0.035863}, {0.145541, 0},        {2.030365, -0.009995},
                              {-0.110366, 0.302695}, {0.017414, -0.304085}};
  for (Index i = 0; i < 8; ++i) CHECK(std::abs(force.harmonics(i) - expected[i]) < 8e-7);
  CHECK_THAT(force.energy, WithinAbs(38.346705, 6e-7));
}

TEST_CASE("Motion along a line of the plane meets friction in one direction", "[circle]") {
  RandomSystems draw(41);
  double apart = 0;
  for (const int highest : {1, 3, 7}) {
    const Index n = highest + 1;
    for (int i = 0; i < 40; ++i) {
      CAPTURE(highest, i);
      const PressedSettings s = random_pressed(draw);
      const ComplexVector r = random_course(draw, highest, 1);
      const ComplexVector g = random_course(draw, highest, 0.5);
      const double angle = draw.uniform(-pi, pi);
      const PressedForce line = pressed_force(s, from_zero_to(highest), r, g, true);
      const CircleForce plane =
          circle_force(s, from_zero_to(highest), along_line(r, angle, g), true, Course::any);
      const double c = std::cos(angle), d = std::sin(angle);
      apart += line.apart_fraction;
      CHECK((plane.harmonics.head(n) - c * line.tangential).norm() < 1e-12);
      CHECK((plane.harmonics.segment(n, n) - d * line.tangential).norm() < 1e-12);
      CHECK((plane.harmonics.tail(n) - line.normal).norm() < 1e-12);
      CHECK_THAT(plane.energy, WithinAbs(line.energy, 1e-12));
      CHECK_THAT(plane.slip_fraction, WithinAbs(line.slip_fraction, 1e-10));
      CHECK_THAT(plane.apart_fraction, WithinAbs(line.apart_fraction, 1e-12));
      ComplexVector both(2 * n);
      both << r, g;
      CHECK_THAT(extreme_press(s, from_zero_to(highest), along_line(r, angle, g), 2, false),
                 WithinAbs(extreme_press(s, from_zero_to(highest), both, 1, false), 1e-12));
      const ComplexVector dr = random_course(draw, highest, 1);
      const ComplexVector dg = random_course(draw, highest, 1);
      const std::vector<double> ds{0.3, -0.2, 0.5, 0.4};
      const ComplexVector found = change(plane, along_line(dr, angle, dg), ds);
      ComplexVector known =
          line.tangential_by_sliding.linear * dr + line.tangential_by_sliding.conjugate * dr.conjugate() +
          line.tangential_by_closing.linear * dg + line.tangential_by_closing.conjugate * dg.conjugate();
      for (std::size_t k = 0; k < 4; ++k) known += ds[k] * line.tangential_by[k];
      const double size = 1 + known.norm();
      CHECK((c * found.head(n) + d * found.segment(n, n) - known).norm() < 1e-11 * size);
      CHECK((d * found.head(n) - c * found.segment(n, n)).norm() < 1e-9 * size);
    }
  }
  CHECK(apart > 5);
}

TEST_CASE("Under a constant normal force along a line in odd harmonics it is a Jenkins element", "[circle]") {
  RandomSystems draw(6);
  const std::vector<int> orders{1, 3, 5};
  for (int i = 0; i < 50; ++i) {
    CAPTURE(i);
    HarmonicVector r(3);
    for (Index a = 0; a < 3; ++a)
      r(a) = std::polar(draw.uniform(0.5, 1) / double(1 + 2 * a), draw.uniform(-pi, pi));
    const double threshold = draw.uniform(0.05, 0.4);
    const double angle = draw.uniform(-pi, pi);
    ElementForce known;
    Jenkins(2, 1).force(orders, r, threshold, true, true, known);
    ComplexVector motion(6);
    motion << std::cos(angle) * r, std::sin(angle) * r;
    const CircleForce force = circle_force({0.5, 2, 0, 4 * threshold}, orders, motion, true, Course::slips);
    CHECK((std::cos(angle) * force.harmonics.head(3) + std::sin(angle) * force.harmonics.segment(3, 3) -
           known.harmonics)
              .norm() < 1e-12);
    CHECK_THAT(force.energy, WithinAbs(known.energy, 1e-12));
  }
}

TEST_CASE("Friction in a plane is that of radial return in time", "[circle]") {
  RandomSystems draw(17);
  int slips = 0, lifts = 0, sticks = 0;
  for (const int highest : {1, 3, 7}) {
    const Index n = highest + 1;
    for (int i = 0; i < 40; ++i) {
      CAPTURE(highest, i);
      const PressedSettings s = random_pressed(draw);
      const ComplexVector motion = random_motion(draw, highest);
      const CircleForce force = circle_force(s, from_zero_to(highest), motion, false, Course::any);
      lifts += force.apart_fraction > 0 && force.apart_fraction < 1;
      slips += force.apart_fraction == 0 && force.slip_fraction > 0;
      const bool rests = force.apart_fraction == 0 && force.slip_fraction == 0;
      sticks += rests;
      const Index samples = 1 << 12;
      ComplexVector error = 2 * marched(s, motion, 2 * samples) - marched(s, motion, samples);
      error -= force.harmonics.head(2 * n);
      if (rests) error(0) = error(n) = 0;  // a march begins elsewhere and rests at another offset
      CHECK(error.norm() < 1e-5);
      double energy = 0;
      for (Index h = 0; h < n; ++h)
        energy += pi * double(h) *
                  std::imag(force.harmonics(h) * std::conj(motion(h)) +
                            force.harmonics(n + h) * std::conj(motion(n + h)));
      CHECK_THAT(force.energy, WithinAbs(energy, 1e-12));
      CHECK(force.energy > -1e-11);
    }
  }
  CHECK(slips > 20);
  CHECK(lifts > 20);
}

TEST_CASE("Derivatives of friction in a plane are exact", "[circle]") {
  RandomSystems draw(3);
  int near = 0, stuck = 0;
  for (const int highest : {1, 3, 7}) {
    for (int i = 0; i < 30; ++i) {
      CAPTURE(highest, i);
      const PressedSettings s = random_pressed(draw);
      const ComplexVector motion = random_motion(draw, highest);
      const ComplexVector way = random_motion(draw, highest);
      const std::vector<double> settings{draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1),
                                         draw.uniform(-1, 1)};
      const auto at = [&](double by) {
        return circle_force(moved(s, settings, by), from_zero_to(highest), motion + by * way, false,
                            Course::any)
            .harmonics;
      };
      const CircleForce force = circle_force(s, from_zero_to(highest), motion, true, Course::any);
      stuck += force.slip_fraction == 0 && force.apart_fraction < 1;
      const ComplexVector fine = difference(at, 2e-4);
      const double size = 1 + fine.norm();
      if ((fine - difference(at, 1e-4)).norm() > 2e-8 * size) {  // beside a transition
        ++near;
        continue;
      }
      CHECK((change(force, way, settings) - fine).norm() < 2e-8 * size);
    }
  }
  CHECK(near < 20);
}

TEST_CASE("Published loops in one direction are met along any line of the plane", "[circle]") {
  // of sliders in two directions that do not know of one another, as some have them, this is all that they
  // share with it
  for (const PublishedLoop& row : published_loops()) {
    CAPTURE(row.X, row.n1, row.phi);
    const ComplexVector g = ComplexVector::Unit(4, 1) * std::polar(row.n1, -row.phi);
    const ComplexVector r = row.X * ComplexVector::Unit(4, 1);
    const CircleForce force =
        circle_force({.75, 2, 2.5, 2.5 * row.n0}, from_zero_to(3), along_line(r, 0.7, g), false, Course::any);
    const ComplexVector along =
        std::cos(0.7) * force.harmonics.head(4) + std::sin(0.7) * force.harmonics.segment(4, 4);
    CHECK(std::abs(along(0) - row.f[0]) < 1e-7);
    for (int h = 1; h <= 3; ++h) {
      const auto at = static_cast<std::size_t>(2 * h);
      CHECK(std::abs(along(h) - Complex(row.f[at - 1], -row.f[at])) < 1.5e-7);  // as printed
    }
  }
}

TEST_CASE("Published motions and states at rest of friction in three directions are met", "[circle]") {
  // tmdsimpy tests/jax/test_jax_3d_eldry.py: k_t = 2, k_n = 2.5, mu = 0.75, along lines of the plane,
  // on which its two sliders and the circle do the same up to their limits
  const PressedSettings s{.75, 2, 2.5, 0};
  const std::vector<int> orders = from_zero_to(3);
  const std::vector<std::vector<double>> courses{
      {.75, 2, 1.3, 0, 0, 1, 0},
      {.1, .2, .05, .1, .1, .1, 0},
      {4.29653115, 4.29165565, 2.8307871, 4.17186848, 3.37441948, .80543152, 3.55638299}};
  for (const std::vector<double>& c : courses) {
    ComplexVector course(4);
    course << c[0], Complex(c[1], -c[2]), Complex(c[3], -c[4]), Complex(c[5], -c[6]);
    for (const Complex way :
         {Complex(5, 3), Complex(.2, .3), Complex(5, 7), Complex(1e3, 1e4), Complex(1e10, 2e10)}) {
      if (std::abs(way) > 1e5 && &c != &courses[1]) continue;  // published for that alone
      for (const double closed : {1.5, 5.7, -0.2, 0.0}) {
        CAPTURE(c[0], way, closed);
        const ComplexVector g = closed * ComplexVector::Unit(4, 0);
        const ComplexVector r = std::abs(way) * course;
        const CircleForce force = circle_force(s, orders, along_line(r, std::arg(way), g), true, Course::any);
        const PressedForce line = pressed_force(s, orders, r, g, false);
        ComplexVector known(8);
        known << way.real() / std::abs(way) * line.tangential, way.imag() / std::abs(way) * line.tangential;
        const double exact = std::abs(way) < 1e3 ? 1e-12 : std::abs(way) < 1e5 ? 1e-11 : 1e-8;
        CHECK((force.harmonics.head(8) - known).norm() < exact);
        CHECK(force.linear.allFinite());
        if (closed <= 0) CHECK(force.harmonics.norm() == 0);
      }
    }
  }
  const Complex far = 1.875 * Complex(15, -8) / 17.0;
  for (const auto& [at, force, press] :
       {std::array<Complex, 3>{{0, 0, -1}}, std::array<Complex, 3>{{Complex(.1, -.1), Complex(.2, -.2), 1}},
        std::array<Complex, 3>{{Complex(15, -8), far, 1}},
        std::array<Complex, 3>{{Complex(-15, 8), -far, 1}}}) {
    ComplexVector motion = ComplexVector::Zero(12);
    motion(0) = at.real();
    motion(4) = at.imag();
    motion(8) = press;
    const CircleForce rest = circle_force(s, orders, motion, false, Course::any);
    CHECK(std::abs(Complex(rest.harmonics(0).real(), rest.harmonics(4).real()) - force) < 1e-12);
    CHECK(std::abs(rest.harmonics(8) - 2.5 * std::max(0.0, press.real())) < 1e-12);
  }
}
