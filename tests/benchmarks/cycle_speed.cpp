// What a point of a branch of cycles costs: Lorenz' cycles from their Hopf point, on 35 intervals of degree 4
// that stay, with Floquet multipliers at each point. Over the time of as many evaluations of the field with
// its derivatives as there are Gauss points, and of as many dense factors of 12 unknowns as there are
// intervals, one after the other in the same run. On the same meshes, of systems of two to eight unknowns, a
// step of AUTO-07p to 1e-7 takes 2.0 to 4.9 times as long as one of these to 1e-10, and 2.2 to 5.6 times as
// long as one to 1e-7.
//
// usage: cycle_speed

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdlib>

#include "../support/least_seconds.hpp"
#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/problems/formulas/formula_problem.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::continuation;
using testing::least_seconds;

std::shared_ptr<const Problem> lorenz() {
  problems::FormulaSystem system;
  system.parameters = {{"rho", 20}, {"beta", 8.0 / 3}, {"sigma", 10}};
  system.equations = {{"x", "sigma*(y - x)"}, {"y", "rho*x - y - x*z"}, {"z", "x*y - beta*z"}};
  return std::make_shared<const problems::FormulaProblem>(system);
}

}  // namespace

int main() {
  const std::shared_ptr<const Problem> problem = lorenz();
  const auto field = std::make_shared<const EquilibriumField>(problem);
  TraceOptions options;
  options.parameter = "rho";
  options.from = 20;
  options.to = 30;
  const double side = std::sqrt(8.0 / 3 * 19);
  const Branch rest =
      trace(*problem, {Eigen::Vector3d(side, side, 19), Eigen::Vector3d(20, 8.0 / 3, 10)}, options);
  const CycleOptions mesh{.intervals = 35, .degree = 4, .tolerance = 0.9};
  for (const BranchPoint& hopf : rest.points) {
    if (hopf.type != PointType::hopf) continue;
    options.from = 14;
    options.max_step = 0.003;
    options.max_points = 200;
    Branch branch;
    const double all = least_seconds(3, [&] {
      branch =
          trace_cycles(cycles_from_hopf(field, {hopf.unknowns, hopf.parameters, hopf.regime}, mesh).front(),
                       options, mesh)
              .branch;
    });
    Vector velocity(3);
    Matrix by_unknowns(3, 3);
    Matrix by_parameters(3, 3);
    const Index rows = 3 * mesh.degree;
    const Matrix block = Matrix::Identity(rows, rows) + 0.1 * Matrix::Ones(rows, rows);
    Eigen::PartialPivLU<Matrix> factors(block);
    const double reference = least_seconds(3, [&] {  // as long a run as the others, which noise hits alike
      for (Index j = 0; j < mesh.intervals * std::ssize(branch.points); ++j) {
        factors.compute(block);
        for (int i = 0; i < mesh.degree; ++i) {
          if (!field->evaluate(0, hopf.unknowns, hopf.parameters, {&velocity, &by_unknowns, &by_parameters}))
            std::abort();
        }
      }
    });
    const auto points = static_cast<double>(branch.points.size());
    fmt::print(
        "{} points, {:.2f} evaluations a point, {:.3f} ms a point: {:.1f} times the field at all Gauss "
        "points "
        "and factors of each interval's matrix\n",
        branch.points.size(), static_cast<double>(branch.work.evaluations) / points, 1e3 * all / points,
        all / reference);
  }
}
