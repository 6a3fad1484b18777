#include "arcslip/problems/library/cusp.hpp"

#include <cmath>

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {
namespace {

/// Beyond the outermost equilibrium on the side of mu, from where Newton's method falls to it.
Vector outer_bound(const continuation::Problem& /*problem*/, const Vector& p) {
  const double size = std::cbrt(std::abs(p(0))) + std::sqrt(std::max(p(1), 0.0));
  return Vector::Constant(1, std::copysign(size, p(0)));
}

}  // namespace

bool Cusp::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                    const continuation::Evaluation& out) const {
  const double x = u(0);
  if (out.residual != nullptr) *out.residual << p(0) + p(1) * x - x * x * x;
  if (out.jacobian != nullptr) *out.jacobian << p(1) - 3 * x * x;
  if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << 1, x;
  return true;
}

LibraryModel cusp_model() {
  return {"cusp",
          "Cusp catastrophe",
          {any_value("mu", -2, "imperfection"), any_value("lambda", 1, "splitting")},
          build_fixed<Cusp>,
          guess_at(outer_bound)};
}

}  // namespace arcslip::problems
