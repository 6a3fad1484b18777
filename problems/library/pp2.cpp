#include "arcslip/problems/library/pp2.hpp"

#include <cmath>

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {

bool PredatorPrey::evaluate(const Vector& unknowns, const Vector& p, const continuation::Regime& /*regime*/,
                            const continuation::Evaluation& out) const {
  const double u = unknowns(0), v = unknowns(1);
  const double caught = -std::expm1(-5 * u);
  if (out.residual != nullptr) *out.residual << 3 * u * (1 - u) - u * v - p(0) * caught, -v + 3 * u * v;
  if (out.jacobian != nullptr) {
    *out.jacobian << 3 - 6 * u - v - 5 * p(0) * (1 - caught), -u,  //
        3 * v, -1 + 3 * u;
  }
  if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << -caught, 0;
  return true;
}

LibraryModel pp2_model() {
  const auto nothing = [](const continuation::Problem& /*problem*/, const Vector& /*p*/) -> Vector {
    return Vector::Zero(2);
  };
  return {"pp2",
          "Predator and fished prey",
          {any_value("p", 0, "fishing")},
          build_fixed<PredatorPrey>,
          guess_at(nothing)};
}

}  // namespace arcslip::problems
