#pragma once

// Microslip: many sliders in parallel, each a spring that yields at a limit of its own [Iwan 1966]. What they
// do together follows from their curve of first loading, the backbone F(x), by Masing's rules: from a point
// where the motion turns back, (x_r, f_r),
//
//   f = f_r + 2 F((x - x_r)/2)   on the way up,   f = f_r - 2 F((x_r - x)/2)   on the way down,
//
// and where a branch comes back to the turning point before the last one it goes on as the branch before. The
// settled cycle begins on the backbone where |x| is largest, as it is left when the motion grows from rest.
// Limits are proportional to the load.
//
// Forces are integrated by Gauss between turning points, closings and corners of F, to rounding where F is a
// polynomial there.

#include <functional>
#include <memory>
#include <vector>

#include "arcslip/elements/element_kind.hpp"

namespace arcslip {

/// F under the load 1, for x >= 0, with F(0) = 0, F' falling from its greatest value to 0 or more.
class Backbone {
 public:
  virtual ~Backbone() = default;

  /// F, with derivatives by the setting that is continued, and dF/dx.
  virtual Jet force(double x) const = 0;
  virtual double slope(double x) const = 0;

  /// Where F is no longer the same smooth function, ascending.
  virtual std::vector<double> corners() const = 0;
};

/// By its backbone.
class MasingElement final : public Element {
 public:
  bool dissipates() const override { return true; }
  /// At a value of the setting that is continued, so much above its own.
  using Made = std::function<std::shared_ptr<const Backbone>(double setting)>;

  /// `setting_scale` is a typical magnitude of that setting, 0 where none is continued.
  MasingElement(Made made, double setting_scale);

  double reference_stiffness(Index /*coordinate*/ = 0) const override { return backbone_->slope(0); }
  bool is_told_by_law() const override { return true; }
  DisturbedLaw disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                         bool beyond) const override;
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond, bool derivatives,
             ElementForce& out) const override;

  /// The greatest force. What part of the period some of the sliders slip in says little of them all.
  std::vector<Reading> readings() const override { return {{"T_max", true}}; }
  std::vector<MotionNumber> read(std::span<const int> orders, const HarmonicVector& x, double load,
                                 bool beyond, bool derivatives) const override;

  /// The curve of first loading.
  const Backbone& backbone() const { return *backbone_; }

 private:
  void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x, double load,
              bool beyond, const Way& way, ElementForce& change) const override;

  Made made_;
  std::shared_ptr<const Backbone> backbone_;
  double setting_scale_;
};

/// Of a backbone that is made of settings, forces per load.
template <class Type>
std::shared_ptr<const Element> masing_of(const ElementKind::Values& values) {
  const auto made = [settings = values.settings](double more) {
    std::vector<Jet> all;
    for (const Jet& one : settings) all.push_back(shifted(one, more));
    return std::make_shared<Type>(all);
  };
  return std::make_shared<MasingElement>(made, setting_scale(values.settings));
}

}  // namespace arcslip
