// Regimes of many switches, of which nobody makes a list: corners where several of them change at once.

#include <cmath>
#include <random>
#include <sstream>

#include "arcslip/continuation/events/corner.hpp"
#include "arcslip/continuation/path/all_solutions.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;
using Catch::Matchers::ContainsSubstring;

namespace {

/// A u + s(u) = p c, where s_i = k_i max(0, u_i - t_i) acts in state 1 of switch i. A is diagonally dominant
/// beside k_i >= 0 of either size, so that for each p there is one solution.
class Switches : public Problem {
 public:
  /// At p = 1 just the first `together` switches are at their threshold.
  Switches(Index count, Index together, unsigned seed) : matrix_(count, count), stiffness_(count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto draw = [&](Index) { return unit(random); };
    corner_ = Vector::NullaryExpr(count, draw);
    matrix_ = Matrix::NullaryExpr(count, count, [&](Index, Index) { return unit(random); });
    for (Index i = 0; i < count; ++i)
      matrix_(i, i) = 0.1 + matrix_.row(i).cwiseAbs().sum() - std::abs(matrix_(i, i));
    stiffness_ = 20 * Vector::NullaryExpr(count, draw).cwiseAbs();
    threshold_ = corner_;
    for (Index i = together; i < count; ++i) threshold_(i) += unit(random) < 0 ? -3 : 3;
    load_ = matrix_ * corner_ + stiffness_.cwiseProduct((corner_ - threshold_).cwiseMax(0));
  }

  Index size() const override { return matrix_.rows(); }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  Index switch_count() const override { return size(); }
  int border_count(const Regime& /*regime*/) const override { return static_cast<int>(size()); }
  std::optional<Regime> regime_beyond(const Regime& regime, int border) const override {
    return regime.with(border, 1 - regime[border]);
  }
  double border(const Vector& u, const Vector& /*p*/, const Regime& regime, int border,
                Gradient* gradient) const override {
    const double sign = regime[border] == 0 ? 1 : -1;
    if (gradient != nullptr) {
      gradient->unknowns.setZero();
      gradient->unknowns(border) = sign;
      gradient->parameters.setZero();
    }
    return sign * (u(border) - threshold_(border));
  }
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    ++evaluations;
    Vector acting = Vector::Zero(size());
    for (Index i = 0; i < size(); ++i) acting(i) = regime[i] == 1 ? stiffness_(i) : 0;
    if (out.residual != nullptr)
      *out.residual = matrix_ * u + acting.cwiseProduct(u - threshold_) - p(0) * load_;
    if (out.jacobian != nullptr) *out.jacobian = matrix_ + Matrix(acting.asDiagonal());
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = -load_;
    return true;
  }

  /// The solution by itself: one equation after another, each solved for its own unknown, until none moves.
  Vector solution(double p) const {
    Vector u = corner_;
    for (int sweep = 0; sweep < 100000; ++sweep) {
      const Vector before = u;
      for (Index i = 0; i < size(); ++i) {
        const double rest = p * load_(i) - (matrix_.row(i).dot(u) - matrix_(i, i) * u(i));
        const double alone = rest / matrix_(i, i);
        u(i) = alone <= threshold_(i)
                   ? alone
                   : (rest + stiffness_(i) * threshold_(i)) / (matrix_(i, i) + stiffness_(i));
      }
      if ((u - before).lpNorm<Eigen::Infinity>() < 1e-15) break;
    }
    return u;
  }

  Regime regime(const Vector& u) const {
    Regime result;
    for (Index i = 0; i < size(); ++i) result = result.with(i, u(i) > threshold_(i) ? 1 : 0);
    return result;
  }

  Guess corner() const { return {corner_, vector_of({1}), regime(solution(1 - 1e-6)), {}}; }

  mutable long evaluations = 0;  // the tests are of one thread

 private:
  Matrix matrix_;
  Vector stiffness_;
  Vector corner_;
  Vector threshold_;
  Vector load_;
};

/// Whether just the pieces before and behind the corner were found.
void check_pieces(const Switches& problem, const std::vector<Guess>& pieces) {
  REQUIRE(pieces.size() == 2);
  for (const Guess& piece : pieces) {
    const double p = 1 + std::copysign(1e-6, piece.direction.tail(1)(0));
    CHECK(piece.regime == problem.regime(problem.solution(p)));
  }
  CHECK(pieces[0].direction.tail(1)(0) * pieces[1].direction.tail(1)(0) < 0);
}

}  // namespace

TEST_CASE("A regime is a value, however many switches it has") {
  Regime regime;
  CHECK(regime.size() == 0);
  CHECK(digits(regime) == "0");
  for (const Index which : {0, 15, 16, 31, 32, 99}) {
    const Regime other = regime.with(which, 3);
    CHECK(other[which] == 3);
    CHECK(other.size() == which + 1);
    CHECK(other != regime);
    CHECK(regime < other);
    CHECK_FALSE(other < regime);
    CHECK(other.with(which, 0) == regime);
    CHECK(regime_of_digits(digits(other)) == other);
  }
  CHECK(Regime().with(99, 1).with(2, 1) != Regime().with(99, 1));
  CHECK(Regime().with(2, 1) < Regime().with(99, 1));
  CHECK(Regime(1) == regime_of_bits(1));
  CHECK(digits(regime_of_bits(6)) == "011");
  CHECK(regime_of_digits("011") == regime_of_bits(6));
  CHECK(regime_of_bits(3) < regime_of_bits(4));
  CHECK_THROWS_AS(Regime(16), std::invalid_argument);
  CHECK_THROWS_AS(Regime(-1), std::invalid_argument);
  CHECK_THROWS_AS(regime_of_digits("0x"), std::invalid_argument);
}

TEST_CASE("At a corner only the switches that are reached there are tried") {
  const auto count = GENERATE(Index{2}, Index{12}, Index{24}, Index{40});
  const auto together = GENERATE(Index{1}, Index{2}, Index{3}, Index{5});
  if (together > count) return;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Switches problem(count, together, seed);
    CAPTURE(count, together, seed);
    const std::vector<Guess> pieces = leaving_pieces(problem, 0, problem.corner());
    check_pieces(problem, pieces);
    // one of each pattern, with a second border of the linearisation where the first is singular
    CHECK(problem.evaluations <= (2L << together));
  }
}

TEST_CASE("Where many switches are reached at once the two pieces take about as many rounds at most") {
  const auto count = GENERATE(Index{9}, Index{12}, Index{24}, Index{40});
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Switches problem(count, count, seed);
    CAPTURE(count, seed);
    check_pieces(problem, leaving_pieces(problem, 0, problem.corner()));
    CHECK(problem.evaluations <= 2 * (count + 2));
  }
}

TEST_CASE("A branch goes on through corners of many switches") {
  const auto count = GENERATE(Index{12}, Index{24}, Index{40});
  const Index together = GENERATE(2, 3, 12);
  const Switches problem(count, together, 7);
  const Vector start = problem.solution(0);
  const Branch branch = trace(problem, {start, vector_of({0}), problem.regime(start), {}}, over("p", 0, 2));
  INFO(branch.explanation);
  REQUIRE(branch.complete());
  const BranchPoint& end = branch.points.back();
  CHECK((end.unknowns - problem.solution(2)).lpNorm<Eigen::Infinity>() < 1e-9);
  CHECK(end.regime == problem.regime(end.unknowns));
}

TEST_CASE("Solutions are looked for in the regimes that starts lie in") {
  const Switches problem(24, 0, 3);
  SolveAllOptions options;
  options.lower = Vector::Constant(24, -10);
  options.upper = Vector::Constant(24, 10);
  const std::vector<Guess> all = solve_all(problem, {{Vector::Zero(24), vector_of({2})}}, options);
  REQUIRE(all.size() == 1);
  CHECK((all[0].unknowns - problem.solution(2)).lpNorm<Eigen::Infinity>() < 1e-9);
  // one in each of two regimes: u = p/a below and p/b above
  options.lower = vector_of({-10});
  options.upper = vector_of({10});
  CHECK(solve_all(Corner(1, -2), {{vector_of({-1}), vector_of({-1})}}, options).size() == 2);
}

TEST_CASE("A guess in a regime that is not there is refused") {
  const Guess guess{vector_of({-1}), vector_of({-1}), Regime().with(1, 1)};
  CHECK_THROWS_WITH(trace(Corner(1, 2), guess, over("p", -1, 1)), ContainsSubstring("a regime 01"));
}

TEST_CASE("Regimes of the second version of checkpoints are bits") {
  const Switches problem(2, 0, 1);
  TraceOptions options = over("p", 5, 6);
  const Vector start = problem.solution(5);
  const Guess guess{start, vector_of({5}), problem.regime(start), {}};
  const Branch whole = trace(problem, guess, options);
  REQUIRE(whole.complete());
  options.max_points = 3;
  std::stringstream text;
  Checkpoint checkpoint = *trace(problem, guess, options).checkpoint;
  checkpoint.ahead->bends.length = 0;
  write(text, checkpoint);
  std::string old = text.str();
  const auto replace = [&](const std::string& now, const std::string& then) {
    REQUIRE(old.find(now) != std::string::npos);
    for (std::size_t at = 0; (at = old.find(now, at)) != std::string::npos; at += then.size())
      old.replace(at, now.size(), then);
  };
  replace("arcslip-checkpoint-8", "arcslip-checkpoint-2");
  const std::string straight = "3\n0x0p+0\n0x0p+0\n0x0p+0\n";
  replace("\n0\nnan\n0x0p+0\n0\n" + straight + straight + "0x0p+0\n0\nno_start\n", "\nno_start\n");
  replace("3\nstates 0\nstates 1\nstates 01\n", "4\nstates 0\nstates 1\nstates 01\nstates 11\n");
  REQUIRE(digits(guess.regime).size() == 2);
  replace("\n" + digits(guess.regime) + "\n", guess.regime[0] == 1 ? "\n3\n" : "\n2\n");
  std::stringstream again(old);
  options.max_points = 1000;
  const Branch rest = resume(problem, read_checkpoint(again), options);
  CHECK(rest.points.size() + 3 == whole.points.size());
  CHECK(rest.points.back().unknowns == whole.points.back().unknowns);
}
