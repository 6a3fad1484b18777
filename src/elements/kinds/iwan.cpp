// Microslip with limits that are spread evenly [Iwan 1966]: of the stiffness k the part with limits up to s
// slips at displacements above s = f/k, f from first_limit to last_limit, times the preload.

#include <algorithm>

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/masing.hpp"

namespace arcslip {
namespace {

class UniformBackbone final : public Backbone {
 public:
  explicit UniformBackbone(const std::vector<Jet>& settings)
      : k_(settings[0]), first_(settings[1] / k_), last_((settings[1] + settings[2]) / k_) {}

  Jet force(double x) const override {
    if (x <= first_.value) return k_ * x;
    if (x >= last_.value) return k_ * 0.5 * (first_ + last_);
    return k_ / (last_ - first_) * (last_ * x - 0.5 * (Jet(x * x) + first_ * first_));
  }
  double slope(double x) const override {
    if (x <= first_.value) return k_.value;
    return k_.value * std::max(0.0, last_.value - x) / (last_.value - first_.value);
  }
  std::vector<double> corners() const override { return {first_.value, last_.value}; }

 private:
  Jet k_;
  Jet first_;
  Jet last_;
};

}  // namespace

ElementKind iwan_element() {
  ElementKind kind{
      "iwan",
      "microslip: sliders in parallel whose limits are spread evenly",
      {{given_positive("stiffness", "k of all together, before any slips"), true},
       {not_negative("first_limit", 0, "per preload; over k the displacement at which the first one slips"),
        true},
       {given_positive("spread", "per preload; over k how much further the last one slips"), true}},
      [](const ElementKind::Values& values) { return masing_of<UniformBackbone>(values); }};
  kind.has_memory = true;
  kind.follows = true;
  return kind;
}

}  // namespace arcslip
