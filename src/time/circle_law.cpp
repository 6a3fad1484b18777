#include "time/circle_law.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip {
namespace {

using Of = RingEvent::Of;

class CircleLaw final : public RingLaw {
 public:
  explicit CircleLaw(const PressedSettings& settings)
      : circle_{settings.tangential_stiffness, settings.friction, settings.normal_stiffness,
                settings.normal_force},
        rest_(std::max(0.0, settings.normal_force)) {}

  Index memories() const override { return 2; }
  bool forgets_place() const override { return true; }
  bool forgets_closing() const override { return circle_.normal_stiffness == 0; }
  double steepest() const override {
    return circle_.stiffness + (1 + circle_.friction) * circle_.normal_stiffness;
  }
  const RingCircle* circle() const override { return &circle_; }
  int phase_at_rest() const override { return circle_.normal_force > 0 ? stick : apart; }

  RingBranch branch(int phase, std::span<const double> memory) const override {
    RingBranch branch;
    branch.closing_offset = -rest_;
    if (phase == apart) return branch;
    branch.closing_stiffness = circle_.normal_stiffness;
    branch.closing_offset += circle_.normal_force;
    branch.slips_round = phase == slip;
    if (phase != stick) return branch;
    branch.powers = {circle_.stiffness};
    branch.origin = memory[0];
    branch.origin_memory = 0;
    branch.across = circle_.stiffness;
    branch.across_origin = memory[1];
    return branch;
  }

  void events(int phase, std::span<const double> /*memory*/, std::vector<RingEvent>& events) const override {
    const double normal = circle_.normal_stiffness;
    const double press = circle_.normal_force;
    const RingEvent comes_apart{Of::place, 0, -normal, press};
    events.clear();
    if (phase == stick) {
      events = {{Of::excess}, comes_apart};
    } else if (phase == slip) {
      events = {{Of::slip}, {Of::place_ahead, 0, -normal, press}};
    } else if (phase == apart) {
      events = {{Of::place, 0, normal, -press}};
    } else if (phase == leaving) {
      events = {{Of::place_ahead, 0, normal, -press}, comes_apart};
    } else {
      events = {{Of::place_behind, 0, normal, -press}, comes_apart};
    }
    if (normal == 0 && phase != leaving && phase != arriving) events.resize(1);
  }

  RingMemoryChanges change(std::size_t which, const RingPlace& at, int& phase,
                           std::span<double> memory) const override {
    const double far = phase == apart ? 0 : normal_force(at) * circle_.friction / circle_.stiffness;
    const int before = phase;
    if (before == apart) {
      const double speed = std::hypot(at.x_rate, at.y_rate);
      const double outgrows = circle_.friction * circle_.normal_stiffness * at.g_rate;
      phase = circle_.stiffness * speed > outgrows ? arriving : stick;
    } else if (which == 1) {
      phase = before == slip ? leaving : apart;
    } else {
      phase = before == slip ? stick : slip;
    }
    if (before == stick || before == slip) return {};
    const double speed = phase == slip ? std::hypot(at.x_rate, at.y_rate) : 0;
    memory[0] = at.x - (speed > 0 ? far * at.x_rate / speed : 0);
    memory[1] = at.y - (speed > 0 ? far * at.y_rate / speed : 0);
    if (phase != stick) return {{0, 1}, {1, 0, 0, 1}};
    return {{0, 1, -at.x_rate / at.g_rate}, {1, 0, -at.y_rate / at.g_rate, 1}};
  }

  bool needs(int phase, Index /*number*/) const override { return phase == stick || phase == slip; }
  bool flows(int phase) const override { return phase == slip; }

  RingMemoryChange idle(int /*phase*/, const RingPlace& at, Index number,
                        std::span<double> memory) const override {
    memory[static_cast<std::size_t>(number)] = number == 0 ? at.x : at.y;
    return number == 0 ? RingMemoryChange{0, 1} : RingMemoryChange{1, 0, 0, 1};
  }

  void begin(const Vector& /*x*/, const RingPlace& now, const Complex& force, int& phase,
             std::span<double> memory) const override {
    const double limit = circle_.friction * normal_force(now);
    phase = limit > 0 ? stick : apart;
    const double size = std::abs(force);
    const Complex held = phase == apart ? 0 : size > limit ? force * (limit / size) : force;
    memory[0] = now.x - held.real() / circle_.stiffness;
    memory[1] = now.y - held.imag() / circle_.stiffness;
  }

 private:
  // `leaving` and `arriving`: parts touch, with friction left out.
  enum Phase : int { stick, slip, apart, leaving, arriving };

  double normal_force(const RingPlace& at) const {
    return circle_.normal_force + circle_.normal_stiffness * at.g;
  }

  RingCircle circle_;
  double rest_;
};

}  // namespace

std::unique_ptr<const RingLaw> circle_law(const PressedSettings& settings) {
  return std::make_unique<CircleLaw>(settings);
}

}  // namespace arcslip
