// What contacts tell of a period, the greatest force and the parts of it in slip and apart: against a march
// in time, and with exact derivatives.

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "arcslip/elements/contact.hpp"
#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/jenkins.hpp"
#include "catch.hpp"
#include "plane_motions.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// Of the last period of a march.
struct MarchedPeriod {
  double traction = 0;
  double slip = 0;
  double apart = 0;
};

/// Sliding displacements (2 x samples) and normal forces.
MarchedPeriod marched_period(const Matrix& slid, const Vector& closing, double k_t, double friction) {
  constexpr double rounding = 1e-12;
  constexpr Index periods = 30;  // in a plane it settles by and by
  const Index samples = slid.cols();
  MarchedPeriod found;
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  for (Index i = 0; i < periods * samples; ++i) {
    const Index here = i % samples;
    const Index last = (here + samples - 1) % samples;
    const double press = std::max(0.0, closing(here));
    const double part = closing(last) < 0 && press > 0 ? closing(here) / (closing(here) - closing(last)) : 1;
    force += k_t * part * (slid.col(here) - slid.col(last));
    const bool slips = force.norm() > friction * press * (1 - rounding);
    if (slips) force *= force.norm() > 0 ? friction * press / force.norm() : 0;
    if (i < (periods - 1) * samples) continue;
    found.traction = std::max(found.traction, force.norm());
    found.slip += slips && press > 0 ? 1 / double(samples) : 0;
    found.apart += press > 0 ? 0 : 1 / double(samples);
  }
  return found;
}

Vector sampled_period(const std::vector<int>& orders, const HarmonicVector& x, Index samples) {
  const PeriodicMotion motion(orders, x, 7);
  Vector all(samples);
  for (Index i = 0; i < samples; ++i) all(i) = motion.value(two_pi * double(i) / double(samples));
  return all;
}

using MadeElement = std::function<std::shared_ptr<const Element>(double setting)>;

/// Along a way of motion, load and setting; false beside a transition.
bool has_exact_derivatives(const MadeElement& made, const std::vector<int>& orders, const HarmonicVector& x,
                           const HarmonicVector& way, bool beyond) {
  constexpr double load = 0.8;
  const auto at = [&](double by) {
    const auto all = made(0.7 * by)->read(orders, x + by * way, load * std::exp(0.3 * by), beyond, false);
    Vector values(std::ssize(all));
    for (Index i = 0; i < values.size(); ++i) values(i) = all[static_cast<std::size_t>(i)].value;
    return values;
  };
  const Vector fine = difference(at, 1e-5);
  if ((fine - difference(at, 5e-6)).norm() > 1e-6 * (1 + fine.norm())) return false;
  const auto told = made(0)->read(orders, x, load, beyond, true);
  REQUIRE(std::ssize(told) == std::ssize(made(0)->readings()));
  for (Index i = 0; i < fine.size(); ++i) {
    const MotionNumber& one = told[static_cast<std::size_t>(i)];
    double exact = 0.3 * one.by_log_load + 0.7 * one.by_setting;
    for (Index a = 0; a < x.size(); ++a) exact += std::real(std::conj(one.by_motion(a)) * way(a));
    INFO(made(0)->readings()[static_cast<std::size_t>(i)].name);
    CHECK_THAT(exact, WithinRel(fine(i), 1e-5) || WithinAbs(fine(i), 1e-6));
  }
  return true;
}

HarmonicVector drawn_motion(RandomSystems& draw, const std::vector<int>& orders, Index coordinates) {
  const auto n = static_cast<Index>(orders.size());
  HarmonicVector x(coordinates * n);
  for (Index a = 0; a < x.size(); ++a) {
    const int h = orders[static_cast<std::size_t>(a % n)];
    // of the mean the imaginary part counts for nothing, as long as nothing drifts
    x(a) = h == 0 ? Complex(draw.uniform(-0.1, 0.1), draw.uniform(-0.1, 0.1))
                  : std::polar(draw.uniform(0.3, 1) / h, draw.uniform(-pi, pi));
  }
  return x;
}

double told_value(const std::vector<MotionNumber>& told, std::size_t which) { return told.at(which).value; }

}  // namespace

TEST_CASE("Contacts under a normal force that varies tell what a march in time does", "[readings]") {
  RandomSystems draw(41);
  const std::vector<int> orders{1, 0, 2, 3};
  constexpr Index samples = 1 << 13;
  int slipping = 0, apart = 0, near = 0, derived = 0;
  for (const char* name : {"friction", "friction_2d"}) {
    const ElementKind& kind = *find_element_kind(name);
    for (int i = 0; i < 24; ++i) {
      CAPTURE(name, i);
      const std::vector<double> values{draw.uniform(0.5, 2), draw.uniform(0.1, 1), draw.uniform(0.2, 0.6),
                                       draw.uniform(-0.2, 0.6), draw.uniform(0.4, 1)};
      const std::size_t varied = static_cast<std::size_t>(i) % values.size();
      const MadeElement made = [&](double by) {
        std::vector<Jet> jets(values.begin(), values.end());
        jets[varied] = Jet(values[varied] + by, 1, 0);
        return kind.make({jets, 1, two_pi, true});
      };
      const auto element = made(0);
      const HarmonicVector x = drawn_motion(draw, orders, element->coordinates());
      const bool slips = element->border(orders, x, nullptr, 0.8, false).value > 0;
      const auto told = element->read(orders, x, 0.8, slips, false);
      Matrix slid = Matrix::Zero(2, samples);
      for (Index c = 0; c + 1 < element->coordinates(); ++c)
        slid.row(c) = sampled_period(orders, x.segment(4 * c, 4), samples).transpose();
      const Vector closing =
          values[1] * sampled_period(orders, x.tail(4), samples).array() + values[3] + 0.8 * values[4];
      const MarchedPeriod other = marched_period(slid, closing, values[0], values[2]);
      CHECK_THAT(told_value(told, 3), WithinAbs(other.slip, 3e-3));
      CHECK_THAT(told_value(told, 4), WithinAbs(other.apart, 1e-3));
      if (slips) CHECK_THAT(told_value(told, 0), WithinRel(other.traction, 2e-3));
      slipping += slips;
      apart += told_value(told, 4) > 0;
      if (!has_exact_derivatives(made, orders, x, drawn_motion(draw, orders, element->coordinates()), slips))
        ++near;
      ++derived;
    }
  }
  CHECK(slipping > 24);
  CHECK(apart > 4);
  CHECK(near < derived / 4);
}

TEST_CASE("Contacts under a constant load tell their force and the part of the period in slip",
          "[readings]") {
  RandomSystems draw(42);
  for (const std::vector<int>& orders : {std::vector{1}, std::vector{1, 3, 5}, std::vector{1, 0, 2, 3}}) {
    for (int i = 0; i < 12; ++i) {
      CAPTURE(orders.size(), i);
      const double k = draw.uniform(0.5, 2);
      const double per_load = draw.uniform(0.1, 1.5);
      const MadeElement made = [&](double) { return std::make_shared<Jenkins>(k, per_load); };
      const HarmonicVector x = drawn_motion(draw, orders, 1);
      const bool slips = made(0)->border(orders, x, nullptr, 0.8, false).value > 0;
      const auto told = made(0)->read(orders, x, 0.8, slips, true);
      CHECK(told_value(told, 0) <= 0.8 * per_load * k * (1 + 1e-12));
      const double range = Swing::of(orders, x).half();
      if (slips) {
        CHECK_THAT(told_value(told, 0), WithinRel(0.8 * per_load * k, 1e-14));
        const Index samples = 1 << 13;
        Matrix slid = Matrix::Zero(2, samples);
        slid.row(0) = sampled_period(orders, x, samples).transpose();
        const MarchedPeriod other = marched_period(slid, Vector::Constant(samples, 0.8 * per_load * k), k, 1);
        CHECK_THAT(told_value(told, 1), WithinAbs(other.slip, 2e-3));
      } else {
        CHECK(told_value(told, 1) == 0);
        CHECK(told_value(told, 0) >= k * range * (1 - 1e-12));
      }
      if (orders.size() == 1) {
        const SlipFraction known = slip_fraction(slips ? std::log(std::abs(x(0)) / (0.8 * per_load)) : 0);
        CHECK_THAT(told_value(told, 1), WithinAbs(known.value, 1e-12));
        if (slips) CHECK_THAT(-told[1].by_log_load, WithinRel(known.by_log, 1e-9));
      }
      has_exact_derivatives(made, orders, x, drawn_motion(draw, orders, 1), slips);
    }
  }
}

TEST_CASE("Microslip tells its greatest force", "[readings]") {
  RandomSystems draw(43);
  for (const char* name : {"iwan", "iwan_4"}) {
    const ElementKind& kind = *find_element_kind(name);
    for (const std::vector<int>& orders : {std::vector{1, 3, 5}, std::vector{1, 0, 2, 3}}) {
      for (int i = 0; i < 6; ++i) {
        CAPTURE(name, orders.size(), i);
        const std::vector<double> values =
            name == std::string("iwan") ? std::vector{draw.uniform(0.5, 2), 0.1, draw.uniform(0.5, 2)}
                                        : std::vector{draw.uniform(0.5, 2), draw.uniform(0.5, 2), -0.4, 0.3};
        const std::size_t varied = static_cast<std::size_t>(i) % values.size();
        const MadeElement made = [&](double by) {
          std::vector<Jet> jets(values.begin(), values.end());
          jets[varied] = Jet(values[varied] + by, 1, 0);
          return kind.make({jets, 1, two_pi, false});
        };
        const HarmonicVector x = drawn_motion(draw, orders, 1);
        const double told = told_value(made(0)->read(orders, x, 0.8, false, false), 0);
        ElementForce force;
        made(0)->force(orders, x, 0.8, false, false, force);
        // in many harmonics the force itself, of which these are the first ones
        std::vector<int> many{1, 0};
        for (int h = 2; h <= 60; ++h) many.push_back(h);
        HarmonicVector wide = HarmonicVector::Zero(std::ssize(many));
        for (std::size_t a = 0; a < orders.size(); ++a)
          wide(std::find(many.begin(), many.end(), orders[a]) - many.begin()) = x(static_cast<Index>(a));
        made(0)->force(many, wide, 0.8, false, false, force);
        CHECK_THAT(told, WithinRel(Swing::of(many, force.harmonics).peak(), 1e-2));
        CHECK(has_exact_derivatives(made, orders, x, drawn_motion(draw, orders, 1), false));
      }
    }
  }
}

TEST_CASE("A friction circle that never ceases to slip slips all the time", "[readings]") {
  const auto element = find_element_kind("friction_2d")->make({{2, 0, 0.5, 0, 1}, 1, two_pi, false});
  HarmonicVector x(2);
  x << 1.0, Complex(0, -1);
  const auto told = element->read(std::vector{1}, x, 0.8, true, true);
  CHECK_THAT(told_value(told, 0), WithinRel(0.4, 1e-12));
  CHECK(told_value(told, 3) == 1);
  CHECK(told[3].by_motion.norm() == 0);
  const auto rests = element->read(std::vector{1}, HarmonicVector(0.1 * x), 0.8, false, true);
  CHECK_THAT(told_value(rests, 0), WithinRel(0.2, 1e-12));
  CHECK(told_value(rests, 3) == 0);
}
