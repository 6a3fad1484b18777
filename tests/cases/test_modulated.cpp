// The modulated waves that leave forced responses, against all nodes in time.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "arcslip/problems/response/modulated_response.hpp"
#include "cycle_cases.hpp"

namespace arcslip::testing::modulated {

using problems::ModulatedResponse;

namespace {

std::string rods(const std::string& harmonics, const std::string& branch) {
  return fmt::format(
      "[system]\nmodel = \"rods\"\nwave_number = 2\nelements = 5\nmass_ratio = 3\nfrequency_ratio = 1.5\n"
      "interface_stiffness = 400\ndamping = {{ base = -2e-3, damper = 0.1 }}\nforce = 1\npreload = 0.3\n"
      "harmonics = {}\n[branch]\nstability = true\nswitching = true\nparameter = \"eta\"\n{}\n",
      harmonics, branch);
}

/// All nodes of these rods, matrices and load of the paper: of the base first, then of the damper, with the
/// places of the sliders.
class Nodes {
 public:
  explicit Nodes(double eta) : eta_(eta) {
    for (int i = 0; i < count; ++i) {
      const int next = (i + 1) % count;
      for (const int part : {0, count}) {
        const double stiffness = part == 0 ? 6.75 * count : count;  // M* gamma^2, 1
        const double mass = (part == 0 ? 3.0 : 1.0) / (6 * count);
        const double damping = part == 0 ? 2 * -2e-3 / (two_pi * 1.5) : 2 * 0.1 / two_pi;
        add(part + i, part + next, 2 * mass, mass, mass_);
        add(part + i, part + next, stiffness, -stiffness, stiffness_);
        add(part + i, part + next, damping * stiffness, -damping * stiffness, damping_);
      }
    }
    factors_ = mass_.inverse();
  }

  static constexpr int count = 5;
  static constexpr double wave = two_pi * 2 / count;
  Vector position = Vector::Zero(2 * count);
  Vector velocity = Vector::Zero(2 * count);
  Vector slider = Vector::Zero(count);

  /// Sliders follow the relative motion of a node.
  void slide(int i, double relative) {
    const double threshold = 0.3 * 6.75 / 400;
    slider(i) = std::clamp(slider(i), relative - threshold, relative + threshold);
  }

  void step(double time, double length) {
    const Vector a1 = rate(time, position, velocity);
    const Vector v2 = velocity + 0.5 * length * a1;
    const Vector a2 = rate(time + 0.5 * length, position + 0.5 * length * velocity, v2);
    const Vector v3 = velocity + 0.5 * length * a2;
    const Vector a3 = rate(time + 0.5 * length, position + 0.5 * length * v2, v3);
    const Vector v4 = velocity + length * a3;
    const Vector a4 = rate(time + length, position + length * v3, v4);
    position += length / 6 * (velocity + 2 * v2 + 2 * v3 + v4);
    velocity += length / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    for (int i = 0; i < count; ++i) slide(i, position(count + i) - position(i));
  }

 private:
  static void add(int i, int next, double own, double other, Matrix& sum) {
    sum(i, i) += own;
    sum(next, next) += own;
    sum(i, next) += other;
    sum(next, i) += other;
  }

  Vector rate(double time, const Vector& x, const Vector& v) const {
    const double load = 6.75 * count / std::pow(2 * pi, 2) * std::pow(std::sin(2 * pi / count), 2);
    const double threshold = 0.3 * 6.75 / 400;
    Vector force = -stiffness_ * x - damping_ * v;
    for (int i = 0; i < count; ++i) {
      const double spring = x(count + i) - x(i) - slider(i);
      const double friction = 400.0 / count * std::clamp(spring, -threshold, threshold);
      force(i) += load * std::cos(two_pi * eta_ * time - wave * i) + friction;
      force(count + i) -= friction;
    }
    return factors_ * force;
  }

  double eta_;
  Matrix mass_ = Matrix::Zero(2 * count, 2 * count);
  Matrix stiffness_ = mass_;
  Matrix damping_ = mass_;
  Matrix factors_;
};

/// How far all nodes are after some periods from where a modulated wave has them, over the greatest |y| that
/// it reaches.
double departure(const TracedBranch& traced, const BranchPoint& point, int periods) {
  const auto& problem = dynamic_cast<const ModulatedResponse&>(*traced.base.problem);
  const ComplexMatrix moved = problem.first_contact(point.unknowns, point.parameters);
  const double eta = point.parameters(ModulatedResponse::eta);
  const double nu = point.unknowns(point.unknowns.size() - 1);
  const double turn = two_pi * (nu < 0 ? -1 : 1) * value(traced, point, "wave_2") / Nodes::count;
  const auto at = [&](int column, int node, double time, bool is_rate) {
    double sum = 0;
    for (std::size_t a = 0; a < problem.lines().size(); ++a) {
      const auto [k, l] = problem.lines()[a];
      const double w = two_pi * (k * eta + l * nu);
      const Complex here = moved(static_cast<Index>(a), column) *
                           std::polar(1.0, w * time - node * (k * Nodes::wave + l * turn));
      sum += is_rate ? -w * here.imag() : here.real();
    }
    return sum;
  };
  Nodes nodes(eta);
  constexpr int steps = 4000;
  for (int i = 0; i < Nodes::count; ++i) {
    for (int k = -4 * steps; k <= 0; ++k) nodes.slide(i, at(0, i, k / (steps * eta), false));
    for (const int part : {0, 1}) {
      nodes.position(part * Nodes::count + i) = at(1 + part, i, 0, false);
      nodes.velocity(part * Nodes::count + i) = at(1 + part, i, 0, true);
    }
  }
  const double length = 1 / (steps * eta);
  for (int k = 0; k < steps * periods; ++k) nodes.step(k * length, length);
  double furthest = 0;
  for (int i = 0; i < Nodes::count; ++i)
    furthest = std::max(furthest, std::abs(nodes.position(i) - at(1, i, periods / eta, false)));
  return furthest / value(traced, point, "Y_peak");
}

}  // namespace

TEST_CASE("A modulated wave turns back at one place whatever its steps are", "[modulated]") {
  for (const double step : {0.02, 0.07}) {
    INFO(step);
    const auto all = traced_of(rods("5", "from = 3.5\nto = 3.57\n") +
                               fmt::format("[continuation]\nmax_step = {}\n", step));
    REQUIRE(all.size() == 3);
    check_values(values_at(all[1], PointType::fold, "eta"), {3.5679915}, 1e-6);
    check_values(values_at(all[2], PointType::fold, "eta"), {3.5659844}, 1e-6);
  }
}

TEST_CASE("Modulated waves leave where pairs of exponents cross, and are those of all nodes in time",
          "[modulated][numbers][long]") {
  const std::vector<TracedBranch> all = traced_of(rods("9", "from = 3.5\nto = 3.57"));
  const std::vector<BranchPoint> crossings = points(all[0], PointType::neimark_sacker);
  REQUIRE(crossings.size() == 2);
  REQUIRE(all.size() == 3);
  for (std::size_t i = 0; i < 2; ++i) {
    const TracedBranch& modulated = all[1 + i];
    INFO(modulated.branch.explanation);
    CHECK(is_end(modulated.branch.stop));
    const BranchPoint& first = modulated.branch.points.front();
    CHECK_THAT(first.parameters(0), WithinRel(crossings[i].parameters(0), 5e-4));
    CHECK_THAT(value(modulated, first, "modulation"), WithinAbs(0.02, 2e-3));
    double most = 0;
    for (std::size_t k = 0; k < modulated.branch.points.size(); k += 6) {
      const BranchPoint& point = modulated.branch.points[k];
      const double told = value(modulated, point, "modulation_error");
      CAPTURE(i, k, told, point.parameters(0));
      CHECK(departure(modulated, point, 6) < 25 * told);  // which grows in time
      most = std::max(most, value(modulated, point, "modulation"));
    }
    CHECK(most > 0.5);
    check_derivatives_along(modulated, 3, 7);
  }
}

TEST_CASE("A modulated wave begins at each pair's crossing, over the preload as well", "[modulated]") {
  const std::string text =
      replaced(rods("3", "from = 0.45\nto = 0.35\neta = 3.57"), "parameter = \"eta\"", "parameter = \"P\"");
  const std::vector<TracedBranch> all = traced_of(replaced(text, "preload = 0.3\n", ""));
  const std::vector<BranchPoint> crossings = points(all[0], PointType::neimark_sacker);
  REQUIRE(crossings.size() == 2);
  REQUIRE(all.size() == 3);
  for (std::size_t i = 0; i < 2; ++i) {
    INFO(all[1 + i].branch.explanation);
    REQUIRE(all[1 + i].branch.points.size() > 3);
    CHECK_THAT(all[1 + i].branch.points.front().parameters(1), WithinRel(crossings[i].parameters(1), 0.02));
    check_derivatives_along(all[1 + i], 2, 9);
  }
}

TEST_CASE("Where a modulated wave is not followed, its branch says why, once", "[modulated]") {
  const std::vector<TracedBranch> all =
      traced_of(rods("3",
                     "from = 3.5\nto = 3.57\n[[element]]\nkind = \"iwan\"\nat = \"base\"\nstiffness = 0.1\n"
                     "first_limit = 0.01\nspread = 0.02"));
  REQUIRE(count(all[0], PointType::neimark_sacker) == 2);
  REQUIRE(all.size() == 2);
  CHECK(all[1].branch.points.empty());
  CHECK(all[1].branch.stop == Stop::no_start);
  CHECK(all[1].branch.explanation.find("beside the element \"iwan\"") != std::string::npos);
}

}  // namespace arcslip::testing::modulated
