// Disturbances of responses whose base stands on cubic springs, against all nodes integrated one by one.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>

#include "arcslip/elements/memoryless.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_stability.hpp"
#include "branches.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "monodromy.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::FloquetResponse;

namespace {

SystemParameters rods_on_springs(Index wave_number, Index elements, int highest, double preload) {
  SystemParameters s;
  s.model = StructureModel::rods;
  s.wave_number = wave_number;
  s.elements = elements;
  s.mass_ratio = 5;
  s.frequency_ratio = 2;
  s.interface_stiffness = 100;
  s.base_damping = 1e-2;
  s.damper_damping = 5e-2;
  s.cubic_stiffness = 10;
  s.preload = preload;
  s.harmonics = odd_up_to(highest);
  return s;
}

/// Of a closed chain of rod elements the matrix with these blocks.
Matrix closed_chain(Index nodes, double diagonal, double beside) {
  Matrix all = Matrix::Zero(nodes, nodes);
  for (Index i = 0; i < nodes; ++i) {
    const Index next = (i + 1) % nodes;
    all(i, i) += diagonal;
    all(next, next) += diagonal;
    all(i, next) += beside;
    all(next, i) += beside;
  }
  return all;
}

/// The linear motion of all nodes beside a response, in (y, u, y', u', sliders).
class AllNodes {
 public:
  AllNodes(const SystemParameters& s, const FloquetResponse& problem, const continuation::Guess& at)
      : s_(s), eta_(at.parameters(0)), orders_(s.harmonics), y_(problem.motion(at.unknowns, 1)) {
    const auto n = static_cast<double>(s.elements);
    const double ratio = s.stiffness_ratio();
    base_mass_ = closed_chain(s.elements, 2 * s.mass_ratio / (6 * n), s.mass_ratio / (6 * n)).inverse();
    base_ = closed_chain(s.elements, ratio * n, -ratio * n);
    damper_mass_ = closed_chain(s.elements, 2 / (6 * n), 1 / (6 * n)).inverse();
    damper_ = closed_chain(s.elements, n, -n);
    if (s.fixed_damper) damper_mass_.setZero();
    pattern_ = stick_pattern(orders_, problem.motion(at.unknowns, 0),
                             problem.slip_threshold(0, at.parameters), at.regime != 0);
  }

  /// The multipliers of a period, but for that of a slider that moves with the damper.
  ComplexVector multipliers() const {
    const double period = 1 / eta_;
    std::vector<double> times = {0, period};
    for (const HysteresisLoop::Arc& arc : pattern_.arcs) {
      for (Index i = 0; i < s_.elements; ++i) {
        for (const double angle : {arc.begin, arc.begin + arc.width}) {
          for (const double turned : {angle, angle + pi}) {
            const double turns = (turned + lag(i)) / two_pi;
            times.push_back((turns - std::floor(turns)) * period);
          }
        }
      }
    }
    std::sort(times.begin(), times.end());
    Matrix state = Matrix::Identity(size(), size());
    std::vector<bool> sticks = sticking(0.5 * (times[0] + times[1]));
    for (Index i = 0; i < s_.elements; ++i) {
      if (pattern_.slips && !sticks[static_cast<std::size_t>(i)]) state.col(4 * s_.elements + i).setZero();
    }
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
      const double length = times[k + 1] - times[k];
      if (length < 1e-13) continue;
      const std::vector<bool> now = sticking(0.5 * (times[k] + times[k + 1]));
      begin_stick(sticks, now, state);
      sticks = now;
      const auto matrix = [&](double t) { return rates(times[k] + t, now); };
      state = monodromy(matrix, length, 10 + static_cast<int>(1500 * length / period)) * state;
    }
    begin_stick(sticks, sticking(0.5 * (times[0] + times[1])), state);
    if (pattern_.slips) return spectrum(state);
    return spectrum(Matrix(state.topLeftCorner(4 * s_.elements, 4 * s_.elements)));
  }

 private:
  Index size() const { return 5 * s_.elements; }
  double lag(Index node) const {
    return two_pi * static_cast<double>(s_.wave_number * node) / static_cast<double>(s_.elements);
  }

  std::vector<bool> sticking(double t) const {
    std::vector<bool> all;
    for (Index i = 0; i < s_.elements; ++i) {
      const double phase = two_pi * eta_ * t - lag(i);
      all.push_back(!pattern_.slips || std::any_of(pattern_.arcs.begin(), pattern_.arcs.end(),
                                                   [&](const HysteresisLoop::Arc& arc) {
                                                     const double behind = phase - arc.begin;
                                                     return behind - pi * std::floor(behind / pi) < arc.width;
                                                   }));
    }
    return all;
  }

  void begin_stick(const std::vector<bool>& before, const std::vector<bool>& now, Matrix& state) const {
    for (Index i = 0; i < s_.elements; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (now[k] && !before[k]) state.row(4 * s_.elements + i) = state.row(s_.elements + i) - state.row(i);
    }
  }

  Matrix rates(double t, const std::vector<bool>& sticks) const {
    const Index n = s_.elements;
    const double k = s_.interface_stiffness / static_cast<double>(n);
    const double k_3 = s_.cubic_stiffness * s_.stiffness_ratio() / static_cast<double>(n);
    Matrix forces = Matrix::Zero(2 * n, size());
    forces.block(0, 0, n, n) = -base_;
    forces.block(n, n, n, n) = -damper_;
    forces.block(0, 2 * n, n, n) = -2 * s_.base_damping / (two_pi * s_.frequency_ratio) * base_;
    forces.block(n, 3 * n, n, n) = -2 * s_.damper_damping / two_pi * damper_;
    for (Index i = 0; i < n; ++i) {
      double y = 0;
      for (Index a = 0; a < y_.size(); ++a) {
        const int h = orders_[static_cast<std::size_t>(a)];
        y += std::real(y_(a) * std::polar(1.0, h * (two_pi * eta_ * t - lag(i))));
      }
      forces(i, i) -= 3 * k_3 * y * y;
      if (!sticks[static_cast<std::size_t>(i)]) continue;
      for (const auto& [row, sign] : {std::pair(i, 1.0), std::pair(n + i, -1.0)}) {
        forces(row, n + i) += sign * k;
        forces(row, i) -= sign * k;
        if (pattern_.slips) forces(row, 4 * n + i) -= sign * k;
      }
    }
    Matrix all = Matrix::Zero(size(), size());
    all.block(0, 2 * n, 2 * n, 2 * n).setIdentity();
    all.middleRows(2 * n, n) = base_mass_ * forces.topRows(n);
    all.middleRows(3 * n, n) = damper_mass_ * forces.bottomRows(n);
    return all;
  }

  SystemParameters s_;
  double eta_;
  std::vector<int> orders_;
  HarmonicVector y_;
  Matrix base_mass_, base_, damper_mass_, damper_;  // inverse masses
  StickPattern pattern_;
};

FloquetResponse response_of(const SystemParameters& system) {
  return {build_harmonic_system(system), ring_waves(system, system.harmonics.back() + 1)};
}

ComplexVector multipliers_of(const FloquetResponse& problem, const continuation::Guess& at) {
  const auto found = problem.disturbances(at.unknowns, at.parameters, at.regime);
  ComplexVector all(std::ssize(found));
  for (Index i = 0; i < all.size(); ++i)
    all(i) = std::exp(two_pi / at.parameters(0) * found[static_cast<std::size_t>(i)].exponent);
  return all;
}

ComplexVector above(const ComplexVector& all, double modulus) {
  std::vector<Complex> kept;
  for (const Complex& value : all) {
    if (std::abs(value) > modulus) kept.push_back(value);
  }
  return ComplexVector::Map(kept.data(), std::ssize(kept));
}

}  // namespace

TEST_CASE("Disturbances meet the slope of a smooth element as its motion passes", "[stability]") {
  const auto cubic = cubic_spring(0.7, 1);
  const Element& spring = *cubic;
  const std::vector<int> orders = {1, 3, 9};
  HarmonicVector x(3);
  x << Complex(1.2, -0.4), Complex(0.3, 0.2), Complex(-0.1, 0.05);
  const VaryingStiffness stiffness = spring.stiffness_in_time(orders, x);
  const OddMotion motion(orders, x);
  for (double theta = -1; theta < 7; theta += 0.37) {
    const double slope = 3 * 0.7 * std::pow(motion.value(theta), 2);
    CHECK_THAT(stiffness.at(theta), WithinAbs(slope, 1e-13));
    double series = 0;
    for (int m = 0; m < 60; ++m) series += stiffness.term(theta - 0.1, 0.2, m) * std::pow(0.5, m);
    CHECK_THAT(series, WithinAbs(slope, 1e-13));
    Complex sum = 0;
    for (int n = -40; n <= 40; ++n) sum += stiffness.coefficient(n) * std::polar(1.0, n * theta);
    CHECK_THAT(sum.real(), WithinAbs(slope, 1e-13));
  }
}

TEST_CASE("Disturbances of a response on cubic springs grow as those of all nodes", "[stability]") {
  struct Ring {
    Index wave_number, elements;
    double preload, eta;
    bool fixed;
  };
  // In stick and in slip, of one class of waves and of two.
  const auto ring =
      GENERATE(Ring{1, 5, 10, 2.3, false}, Ring{1, 5, 0.1, 2.3, false}, Ring{2, 6, 0.1, 4.4, false},
               Ring{2, 6, 10, 4.6, false}, Ring{1, 4, 0.1, 2.2, true});
  CAPTURE(ring.wave_number, ring.elements, ring.preload, ring.fixed);
  SystemParameters system = rods_on_springs(ring.wave_number, ring.elements, 5, ring.preload);
  system.fixed_damper = ring.fixed;
  const FloquetResponse problem = response_of(system);
  const continuation::Guess at = problem.guess(ring.eta, ring.preload);
  CHECK((at.regime != 0) == (ring.preload < 1));
  const ComplexVector found = multipliers_of(problem, at);
  ComplexVector wanted = above(AllNodes(system, problem, at).multipliers(), 0.3);
  CHECK(testing::worst_match(above(found, 0.3 + 1e-6), wanted) < 1e-7);
  CHECK(wanted.size() <=
        above(found, 0.3 - 1e-6).size() + (at.regime != 0 || ring.fixed ? 2 * system.elements : 0));
}

TEST_CASE("The ring in time settles to a response on cubic springs, and grows as told", "[stability]") {
  struct Ring {
    int highest;
    double preload;
    bool fixed;
    double tolerance;  // of what the harmonics leave out
  };
  const auto ring =
      GENERATE(Ring{21, 10, false, 1e-8}, Ring{41, 0.1, false, 1e-5}, Ring{41, 0.1, true, 1e-5});
  CAPTURE(ring.preload, ring.fixed);
  SystemParameters system = rods_on_springs(1, 5, ring.highest, ring.preload);
  system.fixed_damper = ring.fixed;
  const double eta = ring.fixed ? 2.2 : 2.3;
  const FloquetResponse problem = response_of(system);
  const continuation::Guess at = problem.guess(eta, ring.preload);
  RingMotion motion(build_ring(system), eta, ring.preload);
  const SettledMotion settled = shoot(motion, motion.travelling(problems::ring_harmonics(problem, at)));
  REQUIRE(settled.settled);
  RingState state = settled.state;
  HarmonicRecord record(motion, {1});
  motion.advance(state, motion.period(), &record);
  Vector values;
  problem.observe(at.unknowns, at.parameters, at.regime, values);
  CHECK_THAT(std::abs(record.base()(0)), WithinRel(values(FloquetResponse::Y), ring.tolerance));
  const double growth = floquet_stability(motion, settled.state).growth();
  CHECK_THAT(problem.worst(at.unknowns, at.parameters, at.regime).growth, WithinAbs(growth, ring.tolerance));
}

TEST_CASE("Stability changes at the folds of a response on cubic springs", "[stability]") {
  const auto [elements, harmonics] = GENERATE(table<int, int>({{30, 1}, {5, 1}, {5, 3}}));
  const Run run(
      "cubic_response",
      {"branch.stability=true", "branch.for_each.preload=[0.3]", "branch.from=3.9", "branch.to=5.2",
       "system.elements=" + std::to_string(elements), "system.harmonics=" + std::to_string(harmonics)});
  const continuation::Branch& branch = run.traced.front().branch;
  const auto real = [](const BranchPoint& at) {
    return (at.eigenvalues.real().array() > 0 && at.eigenvalues.imag().array() == 0).count();
  };
  int folds = 0;
  for (std::size_t i = 1; i + 1 < branch.points.size(); ++i) {
    const BranchPoint& point = branch.points[i];
    if (point.type != PointType::fold) continue;
    ++folds;
    // Of few waves exponents are exact, and those of folds miss zero by what the harmonics leave out.
    if (elements == 30) CHECK(point.eigenvalues.cwiseAbs().minCoeff() < 1e-7);
    CHECK(std::abs(real(branch.points[i + 1]) - real(branch.points[i - 1])) == 1);
  }
  CHECK(folds == 2);
}
