// Systems given by formulas: as good as those that are written in C++, to the last digits.

#include "arcslip/problems/formulas/formula_problem.hpp"

#include <cmath>
#include <numbers>

#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "library_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using problems::FormulaKind;
using problems::FormulaSystem;
using problems::LibraryModel;

namespace {

const FormulaSystem tank{.parameters = {{"p1", 0}, {"p2", 14}, {"p3", 3}},
                         .equations = {{"u1", "-u1 + rate"}, {"u2", "-u2 + p2*rate - p3*u2"}},
                         .definitions = {{"rate", "p1*(1 - u1)*exp(u2)"}}};
const FormulaSystem lorenz{
    .parameters = {{"F", 3}, {"T", 0.04}, {"a", 0.25}, {"b", 1}, {"G", 0.25}, {"d", 1.04}, {"g", 0.987}},
    .equations = {{"X", "-Y^2 - Z^2 - a*X + a*F - g*U^2"},
                  {"Y", "X*Y - b*X*Z - Y + G"},
                  {"Z", "b*X*Y + X*Z - Z"},
                  {"U", "-d*U + g*U*X + T"}},
    .start = {{"X", "2.9787004394953343"},
              {"Y", "-0.03868302503393752"},
              {"Z", "0.058232737694740085"},
              {"U", "-0.02105288273117459"}}};
const FormulaSystem prey{.parameters = {{"p", 0}},
                         .equations = {{"u", "3*u*(1 - u) - u*v - p*(1 - exp(-5*u))"}, {"v", "-v + 3*u*v"}}};

/// Both branches have the same points, and what is special is in the same places.
void check_same(const std::vector<Branch>& ours, const std::vector<Branch>& theirs) {
  REQUIRE(ours.size() == theirs.size());
  for (std::size_t b = 0; b < ours.size(); ++b) {
    REQUIRE(ours[b].points.size() == theirs[b].points.size());
    CHECK(ours[b].stop == theirs[b].stop);
    for (std::size_t i = 0; i < ours[b].points.size(); ++i) {
      const BranchPoint& one = ours[b].points[i];
      const BranchPoint& other = theirs[b].points[i];
      INFO("branch " << b << ", point " << i);
      CHECK(one.type == other.type);
      if (one.type == PointType::regular) CHECK(one.unstable == other.unstable);  // else one is just zero
      CHECK((one.parameters - other.parameters).cwiseAbs().maxCoeff() < 1e-12);
      const double size = std::max(1.0, other.unknowns.cwiseAbs().maxCoeff());
      CHECK((one.unknowns - other.unknowns).cwiseAbs().maxCoeff() < 1e-12 * size);
    }
  }
}

Branch traced(const LibraryModel& model, LibraryModel::Values values,
              const continuation::TraceOptions& options) {
  const std::unique_ptr<continuation::Problem> problem = model.build(values);
  values[static_cast<std::size_t>(continuation::index_of(problem->parameter_names(), options.parameter))] =
      options.from;
  return continuation::trace(*problem, model.guess(*problem, values), options);
}

Branch traced(const FormulaSystem& system, const continuation::TraceOptions& options) {
  const LibraryModel model = problems::model_of(system);
  return traced(model, problems::defaults(model), options);
}

const BranchPoint& only_point(const Branch& branch, PointType type) {
  const auto is_one = [&](const BranchPoint& point) { return point.type == type; };
  REQUIRE(std::count_if(branch.points.begin(), branch.points.end(), is_one) == 1);
  return *std::find_if(branch.points.begin(), branch.points.end(), is_one);
}

}  // namespace

TEST_CASE("Library models given as formulas have the same branches", "[formulas]") {
  const LibraryModel ab = problems::model_of(tank);
  for (const double p2 : {14.0, 17.0}) {
    const LibraryModel& theirs = *problems::find_model("ab");
    const auto options = over("p1", 0, p2 == 14 ? 0.4 : 0.2);
    const std::unique_ptr<continuation::Problem> problem = theirs.build({0, p2, 3});
    const continuation::Guess start = theirs.guess(*problem, {0, p2, 3});
    check_same({continuation::trace(*ab.build({0, p2, 3}), start, options)},
               {continuation::trace(*problem, start, options)});
  }
  check_same({traced(lorenz, over("F", 3, 0.5))},
             {traced(*problems::find_model("lorenz84"), problems::defaults(*problems::find_model("lorenz84")),
                     over("F", 3, 0.5))});
}

TEST_CASE("Branches that meet are the same by formulas", "[formulas]") {
  const LibraryModel ours = problems::model_of(prey);
  const LibraryModel& theirs = *problems::find_model("pp2");
  auto options = over("p", 0, 1);
  const auto connected = [&](const LibraryModel& model) {
    const auto problem = model.build({0});
    return continuation::trace_connected(*problem, model.guess(*problem, {0}), options);
  };
  check_same(connected(ours), connected(theirs));
}

TEST_CASE("Formulas give exact first and second derivatives of a system and its observables", "[formulas]") {
  FormulaSystem system = lorenz;
  system.observables = {{"energy", "half*(X^2 + speed)"}, {"angle", "atan2(Y, Z)*T"}};
  system.definitions = {{"speed", "Y^2 + Z^2 + U^2"}, {"half", "1/2"}};
  for (const FormulaKind kind : {FormulaKind::flow, FormulaKind::map, FormulaKind::algebraic}) {
    system.kind = kind;
    system.iterate = 2;
    const problems::FormulaProblem problem(system);
    const Vector u = Eigen::Vector4d(0.9, -0.4, 0.6, 0.3);
    Vector p(7), dp(7);
    p << 0.7, 0.04, 0.25, 0.5, 0.25, 1.04, 0.987;
    dp << 0.3, -0.2, 0.1, 0.5, 0.7, -0.4, 0.2;
    const auto report = continuation::check_derivatives(problem, u, p, {});
    INFO(report.where);
    CHECK(report.worst < 1e-8);
    const Vector w = Eigen::Vector4d(1, -2, 0.5, 0.7), du = Eigen::Vector4d(0.2, 0.9, -0.6, 0.4);
    Vector exact, difference(11);
    REQUIRE(problem.second(u, p, {}, w, du, dp, exact));
    const auto row = [&](double h, Vector& out) {
      Matrix by_u(4, 4), by_p(4, 7);
      continuation::Evaluation wanted;
      wanted.jacobian = &by_u;
      wanted.parameter_jacobian = &by_p;
      if (!problem.evaluate(u + h * du, p + h * dp, {}, wanted)) return false;
      out.resize(11);
      out << by_u.transpose() * w, by_p.transpose() * w;
      return true;
    };
    CHECK(continuation::differentiate(row, 0.01, difference).agrees);
    CHECK((exact - difference).cwiseAbs().maxCoeff() < 1e-8);
    Vector values;
    problem.observe(u, p, {}, values);
    REQUIRE(values.size() == 6);
    CHECK(values(4) == Approx(0.5 * u.squaredNorm()).epsilon(1e-15));
  }
}

TEST_CASE("Formulas at any number of places have the values and derivatives of one by one", "[formulas]") {
  const problems::FormulaProblem problem(lorenz);
  Vector p(7);
  p << 0.7, 0.04, 0.25, 0.5, 0.25, 1.04, 0.987;
  for (const Index places : {1, 7, 8, 9, 31, 32, 33, 39, 40, 71}) {
    const Matrix u = Matrix::NullaryExpr(4, places, [](Index r, Index k) { return std::sin(3. * k + r); });
    Matrix values(4, places), by_u(4, 4 * places), by_p(4, 7 * places);
    REQUIRE(problem.evaluate_columns(u, p, &values, &by_u, &by_p));
    for (Index k = 0; k < places; ++k) {
      Vector value(4);
      Matrix one_by_u(4, 4), one_by_p(4, 7);
      const Vector place = u.col(k);
      REQUIRE(problem.evaluate(place, p, {}, {&value, &one_by_u, &one_by_p}));
      CHECK(values.col(k) == value);
      CHECK(by_u.middleCols(4 * k, 4) == one_by_u);
      CHECK(by_p.middleCols(7 * k, 7) == one_by_p);
    }
  }
}

TEST_CASE("The logistic map doubles its period at r = 3, and its 2-cycle at 1 + sqrt 6", "[formulas]") {
  FormulaSystem map{.kind = FormulaKind::map,
                    .parameters = {{"r", 2}},
                    .equations = {{"x", "r*x*(1 - x)"}},
                    .start = {{"x", "1 - 1/r"}}};
  const Branch once = traced(map, over("r", 1.5, 4));
  const BranchPoint& first = only_point(once, PointType::period_doubling);
  CHECK_THAT(first.parameters(0), Catch::Matchers::WithinAbs(3, 1e-10));
  CHECK(once.points.front().unstable == 0);
  CHECK(once.points.back().unstable == 1);

  map.iterate = 2;
  const LibraryModel model = problems::model_of(map);
  const auto problem = model.build({1.5});
  const std::vector<Branch> twice =
      continuation::trace_connected(*problem, model.guess(*problem, {1.5}), over("r", 1.5, 4));
  const BranchPoint& born = only_point(twice[0], PointType::branch_point);
  CHECK_THAT(born.parameters(0), Catch::Matchers::WithinAbs(3, 1e-9));
  REQUIRE(twice.size() == 3);
  for (std::size_t i = 1; i < 3; ++i) {
    const BranchPoint& next = only_point(twice[i], PointType::period_doubling);
    CHECK_THAT(next.parameters(0), Catch::Matchers::WithinAbs(1 + std::sqrt(6), 1e-10));
    const double x = next.unknowns(0), r = next.parameters(0);  // x = (r + 1 +- sqrt((r + 1)(r - 3)))/2r
    CHECK(std::abs(std::abs(2 * r * x - r - 1) - std::sqrt((r + 1) * (r - 3))) < 1e-9);
  }
}

TEST_CASE("Fixed points of an iterated map pass where their only multiplier is 1", "[formulas]") {
  FormulaSystem map{.kind = FormulaKind::map,
                    .parameters = {{"r", 2}},
                    .equations = {{"x", "r*x*(1 - x)"}},
                    .start = {{"x", "1 - 1/r"}}};
  for (const int iterate : {2, 4}) {
    for (const double from : {2.3, 2.5, 2.8, 2.94, 2.98}) {
      CAPTURE(iterate, from);
      map.iterate = iterate;
      const Branch branch = traced(map, over("r", from, 3.3));
      REQUIRE(branch.stop == continuation::Stop::reached_end);
      CHECK_THAT(only_point(branch, PointType::branch_point).parameters(0),
                 Catch::Matchers::WithinAbs(3, 1e-9));
      const BranchPoint& last = branch.points.back();
      CHECK_THAT(last.unknowns(0), Catch::Matchers::WithinAbs(1 - 1 / 3.3, 1e-12));
      CHECK(branch.points.front().unstable == 0);
      CHECK(last.unstable == 1);
    }
  }
}

TEST_CASE("A period-3 window of the logistic map opens at 1 + sqrt 8", "[formulas]") {
  const FormulaSystem map{.kind = FormulaKind::map,
                          .iterate = 3,
                          .parameters = {{"r", 3.84}},
                          .equations = {{"x", "r*x*(1 - x)"}},
                          .start = {{"x", "0.149"}}};
  const Branch branch = traced(map, over("r", 3.84, 3.8));
  const BranchPoint& fold = only_point(branch, PointType::fold);
  CHECK_THAT(fold.parameters(0), Catch::Matchers::WithinAbs(1 + std::sqrt(8), 1e-10));
  CHECK(branch.points.front().unstable == 0);
}

TEST_CASE("A pair of multipliers of the delayed logistic map crosses at r = 2 by 60 degrees", "[formulas]") {
  const FormulaSystem map{.kind = FormulaKind::map,
                          .parameters = {{"r", 1.5}},
                          .equations = {{"x", "r*x*(1 - y)"}, {"y", "x"}},
                          .start = {{"x", "1 - 1/r"}, {"y", "1 - 1/r"}}};
  const Branch branch = traced(map, over("r", 1.5, 2.5));
  const BranchPoint& crossing = only_point(branch, PointType::neimark_sacker);
  CHECK_THAT(crossing.parameters(0), Catch::Matchers::WithinAbs(2, 1e-10));
  CHECK(std::abs(omega_of(crossing) - std::numbers::pi / 3) < 1e-8);
  CHECK(of_type(branch, PointType::hopf).empty());
  CHECK(branch.points.back().unstable == 2);
}

TEST_CASE("An algebraic system has folds and no stability", "[formulas]") {
  const FormulaSystem circle{.kind = FormulaKind::algebraic,
                             .parameters = {{"c", 0}},
                             .equations = {{"x", "x^2 + c^2 - 1"}},
                             .start = {{"x", "1"}}};
  const Branch branch = traced(circle, over("c", 0, 2));
  CHECK_THAT(only_point(branch, PointType::fold).parameters(0), Catch::Matchers::WithinAbs(1, 1e-12));
  CHECK(branch.points.front().unstable == -1);
}

TEST_CASE("A branch shortens its steps where a formula has no value", "[formulas]") {
  const FormulaSystem root{
      .parameters = {{"c", 1}}, .equations = {{"x", "sqrt(x) - c"}}, .start = {{"x", "c^2"}}};
  const Branch branch = traced(root, over("c", 1, -1));  // x = c^2 ends at c = 0
  CHECK(branch.stop == continuation::Stop::no_value);
  CHECK(std::abs(branch.points.back().parameters(0)) < 1e-3);
}

TEST_CASE("A right-hand side may depend on the time, with its derivative", "[formulas]") {
  const FormulaSystem forced{.parameters = {{"w", 2}, {"a", 3}},
                             .equations = {{"x", "v"}, {"v", "-x + a*phase"}},
                             .definitions = {{"phase", "cos(w*t)"}}};
  const Tape tape = problems::right_hand_side(forced);
  const std::vector<double> at{0.7, 0.1, 0.2, 2, 3};  // t, x, v, w, a
  std::vector<double> f(2), gradients(10);
  REQUIRE(tape.evaluate(at.data(), f.data(), gradients.data()));
  CHECK(f == std::vector<double>{0.2, -0.1 + 3 * std::cos(1.4)});
  CHECK(gradients[5] == Approx(-6 * std::sin(1.4)).epsilon(1e-15));
  CHECK(gradients[8] == Approx(-2.1 * std::sin(1.4)).epsilon(1e-15));
  CHECK(tape.uses(0));
}

TEST_CASE("Names that mean two things are refused with both places", "[formulas]") {
  const auto message = [](const FormulaSystem& system) -> std::string {
    try {
      problems::model_of(system);
    } catch (const FormulaError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message({.parameters = {{"x", 1, "parameters.x"}}, .equations = {{"x", "x", "equations.x"}}}) ==
        "equations.x: parameters.x has this name already");
  CHECK(message({.parameters = {{"point", 1}}, .equations = {{"x", "x"}}}) ==
        "point: results have point already; expected another name");
  CHECK(message({.equations = {{"x", "-x"}}, .start = {{"y", "1"}}}) ==
        "y: there is no equation of this name");
  CHECK(
      message({.equations = {{"x", "-x + t"}}}) ==
      "x: \"t\" at column 6 of \"-x + t\" is the time, on which systems of kind \"forced\" alone may depend");
  CHECK(message({.parameters = {{"a", 1}}, .equations = {{"x", "-x"}}, .start = {{"x", "x"}}}) ==
        "x: unknown name \"x\" at column 1 of \"x\"; there are a");
}
