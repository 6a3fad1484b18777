#include "arcslip/problems/library/enz.hpp"

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {
namespace {

/// R(s) = s/d with its derivatives.
struct Rate {
  Rate(double s, double k)
      : denominator(1 + s + k * s * s),
        value(s / denominator),
        by_s((1 - k * s * s) / (denominator * denominator)),
        by_k(-s * s * s / (denominator * denominator)) {}
  double denominator, value, by_s, by_k;
};

/// Below the symmetric equilibrium of least substrate, as R(s) <= s; Newton's method rises to it.
Vector lower_bound(const continuation::Problem& /*problem*/, const Vector& p) {
  return Vector::Constant(2, p(0) / (1 + p(2)));
}

}  // namespace

bool EnzymeCompartments::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                                  const continuation::Evaluation& out) const {
  const Rate first(u(0), p(3)), second(u(1), p(3));
  if (!(first.denominator > 0 && second.denominator > 0)) return false;
  const double rho = p(2);
  if (out.residual != nullptr) {
    *out.residual << p(0) - u(0) + (u(1) - u(0)) - rho * first.value,
        p(0) + p(1) - u(1) + (u(0) - u(1)) - rho * second.value;
  }
  if (out.jacobian != nullptr) *out.jacobian << -2 - rho * first.by_s, 1, 1, -2 - rho * second.by_s;
  if (out.parameter_jacobian != nullptr) {
    *out.parameter_jacobian << 1, 0, -first.value, -rho * first.by_k,  //
        1, 1, -second.value, -rho * second.by_k;
  }
  return true;
}

LibraryModel enz_model() {
  return {"enz",
          "Enzyme in two compartments",
          {not_negative("s0", 0, "substrate outside"), any_value("mu", 0, "asymmetry"),
           not_negative("rho", 100, "activity of the enzyme"), not_negative("k", 1, "inhibition")},
          build_fixed<EnzymeCompartments>,
          guess_at(lower_bound)};
}

}  // namespace arcslip::problems
