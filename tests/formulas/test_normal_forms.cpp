// Normal forms of points of codimension two: of systems that are in normal form, written in other
// coordinates, and of published ones; by exact series and by differences.

#include "arcslip/continuation/points/codimension_two.hpp"

#include <cmath>

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/problems/formulas/formula_problem.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::BasePoint;
using continuation::BranchPoint;
using continuation::NormalForm;
using continuation::PointType;
using problems::FormulaProblem;
using problems::FormulaSystem;

namespace {

/// The same without series.
class Plain : public FormulaProblem {
 public:
  using FormulaProblem::FormulaProblem;
  bool series(const Matrix& /*u*/, const Vector& /*p*/, const continuation::Regime& /*regime*/,
              Matrix& /*out*/) const override {
    return false;
  }
};

/// X' = `rates`[0] and so on of Y, Z and Q, by formulas of these and of S = X^2 + Y^2, times 1 + `speed` Z.
FormulaSystem system_of(const std::vector<std::string>& rates, const std::string& speed = "0") {
  FormulaSystem system{.parameters = {{"m1", 0}, {"m2", 0}}};
  system.equations = {{"X", "(1 + time)*(" + rates[0] + ")"},
                      {"Y", "(1 + time)*(" + rates[1] + ")"},
                      {"Z", "(1 + time)*(" + rates[2] + ")"},
                      {"Q", "(1 + time)*(" + rates[3] + ")"}};
  system.definitions = {{"time", speed + "*Z"}, {"S", "X^2 + Y^2"}};
  return system;
}

/// The same in coordinates u that are rotated after each has had a quadratic form of those before it added.
FormulaSystem seen_bent(const FormulaSystem& straight, double angle) {
  FormulaSystem system{.parameters = straight.parameters};
  auto& all = system.definitions;
  all = {{"c", std::to_string(std::cos(angle))},
         {"s", "sqrt(1 - c^2)"},
         {"a", "c*u1 + s*u4"},
         {"b", "c*u2 + s*u3"},
         {"d", "c*u3 - s*u2"},
         {"g", "c*u4 - s*u1"}};
  all.push_back({"X", "a"});
  all.push_back({"Y", "b + 0.4*a^2"});
  all.push_back({"Z", "d + 0.3*a^2 - 0.5*a*b + 0.2*b^2"});
  all.push_back({"Q", "g + 0.7*a*d - 0.6*b^2 + 0.3*d^2"});
  for (const Formula& one : straight.definitions) all.push_back(one);
  for (const Formula& one : straight.equations) all.push_back({"f" + one.name, one.text});
  all.push_back({"ra", "fX"});
  all.push_back({"rb", "fY - 0.8*a*ra"});
  all.push_back({"rd", "fZ - (0.6*a - 0.5*b)*ra - (0.4*b - 0.5*a)*rb"});
  all.push_back({"rg", "fQ - 0.7*(ra*d + a*rd) + 1.2*b*rb - 0.6*d*rd"});
  system.equations = {
      {"u1", "c*ra - s*rg"}, {"u2", "c*rb - s*rd"}, {"u3", "s*rb + c*rd"}, {"u4", "s*ra + c*rg"}};
  return system;
}

enum class On { folds, hopf };

NormalForm form_of(const continuation::Problem& problem, PointType type, On on, const Vector& u,
                   const Vector& p, double kappa = 0) {
  std::unique_ptr<continuation::ExtendedProblem> curve;
  if (on == On::folds) curve = std::make_unique<continuation::FoldProblem>(problem, 0);
  if (on == On::hopf) curve = std::make_unique<continuation::HopfProblem>(problem, 0);
  BranchPoint point;
  point.type = type;
  const BasePoint at{u, p, 0, on == On::folds ? Vector() : Vector::Constant(1, kappa)};
  curve->join(at, point.unknowns, point.parameters);
  const auto form = continuation::codimension_two_form(*curve, 1, point);
  REQUIRE(form);
  return *form;
}

double value(const NormalForm& form, const std::string& name) {
  for (const auto& one : form.coefficients) {
    if (one.name == name) return one.value;
  }
  FAIL("no coefficient " << name);
  return 0;
}

/// Of a system with equilibrium 0, exactly and by differences, in its own coordinates and in others.
void check_form(const FormulaSystem& straight, PointType type, On on, double kappa,
                const std::vector<std::pair<std::string, double>>& expected) {
  for (const double angle : {-1.0, 0.0, 0.7, 2.0}) {
    const FormulaSystem system = angle < 0 ? straight : seen_bent(straight, angle);
    INFO("angle " << angle);
    const Vector u = Vector::Zero(4), p = Vector::Zero(2);
    const NormalForm exact = form_of(FormulaProblem(system), type, on, u, p, kappa);
    CHECK(exact.error == 0);
    const NormalForm plain = form_of(Plain(system), type, on, u, p, kappa);
    CHECK(plain.error < 1e-6);
    for (const auto& [name, number] : expected) {
      INFO(name);
      CHECK_THAT(value(exact, name), WithinAbs(number, 1e-9 * (1 + std::abs(number))));
      CHECK_THAT(value(plain, name), WithinAbs(number, std::max(10 * plain.error, 1e-9)));
    }
  }
}

/// A curve of folds or of Hopf points through a guess.
template <class Curve>
std::vector<std::pair<BranchPoint, NormalForm>> forms_along(const FormulaProblem& problem, Curve& curve,
                                                            const BasePoint& guess,
                                                            const std::string& over_parameter, double from,
                                                            double to) {
  const auto branch = continuation::trace_curve(curve, guess, over(over_parameter, from, to));
  std::vector<std::pair<BranchPoint, NormalForm>> all;
  const Index other = continuation::index_of(problem.parameter_names(), over_parameter);
  for (const BranchPoint& point : branch.points) {
    if (const auto form = continuation::codimension_two_form(curve, other, point))
      all.emplace_back(point, *form);
  }
  return all;
}

}  // namespace

TEST_CASE("The cubic coefficient of a cusp is that of its normal form in any coordinates") {
  // X' = c X^3 + Q X with Q = k X^2 on the manifold
  const auto system = system_of({"m1 + m2*X - 0.8*X^3 + 0.9*Q*X", "-Y + X*Q", "-2*Z + X^2", "-Q + 0.5*X^2"});
  for (const double angle : {-1.0, 0.0, 0.7}) {
    const FormulaSystem seen = angle < 0 ? system : seen_bent(system, angle);
    const Vector u = Vector::Zero(4), p = Vector::Zero(2);
    const NormalForm form = form_of(FormulaProblem(seen), PointType::cusp, On::folds, u, p);
    CHECK(form.is_regular);
    CHECK_THAT(value(form, "c"), WithinAbs(-0.8 + 0.9 * 0.5, 1e-9));
    const NormalForm plain = form_of(Plain(seen), PointType::cusp, On::folds, u, p);
    CHECK_THAT(value(plain, "c"), WithinAbs(-0.35, 1e-7));
  }
}

TEST_CASE("A cusp that the parameters do not unfold is told") {
  for (const char* rate : {"m1*X + m2*X^3 - X^5", "m1*X - X^3", "m1 - m2 - X^3"}) {
    INFO(rate);
    const FormulaProblem problem({.parameters = {{"m1", 0}, {"m2", 0}}, .equations = {{"X", rate}}});
    CHECK_FALSE(form_of(problem, PointType::cusp, On::folds, Vector::Zero(1), Vector::Zero(2)).is_regular);
  }
  for (const char* rate : {"m1 + m2*X - X^3", "m2 + m1*X + 1e-3*X^3"}) {
    const FormulaProblem problem({.parameters = {{"m1", 0}, {"m2", 0}}, .equations = {{"X", rate}}});
    CHECK(form_of(problem, PointType::cusp, On::folds, Vector::Zero(1), Vector::Zero(2)).is_regular);
  }
}

TEST_CASE("Bogdanov-Takens coefficients are those of the normal form in any coordinates") {
  const auto system = system_of({"Y", "m1 + m2*X + 0.6*X^2 - 1.7*X*Y", "-2*Z + Y^2 - X*Y", "-Q + 0.5*X^2"});
  for (const On on : {On::folds, On::hopf}) {
    check_form(system, PointType::bogdanov_takens, on, 0, {{"a", 0.6}, {"b", -1.7}});
  }
}

TEST_CASE("The second Lyapunov coefficient is that of the normal form in any coordinates") {
  // z = 0.5 s on the manifold, whose part in r' is taken away again; w = (x + j y)/sqrt(2)
  const auto system = system_of({"m1*X - 1.3*Y - 0.4*S*Y + (0.8*Z - 0.4*S)*X - 0.7*S^2*X",
                                 "m1*Y + 1.3*X + 0.4*S*X + (0.8*Z - 0.4*S)*Y - 0.7*S^2*Y",
                                 "-Z + 0.5*S + 2*(m1 + 0.8*Z - 0.4*S - 0.7*S^2)*0.5*S", "-2*Q + X*Y + Z^2"});
  check_form(system, PointType::generalized_hopf, On::hopf, 1.69, {{"l2", -4 * 0.7 / 1.3}, {"omega", 1.3}});
}

TEST_CASE("Zero-Hopf coefficients do not depend on coordinates nor on the speed of time") {
  // w = (x + j y)/sqrt(2), v = z: s = 2 |w|^2
  const double b = 0.6, c = -0.9, d = 0.35, e = -0.8;
  const std::string turn = "(1.3 + 0.3*Z)", grow = "(m1 + 0.35*Z - 0.8*Z^2)";
  for (const char* speed : {"0", "0.5"}) {
    const auto system = system_of({grow + "*X - " + turn + "*Y", grow + "*Y + " + turn + "*X",
                                   "m2 + 0.6*Z^2 - 0.9*S", "-2*Q + X*Y + Z^2"},
                                  speed);
    for (const On on : {On::folds, On::hopf}) {
      check_form(system, PointType::zero_hopf, on, 1.69,
                 {{"b", b}, {"c", 2 * c}, {"d", d}, {"e", e}, {"s", -1}, {"theta", d / b}, {"omega", 1.3}});
    }
  }
}

TEST_CASE("Double Hopf coefficients are those of the normal form in any coordinates") {
  const std::string r = "(X^2 + Y^2)", t = "(Z^2 + Q^2)";
  const std::string one = "(m1 - 0.5*" + r + " + 0.8*" + t + ")",
                    other = "(m2 - 0.3*" + r + " - 0.9*" + t + ")";
  const auto system =
      system_of({one + "*X - 2.3*Y", one + "*Y + 2.3*X", other + "*Z - 0.7*Q", other + "*Q + 0.7*Z"});
  check_form(
      system, PointType::hopf_hopf, On::hopf, 2.3 * 2.3,
      {{"p11", -1}, {"p12", 1.6}, {"p21", -0.6}, {"p22", -1.8}, {"theta", -1.6 / 1.8}, {"delta", 0.6}});
}

TEST_CASE("Normal forms along the curves of carbon monoxide oxidation are those of MatCont") {
  // Of BifurcationKit.jl, test COModel.jl, which has them from MatCont: the model of Bykov and Yablonskii
  const FormulaSystem oxidation{
      .parameters = {{"q1", 2.5}, {"q2", 1}, {"q3", 10}, {"q4", 0.0675}, {"q5", 1}, {"q6", 0.1}, {"k", 0.4}},
      .equations = {{"x", "2*q1*z^2 - 2*q5*x^2 - q3*x*y"},
                    {"y", "q2*z - q6*y - q3*x*y"},
                    {"s", "q4*(z - k*s)"}},
      .definitions = {{"z", "1 - x - y - s"}}};
  const FormulaProblem problem(oxidation);
  const Vector start = vector_of({0.1066, 0.17583, 0.51255}),
               p = vector_of({2.5, 1, 10, 0.0675, 1, 0.1, 0.4});
  const auto branch = continuation::trace(problem, {start, p, 0, {}}, over("q2", 1, 2));
  CAPTURE(branch.explanation, branch.points.size());
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 2);
  continuation::FoldProblem of_folds(problem, 1);
  const auto at_folds =
      forms_along(problem, of_folds, {folds[0].unknowns, folds[0].parameters, 0, {}}, "k", 0.01, 1);
  REQUIRE(at_folds.size() == 3);
  int takens = 0;
  for (const auto& [point, form] : at_folds) {
    const double k = point.parameters(point.parameters.size() - 1);
    CAPTURE(to_string(point.type), k);
    if (point.type == PointType::cusp) {
      CHECK_THAT(k, WithinRel(0.35665351, 2e-3));  // there a cusp is only met by steps
      CHECK_THAT(value(form, "c"), WithinRel(0.362, 1e-2));
      CHECK(form.is_regular);
    } else {
      REQUIRE(point.type == PointType::bogdanov_takens);
      if (k < 0.9) continue;
      ++takens;
      CHECK_THAT(k, WithinAbs(0.97139757, 1e-7));
      CHECK_THAT(value(form, "a"), WithinRel(0.083784, 1e-5));
      CHECK_THAT(std::abs(value(form, "b")), WithinRel(2.1363, 1e-5));
    }
  }
  CHECK(takens == 1);
  const auto hopfs = of_type(branch, PointType::hopf);
  REQUIRE(hopfs.size() == 2);
  continuation::HopfProblem of_hopf(problem, 1);
  const Vector kappa = Vector::Constant(1, continuation::kappa_of(hopfs[0].eigenvalues));
  const auto at_hopf =
      forms_along(problem, of_hopf, {hopfs[0].unknowns, hopfs[0].parameters, 0, kappa}, "k", 0.01, 1);
  std::vector<double> ks;
  for (const auto& [point, form] : at_hopf) {
    if (point.type != PointType::generalized_hopf) continue;
    ks.push_back(point.parameters(point.parameters.size() - 1));
    if (ks.back() > 0.3) {  // MatCont's l_2 is not over omega
      CHECK_THAT(ks.back(), WithinAbs(0.305879, 1e-6));
    } else {
      CHECK_THAT(value(form, "l2") * value(form, "omega"), WithinRel(-776.89, 1e-4));
    }
  }
  CHECK(ks.size() == 2);
}
