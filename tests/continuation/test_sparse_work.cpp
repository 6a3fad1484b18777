// What branches and curves of many unknowns cost.

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "sparse_problems.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// dF/dp by central differences of F, good to five digits only, since F loses them.
class Differenced : public Ignition {
 public:
  using Ignition::Ignition;
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    for (Index k = 0; out.parameter_jacobian != nullptr && k < p.size(); ++k) {
      const Vector h = Vector::Unit(p.size(), k) * 6e-6;
      out.parameter_jacobian->col(k) = (value(u, p + h) - value(u, p - h)) / 1.2e-5;
    }
    Evaluation others = out;
    others.parameter_jacobian = nullptr;
    return Ignition::evaluate(u, p, regime, others);
  }

 private:
  /// The terms in an order that rounds them.
  Vector value(const Vector& u, const Vector& p) const {
    Vector f(size());
    for (Index i = 0; i < size(); ++i) {
      f(i) = -2 * u(i) + spacing() * spacing() * source(u(i), p).value;
      if (i > 0) f(i) += u(i - 1);
      if (i + 1 < size()) f(i) += u(i + 1);
    }
    return f;
  }
};

/// The folds from K = 0, and how often the problem was evaluated for them.
Branch folds_of(const Problem& base) {
  TraceOptions options;
  options.parameter = "L";
  options.to = 5;
  options.stop_after = {{PointType::fold, 1, {}}};
  const Branch branch = trace(base, {Vector::Zero(base.size()), Vector{{0.0, 0.0}}, 0, {}}, options);
  const CurveStart start = curve_through(base, "L", branch.points.back());
  TraceOptions along;
  along.parameter = "K";
  along.to = 0.2;
  Branch folds = trace_curve(*start.problem, start.point, along);
  folds.work.evaluations = start.problem->evaluations();
  return folds;
}

}  // namespace

TEST_CASE("A curve of folds is hardly more work where derivatives are themselves differences") {
  const Branch rough = folds_of(Differenced(999, true));
  const Branch exact = folds_of(Ignition(999, true));
  REQUIRE(rough.complete());
  REQUIRE(exact.complete());
  CHECK_THAT(rough.points.back().unknowns(999), WithinRel(exact.points.back().unknowns(999), 1e-9));
  // The rest is the search of the first steps for two branch points, by slopes that err.
  CHECK(rough.work.evaluations < 8 * exact.work.evaluations);
  CHECK(exact.work.evaluations < 70 * std::ssize(exact.points));
}

TEST_CASE("Bratu's problem in the square is traced to L = 0 at few factorisations a point") {
  const BratuRectangle square(15, 15);
  TraceOptions options;
  options.parameter = "L";
  options.to = 8;
  const Branch branch = trace(square, {Vector::Zero(225), Vector{{0.0}}, 0, {}}, options);
  // On the upper half u -> infinity.
  CHECK(branch.stop == Stop::asymptotic);
  CHECK(of_type(branch, PointType::fold).size() == 1);
  CHECK(branch.points.back().parameters(0) < 1e-10);
  CHECK(branch.work.factorizations < 8 * std::ssize(branch.points));
}
