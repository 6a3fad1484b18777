// A spring of stiffness k pushes a shallow arch down. Where its far end has come by d, the apex has by u:
//
//   u (1 - u) (2 - u)/2 - k (d - u) = 0
//
// On a soft spring, k < 1/2, the arch snaps through. At k = 1/5 it does so at d = 1 +- sqrt(1/5).

#include <arcslip/continuation/path/trace.hpp>
#include <arcslip/continuation/problem/derivative_check.hpp>
#include <iostream>

using namespace arcslip;
using namespace arcslip::continuation;

class Arch : public Problem {
 public:
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"d", "k"}; }

  bool evaluate(const Vector& unknowns, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double u = unknowns(0), d = p(0), k = p(1);
    if (out.residual) *out.residual << u * (1 - u) * (2 - u) / 2 - k * (d - u);
    if (out.jacobian) *out.jacobian << (3 * u * u - 6 * u + 2) / 2 + k;
    if (out.parameter_jacobian) *out.parameter_jacobian << -k, u - d;
    return true;
  }
};

int main() {
  const Arch arch;
  TraceOptions options;
  options.parameter = "d";
  options.from = 0;
  options.to = 2;
  const Guess unloaded{Vector::Zero(1), Eigen::Vector2d(0, 0.2)};  // u; d and k
  const Branch branch = trace(arch, unloaded, options);

  for (const BranchPoint& point : branch.points) {
    if (point.type == PointType::regular) continue;
    std::cout << to_string(point.type) << ": d = " << point.parameters(0) << ", u = " << point.unknowns(0)
              << '\n';
  }
  const BranchPoint& last = branch.points.back();
  const auto report = check_derivatives(arch, last.unknowns, last.parameters, last.regime);
  std::cout << branch.explanation << "; derivatives exact to " << report.worst << '\n';
  return branch.complete() ? 0 : 1;
}
