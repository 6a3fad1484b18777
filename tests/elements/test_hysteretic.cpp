#include "arcslip/elements/hysteretic.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "arcslip/elements/jenkins.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

constexpr double slider_stiffness = 2;
constexpr double slider_limit = 0.6;  // of the force

/// A spring in series with a slider that goes from sample to sample, with its tangents; the limit is
/// continued.
class MarchedSlider final : public CycleLaw {
 public:
  explicit MarchedSlider(Index samples) : samples_(samples) {}
  Index samples() const override { return samples_; }
  double setting_scale() const override { return slider_limit; }

  void at(const Vector& x, const Matrix& ways, double setting, bool derivatives,
          CycleSamples& out) const override {
    const double most = slider_limit + setting;
    const Index n = x.size();
    out.force.resize(n);
    out.changes.resize(n, ways.cols());
    out.by_setting.resize(derivatives ? n : 0);
    double force = std::min(slider_stiffness * x(0), most);  // at the largest displacement
    const bool slips = slider_stiffness * x(0) > most;
    Vector change = (slips ? 0 : slider_stiffness) * ways.topRows(1).transpose();
    double by_limit = slips ? 1 : 0;
    for (Index i = 1; i <= n; ++i) {
      force += slider_stiffness * (x(i % n) - x(i - 1));
      change += slider_stiffness * (ways.row(i % n) - ways.row(i - 1)).transpose();
      if (std::abs(force) > most) {
        by_limit = force > 0 ? 1 : -1;
        force = by_limit * most;
        change.setZero();
      }
      out.force(i % n) = force;
      out.changes.row(i % n) = change.transpose();
      if (derivatives) out.by_setting(i % n) = by_limit;
    }
  }

 private:
  Index samples_;
};

HystereticElement slider_of(Index samples) { return {std::make_shared<MarchedSlider>(samples), 1}; }

struct SlidMotion {
  std::vector<int> orders;
  HarmonicVector x;
};

/// Of amplitudes above limit/stiffness, which turn back twice in a period.
std::vector<SlidMotion> slid_motions() {
  HarmonicVector one(1);
  HarmonicVector three(3);
  one << Complex(0.5, 0.7);
  three << Complex(0.9, -0.4), Complex(0.06, 0.05), Complex(-0.01, 0.02);
  return {{{1}, one}, {{1, 3, 5}, three}};
}

ElementForce sampled_force(const Element& element, const SlidMotion& motion, const HarmonicVector& x) {
  ElementForce force;
  element.force(motion.orders, x, 1, true, true, force);
  return force;
}

}  // namespace

TEST_CASE("A slider by its samples is the contact, to the square of their distance", "[elements]") {
  const Jenkins contact(slider_stiffness, slider_limit / slider_stiffness);
  for (const SlidMotion& motion : slid_motions()) {
    const ElementForce exact = sampled_force(contact, motion, motion.x);
    for (const Index samples : {256, 4096}) {
      const ElementForce sampled = sampled_force(slider_of(samples), motion, motion.x);
      const double step = two_pi / static_cast<double>(samples);
      CHECK((sampled.harmonics - exact.harmonics).norm() < step * step * exact.harmonics.norm());
      CHECK(std::abs(sampled.energy - exact.energy) < step * step * exact.energy);
      // Kinks lie between samples: derivatives, which jump there, are off by a sample.
      CHECK((sampled.linear - exact.linear).norm() < 2 * step * exact.linear.norm());
      CHECK((sampled.conjugate - exact.conjugate).norm() < 2 * step * exact.linear.norm());
    }
  }
}

TEST_CASE("Its derivatives are those of differences, of its samples' places as well", "[elements]") {
  constexpr double h = 1e-7;
  const HystereticElement element = slider_of(64);
  for (const SlidMotion& motion : slid_motions()) {
    const ElementForce force = sampled_force(element, motion, motion.x);
    for (Index l = 0; l < motion.x.size(); ++l) {
      for (const Complex direction : {Complex(1, 0), Complex(0, 1)}) {
        HarmonicVector moved = motion.x;
        moved(l) += h * direction;
        const HarmonicVector above = sampled_force(element, motion, moved).harmonics;
        moved(l) -= 2 * h * direction;
        const HarmonicVector difference = (above - sampled_force(element, motion, moved).harmonics) / (2 * h);
        const HarmonicVector exact =
            force.linear.col(l) * direction + force.conjugate.col(l) * std::conj(direction);
        CHECK((difference - exact).norm() < 1e-6 * force.linear.norm());
      }
    }
  }
}

TEST_CASE("Its second derivatives are those of the contact but for some per cent", "[elements]") {
  const Jenkins contact(slider_stiffness, slider_limit / slider_stiffness);
  const HystereticElement element = slider_of(1024);
  for (const SlidMotion& motion : slid_motions()) {
    Element::Way way{motion.x * Complex(0.3, 0.8), 0, 0};
    const ElementForce at = sampled_force(contact, motion, motion.x);
    const ElementForce exact = contact.change(at, motion.orders, motion.x, 1, true, way);
    const ElementForce found =
        element.change(sampled_force(element, motion, motion.x), motion.orders, motion.x, 1, true, way);
    CHECK((found.linear - exact.linear).norm() < 0.1 * exact.linear.norm());
    way = {HarmonicVector::Zero(motion.x.size()), 1, slider_limit};  // of the load there, of the limit here
    const ElementForce by_load = contact.change(at, motion.orders, motion.x, 1, true, way);
    way.log_load = 0;
    const ElementForce by_limit =
        element.change(sampled_force(element, motion, motion.x), motion.orders, motion.x, 1, true, way);
    CHECK((by_limit.harmonics - by_load.harmonics).norm() < 1e-2 * by_load.harmonics.norm());
    CHECK((by_limit.linear - by_load.linear).norm() < 0.1 * by_load.linear.norm());
  }
}

TEST_CASE("An element with a memory has no stiffness in time and a reference of its own", "[elements]") {
  const SlidMotion motion = slid_motions().front();
  CHECK_THROWS_AS(slider_of(64).stiffness_in_time(motion.orders, motion.x), std::logic_error);
  CHECK_THROWS_AS(HystereticElement(std::make_shared<MarchedSlider>(64), 0), std::invalid_argument);
  HarmonicVector still(1);
  still << 0;
  CHECK(sampled_force(slider_of(64), motion, still).harmonics.norm() == 0);
}
