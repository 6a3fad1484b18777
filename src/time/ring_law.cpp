#include "arcslip/time/ring_law.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/elements/circle/circle_element.hpp"
#include "arcslip/elements/idle.hpp"
#include "arcslip/elements/jenkins.hpp"
#include "arcslip/elements/pressed/pressed_element.hpp"
#include "time/circle_law.hpp"
#include "time/masing_law.hpp"

namespace arcslip {
namespace {

/// By the momentary displacement; its phases are the law's zones.
class PlainLaw final : public RingLaw {
 public:
  explicit PlainLaw(const PiecewiseLaw& law) : law_(law) {}

  double steepest() const override {
    double steepest = 0;
    for (const PiecewiseLaw::Piece& piece : law_.pieces()) {
      if (piece.coefficients.size() == 2)
        steepest = std::max(steepest, std::abs(piece.coefficients[1].value));
    }
    return steepest;
  }
  int phase_at_rest() const override { return law_.zone_at(0); }

  RingBranch branch(int zone, std::span<const double> /*memory*/) const override {
    const auto& terms = law_.pieces()[static_cast<std::size_t>(std::abs(zone))].coefficients;
    RingBranch branch;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const double term = (zone < 0 && k % 2 == 0 ? -1 : 1) * terms[k].value;
      if (k == 0) {
        branch.offset = term;
      } else {
        branch.powers.push_back(term);
      }
    }
    return branch;
  }

  void events(int zone, std::span<const double> /*memory*/, std::vector<RingEvent>& events) const override {
    const auto [low, high] = law_.ends(zone);
    events = {{RingEvent::Of::place, 1, 0, high}, {RingEvent::Of::place, -1, 0, -low}};
  }

  RingMemoryChanges change(std::size_t which, const RingPlace& /*at*/, int& zone,
                           std::span<double> /*memory*/) const override {
    zone += which == 0 ? 1 : -1;
    return {};
  }

  void begin(const Vector& /*x*/, const RingPlace& now, const Complex& /*force*/, int& zone,
             std::span<double> /*memory*/) const override {
    zone = law_.zone_at(now.x);
  }

 private:
  PiecewiseLaw law_;
};

/// A force against the velocity.
class DashpotLaw final : public RingLaw {
 public:
  explicit DashpotLaw(double damping) : damping_(damping) {}

  double steepest() const override { return 0; }
  double viscous() const override { return damping_; }
  RingBranch branch(int /*phase*/, std::span<const double> /*memory*/) const override { return {}; }
  void events(int /*phase*/, std::span<const double> /*memory*/,
              std::vector<RingEvent>& events) const override {
    events.clear();
  }
  RingMemoryChanges change(std::size_t /*which*/, const RingPlace& /*at*/, int& /*phase*/,
                           std::span<double> /*memory*/) const override {
    return {};
  }
  void begin(const Vector& /*x*/, const RingPlace& /*now*/, const Complex& /*force*/, int& phase,
             std::span<double> /*memory*/) const override {
    phase = 0;
  }

 private:
  double damping_;
};

/// A spring in series with a slider under a normal force that may vary: the slider's place z is what it
/// remembers.
class SliderLaw final : public RingLaw {
 public:
  explicit SliderLaw(const PressedSettings& settings)
      : mu_(settings.friction),
        k_(settings.tangential_stiffness),
        normal_(settings.normal_stiffness),
        press_(settings.normal_force),
        rest_(std::max(0.0, settings.normal_force)) {}

  Index memories() const override { return 1; }
  bool forgets_place() const override { return true; }
  bool forgets_closing() const override { return normal_ == 0; }
  double steepest() const override { return k_ + (1 + mu_) * normal_; }
  int phase_at_rest() const override { return press_ > 0 ? stick : apart; }

  RingBranch branch(int phase, std::span<const double> memory) const override {
    RingBranch branch;
    if (phase == apart) {
      branch.closing_offset = -rest_;
      return branch;
    }
    branch.closing_stiffness = normal_;
    branch.closing_offset = press_ - rest_;
    if (phase == stick) {
      branch.powers = {k_};
      branch.origin = memory[0];
      branch.origin_memory = 0;
    } else {
      branch.offset = phase * mu_ * press_;
      branch.by_closing = phase * mu_ * normal_;
    }
    return branch;
  }

  void events(int phase, std::span<const double> memory, std::vector<RingEvent>& events) const override {
    events.clear();
    if (phase == apart) {
      events.push_back({RingEvent::Of::place, 0, normal_, -press_});
    } else if (phase == stick) {
      for (const double side : {1.0, -1.0})
        events.push_back(
            {RingEvent::Of::place, side * k_, -mu_ * normal_, side * k_ * memory[0] + mu_ * press_});
    } else {
      events.push_back({RingEvent::Of::rate, -phase * k_, mu_ * normal_});
      if (normal_ > 0) events.push_back({RingEvent::Of::place, 0, -normal_, press_});
    }
  }

  RingMemoryChanges change(std::size_t which, const RingPlace& at, int& phase,
                           std::span<double> memory) const override {
    if (phase == stick) {
      phase = which == 0 ? 1 : -1;
      return {};
    }
    if (phase == apart) return touch(at, phase, memory);
    if (which == 1) {
      phase = apart;
      return {};
    }
    const RingMemoryChange left = idle(phase, at, 0, memory);
    phase = stick;
    return {left};
  }

  bool needs(int phase, Index /*number*/) const override { return phase == stick; }

  RingMemoryChange idle(int phase, const RingPlace& at, Index number,
                        std::span<double> memory) const override {
    memory[0] = at.x;
    if (phase == apart) return {number, 1, 0};
    memory[0] -= phase * mu_ / k_ * (press_ + normal_ * at.g);
    return {number, 1, -phase * mu_ / k_ * normal_};
  }

  void begin(const Vector& /*x*/, const RingPlace& now, const Complex& force, int& phase,
             std::span<double> memory) const override {
    const double limit = mu_ * (press_ + normal_ * now.g);
    phase = press_ + normal_ * now.g >= 0 ? stick : apart;
    memory[0] = now.x - (phase == stick ? std::clamp(force.real(), -limit, limit) / k_ : 0);
  }

 private:
  // Beside these the signs of slip, 1 and -1.
  static constexpr int stick = 0;
  static constexpr int apart = 2;

  RingMemoryChanges touch(const RingPlace& at, int& phase, std::span<double> memory) const {
    if (k_ * std::abs(at.x_rate) > mu_ * normal_ * at.g_rate) {
      phase = at.x_rate > 0 ? 1 : -1;
      return {};
    }
    phase = stick;
    memory[0] = at.x;
    return {{0, 1, -at.x_rate / at.g_rate}};
  }

  double mu_;
  double k_;
  double normal_;
  double press_;
  double rest_;
};

}  // namespace

std::unique_ptr<const RingLaw> ring_law(const Element& element, double load) {
  if (element.law() != nullptr) return std::make_unique<PlainLaw>(*element.law());
  if (element.damping().value != 0) return std::make_unique<DashpotLaw>(element.damping().value);
  if (dynamic_cast<const Idle*>(&element) != nullptr) return nullptr;
  if (dynamic_cast<const Jenkins*>(&element) != nullptr) {
    const double k = element.reference_stiffness();
    return std::make_unique<SliderLaw>(PressedSettings{1, k, 0, k * element.threshold(load)});
  }
  if (const auto* pressed = dynamic_cast<const PressedElement*>(&element))
    return std::make_unique<SliderLaw>(pressed->settings(load));
  if (const auto* masing = dynamic_cast<const MasingElement*>(&element))
    return masing_law(masing->backbone(), load);
  if (const auto* circle = dynamic_cast<const CircleElement*>(&element))
    return circle_law(circle->settings(load));
  throw std::invalid_argument(
      "elements that are known by samples of their force have no motion in time here");
}

}  // namespace arcslip
