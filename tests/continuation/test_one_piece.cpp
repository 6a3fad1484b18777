// Problems whose pieces join smoothly, taken as one piece.

#include "arcslip/continuation/problem/one_piece.hpp"

#include <cmath>

#include "branches.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// u_i + k max(0, u_i - t_i)^2 = sin(p) + i p/10: each switch i closes and opens where the right-hand side is
/// t_i, several of them at one p where their t_i are equal. The last border of all ends every branch.
class Closing : public Problem {
 public:
  Index size() const override { return thresholds.size(); }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  Index switch_count() const override { return size(); }
  int border_count(const Regime& /*regime*/) const override { return static_cast<int>(size()) + 1; }
  std::optional<Regime> regime_beyond(const Regime& regime, int border) const override {
    if (border == size()) return std::nullopt;
    return regime.with(border, 1 - regime[border]);
  }
  double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                Gradient* gradient) const override {
    const bool is_last = border == size();
    const double sign = is_last || regime[border] == 0 ? 1 : -1;
    if (gradient != nullptr) {
      gradient->unknowns.setZero();
      gradient->parameters.setZero();
      (is_last ? gradient->parameters(0) : gradient->unknowns(border)) = sign;
    }
    return is_last ? p(0) - 100 : sign * (u(border) - thresholds(border));
  }
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    if (out.jacobian != nullptr) out.jacobian->setZero();
    for (Index i = 0; i < size(); ++i) {
      const double beyond = regime[i] == 1 ? u(i) - thresholds(i) : 0;
      const auto rate = static_cast<double>(i) / 10;
      if (out.residual != nullptr)
        (*out.residual)(i) = u(i) + 3 * beyond * beyond - std::sin(p(0)) - rate * p(0);
      if (out.jacobian != nullptr) (*out.jacobian)(i, i) = 1 + 6 * beyond;
      if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(i, 0) = -std::cos(p(0)) - rate;
    }
    return true;
  }
  std::vector<Observable> observables() const override { return {{"last", true}}; }
  void observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/,
               Vector& values) const override {
    values = u.tail(1);
  }
  double observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/, Index /*which*/,
                 Gradient& gradient) const override {
    gradient.unknowns = Vector::Unit(size(), size() - 1);
    gradient.parameters.setZero();
    return u(size() - 1);
  }

  Vector thresholds = (Vector(4) << 0.2, 0.5, 0.5, 0.7).finished();
};

Branch along(const Problem& problem) {
  TraceOptions options;
  options.parameter = "p";
  options.from = 0;
  options.to = 6;
  options.extrema_of = {"last"};
  return trace(problem, {Vector::Zero(4), Vector::Zero(1), {}, {}}, options);
}

}  // namespace

TEST_CASE("A problem in one piece has the branch that it has in pieces", "[regimes]") {
  const auto pieces = std::make_shared<const Closing>();
  const OnePiece whole(pieces);
  const Branch located = along(*pieces);
  const Branch passed = along(whole);
  REQUIRE(located.complete());
  REQUIRE(passed.complete());
  CHECK(of_type(located, PointType::regime_switch).size() > 4);
  CHECK(of_type(passed, PointType::regime_switch).empty());
  CHECK(passed.points.size() < located.points.size());
  const double peak = std::acos(-0.3);  // of sin(p) + 3 p/10
  for (const Branch* branch : {&located, &passed}) {
    const std::vector<BranchPoint> peaks = of_type(*branch, PointType::peak);
    REQUIRE(peaks.size() == 1);
    CHECK_THAT(peaks[0].parameters(0), WithinAbs(peak, 1e-8));
    const double beyond = std::sin(peak) + 0.3 * peak - 0.7;
    CHECK_THAT(peaks[0].unknowns(3), WithinRel(0.7 + (std::sqrt(1 + 12 * beyond) - 1) / 6, 1e-9));
  }
}

TEST_CASE("The piece of a point is found from any other one", "[regimes]") {
  const Closing pieces;
  const Vector u = (Vector(4) << 0.3, 0.5, 0.6, 0.0).finished();
  const Vector p = Vector::Zero(1);
  const Regime own = Regime().with(0, 1).with(2, 1);
  for (const Regime& start : {Regime(), Regime().with(3, 1), own.with(1, 0)})
    CHECK(regime_at(pieces, u, p, start) == own);
  // What ends a branch is no piece to enter: a point beyond it keeps the others' states.
  CHECK(regime_at(pieces, u, Vector::Constant(1, 101.0)) == own);
  CHECK_THROWS_AS(OnePiece(nullptr), std::invalid_argument);
}
