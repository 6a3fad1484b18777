// Microslip by the four-parameter Iwan model [Segalman, J. Appl. Mech. 72 (2005) 752]: limits spread as
// R_0 s^chi up to phi_max, and sliders that all slip there. F_S, where all slip, is proportional to the load.

#include <cmath>
#include <complex>

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/masing.hpp"

namespace arcslip {
namespace {

constexpr double imaginary_step = 1e-30;  // whose square is nothing: derivatives to rounding

class FourParameterBackbone final : public Backbone {
 public:
  explicit FourParameterBackbone(const std::vector<Jet>& settings) {
    const auto complex = [](const Jet& jet) { return Complex(jet.value, imaginary_step * jet.first); };
    slip_force_ = complex(settings[0]);
    stiffness_ = complex(settings[1]);
    chi_ = complex(settings[2]);
    const Complex beta = complex(settings[3]);
    const Complex part = beta + (chi_ + 1.0) / (chi_ + 2.0);
    phi_max_ = slip_force_ * (1.0 + beta) / (stiffness_ * part);
    density_ = slip_force_ * (chi_ + 1.0) / (std::pow(phi_max_, chi_ + 2.0) * part);
  }

  Jet force(double x) const override {
    if (!(x > 0)) return 0;
    const Complex f = x >= phi_max_.real() ? slip_force_
                                           : stiffness_ * x - density_ * std::pow(x, chi_ + 2.0) /
                                                                  ((chi_ + 1.0) * (chi_ + 2.0));
    return {f.real(), f.imag() / imaginary_step, 0};
  }
  double slope(double x) const override {
    if (!(x > 0)) return stiffness_.real();
    const double chi = chi_.real();
    return x >= phi_max_.real() ? 0 : stiffness_.real() - density_.real() * std::pow(x, chi + 1) / (chi + 1);
  }
  std::vector<double> corners() const override { return {phi_max_.real()}; }

 private:
  Complex slip_force_;
  Complex stiffness_;
  Complex chi_;
  Complex phi_max_;
  Complex density_;  // R_0
};

}  // namespace

ElementKind iwan_4_element() {
  Setting chi =
      any_value("chi", std::numeric_limits<double>::quiet_NaN(), "exponent of the spread of limits");
  chi.low = -1;
  ElementKind kind{
      "iwan_4",
      "microslip: the four-parameter Iwan model",
      {{given_positive("slip_force", "F_S per preload, at which all slips"), true},
       {given_positive("stiffness", "K_T before any slips"), true},
       {chi},
       {not_negative("beta", 0, "of sliders that slip last, over the spread ones")}},
      [](const ElementKind::Values& values) { return masing_of<FourParameterBackbone>(values); }};
  kind.has_memory = true;
  kind.follows = true;
  return kind;
}

}  // namespace arcslip
