#include "arcslip/problems/library/lorenz84.hpp"

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {

bool Lorenz84::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                        const continuation::Evaluation& out) const {
  const double X = u(0), Y = u(1), Z = u(2), U = u(3);
  const double F = p(0), T = p(1), a = p(2), b = p(3), G = p(4), d = p(5), g = p(6);
  if (out.residual != nullptr) {
    *out.residual << -Y * Y - Z * Z - a * X + a * F - g * U * U,  //
        X * Y - b * X * Z - Y + G,                                //
        b * X * Y + X * Z - Z,                                    //
        -d * U + g * U * X + T;
  }
  if (out.jacobian != nullptr) {
    *out.jacobian << -a, -2 * Y, -2 * Z, -2 * g * U,  //
        Y - b * Z, X - 1, -b * X, 0,                  //
        b * Y + Z, b * X, X - 1, 0,                   //
        g * U, 0, 0, -d + g * X;
  }
  if (out.parameter_jacobian != nullptr) {
    *out.parameter_jacobian << a, 0, F - X, 0, 0, 0, -U * U,  //
        0, 0, 0, -X * Z, 1, 0, 0,                             //
        0, 0, 0, X * Y, 0, 0, 0,                              //
        0, 1, 0, 0, 0, -U, U * X;
  }
  return true;
}

LibraryModel lorenz84_model() {
  const auto at_three = [](const continuation::Problem& /*problem*/, const Vector& /*p*/) -> Vector {
    return Eigen::Vector4d(2.9787004394953343, -0.03868302503393752, 0.058232737694740085,
                           -0.02105288273117459);  // the published start, at F = 3
  };
  return {"lorenz84",
          "Lorenz's model of 1984, extended",
          {any_value("F", 3, "symmetric forcing"), any_value("T", 0.04, "forcing of U"),
           any_value("a", 0.25, "relaxation"), any_value("b", 1, "advection"),
           any_value("G", 0.25, "asymmetric forcing"), any_value("d", 1.04, "damping of U"),
           any_value("g", 0.987, "coupling of U")},
          build_fixed<Lorenz84>,
          guess_at(at_three)};
}

}  // namespace arcslip::problems
