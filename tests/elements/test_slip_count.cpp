// Where a further slip begins within a period: counted in time, and just where derivatives jump.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/jenkins.hpp"
#include "catch.hpp"
#include "draws.hpp"
#include "plane_motions.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

constexpr double load = 0.8;

/// An element under motions with these orders, and what it is in a march.
struct Sliding {
  std::shared_ptr<const Element> element;
  std::vector<int> orders;
  double stiffness = 1;
  double friction = 1;
  double normal_stiffness = 0;
  double normal_force = 0;
  bool closes = false;

  HarmonicVector drawn(RandomSystems& draw) const {
    const auto n = static_cast<Index>(orders.size());
    HarmonicVector x(element->coordinates() * n);
    for (Index a = 0; a < x.size(); ++a) {
      const int h = orders[static_cast<std::size_t>(a % n)];
      x(a) = h == 0 ? Complex(draw.uniform(-0.1, 0.1))
                    : std::polar(draw.uniform(0.5, 1.5) / h, draw.uniform(-pi, pi));
    }
    return x;
  }

  bool slips(const HarmonicVector& x) const {
    return element->border(orders, x, nullptr, load, false).value > 0;
  }

  ElementForce force(const HarmonicVector& x) const {
    ElementForce out;
    element->force(orders, x, load, true, true, out);
    return out;
  }

  /// The functions of further slips.
  std::vector<double> told(const HarmonicVector& x) const {
    const ElementForce there = force(x);
    std::vector<double> values;
    for (const ElementEvent& event : element->events(orders)) {
      if (event.further_slips) values.push_back(there.further_slips.functions[*event.further_slips]);
    }
    return values;
  }

  /// How often slip follows upon stick in a period of a march.
  int onsets(const HarmonicVector& x) const {
    constexpr Index samples = 1 << 14;
    constexpr Index periods = 12;
    const auto n = static_cast<Index>(orders.size());
    const auto course = [&](Index c) { return PeriodicMotion(orders, x.segment(c * n, n), 7); };
    const Index slides = element->coordinates() - (closes ? 1 : 0);
    Matrix slid = Matrix::Zero(2, samples);
    Vector press = Vector::Constant(samples, normal_force);
    for (Index i = 0; i < samples; ++i) {
      const double theta = two_pi * double(i) / double(samples);
      for (Index c = 0; c < slides; ++c) slid(c, i) = course(c).value(theta);
      if (closes) press(i) += normal_stiffness * course(slides).value(theta);
    }
    Eigen::Vector2d force = Eigen::Vector2d::Zero();
    int count = 0;
    bool was_stuck = false;
    for (Index i = 0; i < periods * samples; ++i) {
      const Index here = i % samples;
      const double limit = friction * std::max(0.0, press(here));
      force += stiffness * (slid.col(here) - slid.col((here + samples - 1) % samples));
      const bool moves = force.norm() > limit * (1 - 1e-12);
      if (moves) force *= force.norm() > 0 ? limit / force.norm() : 0;
      if (i >= (periods - 1) * samples) count += moves && was_stuck && limit > 0;
      was_stuck = !moves && limit > 0;
    }
    return count;
  }
};

/// By the kind, drawn.
Sliding drawn_sliding(RandomSystems& draw, const std::string& kind) {
  if (kind == "odd" || kind == "mean") {
    const double k = draw.uniform(0.5, 2);
    const double slip = draw.uniform(0.1, 0.6);
    const std::vector<int> orders = kind == "odd" ? std::vector{1, 3, 5, 7} : std::vector{1, 0, 2, 3, 4};
    return {std::make_shared<Jenkins>(k, slip), orders, k, 1, 0, k * slip * load};
  }
  const std::vector<double> v{draw.uniform(0.5, 2), draw.uniform(0.1, 0.6), draw.uniform(0.2, 0.6),
                              draw.uniform(0, 0.6), draw.uniform(0.4, 1)};
  return {find_element_kind(kind)->make({{v.begin(), v.end()}, 1, two_pi, true}),
          {1, 0, 2, 3, 4},
          v[0],
          v[2],
          v[1],
          v[3] + load * v[4],
          true};
}

}  // namespace

TEST_CASE("The sign tells whether slip begins an even number of times in a march", "[slips]") {
  RandomSystems draw(5);
  for (const char* kind : {"odd", "mean", "friction", "friction_2d"}) {
    int even = 0, compared = 0;
    for (int i = 0; i < draws(40); ++i) {
      CAPTURE(kind, i);
      const Sliding contact = drawn_sliding(draw, kind);
      const HarmonicVector x = contact.drawn(draw);
      if (!contact.slips(x)) continue;
      double product = 1;
      double least = 1;
      for (const double value : contact.told(x)) {
        product *= value;
        least = std::min(least, std::abs(value));
      }
      if (least < 2e-3) continue;  // a slip may hide between samples
      const int onsets = contact.onsets(x);
      const int parity = std::string(kind) == "odd" ? onsets / 2 : onsets;
      CAPTURE(onsets, contact.told(x));
      CHECK((product > 0) == (parity % 2 == 0));
      even += parity % 2 == 0;
      ++compared;
    }
    CHECK(compared > draws(40) / 2);
    CHECK(even > 0);
    CHECK(even < compared);
  }
}

TEST_CASE("Derivatives of the force jump where a further slip begins, and only there", "[slips][numbers]") {
  RandomSystems draw(6);
  for (const char* kind : {"odd", "mean", "friction", "friction_2d"}) {
    int begun = 0;
    for (int i = 0; i < 12; ++i) {
      const Sliding contact = drawn_sliding(draw, kind);
      const HarmonicVector from = contact.drawn(draw);
      const HarmonicVector way = contact.drawn(draw) - from;
      const auto at = [&](double s) -> HarmonicVector { return from + s * way; };
      constexpr int places = 100;
      for (int k = 0; k < places; ++k) {
        double low = double(k) / places, high = double(k + 1) / places;
        if (!contact.slips(at(low)) || !contact.slips(at(high))) continue;
        const std::vector<double> before = contact.told(at(low)), behind = contact.told(at(high));
        for (std::size_t which = 0; which < before.size(); ++which) {
          if (before[which] * behind[which] > 0) continue;
          double a = low, b = high;
          while (b - a > 1e-10) {
            const double middle = 0.5 * (a + b);
            (contact.told(at(middle))[which] * before[which] > 0 ? a : b) = middle;
          }
          CAPTURE(kind, i, which, a);
          const double left =
              std::max(std::abs(contact.told(at(a))[which]), std::abs(contact.told(at(b))[which]));
          const double jump =
              (contact.force(at(b + 1e-9)).linear - contact.force(at(a - 1e-9)).linear).norm();
          if (left < 1e-6) {
            CHECK(jump > 1e-3);
            ++begun;
          } else {
            CHECK(left > 1e-4);
            CHECK(jump < 1e-2);
          }
        }
      }
    }
    CAPTURE(kind);
    CHECK(begun > 3);
  }
}

TEST_CASE("No further slip begins where parts that come to touch no longer stick at first", "[slips]") {
  for (const double share : {0.0, 0.1, 0.3, -0.2}) {
    const Sliding contact{
        find_element_kind("friction_2d")->make({{1.0, 0.4, 0.5, 0.0, 0.25}, 1, two_pi, true}),
        {1, 0},
        1,
        0.5,
        0.4,
        0.2,
        true};
    // press = 0.2 + 0.4 cos(theta) from theta = 4 pi/3 on, 0 before
    const auto at = [&](double phase) {
      HarmonicVector x = HarmonicVector::Zero(6);
      x(0) = std::polar(0.6, phase);
      x(2) = Complex(0, share) * x(0);
      x(4) = 1;
      return x;
    };
    const auto told = [&](double phase) { return contact.force(at(phase)).further_slips.functions; };
    int changes = 0;
    constexpr int places = 200;
    for (int i = 0; i < places; ++i) {
      double a = two_pi * i / places, b = two_pi * (i + 1) / places;
      if (!contact.slips(at(a)) || !contact.slips(at(b))) continue;
      for (std::size_t which = 0; which < 2; ++which) {
        const double before = told(a)[which];
        if (before * told(b)[which] > 0) continue;
        double low = a, high = b;
        while (high - low > 1e-14) {
          const double middle = 0.5 * (low + high);
          (told(middle)[which] * before > 0 ? low : high) = middle;
        }
        const double jump =
            (contact.force(at(high + 1e-7)).linear - contact.force(at(low - 1e-7)).linear).norm();
        if (jump > 1e-3) continue;
        ++changes;
        for (int k = -100; k <= 100; ++k) {
          const double phase = low + k * 1e-15;
          CAPTURE(share, i, which, low, k);
          CHECK(std::abs(told(phase)[which]) > 1e-4);
        }
      }
    }
    CHECK(changes > 0);
  }
}

TEST_CASE("At the border of slip, where rounding hides the first, no further slip begins", "[slips]") {
  std::array<SlipCount, 2> first;
  for (SlipCount& one : first) one.slip(1e-9);
  const FurtherSlips behind = FurtherSlips::of(first, 1, false);
  CHECK(FurtherSlips::at_border().functions == behind.functions);
  CHECK(FurtherSlips::at_border().piece == behind.piece);
}
