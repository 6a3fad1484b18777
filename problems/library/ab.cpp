#include "arcslip/problems/library/ab.hpp"

#include <cmath>

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {
namespace {

/// The equilibrium of lowest conversion, by an iteration that rises to it from zero.
Vector lowest_equilibrium(const continuation::Problem& /*problem*/, const Vector& p) {
  const double heat = p(1) / (1 + p(2));
  double conversion = 0;
  for (int rounds = 0; rounds < 200; ++rounds) {
    const double rate = p(0) * std::exp(heat * conversion);
    conversion = rate / (1 + rate);
  }
  return Eigen::Vector2d(conversion, heat * conversion);
}

}  // namespace

bool StirredTank::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                           const continuation::Evaluation& out) const {
  const double arrhenius = std::exp(u(1));
  const double left = (1 - u(0)) * arrhenius;
  if (out.residual != nullptr) {
    *out.residual << -u(0) + p(0) * left, -u(1) + p(0) * p(1) * left - p(2) * u(1);
  }
  if (out.jacobian != nullptr) {
    *out.jacobian << -1 - p(0) * arrhenius, p(0) * left,  //
        -p(0) * p(1) * arrhenius, -1 + p(0) * p(1) * left - p(2);
  }
  if (out.parameter_jacobian != nullptr)
    *out.parameter_jacobian << left, 0, 0, p(1) * left, p(0) * left, -u(1);
  return true;
}

LibraryModel ab_model() {
  return {"ab",
          "Stirred tank with the reaction A -> B",
          {not_negative("p1", 0, "Damkoehler number"), any_value("p2", 14, "heat of reaction"),
           not_negative("p3", 3, "cooling")},
          build_fixed<StirredTank>,
          guess_at(lowest_equilibrium)};
}

}  // namespace arcslip::problems
