// Branches that are left and gone on with, from checkpoints.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "same_points.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// Traces up to `count` points, goes on from the checkpoint as text, and compares with the whole branch.
void check_resume(const Problem& problem, const Guess& guess, TraceOptions options, long count) {
  const Branch whole = trace(problem, guess, options);
  options.max_points = count;
  const Branch first = trace(problem, guess, options);
  REQUIRE(first.stop == Stop::max_points);
  REQUIRE(first.checkpoint);
  std::stringstream text;
  write(text, *first.checkpoint);
  options.max_points = 100000;
  const Branch rest = resume(problem, read_checkpoint(text), options);
  check_gone_on(first, rest, whole);
}

}  // namespace

TEST_CASE("A resumed branch is the one that was left, bit by bit, wherever it was left") {
  const long count = GENERATE(2, 3, 7, 11, 12, 13, 14, 15, 20, 26);
  check_resume(Cusp(), {vector_of({-1.5}), vector_of({-2})}, over("mu", -2, 2), count);
}

TEST_CASE("A branch with corners, extrema and events is resumed bit by bit") {
  const long count = GENERATE(5, 10, 14, 15, 16, 17, 25);
  TraceOptions options = over("p", 0, 2);
  options.events = {{"half", [](const Vector&, const Vector& p, const Regime&) { return p(0) - 0.5; }}};
  check_resume(Bump(0.3), {vector_of({-0.91}), vector_of({0})}, options, count);
}

TEST_CASE("Text that is no checkpoint is refused") {
  std::stringstream text("arcslip branch");
  CHECK_THROWS_AS(read_checkpoint(text), std::runtime_error);
}

namespace {

/// What `resume` says of a checkpoint that is not this problem's, or "none".
std::string refusal(const Problem& problem, const Checkpoint& checkpoint, const TraceOptions& options) {
  try {
    return resume(problem, checkpoint, options).points.empty() ? "no point" : "none";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("A branch is not gone on with as another one: what differs is named") {
  TraceOptions options = over("p", 0, 9);
  options.events = {{"one", [](const Vector& u, const Vector&, const Regime&) { return u(0) - 1; }}};
  options.max_points = 5;
  const Branch begun = trace(line("p", 1), {vector_of({0}), vector_of({0})}, options);
  REQUIRE(begun.checkpoint);
  const Checkpoint& checkpoint = *begun.checkpoint;
  CHECK(refusal(line("p", 1), checkpoint, options) == "none");
  CHECK_THAT(refusal(line("p", 2), checkpoint, options), ContainsSubstring("the problem is another one"));
  CHECK_THAT(refusal(Bratu(3), checkpoint, over("L", 0, 1)), ContainsSubstring("the parameters are"));
  CHECK_THAT(refusal(line("q", 1), checkpoint, over("q", 0, 9)), ContainsSubstring(R"(["q"])"));
  TraceOptions more = options;
  more.events.push_back({"two", [](const Vector& u, const Vector&, const Regime&) { return u(0) - 2; }});
  CHECK_THAT(refusal(line("p", 1), checkpoint, more), ContainsSubstring(R"(the events are ["one", "two"])"));
  more = options;
  more.extrema_of = {"u"};
  CHECK_THAT(refusal(line("p", 1), checkpoint, more), ContainsSubstring("extrema_of are [\"u\"]"));

  // A checkpoint of the first version has no names, but numbers.
  Checkpoint nameless = checkpoint;
  nameless.of.reset();
  CHECK(refusal(line("p", 1), nameless, options) == "none");
  CHECK_THAT(refusal(line("p", 1), nameless, more), ContainsSubstring("extrema are looked for"));
  CHECK_THAT(refusal(Bratu(3), nameless, over("L", 0, 1)), ContainsSubstring("there are 3 unknowns"));
}

TEST_CASE("A checkpoint of the first version is still read") {
  std::stringstream text(
      "arcslip-checkpoint-1\n1\n0x1p-1\n1\n0x1p-1\n2\n0x1p+0\n0x1p+0\n2\n0x1.6a09e667f3bcdp-1\n"
      "0x1.6a09e667f3bcdp-1\n0\n0x1p+0\n0x0p+0\n0\n1\n0x0p+0\n1\n0x0p+0\n2\n0x1p+0\n0x1p+0\n2\n"
      "0x1.6a09e667f3bcdp-1\n0x1.6a09e667f3bcdp-1\n0\n0x1p+0\n0x0p+0\n0\n2\n0x0p+0\n0x0p+0\n0\n1\n0\n0\n"
      "-1\n0\n0x1p-6\n0x1.6a09e667f3bcdp-1\n0\n");
  const Checkpoint checkpoint = read_checkpoint(text);
  const Branch rest = resume(line("p", 1), checkpoint, over("p", 0, 9));
  CHECK(rest.complete());
  CHECK(rest.points.front().parameters(0) > 0.5);
  CHECK(rest.points.back().unknowns(0) == 9);
}

TEST_CASE("Of a branch that is traced both ways both parts are gone on with") {
  const Guess guess{vector_of({0.2}), vector_of({0.2})};
  TraceOptions options = over("p", -9, 9);
  const Branch whole = trace_both(line("p", 1), guess, options);
  options.max_points = GENERATE(4, 5, 40);
  Branch begun = trace_both(line("p", 1), guess, options);
  REQUIRE(begun.checkpoint);
  std::stringstream text;
  write(text, *begun.checkpoint);
  options.max_points = 100000;
  const Branch rest = resume(line("p", 1), read_checkpoint(text), options);
  CHECK(rest.complete());
  CHECK(is_end(rest.first_stop.value()));
  std::vector<BranchPoint> all;
  for (const BranchPoint& point : rest.points) {
    if (point.arclength < begun.points.front().arclength) all.push_back(point);
  }
  all.insert(all.end(), begun.points.begin(), begun.points.end());
  for (const BranchPoint& point : rest.points) {
    if (point.arclength > begun.points.back().arclength) all.push_back(point);
  }
  REQUIRE(all.size() == whole.points.size());
  for (std::size_t i = 0; i < all.size(); ++i) check_same(all[i], whole.points[i]);
}

TEST_CASE("A part that was not begun when the other one was interrupted is begun later") {
  const Guess guess{vector_of({0.2}), vector_of({0.2})};
  const TraceOptions options = over("p", -9, 9);
  const Branch whole = trace_both(line("p", 1), guess, options);
  int left = 7;
  const Branch begun =
      trace_both(line("p", 1), guess, options, [&](const BranchPoint&) { return --left > 0; });
  REQUIRE(begun.stop == Stop::interrupted);
  std::stringstream text;
  write(text, *begun.checkpoint);
  const Branch rest = resume(line("p", 1), read_checkpoint(text), options);
  CHECK(rest.complete());
  CHECK(rest.points.front().parameters(0) == -9);
  CHECK(rest.points.size() + begun.points.size() == whole.points.size());
}

namespace {

/// x' = mu + lambda x - x^3.
class CuspOfTwo : public Problem {
 public:
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"mu", "lambda"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double x = u(0);
    if (out.residual != nullptr) (*out.residual)(0) = p(0) + p(1) * x - x * x * x;
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = p(1) - 3 * x * x;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << 1, x;
    return true;
  }
};

const CurveWindow window{-0.5, 0.7};

CurveStart folds(const Problem& problem) {
  BranchPoint fold;
  fold.type = PointType::fold;
  fold.unknowns = vector_of({std::sqrt(1.0 / 3)});
  fold.parameters = vector_of({-2 / std::sqrt(27.0), 1});
  return curve_through(problem, "mu", fold);
}

}  // namespace

TEST_CASE("A curve that is resumed keeps its window and both its halves") {
  const CuspOfTwo problem;
  CurveStart start = folds(problem);
  TraceOptions options = over("lambda", -1, 3);
  const Branch whole = trace_curve(*start.problem, start.point, options, window);
  REQUIRE(whole.complete());

  CurveStart again = folds(problem);
  Branch begun;
  if (GENERATE(true, false)) {
    options.max_points = GENERATE(3, 6, 30);
    begun = trace_curve(*again.problem, again.point, options, window);
  } else {
    int left = GENERATE(2, 6);
    begun = trace_curve(*again.problem, again.point, options, window,
                        [&](const BranchPoint&) { return --left > 0; });
  }
  REQUIRE(begun.checkpoint);
  std::stringstream text;
  write(text, *begun.checkpoint);
  options.max_points = 100000;
  CurveStart later = folds(problem);
  const Branch rest = resume(*later.problem, read_checkpoint(text), options);
  INFO(rest.explanation);
  CHECK(rest.complete());
  std::vector<BranchPoint> all = begun.points;
  all.insert(all.end(), rest.points.begin(), rest.points.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const BranchPoint& a, const BranchPoint& b) { return a.arclength < b.arclength; });
  REQUIRE(all.size() == whole.points.size());
  for (std::size_t i = 0; i < all.size(); ++i) check_same(all[i], whole.points[i]);
  // Both ends of the window, where mu = +-2 (lambda/3)^(3/2).
  CHECK_THAT(all.front().unknowns(1), WithinRel(0.7, 1e-9) || WithinRel(-0.5, 1e-9));
  CHECK_THAT(all.back().unknowns(1), WithinRel(0.7, 1e-9) || WithinRel(-0.5, 1e-9));
}

TEST_CASE("A curve is resumed as a curve of the same points only") {
  const CuspOfTwo problem;
  CurveStart start = folds(problem);
  TraceOptions options = over("lambda", -1, 3);
  options.max_points = 4;
  const Branch begun = trace_curve(*start.problem, start.point, options, window);
  REQUIRE(begun.checkpoint);
  const Problem& as_branch = *start.problem;
  CHECK_THAT(refusal(as_branch, *begun.checkpoint, options), ContainsSubstring("one of a curve"));
  TraceOptions more = options;
  more.extrema_of = {"mu"};
  CHECK_THROWS_AS(resume(*start.problem, *begun.checkpoint, more), std::invalid_argument);
  const ScalarProblem mirrored(
      {"mu", "lambda"}, [](double x, const Vector& p) { return p(0) - p(1) * x - x * x * x; },
      [](double x, const Vector& p) { return -p(1) - 3 * x * x; },
      {[](double, const Vector&) { return 1.0; }, [](double x, const Vector&) { return -x; }});
  FoldProblem other(mirrored, 0);
  CHECK_THROWS_AS(resume(other, *begun.checkpoint, options), std::invalid_argument);
  Checkpoint nameless = *begun.checkpoint;
  nameless.of.reset();
  CHECK_THROWS_AS(resume(*start.problem, nameless, options), std::invalid_argument);
}
