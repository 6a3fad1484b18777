// Formulas are evaluated without an allocation, by several threads at once.

#include <future>

#include "allocations.hpp"
#include "arcslip/problems/formulas/formula_problem.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

/// Cells in a row, each with three unknowns, in a flow of several hundred operations.
problems::FormulaSystem cells(int count) {
  problems::FormulaSystem system{.parameters = {{"a", 1.2}, {"b", 3.1}, {"d", 0.3}}};
  for (int i = 0; i < count; ++i) {
    const auto of = [&](const char* name, int at) { return name + std::to_string(at); };
    const std::string x = of("x", i), y = of("y", i), next = of("x", (i + 1) % count);
    system.definitions.push_back({of("rate", i), x + "^2*" + y + "/(1 + " + x + "^2)"});
    system.equations.push_back(
        {x, "a - (b + 1)*" + x + " + " + of("rate", i) + " + d*(" + next + " - " + x + ")"});
    system.equations.push_back({y, "b*" + x + " - " + of("rate", i)});
    system.observables.push_back({of("size", i), "sqrt(" + x + "^2 + " + y + "^2)"});
  }
  return system;
}

/// All that a problem is asked for, and the sum of it.
struct Asked {
  explicit Asked(const problems::FormulaProblem& problem)
      : residual(problem.size()),
        second(problem.size() + 3),
        values(2 * problem.size()),
        jacobian(problem.size(), problem.size()),
        by_parameters(problem.size(), 3),
        gradient{Vector(problem.size()), Vector(3)} {}

  double of(const problems::FormulaProblem& problem, const Vector& u, const Vector& p) {
    continuation::Evaluation out;
    out.residual = &residual;
    out.jacobian = &jacobian;
    out.parameter_jacobian = &by_parameters;
    bool good = problem.evaluate(u, p, {}, out) && problem.second(u, p, {}, u, u, p, second);
    problem.observe(u, p, {}, values);
    const double size = problem.observe(u, p, {}, problem.size() + 1, gradient);
    return good ? residual.sum() + jacobian.sum() + by_parameters.sum() + second.sum() + values.sum() + size
                : 0;
  }

  Vector residual, second, values;
  Matrix jacobian, by_parameters;
  continuation::Gradient gradient;
};

}  // namespace

TEST_CASE("Formulas allocate nothing while they are evaluated") {
  const problems::FormulaProblem problem(cells(10));
  const Vector u = Vector::LinSpaced(problem.size(), 0.5, 1.5), p = Eigen::Vector3d(1.2, 3.1, 0.3);
  Asked asked(problem);
  asked.of(problem, u, p);
  const long before = allocations;
  const double sum = asked.of(problem, u, p);
  CHECK(allocations == before);
  CHECK(sum != 0);
}

TEST_CASE("Threads that share formulas find the same") {
  const problems::FormulaProblem problem(cells(40));
  const Vector p = Eigen::Vector3d(1.2, 3.1, 0.3);
  const auto sums = [&] {
    Asked asked(problem);
    std::vector<double> found;
    for (int i = 0; i < 200; ++i)
      found.push_back(asked.of(problem, Vector::LinSpaced(problem.size(), 0.5, 1.5 + 0.01 * i), p));
    return found;
  };
  std::vector<std::future<std::vector<double>>> others;
  for (int k = 0; k < 4; ++k) others.push_back(std::async(std::launch::async, sums));
  const std::vector<double> expected = sums();
  CHECK(expected[0] != 0);
  for (auto& other : others) CHECK(other.get() == expected);
}
