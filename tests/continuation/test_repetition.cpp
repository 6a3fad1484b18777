// Branches that go round and round a loop that their start is not on.

#include "arcslip/continuation/path/repetition.hpp"

#include <cmath>

#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;

namespace {

/// u^2 + p^2 = 1.
class RoundCircle : public Problem {
 public:
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    if (out.residual != nullptr) (*out.residual)(0) = u(0) * u(0) + p(0) * p(0) - 1;
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 2 * u(0);
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(0, 0) = 2 * p(0);
    return true;
  }
};

BranchPoint on_circle(double angle, PointType type, double sense = 1) {
  BranchPoint point;
  point.type = type;
  point.unknowns = Vector::Constant(1, std::sin(angle));
  point.parameters = Vector::Constant(1, std::cos(angle));
  point.tangent = sense * (Vector(2) << std::cos(angle), -std::sin(angle)).finished();
  return point;
}

}  // namespace

TEST_CASE("A branch is told to come round where it passes a fold again in the same direction",
          "[repetition]") {
  const RoundCircle circle;
  std::vector<BranchPoint> points = {on_circle(-0.5, PointType::regular), on_circle(0, PointType::fold)};
  CHECK(!came_round(circle, points, 0));
  for (const double angle : {0.5, 1.5, 2.5}) points.push_back(on_circle(angle, PointType::regular));
  points.push_back(on_circle(pi, PointType::fold));
  CHECK(!came_round(circle, points, 0));  // the other fold
  points.push_back(on_circle(5, PointType::regular));
  points.push_back(on_circle(two_pi + 1e-9, PointType::fold));
  CHECK(came_round(circle, points, 0) == std::optional<std::size_t>(1));
  points.back().type = PointType::regular;
  CHECK(!came_round(circle, points, 0));
  points.back() = on_circle(1e-5, PointType::fold);  // near it, and not there
  CHECK(!came_round(circle, points, 0));
  points.back() = on_circle(0, PointType::fold, -1);  // on the way back
  CHECK(!came_round(circle, points, 0));
  points.back() = on_circle(0, PointType::fold);
  points.back().regime = 1;
  CHECK(!came_round(circle, points, 0));
}

TEST_CASE("A branch that creeps past a fold does not come round", "[repetition]") {
  const RoundCircle circle;
  std::vector<BranchPoint> points;
  for (const double angle : {0.0, 1e-9, 2e-9, 5e-9}) points.push_back(on_circle(angle, PointType::fold));
  CHECK(!came_round(circle, points, 0));
}

TEST_CASE("A branch is told to turn in one place where it has many folds on no way", "[repetition]") {
  std::vector<BranchPoint> points = {on_circle(1, PointType::regular)};
  const auto go_on = [&](double way, PointType type) {
    const double before = points.back().arclength;
    points.push_back(on_circle(1, type));
    points.back().arclength = before + way;
  };
  go_on(0.1, PointType::fold);  // a place before it
  for (int i = 0; i < 19; ++i) {
    go_on(i == 0 ? 0.1 : 1e-9, PointType::fold);
    go_on(1e-9, PointType::peak);
    CHECK(!turns_in_place(points));
  }
  go_on(1e-9, PointType::regular);
  CHECK(!turns_in_place(points));
  go_on(1e-9, PointType::fold);
  CHECK(turns_in_place(points) == std::optional<std::size_t>(2));
  std::erase_if(points, [](const BranchPoint& point) { return point.type != PointType::fold; });
  for (std::size_t i = 0; i < points.size(); ++i) points[i].arclength = 1e-6 * static_cast<double>(i);
  CHECK(!turns_in_place(points));  // close folds of a curve that goes on
}

TEST_CASE("A branch is told to stay in one place where it has rows of any type there without end",
          "[repetition]") {
  std::vector<BranchPoint> points = {on_circle(1, PointType::regular), on_circle(1, PointType::regular)};
  points.back().arclength = 0.1;
  for (int i = 0; i < 99; ++i) {
    CHECK(!turns_in_place(points));
    points.push_back(on_circle(1, i % 2 == 0 ? PointType::regime_switch : PointType::peak));
    points.back().arclength = 0.1;
  }
  CHECK(turns_in_place(points) == std::optional<std::size_t>(1));
}
