// Curves of extrema that go on across borders, against closed forms.

#include <cmath>

#include "arcslip/continuation/curves/curve.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "level_set.hpp"
#include "scalar_problem.hpp"
#include "unfinished_work.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// u = p, with two regimes on both sides of u = q: before it Y = 10 - u^2, behind it, with t = u - q,
///
///   Y = 10 - q^2 + a(q) t - t^(3/2),   a(q) = slope + rise q.
class Edge : public Problem {
 public:
  Edge(double slope, double rise) : slope_(slope), rise_(rise) {}
  enum SwitchState : int { before, behind };

  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"p", "q"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    if (out.residual != nullptr) (*out.residual)(0) = u(0) - p(0);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << -1, 0;
    return true;
  }
  Index switch_count() const override { return 1; }
  int border_count(const Regime& /*regime*/) const override { return 1; }
  double border(const Vector& u, const Vector& p, const Regime& regime, int /*border*/,
                Gradient* gradient) const override {
    const double sign = regime == before ? 1 : -1;
    if (gradient != nullptr) {
      gradient->unknowns(0) = sign;
      gradient->parameters << 0, -sign;
    }
    return sign * (u(0) - p(1));
  }
  std::optional<Regime> regime_beyond(const Regime& regime, int /*border*/) const override {
    return Regime(regime == before ? behind : before);
  }
  std::vector<Observable> observables() const override { return {{"Y", true}}; }
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override {
    Gradient unused{Vector::Zero(1), Vector::Zero(2)};
    values = Vector::Constant(1, observe(u, p, regime, 0, unused));
  }
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index /*which*/,
                 Gradient& gradient) const override {
    gradient.parameters.setZero();
    if (regime == before) {
      gradient.unknowns(0) = -2 * u(0);
      return 10 - u(0) * u(0);
    }
    const double t = std::max(0.0, u(0) - p(1));
    gradient.unknowns(0) = steepness(p(1)) - 1.5 * std::sqrt(t);
    gradient.parameters(1) = -2 * p(1) + rise_ * t - gradient.unknowns(0);
    return 10 - p(1) * p(1) + steepness(p(1)) * t - std::pow(t, 1.5);
  }

 private:
  double steepness(double q) const { return slope_ + rise_ * q; }

  double slope_;
  double rise_;
};

/// The same as one regime, which tells of no border.
class HiddenEdge : public Edge {
 public:
  using Edge::Edge;
  Index switch_count() const override { return 0; }
  int border_count(const Regime& /*regime*/) const override { return 0; }
  double observe(const Vector& u, const Vector& p, const Regime& /*regime*/, Index which,
                 Gradient& gradient) const override {
    return Edge::observe(u, p, u(0) < p(1) ? before : behind, which, gradient);
  }
};

/// Two equal halves, u_i + s_i (u_i - q) + (u_i - u_j) = 10 - p^2, where s_i is 1 for u_i > q and else 0: by
/// symmetry both come to their borders at once.
class EqualHalves : public Problem {
 public:
  enum SwitchState : int { above, below };

  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"p", "q"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    for (Index i = 0; i < 2; ++i) {
      const double s = regime[i] == above ? 1 : 0;
      if (out.residual != nullptr)
        (*out.residual)(i) = u(i) + s * (u(i) - p(1)) + u(i) - u(1 - i) - 10 + p(0) * p(0);
      if (out.jacobian != nullptr) out.jacobian->row(i) << (i == 0 ? 2 + s : -1), (i == 0 ? -1 : 2 + s);
      if (out.parameter_jacobian != nullptr) out.parameter_jacobian->row(i) << 2 * p(0), -s;
    }
    return true;
  }
  Index switch_count() const override { return 2; }
  int border_count(const Regime& /*regime*/) const override { return 2; }
  double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                Gradient* gradient) const override {
    const double sign = regime[border] == above ? 1 : -1;
    if (gradient != nullptr) {
      gradient->unknowns = -sign * Vector::Unit(2, border);
      gradient->parameters << 0, sign;
    }
    return sign * (p(1) - u(border));
  }
  std::optional<Regime> regime_beyond(const Regime& regime, int border) const override {
    return regime.with(border, regime[border] == above ? below : above);
  }
  std::vector<Observable> observables() const override { return {{"Y", true}}; }
  void observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/,
               Vector& values) const override {
    values = u.head(1);
  }
  double observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/, Index /*which*/,
                 Gradient& gradient) const override {
    gradient.unknowns << 1, 0;
    gradient.parameters.setZero();
    return u(0);
  }
};

/// The curve through the first extremum of a type at some q, over q from -3 to 2.
Branch curve_of(const Problem& problem, PointType type, double q, const TraceOptions& wanted) {
  TraceOptions options = over("p", -5, 5);
  options.extrema_of = {"Y"};
  const Branch response = trace(problem, {vector_of({-5}), vector_of({-5, q}), Edge::before}, options);
  const auto found = of_type(response, type);
  REQUIRE(!found.empty());
  const CurveStart start = curve_through(problem, "p", found[0], "Y");
  return trace_curve(*start.problem, start.point, wanted);
}

std::vector<double> places(const Branch& curve, PointType type) {
  std::vector<double> all;
  for (const BranchPoint& point : of_type(curve, type)) all.push_back(point.parameters(0));
  return all;
}

/// From q = 2 to a corner fold at q = 0 and back.
void check_turns_back(const Branch& curve) {
  REQUIRE(curve.complete());
  CHECK(curve.points.front().parameters(0) == 2);
  CHECK(curve.points.back().parameters(0) == 2);
  const std::vector<double> folds = places(curve, PointType::corner_fold);
  REQUIRE(folds.size() == 1);
  CHECK_THAT(folds[0], WithinAbs(0, 1e-10));
}

}  // namespace

TEST_CASE("A peak goes on from a regime along its border and into the next one") {
  // Smooth behind up to q = -1, where it touches the border, then a corner, from q = 0 on smooth before.
  const Edge problem(-1, -1);
  const double q = GENERATE(-2.0, -0.5, 1.5);  // of the seed
  TraceOptions options = over("q", -3, 2);
  options.extrema_of = {"Y"};
  options.stop_at = {-1.0001, -0.9999, 0.00005};
  const Branch curve = curve_of(problem, PointType::peak, q, options);
  REQUIRE(curve.complete());
  CHECK(curve.points.front().parameters(0) == -3);
  CHECK(curve.points.back().parameters(0) == 2);
  for (const BranchPoint& point : curve.points) {
    const double at = point.parameters(0);
    const double t = at < -1 ? std::pow((at + 1) / 1.5, 2) : 0;
    CAPTURE(at);
    CHECK_THAT(point.unknowns(1), WithinAbs(at < 0 ? at + t : 0, 1e-10));
    CHECK_THAT(point.unknowns(0), WithinAbs(point.unknowns(1), 1e-10));
  }
  const std::vector<double> switches = places(curve, PointType::regime_switch);
  REQUIRE(switches.size() == 2);
  CHECK_THAT(switches[0], WithinAbs(-1, 1e-10));
  CHECK_THAT(switches[1], WithinAbs(0, 1e-10));
  CHECK(places(curve, PointType::user) == std::vector<double>{-1.0001, -0.9999, 0.00005});
  CHECK(places(curve, PointType::corner_fold).empty());
  for (std::size_t i = 1; i < curve.points.size(); ++i)
    CHECK(curve.points[i].arclength >= curve.points[i - 1].arclength);
}

TEST_CASE("A peak goes on beyond borders that it comes to together") {
  const EqualHalves problem;
  TraceOptions options = over("p", -1, 1);
  options.extrema_of = {"Y"};
  const auto peak =
      of_type(trace(problem, {vector_of({7, 7}), vector_of({-1, 5})}, options), PointType::peak);
  REQUIRE(peak.size() == 1);
  const CurveStart start = curve_through(problem, "p", peak[0], "Y");
  const Branch curve = trace_curve(*start.problem, start.point, over("q", 1, 20));
  REQUIRE(curve.complete());
  CHECK(curve.points.front().parameters(0) == 1);
  CHECK(curve.points.back().parameters(0) == 20);
  CHECK(curve.points.back().regime == Regime().with(0, EqualHalves::below).with(1, EqualHalves::below));
  for (const BranchPoint& point : curve.points) {
    const double q = point.parameters(0);
    CAPTURE(q);
    CHECK_THAT(point.unknowns(0), WithinAbs(q < 10 ? (10 + q) / 2 : 10, 1e-9));
    CHECK_THAT(point.unknowns(2), WithinAbs(0, 1e-9));
  }
  CHECK(of_type(curve, PointType::regime_switch).size() == 1);
  CHECK(of_type(curve, PointType::corner_fold).empty());
}

TEST_CASE("Where a peak meets a corner trough its curve turns back along the border") {
  const Edge problem(1, 0);
  TraceOptions options = over("q", -3, 2);
  options.extrema_of = {"Y"};
  const Branch curve = curve_of(problem, PointType::peak, 1.5, options);
  check_turns_back(curve);
  bool on_border = std::abs(curve.points.front().unknowns(1)) > 1;
  for (const BranchPoint& point : curve.points) {
    if (point.type == PointType::corner_fold) on_border = !on_border;
    if (point.parameters(0) < 1e-9) continue;
    CHECK_THAT(point.unknowns(1), WithinAbs(on_border ? point.parameters(0) : 0, 1e-9));
  }
}

TEST_CASE("A curve of extrema that crosses borders counts, and ends where it is told to") {
  const Edge problem(-1, -1);
  TraceOptions options = over("q", -3, 2);
  options.stop_after = {{PointType::regime_switch, 2, {}}};
  const Branch counted = curve_of(problem, PointType::peak, -2, options);
  CHECK(counted.stop == Stop::requested);
  CHECK_THAT(counted.points.back().parameters(0), WithinAbs(0, 1e-10));
  options.stop_after.clear();
  options.max_points = 40;
  const Branch few = curve_of(problem, PointType::peak, -2, options);
  CHECK(few.stop == Stop::max_points);
  CHECK(std::ssize(few.points) <= 2 * options.max_points);
}

TEST_CASE("An extremum is followed along a corner that no border tells of") {
  const HiddenEdge problem(-1, -1);
  TraceOptions options = over("q", -3, 2);
  options.stop_at = {-0.5};
  const Branch curve = curve_of(problem, PointType::peak, 1.5, options);
  REQUIRE(curve.complete());
  CHECK(curve.points.front().parameters(0) == -3);
  CHECK(curve.points.back().parameters(0) == 2);
  CHECK(places(curve, PointType::user) == std::vector<double>{-0.5});
  CHECK(places(curve, PointType::corner_fold).empty());
  CHECK(curve.points.size() < 400);
  for (const BranchPoint& point : curve.points) {
    const double at = point.parameters(0);
    const double t = at < -1 ? std::pow((at + 1) / 1.5, 2) : 0;
    CAPTURE(at);
    CHECK_THAT(point.unknowns(1), WithinAbs(at < 0 ? at + t : 0, 1e-9));
  }
}

TEST_CASE("Where a peak vanishes on a corner that no border tells of its curve goes back as a trough") {
  const HiddenEdge problem(1, 0);
  const Branch curve = curve_of(problem, PointType::peak, 1.5, over("q", -3, 2));
  check_turns_back(curve);
}

TEST_CASE("A peak becomes a trough of the other part of a response where both parts meet") {
  // With y = u - 2: p^2 + p y/10 - y^2 = q, for q < 0 one part above and one below, for q > 0 one on each
  // side. The extrema p = -y/20, q = -1.0025 y^2 are those of the part below, then above.
  const ScalarProblem problem = level_set(
      [](const Place& z) { return z(1) * z(1) + 0.1 * z(1) * (z(0) - 2) - (z(0) - 2) * (z(0) - 2) - z(2); },
      [](const Place& z) { return Place(0.1 * z(1) - 2 * (z(0) - 2), 2 * z(1) + 0.1 * (z(0) - 2), -1); });
  for (const double step : {0.01, 0.05, 0.1, 0.2}) {
    CAPTURE(step);
    TraceOptions options = over("p", -1, 1);
    options.extrema_of = {"u"};
    const Branch response = trace(problem, start(0.5, -1, -1), options);
    const auto peaks = of_type(response, PointType::peak);
    REQUIRE(peaks.size() == 1);
    const CurveStart begin = curve_through(problem, "p", peaks[0], "u");
    TraceOptions along = over("q", -1.5, 1);
    along.max_step = step;
    const Branch curve = trace_curve(*begin.problem, begin.point, along);
    INFO(curve.explanation);
    REQUIRE(curve.complete());
    CHECK(curve.points.front().parameters(0) == -1.5);
    CHECK(curve.points.back().parameters(0) == -1.5);
    const auto folds = of_type(curve, PointType::fold);
    REQUIRE(folds.size() == 1);
    CHECK_THAT(folds[0].parameters(0), WithinAbs(0, 1e-10));
    CHECK(of_type(curve, PointType::branch_point).empty());
    CHECK((curve.points.front().unknowns(0) - 2) * (curve.points.back().unknowns(0) - 2) < 0);
    for (const BranchPoint& point : curve.points) {
      const double y = point.unknowns(0) - 2;
      CHECK_THAT(point.unknowns(1), WithinAbs(-0.05 * y, 1e-8));
      CHECK_THAT(point.parameters(0), WithinAbs(-1.0025 * y * y, 1e-8));
    }
  }
}

TEST_CASE("A curve of peaks goes on in the midst of its pieces", "[resume]") {
  const Edge edge(-1, -1);
  const HiddenEdge hidden(-1, -1);
  const bool is_hidden = GENERATE(false, true);
  const double q = is_hidden ? 1.5 : -0.5;  // of the seed
  const Problem& problem = is_hidden ? static_cast<const Problem&>(hidden) : edge;
  TraceOptions options = over("p", -5, 5);
  options.extrema_of = {"Y"};
  const auto peak =
      of_type(trace(problem, {vector_of({-5}), vector_of({-5, q}), Edge::before}, options), PointType::peak);
  REQUIRE(!peak.empty());
  const Tracing work = [&](const TraceOptions& o) {
    const CurveStart start = curve_through(problem, "p", peak[0], "Y");
    return Branches{trace_curve(*start.problem, start.point, o)};
  };
  TraceOptions along = over("q", -3, 2);
  along.extrema_of = {"Y"};
  check_interrupted(work, along);
  check_out_of_time(work, along);
}
