#include "arcslip/problems/library/freudenstein_roth.hpp"

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {
namespace {

/// The solution of least x2: Newton's method rises to it from far below.
Vector least_solution(const continuation::Problem& /*problem*/, const Vector& p) {
  double t = -100;
  for (int i = 0; i < 100; ++i) t -= (((t - 2) * t - 6) * t + 4 - 12 * p(0)) / ((3 * t - 4) * t - 6);
  return Eigen::Vector2d((((-11 * t + 4) * t + 114) * t + 214) / 6, t);
}

}  // namespace

bool FreudensteinRoth::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                                const continuation::Evaluation& out) const {
  const double x = u(0), y = u(1), z = p(0) - 1;
  if (out.residual != nullptr) {
    *out.residual << x - y * y * y + 5 * y * y - 2 * y - 13 + 34 * z,
        x + y * y * y + y * y - 14 * y - 29 + 10 * z;
  }
  if (out.jacobian != nullptr) *out.jacobian << 1, -3 * y * y + 10 * y - 2, 1, 3 * y * y + 2 * y - 14;
  if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << 34, 10;
  return true;
}

LibraryModel freudenstein_roth_model() {
  return {"freudenstein_roth",
          "Function of Freudenstein and Roth",
          {any_value("x3", 0, "the third variable")},
          build_fixed<FreudensteinRoth>,
          guess_at(least_solution)};
}

}  // namespace arcslip::problems
