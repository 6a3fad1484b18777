// Microslip against its closed forms, against many Jenkins elements in parallel, and by differences.

#include <cmath>
#include <vector>

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/jenkins.hpp"
#include "catch.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

std::shared_ptr<const Element> microslip(const char* kind, std::vector<Jet> settings) {
  return find_element_kind(kind)->make({std::move(settings), 1});
}

ElementForce force_of(const Element& element, const std::vector<int>& orders, const HarmonicVector& x,
                      double load = 1) {
  ElementForce out;
  element.force(orders, x, load, false, true, out);
  return out;
}

HarmonicVector random_motion(RandomSystems& draw, const std::vector<int>& orders) {
  HarmonicVector x(std::ssize(orders));
  for (Index a = 0; a < x.size(); ++a) {
    const int h = orders[static_cast<std::size_t>(a)];
    x(a) = h == 0 ? Complex(draw.uniform(-0.5, 0.5))
                  : std::polar(draw.uniform(0.2, 1.2) / h, draw.uniform(-pi, pi));
  }
  return x;
}

/// The Jenkins elements of an even spread of slip displacements.
ElementForce sum_of_sliders(double first, double last, const std::vector<int>& orders,
                            const HarmonicVector& x, int count) {
  ElementForce sum;
  sum.harmonics.setZero(x.size());
  for (int i = 0; i < count; ++i) {
    const double s = first + (last - first) * (i + 0.5) / count;
    const Jenkins slider(1.0 / count, s);
    ElementForce one;
    slider.force(orders, x, 1, Swing::of(orders, x).half() > s, false, one);
    sum.harmonics += one.harmonics;
    sum.energy += one.energy;
  }
  return sum;
}

}  // namespace

TEST_CASE("Evenly spread sliders have their closed form in one harmonic", "[masing]") {
  const auto coefficient = [](double first, double last, double R) {
    const HarmonicVector x = HarmonicVector::Constant(1, R);
    return force_of(*microslip("iwan", {1, first, last - first}), {1}, x).harmonics(0) / R;
  };
  CHECK(std::abs(coefficient(0, 1, 0.5) - Complex(0.75, 0.1061032954)) < 1e-10);
  CHECK(std::abs(coefficient(0, 1, 2) - 0.2122065908 * Complex(1, 1)) < 1e-10);
  CHECK(std::abs(coefficient(0.5, 1.5, 1.2) - Complex(0.8173831956, 0.1588602117)) < 1e-10);
  CHECK(std::abs(coefficient(0.5, 1.5, 0.5) - 1.0) < 1e-14);
  // E = 2 k R^3/(3 s_2) while none has slipped at the end of its range
  for (const double R : {1e-6, 0.3, 1.0}) {
    const ElementForce force = force_of(*microslip("iwan", {2, 0, 2}), {1}, HarmonicVector::Constant(1, R));
    CHECK_THAT(force.energy, WithinRel(2 * 2 * R * R * R / 3, 1e-9));
  }
}

TEST_CASE("The four-parameter Iwan model loses what it is to", "[masing]") {
  const double F = 1.7, K = 2.3, chi = -0.4, beta = 0.6;
  const double part = beta + (chi + 1) / (chi + 2);
  const double phi = F * (1 + beta) / (K * part);
  const double density = F * (chi + 1) / (std::pow(phi, chi + 2) * part);
  for (const double share : {1e-3, 0.1, 0.9}) {
    const double R = share * phi;
    const ElementForce force =
        force_of(*microslip("iwan_4", {F, K, chi, beta}), {1}, HarmonicVector::Constant(1, R));
    CHECK_THAT(force.energy, WithinRel(4 * density * std::pow(R, chi + 3) / ((chi + 2) * (chi + 3)), 1e-8));
  }
  // far beyond a square wave of F_S
  const ElementForce slips =
      force_of(*microslip("iwan_4", {F, K, chi, beta}), {1, 3}, HarmonicVector{{1e6 * phi, 0}});
  CHECK_THAT(slips.harmonics(0).imag(), WithinRel(4 * F / pi, 1e-5));
}

TEST_CASE("Microslip is what many sliders do in parallel, also with a mean", "[masing]") {
  RandomSystems draw(11);
  for (const std::vector<int>& orders :
       {std::vector{1, 3, 5}, std::vector{1, 0, 2, 3, 4}, std::vector{1, 0}}) {
    for (int i = 0; i < 8; ++i) {
      const HarmonicVector x = random_motion(draw, orders);
      const double first = i % 2 == 0 ? 0 : draw.uniform(0, 0.5);
      const double last = first + draw.uniform(0.3, 2);
      const ElementForce exact = force_of(*microslip("iwan", {1, first, last - first}), orders, x);
      const ElementForce sliders = sum_of_sliders(first, last, orders, x, 2000);
      INFO("orders " << orders.size() << ", motion " << i);
      CHECK((exact.harmonics - sliders.harmonics).norm() < 2e-6);
      CHECK_THAT(exact.energy, WithinAbs(sliders.energy, 2e-6));
    }
  }
}

TEST_CASE("Derivatives of microslip are exact, also by its settings", "[masing]") {
  RandomSystems draw(23);
  constexpr double h = 1e-6;
  for (const char* kind : {"iwan", "iwan_4"}) {
    for (const std::vector<int>& orders : {std::vector{1, 3, 5}, std::vector{1, 0, 2, 3}}) {
      const std::vector<double> values{draw.uniform(0.5, 2), draw.uniform(0.5, 2), draw.uniform(0.1, 0.8),
                                       draw.uniform(0.1, 1)};
      const std::size_t count = find_element_kind(kind)->settings.size();
      const HarmonicVector x = random_motion(draw, orders);
      for (std::size_t s = 0; s < count; ++s) {
        const auto at = [&](double step) {
          std::vector<Jet> jets;
          for (std::size_t k = 0; k < count; ++k)
            jets.push_back(k == s ? Jet(values[k] + step, 1, 0) : Jet(values[k]));
          return microslip(kind, jets);
        };
        const ElementForce force = force_of(*at(0), orders, x);
        const HarmonicVector ahead = force_of(*at(h), orders, x).harmonics;
        const HarmonicVector behind = force_of(*at(-h), orders, x).harmonics;
        CHECK((force.by_setting - (ahead - behind) / (2 * h)).norm() < 1e-8);
        HarmonicVector dx = random_motion(draw, orders);
        const Element::Way way{dx, 0.3, 0.7};
        const HarmonicVector change = force.linear * dx + force.conjugate * dx.conjugate() +
                                      0.3 * force.by_log_load + 0.7 * force.by_setting;
        const auto moved = [&](double step) {
          return force_of(*at(0.7 * step), orders, x + step * dx, std::exp(0.3 * step)).harmonics;
        };
        CHECK((change - (moved(h) - moved(-h)) / (2 * h)).norm() < 1e-8);
        const ElementForce second = at(0)->change(force, orders, x, 1, false, way);
        const ElementForce up = force_of(*at(0.7 * h), orders, x + h * dx, std::exp(0.3 * h));
        const ElementForce down = force_of(*at(-0.7 * h), orders, x - h * dx, std::exp(-0.3 * h));
        CHECK((second.linear - (up.linear - down.linear) / (2 * h)).norm() < 1e-5);
      }
    }
  }
}
