// What must not change a branch: the order of its unknowns, their units, the direction of travel.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "arcslip/problems/library/library.hpp"
#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// A problem with its unknowns and equations in another order, and both in other units.
class Changed : public Problem {
 public:
  Changed(const Problem& base, std::vector<Index> order, double unknowns, double residuals)
      : base_(base), order_(std::move(order)), unknowns_(unknowns), residuals_(residuals) {}

  Index size() const override { return base_.size(); }
  std::vector<std::string> parameter_names() const override { return base_.parameter_names(); }
  bool is_equilibrium() const override { return base_.is_equilibrium() && unknowns_ == residuals_; }

  Vector changed(const Vector& u) const { return unknowns_ * u(order_); }
  Vector original(const Vector& u) const {
    Vector back(u.size());
    back(order_) = u / unknowns_;
    return back;
  }

  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    const Index n = size();
    Vector residual(n);
    Matrix jacobian(n, n);
    Matrix by_parameters(n, p.size());
    Evaluation all;
    all.residual = &residual;
    all.jacobian = &jacobian;
    all.parameter_jacobian = &by_parameters;
    if (!base_.evaluate(original(u), p, regime, all)) return false;
    if (out.residual != nullptr) *out.residual = residuals_ * residual(order_);
    if (out.jacobian != nullptr) *out.jacobian = (residuals_ / unknowns_) * jacobian(order_, order_);
    if (out.parameter_jacobian != nullptr)
      *out.parameter_jacobian = residuals_ * by_parameters(order_, Eigen::all);
    return true;
  }
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    Vector of_base(size());
    base_.scale(original(u), p, of_base, parameters);
    unknowns = changed(of_base);
  }

 private:
  const Problem& base_;
  std::vector<Index> order_;
  double unknowns_, residuals_;
};

struct Subject {
  std::unique_ptr<Problem> problem;
  Guess guess;
  TraceOptions options;
};

Subject subject(const std::string& name) {
  const problems::LibraryModel& model = *problems::find_model(name);
  problems::LibraryModel::Values values = problems::defaults(model);
  Subject result;
  if (name == "ab") {
    values[1] = 17;
    result.options = over("p1", 0, 0.3);
  } else if (name == "enz") {
    result.options = over("s0", 0, 60);
  } else if (name == "freudenstein_roth") {
    values[0] = -0.9;
    result.options = over("x3", -0.9, 1);
  } else {
    result.options = over("W", 0.5, 1.8);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (model.settings[i].name == "W") values[i] = 0.5;
    }
  }
  result.problem = model.build(values);
  result.guess = model.guess(*result.problem, values);
  return result;
}

std::vector<BranchPoint> special(const Branch& branch) {
  std::vector<BranchPoint> points;
  for (const BranchPoint& point : branch.points) {
    if (point.type != PointType::regular) points.push_back(point);
  }
  return points;
}

void check_special(const std::vector<BranchPoint>& expected, const std::vector<BranchPoint>& found,
                   const Changed& problem) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(found[i].type == expected[i].type);
    for (Index k = 0; k < expected[i].parameters.size(); ++k) {
      CHECK_THAT(found[i].parameters(k),
                 WithinRel(expected[i].parameters(k), 1e-10) || WithinAbs(expected[i].parameters(k), 1e-10));
    }
    const Vector back = problem.original(found[i].unknowns);
    for (Index k = 0; k < back.size(); ++k) {
      CHECK_THAT(back(k),
                 WithinRel(expected[i].unknowns(k), 1e-8) || WithinAbs(expected[i].unknowns(k), 1e-8));
    }
  }
}

}  // namespace

TEST_CASE("Neither the order of the unknowns nor their units change a branch and its special points") {
  const std::string name = GENERATE("ab", "enz", "freudenstein_roth", "duffing");
  const double unknowns = GENERATE(1.0, 1e6, 1e-6);
  const double residuals = GENERATE(1.0, 1e6, 1e-6);
  CAPTURE(name, unknowns, residuals);
  const Subject plain = subject(name);
  const Branch expected = trace(*plain.problem, plain.guess, plain.options);
  REQUIRE(expected.complete());
  std::vector<Index> order(static_cast<std::size_t>(plain.problem->size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::reverse(order.begin(), order.end());
  const Changed problem(*plain.problem, order, unknowns, residuals);
  Guess guess = plain.guess;
  guess.unknowns = problem.changed(plain.guess.unknowns);
  const Branch found = trace(problem, guess, plain.options);
  CAPTURE(to_string(found.stop), found.explanation);
  REQUIRE(found.complete());
  std::vector<BranchPoint> wanted = special(expected);
  if (!problem.is_equilibrium())  // no eigenvalues in other units of F alone
    std::erase_if(wanted, [](const BranchPoint& point) { return point.type == PointType::hopf; });
  check_special(wanted, special(found), problem);
}

TEST_CASE("A branch traced backwards from its end has the same special points") {
  const std::string name = GENERATE("ab", "enz", "freudenstein_roth", "duffing");
  CAPTURE(name);
  const Subject plain = subject(name);
  const Branch forward = trace(*plain.problem, plain.guess, plain.options);
  REQUIRE(forward.stop == Stop::reached_end);
  const BranchPoint& last = forward.points.back();
  TraceOptions options = plain.options;
  std::swap(options.from, options.to);
  const Branch backward = trace(*plain.problem, {last.unknowns, last.parameters}, options);
  REQUIRE(backward.stop == Stop::reached_end);
  std::vector<BranchPoint> expected = special(forward);
  std::reverse(expected.begin(), expected.end());
  std::swap(expected.front().type, expected.back().type);
  std::vector<Index> order(static_cast<std::size_t>(plain.problem->size()));
  std::iota(order.begin(), order.end(), Index{0});
  check_special(expected, special(backward), Changed(*plain.problem, order, 1, 1));
}
