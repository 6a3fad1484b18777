// Jacobians of whole rings, condensed to the contacts that slip: what matrices give, by factors and by
// iterations.

#include <Eigen/LU>
#include <random>

#include "arcslip/continuation/linear/condensed_bordered_solver.hpp"
#include "arcslip/continuation/linear/dense_bordered_solver.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/evaluation.hpp"
#include "arcslip/continuation/problem/linearization.hpp"
#include "arcslip/structure/block_circulant.hpp"
#include "catch.hpp"
#include "whole_rings.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Guess;
using problems::HarmonicResponse;
using Course = WholeLoad::Course;

namespace {

constexpr Index always = 0;         // condensed from so many unknowns on, iterated from so many active ones
constexpr Index never = 1'000'000;  // or not

RingContacts scattered(Index count, unsigned seed, bool in_stiffness = true) {
  std::mt19937 random(seed);
  std::lognormal_distribution<double> any(0, 1);
  RingContacts contacts;
  for (Index i = 0; i < count; ++i) contacts.limit.push_back(any(random));
  for (Index i = 0; in_stiffness && i < count; ++i) contacts.stiffness.push_back(1 + .1 * any(random));
  return contacts;
}

/// Beside a solution, some contacts of which stick; the others slip as the amplitudes have it.
Guess mixed(const HarmonicResponse& problem, double eta, double preload) {
  Guess at = problem.guess(eta, 1e3);
  at.parameters(HarmonicResponse::preload) = preload;
  for (Index i = 0; i < problem.contacts(); ++i) {
    if (std::abs(problem.motion(at.unknowns, i)(0)) > problem.slip_threshold(i, at.parameters))
      at.regime = at.regime.with(static_cast<int>(i), 1);
  }
  at.unknowns *= 1.01;
  return at;
}

Index slipping(const HarmonicResponse& problem, const Guess& at) {
  Index count = 0;
  for (Index i = 0; i < problem.contacts(); ++i) count += at.regime[i];
  return count;
}

/// The matrix of a solver's blocks.
Matrix joined_blocks(const Matrix& jacobian, const Vector& scale, continuation::BorderedSolver& solver) {
  const Index n = solver.size();
  const Index all = n + solver.borders();
  Matrix whole(all, all);
  whole << jacobian * scale.asDiagonal(), solver.columns(), solver.rows(), solver.corner();
  return whole;
}

void check_condensed(const SystemParameters& system, double eta, double preload) {
  const HarmonicResponse problem(build_harmonic_system(system), always);
  const Guess at = mixed(problem, eta, preload);
  CAPTURE(problem.size(), slipping(problem, at), problem.contacts(), preload);
  continuation::Linearization matrix(problem, true);
  continuation::Linearization condensed(problem);
  REQUIRE(matrix.evaluate(at.unknowns, at.parameters, at.regime));
  REQUIRE(condensed.evaluate(at.unknowns, at.parameters, at.regime));
  CHECK((matrix.residual() - condensed.residual()).norm() < 1e-14);
  CHECK((matrix.parameter_jacobian() - condensed.parameter_jacobian()).norm() <
        1e-13 * matrix.parameter_jacobian().norm());

  const Index n = problem.size();
  const Vector x = Vector::Random(n);
  Vector expected(n);
  Vector found(n);
  matrix.multiply(x, expected);
  condensed.multiply(x, found);
  CHECK((found - expected).norm() < 1e-13 * expected.norm());
  matrix.multiply_transposed(x, expected);
  condensed.multiply_transposed(x, found);
  CHECK((found - expected).norm() < 1e-13 * expected.norm());
  matrix.multiply_absolute(x, expected);
  condensed.multiply_absolute(x, found);
  CHECK((found.array() >= (1 - 1e-12) * expected.array()).all());
  CHECK((found.array() <= 20 * expected.array() + 1e-12).all());

  const auto jacobian = problem.condensed_jacobian();
  Vector residual(n);
  Matrix by_parameters(n, at.parameters.size());
  REQUIRE(continuation::evaluate(
      problem, at.unknowns, at.parameters, at.regime,
      {.residual = &residual, .parameter_jacobian = &by_parameters, .condensed_jacobian = jacobian.get()}));
  const Vector scale = at.unknowns.norm() * (Vector::Random(n).cwiseAbs() + Vector::Constant(n, .1));
  for (const Index factored : {always, never}) {
    continuation::CondensedBorderedSolver solver(n, 2, factored);
    solver.set_jacobian(*jacobian, scale);
    solver.columns().setRandom();
    solver.rows().setRandom();
    solver.corner().setRandom();
    const Matrix all = joined_blocks(matrix.jacobian(), scale, solver);
    CAPTURE(factored);
    continuation::DenseBorderedSolver dense(n + 2, 0);
    dense.set_jacobian(all, Vector::Ones(n + 2));
    CHECK(solver.factor() == dense.factor());
    continuation::LogProduct determinant;
    continuation::LogProduct of_dense;
    solver.multiply_determinant(determinant);
    dense.multiply_determinant(of_dense);
    CHECK(determinant.log() ==
          Approx(of_dense.log()).margin(factored == never ? 1e-8 : .05 * static_cast<double>(n)));
    const Vector right = Vector::Random(n + 2);
    Vector solution = right;
    solver.solve(solution);
    CHECK((all * solution - right).norm() < 1e-10 * right.norm());
    solution = right;
    solver.solve_transposed(solution);
    CHECK((all.transpose() * solution - right).norm() < 1e-10 * right.norm());
  }
}

}  // namespace

TEST_CASE("Block-circulant matrices are inverted wave by wave, and no others") {
  const Index size = GENERATE(1, 2, 3);
  const Index blocks = GENERATE(2, 3, 5, 6, 12);
  CAPTURE(size, blocks);
  const ComplexMatrix column = ComplexMatrix::Random(size * blocks, size);
  ComplexMatrix all(size * blocks, size * blocks);
  for (Index j = 0; j < blocks; ++j) {
    for (Index i = 0; i < blocks; ++i)
      all.block(i * size, j * size, size, size) = column.middleRows((i - j + blocks) % blocks * size, size);
  }
  ComplexMatrix inverse = all;
  REQUIRE(invert_block_circulant(inverse, blocks));
  CHECK((inverse * all - ComplexMatrix::Identity(all.rows(), all.cols())).norm() < 1e-10 * inverse.norm());
  ComplexMatrix other = all;
  other(other.rows() - 1, 0) += 1e-16 + 1e-15 * std::abs(other(other.rows() - 1, 0));
  const ComplexMatrix kept = other;
  CHECK_FALSE(invert_block_circulant(other, blocks));
  CHECK(other == kept);
  CHECK_FALSE(invert_block_circulant(other, 1));
  CHECK_FALSE(invert_block_circulant(other, size * blocks + 1));
}

TEST_CASE("Condensed Jacobians of rings are the matrices, and solve as these do", "[whole ring]") {
  const Index sectors = GENERATE(6, 9, 24);
  for (const double preload : {50., .5, .05}) {  // none slips, some do, nearly all do
    SystemParameters one = blisk(preload, sectors, sectors / 3);
    one.harmonics = {1, 3, 5};
    for (const Course course : {Course::travelling, Course::standing, Course::point}) {
      CAPTURE(sectors, to_string(course));
      const RingMake ring = ring_of(one, course);
      check_condensed(whole_of(one, ring), 552.8, preload);
      check_condensed(whole_of(one, ring, scattered(sectors, 1)), 552.8, preload);
    }
    RingMake split = ring_of(one, Course::standing);
    split.damper_ports = 1;
    split.changes = {{false, {{{sectors - 1, 0, -1}, {0, 0, 1}}}, Matrix::Constant(1, 1, -5e6)}};
    SystemParameters with_port = blisk(preload, sectors, sectors / 3, DampingKind::modal, {}, {{{0, 1}}});
    with_port.harmonics = {1, 3};
    split.structures = with_port.structures;
    check_condensed(whole_of(with_port, split, scattered(sectors, 2)), 552.8, preload);
  }
}

TEST_CASE("Rings whose Jacobians are condensed have the responses that matrices give", "[whole ring]") {
  SystemParameters one = blisk(.01, 12, 2);
  one.harmonics = {1, 3};
  const SystemParameters system = whole_of(one, ring_of(one, Course::standing), scattered(12, 4));
  const HarmonicResponse by_matrix(build_harmonic_system(system), never);
  const HarmonicResponse condensed(build_harmonic_system(system), always);
  REQUIRE(by_matrix.condensed_jacobian() == nullptr);
  REQUIRE(condensed.condensed_jacobian() != nullptr);
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = 550;
  options.to = 558;
  options.extrema_of = {"Y_max"};
  const continuation::Branch expected = trace(by_matrix, by_matrix.guess(550, .01), options);
  const continuation::Branch found = trace(condensed, condensed.guess(550, .01), options);
  REQUIRE(expected.complete());
  REQUIRE(found.complete());
  const auto special = [](const continuation::Branch& branch) {
    std::vector<const continuation::BranchPoint*> all;
    for (const continuation::BranchPoint& point : branch.points) {
      if (point.type != continuation::PointType::regular) all.push_back(&point);
    }
    return all;
  };
  const auto points = special(expected);
  const auto others = special(found);
  REQUIRE(points.size() == others.size());
  REQUIRE(points.size() > 8);
  for (std::size_t i = 0; i < points.size(); ++i) {
    CAPTURE(i, points[i]->parameters(0));
    CHECK(others[i]->type == points[i]->type);
    CHECK(others[i]->parameters(0) == Approx(points[i]->parameters(0)).epsilon(1e-9));
    CHECK((others[i]->unknowns - points[i]->unknowns).norm() < 1e-7 * points[i]->unknowns.norm());
  }

  const Guess at = mixed(condensed, 552.8, .01);
  const Vector w = Vector::Random(condensed.size());
  const Vector du = at.unknowns.norm() * Vector::Random(condensed.size());
  const Vector dp = Eigen::Vector2d(.3, .1);
  Vector second(condensed.size() + 2);
  Vector by_matrices(condensed.size() + 2);
  REQUIRE(condensed.second(at.unknowns, at.parameters, at.regime, w, du, dp, second));
  REQUIRE(by_matrix.second(at.unknowns, at.parameters, at.regime, w, du, dp, by_matrices));
  CHECK((second - by_matrices).norm() < 1e-9 * by_matrices.norm());
}

TEST_CASE("Rings with thousands of unknowns are solved by iterations", "[whole ring][numbers]") {
  SystemParameters one = blisk(.05, 280, 23);
  one.harmonics = {1, 3};
  const SystemParameters system = whole_of(one, ring_of(one, Course::standing), scattered(280, 7, false));
  const HarmonicResponse problem(build_harmonic_system(system));
  const HarmonicResponse by_matrix(build_harmonic_system(system), never);
  const Guess found = problem.guess(552.8, .05);
  REQUIRE(4 * slipping(problem, found) > 1000);  // active unknowns: more than are factored
  CHECK(problem.crossed_border(found) < 0);
  Vector residual(problem.size());
  REQUIRE(by_matrix.evaluate(found.unknowns, found.parameters, found.regime, {&residual}));
  CHECK(residual.lpNorm<Eigen::Infinity>() < 1e-10);
}
