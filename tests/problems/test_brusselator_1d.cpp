#include "arcslip/problems/library/brusselator_1d.hpp"

#include <cmath>

#include "../support/branches.hpp"
#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/points/hopf_form.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double B = 5.45;

/// Of -u'' by differences on m intervals: the k-th eigenvalue.
double bend(Index intervals, int k) {
  const double m = static_cast<double>(intervals);
  const double root = 2 * m * std::sin(k * pi / (2 * m));
  return root * root;
}

/// Where the trace of the k-th mode's 2 x 2 matrix vanishes.
double hopf_length(Index intervals, int k, double b) {
  return std::sqrt(0.012 * bend(intervals, k) / (b - 5));
}

/// The root of that matrix's determinant there.
double hopf_omega(Index intervals, int k, double b) {
  const double q = bend(intervals, k) / std::pow(hopf_length(intervals, k, b), 2);
  return std::sqrt((b - 1 - 0.008 * q) * (-4 - 0.004 * q) + 4 * b);
}

Guess rest(const Problem& problem, double length, double b = B) {
  return {Vector{{2, b / 2}}.replicate(problem.size() / 2, 1), Vector{{length, 2, b, 0.008, 0.004}}};
}

/// The same with dense derivatives.
class Dense : public Problem {
 public:
  explicit Dense(Index intervals) : base_(intervals) {}
  Index size() const override { return base_.size(); }
  std::vector<std::string> parameter_names() const override { return base_.parameter_names(); }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    SparseMatrix entries;
    Evaluation of_base = out;
    of_base.jacobian = nullptr;
    of_base.sparse_jacobian = out.jacobian != nullptr ? &entries : nullptr;
    if (!base_.evaluate(u, p, regime, of_base)) return false;
    if (out.jacobian != nullptr) *out.jacobian = entries;
    return true;
  }

 private:
  problems::BrusselatorLine base_;
};

}  // namespace

TEST_CASE("The Brusselator on a line has exact derivatives", "[library]") {
  const Index intervals = GENERATE(2, 3, 20);
  const problems::BrusselatorLine problem(intervals);
  Guess at = rest(problem, 0.7);
  for (Index i = 0; i < at.unknowns.size(); ++i) at.unknowns(i) += 0.3 * std::sin(static_cast<double>(i));
  CHECK(check_derivatives(problem, at.unknowns, at.parameters, 0).worst < 1e-8);
}

TEST_CASE("Its rest has the Hopf points of a closed form, few unknowns or many", "[library]") {
  const Index intervals =
      GENERATE(40, 101, 102, 500);  // 200 and 202 unknowns: all eigenvalues, and the nearest
  CAPTURE(intervals);
  const problems::BrusselatorLine problem(intervals);
  TraceOptions options;
  options.parameter = "L";
  options.from = 0.3;
  options.to = 1.8;
  const Branch branch = trace(problem, rest(problem, 0.3), options);
  REQUIRE(branch.complete());
  const auto found = testing::of_type(branch, PointType::hopf);
  REQUIRE(found.size() == 3);
  for (int k = 1; k <= 3; ++k) {
    const BranchPoint& point = found[static_cast<std::size_t>(k - 1)];
    CHECK_THAT(point.parameters(0), WithinRel(hopf_length(intervals, k, B), 1e-9));
    Index critical = 0;
    point.eigenvalues.real().cwiseAbs().minCoeff(&critical);
    CHECK_THAT(std::abs(point.eigenvalues(critical).imag()), WithinRel(hopf_omega(intervals, k, B), 1e-9));
  }
  CHECK(branch.points.back().unstable == 6);
  CHECK(branch.points.size() < 100);  // however large their determinant is
}

TEST_CASE("Its Hopf points are super- or subcritical as those of a dense problem are", "[library]") {
  const Index intervals = GENERATE(30, 110);
  const int k = GENERATE(1, 2);
  const problems::BrusselatorLine sparse(intervals);
  const Dense dense(intervals);
  const Guess at = rest(sparse, hopf_length(intervals, k, B));
  const auto a = hopf_form(sparse, at);
  const auto b = hopf_form(dense, at);
  REQUIRE(a);
  REQUIRE(b);
  CHECK_THAT(a->omega, WithinRel(hopf_omega(intervals, k, B), 1e-10));
  CHECK_THAT(a->lyapunov, WithinAbs(b->lyapunov, 1e-7 * b->terms));
  if (k == 1) CHECK(a->lyapunov < 0);
}

TEST_CASE("Its Hopf points are followed over a second parameter", "[library]") {
  const Index intervals = 150;
  const problems::BrusselatorLine problem(intervals);
  BranchPoint hopf;
  const Guess at = rest(problem, hopf_length(intervals, 1, B));
  hopf.unknowns = at.unknowns;
  hopf.parameters = at.parameters;
  hopf.type = PointType::hopf;
  const double omega = hopf_omega(intervals, 1, B);
  hopf.eigenvalues = ComplexVector{{Complex(0, omega), Complex(0, -omega)}};
  const CurveStart start = curve_through(problem, "L", hopf);
  TraceOptions options;
  options.parameter = "B";
  options.from = B;
  options.to = 7;
  const Branch curve = trace_curve(*start.problem, start.point, options);
  REQUIRE(curve.complete());
  for (const BranchPoint& point : curve.points) {
    const double b = point.parameters(1);  // L has become an unknown
    CAPTURE(b);
    CHECK_THAT(point.unknowns(problem.size()), WithinRel(hopf_length(intervals, 1, b), 1e-9));
    CHECK_THAT(std::sqrt(point.unknowns(problem.size() + 1)), WithinRel(hopf_omega(intervals, 1, b), 1e-8));
  }
}
