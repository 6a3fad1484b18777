// Duffing's oscillator q'' + 0.05 q' + q + 0.1 q^3 = 0.18 cos(W t), example 1 of NLvib, by harmonic balance.

#include <Eigen/LU>
#include <cmath>

#include "arcslip/continuation/path/newton.hpp"
#include "catch.hpp"
#include "library_cases.hpp"
#include "monodromy.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

constexpr double damping_ratio = 0.05;
constexpr double cubic = 0.1;

// The reference values have twelve decimals.
constexpr double published_duffing = 1e-11;

Branch duffing_response(const Instance& duffing, std::vector<std::string> extrema = {}) {
  TraceOptions options = over("W", 0.5, 2);
  options.extrema_of = std::move(extrema);
  Branch branch = duffing.trace(options);
  INFO(branch.explanation);
  REQUIRE(branch.complete());
  return branch;
}

/// The two folds of the resonance, each solved to what defines it; the upper one comes first.
std::vector<BranchPoint> folds_of(const Instance& duffing) {
  std::vector<BranchPoint> folds = of_type(duffing_response(duffing), PointType::fold);
  REQUIRE(folds.size() == 2);
  for (const BranchPoint& fold : folds) CHECK(defining_residual(*duffing.problem, 0, fold) <= 1e-10);
  return folds;
}

double observed(const Instance& duffing, const BranchPoint& point, const std::string& name) {
  Vector values;
  duffing.problem->observe(point.unknowns, point.parameters, 0, values);
  const auto observables = duffing.problem->observables();
  for (std::size_t i = 0; i < observables.size(); ++i) {
    if (observables[i].name == name) return values(static_cast<Index>(i));
  }
  return std::nan("");
}

}  // namespace

TEST_CASE("Duffing's folds in one harmonic are those of the closed form", "[library]") {
  const Instance duffing("duffing", {{"harmonics", 1}});
  const auto folds = folds_of(duffing);
  CHECK_THAT(folds[0].parameters(0), WithinRel(1.267536959513, published_duffing));
  CHECK_THAT(observed(duffing, folds[0], "a1"), WithinRel(2.836222596637, published_duffing));
  CHECK_THAT(folds[1].parameters(0), WithinRel(1.115585927182, published_duffing));
  CHECK_THAT(observed(duffing, folds[1], "a1"), WithinRel(1.084080112843, published_duffing));
}

TEST_CASE("Duffing's largest amplitude in one harmonic is that of the closed form", "[library]") {
  const Instance duffing("duffing", {{"harmonics", 1}});
  const auto peaks = of_type(duffing_response(duffing, {"a1"}), PointType::peak);
  REQUIRE(peaks.size() == 1);
  CHECK_THAT(observed(duffing, peaks[0], "a1"), WithinRel(2.841624599369, published_duffing));
  CHECK_THAT(peaks[0].parameters(0), WithinRel(1.266634231845, published_duffing));
}

TEST_CASE("Duffing's folds with more harmonics converge to those by collocation", "[library]") {
  struct Row {
    double harmonics, upper, lower;
  };
  const Row row = GENERATE(values<Row>({{3, 1.269600032145, 1.115700246882},
                                        {5, 1.269601954391, 1.115700251771},
                                        {9, 1.269601955546, 1.115700251771},
                                        {10, 1.269601955546, 1.115700251771},
                                        {15, 1.269601955546, 1.115700251771}}));
  CAPTURE(row.harmonics);
  const Instance duffing("duffing", {{"harmonics", row.harmonics}});
  const auto folds = folds_of(duffing);
  CHECK_THAT(folds[0].parameters(0), WithinRel(row.upper, published_duffing));
  CHECK_THAT(folds[1].parameters(0), WithinRel(row.lower, published_duffing));
  if (row.harmonics < 9) return;
  CHECK_THAT(observed(duffing, folds[0], "a1"), WithinRel(2.8250167129, 1e-10));
  CHECK_THAT(observed(duffing, folds[1], "a1"), WithinRel(1.0818703234, 1e-10));
  CHECK_THAT(folds[0].parameters(0), WithinRel(1.2696019548, 1e-9));  // AUTO-07p, by its tolerance
  CHECK_THAT(folds[1].parameters(0), WithinRel(1.1157002516, 1e-9));
}

TEST_CASE("Duffing's folds at other forces are those of the closed form", "[library]") {
  struct Row {
    double force, lower, upper;
  };
  const Row row = GENERATE(values<Row>({{0.06, 1.049467203819, 1.051404521411},
                                        {0.1, 1.076067057413, 1.115508359522},
                                        {0.3, 1.161865303909, 1.489393339365}}));
  CAPTURE(row.force);
  const auto folds = folds_of(Instance("duffing", {{"harmonics", 1}, {"force", row.force}}));
  CHECK_THAT(folds[0].parameters(0), WithinRel(row.upper, published_duffing));
  CHECK_THAT(folds[1].parameters(0), WithinRel(row.lower, published_duffing));
}

TEST_CASE("Duffing's folds at any force are double roots of the closed form", "[library]") {
  const double force = GENERATE(0.055, 0.13, 0.22, 0.4);
  const Instance duffing("duffing", {{"harmonics", 1}, {"force", force}});
  for (const BranchPoint& fold : folds_of(duffing)) {
    // g(x) = [(1 - W^2 + 3/4 k3 x)^2 + (delta W)^2] x - force^2, x = a^2, and its slope
    const double W = fold.parameters(0);
    const double x = std::pow(observed(duffing, fold, "a1"), 2);
    const double detuning = 1 - W * W + 0.75 * cubic * x;
    const double square = detuning * detuning + damping_ratio * damping_ratio * W * W;
    CHECK_THAT(square * x, WithinRel(force * force, 1e-9));
    CHECK_THAT(square + 1.5 * cubic * x * detuning, WithinAbs(0, 1e-11));
  }
}

TEST_CASE("Duffing's branch below the least force that bends it over has no fold", "[library]") {
  const Instance duffing("duffing", {{"harmonics", 1}, {"force", 0.04}});
  CHECK(of_type(duffing_response(duffing), PointType::fold).empty());
}

TEST_CASE("Duffing's highest root mean square is that of the original example", "[library]") {
  const Instance duffing("duffing", {{"harmonics", 7}});
  const auto peaks = of_type(duffing_response(duffing, {"rms"}), PointType::peak);
  REQUIRE_FALSE(peaks.empty());
  const BranchPoint& peak = *std::max_element(peaks.begin(), peaks.end(), [&](const auto& a, const auto& b) {
    return observed(duffing, a, "rms") < observed(duffing, b, "rms");
  });
  // NLvib stores the highest of points that are 1e-3 apart; harmonics with powers of ten fewer digits
  CHECK_THAT(observed(duffing, peak, "rms"), WithinRel(2.001518, 1e-3));
  CHECK_THAT(peak.parameters(0), WithinRel(1.2687, 1e-3));
  CHECK_THAT(observed(duffing, peak, "a1"), WithinRel(2.830198, 1e-3));
  CHECK_THAT(observed(duffing, peak, "a3"), WithinRel(0.046166, 3e-3));
  CHECK_THAT(observed(duffing, peak, "a5"), WithinRel(0.000741, 5e-3));
}

TEST_CASE("The cubic term is projected without aliasing", "[library]") {
  // q = cos t: q^3 = 3/4 cos t + 1/4 cos 3t. At W = 0 and force = 0 the residual is q + k3 q^3, by harmonics.
  const double harmonics = GENERATE(1, 3, 5);
  const Instance duffing("duffing", {{"harmonics", harmonics}, {"W", 0}, {"force", 0}});
  const Guess guess = duffing.guess();
  const Index n = guess.unknowns.size();
  Vector residual(n);
  Evaluation out;
  out.residual = &residual;
  REQUIRE(duffing.problem->evaluate(Vector::Unit(n, 0), guess.parameters, 0, out));
  Vector exact = Vector::Zero(n);
  exact(0) = 1 + 0.75 * cubic;
  if (n > 2) exact(2) = 0.25 * cubic;
  CHECK((residual - exact).lpNorm<Eigen::Infinity>() < 1e-15);
  // The highest harmonic alone: its cube falls on itself and on one beyond.
  REQUIRE(duffing.problem->evaluate(Vector::Unit(n, n - 1), guess.parameters, 0, out));
  exact.setZero();
  exact(n - 1) = 1 + 0.75 * cubic;
  CHECK((residual - exact).lpNorm<Eigen::Infinity>() < 1e-15);
}

TEST_CASE("Without damping and next to no force the oscillator's frequency is that of its elliptic integral",
          "[library][numbers]") {
  // Section C2: w(A) = pi sqrt(1 + g A^2)/(2 K(m)), m = g A^2/(2 (1 + g A^2)), here g = 1; A is the sum of
  // the cosines, which are in phase at the turning point. A small force fixes the phase; its two signs have
  // the free vibration as their mean, to second order.
  struct Row {
    double amplitude, frequency;
  };
  const Row row = GENERATE(values<Row>({{0.1, 1.003741836178},
                                        {0.5, 1.089158178779},
                                        {1, 1.317776064966},
                                        {2, 1.976016364071},
                                        {5, 4.357461856523},
                                        {10, 8.533586188999}}));
  CAPTURE(row.amplitude);
  const auto amplitude_of = [&](double harmonics, double frequency) {
    double mean = 0;
    for (const double sign : {1, -1}) {
      const Instance duffing("duffing",
                             {{"harmonics", harmonics}, {"delta", 0}, {"k3", 1}, {"W", frequency}});
      Guess guess = duffing.guess();
      guess.unknowns.setZero();
      guess.unknowns(0) = (1 + sign * 0.01) * row.amplitude;
      const double square = row.amplitude * row.amplitude;
      const double pull = sign * 0.02 * row.amplitude * square / (1 + square);  // a per cent of the amplitude
      const Branch branch = trace(*duffing.problem, guess, over("force", pull, 1e-5 * pull));
      REQUIRE(branch.stop == Stop::reached_end);
      CHECK(of_type(branch, PointType::neimark_sacker).empty());  // its pairs are on the axis all along
      const Vector& end = branch.points.back().unknowns;
      for (Index i = 0; i < end.size(); i += 2) mean += 0.5 * end(i);
    }
    return mean;
  };
  CHECK_THAT(amplitude_of(23, row.frequency), WithinRel(row.amplitude, 1e-8));
  const double one_harmonic = std::sqrt(1 + 0.75 * row.amplitude * row.amplitude);
  CHECK_THAT(amplitude_of(1, one_harmonic), WithinRel(row.amplitude, 1e-8));
}

TEST_CASE("Duffing's response is unstable from fold to fold, where a real exponent vanishes", "[hill]") {
  const double harmonics = GENERATE(1, 3, 9);
  const double force = GENERATE(0.18, 0.3);
  CAPTURE(harmonics, force);
  const Instance duffing("duffing", {{"harmonics", harmonics}, {"force", force}});
  const Branch branch = duffing_response(duffing);
  int folds = 0;
  for (const BranchPoint& point : branch.points) {
    CAPTURE(point.parameters(0), point.eigenvalues);
    REQUIRE(point.eigenvalues.size() == 2);
    CHECK_THAT(point.eigenvalues.sum().real(), WithinAbs(-damping_ratio, 1e-9));  // Liouville
    if (point.type == PointType::fold) {
      ++folds;
      CHECK(point.eigenvalues.cwiseAbs().minCoeff() < 1e-8);  // as sharp as the fold is located
    } else {
      CHECK((point.type == PointType::regular || point.type == PointType::start ||
             point.type == PointType::end));
      CHECK(point.unstable == (folds == 1 ? 1 : 0));
    }
  }
  CHECK(folds == 2);
}

namespace {

double displacement(const BranchPoint& point, double t) {
  double q = 0;
  for (Index k = 0; k < point.unknowns.size() / 2; ++k) {
    const double turn = static_cast<double>(2 * k + 1) * point.parameters(0) * t;
    q += point.unknowns(2 * k) * std::cos(turn) + point.unknowns(2 * k + 1) * std::sin(turn);
  }
  return q;
}

}  // namespace

TEST_CASE("Duffing's exponents are those of the monodromy matrix", "[hill]") {
  const double force = GENERATE(0.18, 0.5);
  const Instance duffing("duffing", {{"harmonics", 15}, {"force", force}});
  for (const BranchPoint& point : duffing_response(duffing).points) {
    const double W = point.parameters(0);
    const auto variation = [&](double t) {
      const double q = displacement(point, t);
      return Eigen::Matrix2d{{0, 1}, {-1 - 3 * cubic * q * q, -damping_ratio}};
    };
    const double period = 2 * M_PI / W;
    const ComplexVector found = (point.eigenvalues * period).array().exp();
    CAPTURE(W, found);
    // Next to each other multipliers are as the square root of an error, their sum is not.
    CHECK(std::abs(found.sum() - monodromy(variation, period, 500).trace()) < 1e-7);  // 80 steps a radian
  }
}

TEST_CASE("Where Duffing's motion loses its symmetry a multiplier of half a period passes 1", "[hill]") {
  const Instance duffing("duffing", {{"harmonics", 25}, {"k3", 1}, {"delta", 0.2}, {"W", 1}});
  const Branch branch = duffing.trace(over("force", 0.01, 12));
  REQUIRE(branch.complete());
  const std::vector<BranchPoint> broken = of_type(branch, PointType::symmetry_breaking);
  REQUIRE(broken.size() == 2);
  for (const BranchPoint& point : broken) {
    const double W = point.parameters(0);
    const auto variation = [&](double t) {
      const double q = displacement(point, t);
      return Eigen::Matrix2d{{0, 1}, {-1 - 3 * q * q, -0.2}};
    };
    const Matrix half = monodromy(variation, M_PI / W, 2000);
    CHECK_THAT((half - Matrix::Identity(2, 2)).determinant(), WithinAbs(0, 1e-8));  // of 25 harmonics
    CHECK(point.eigenvalues.cwiseAbs().minCoeff() < 1e-8);
  }
  for (const BranchPoint& point : branch.points) {
    if (point.type != PointType::regular) continue;
    CAPTURE(point.parameters(1));
    const bool between =
        point.parameters(1) > broken[0].parameters(1) && point.parameters(1) < broken[1].parameters(1);
    CHECK(point.unstable == (between ? 1 : 0));
  }
}
