// Disturbances of microslip against a mass on many sliders in time.

#include <cmath>

#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "monodromy.hpp"
#include "plane_masses.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::FloquetResponse;

namespace {

/// One mass of Masses on `count` sliders in parallel in place of its friction.
class Sliders {
 public:
  Sliders(const Masses& s, double eta, int count) : s_(s), w_(two_pi * eta), limits_(count) {
    for (int i = 0; i < count; ++i) limits_(i) = (0.1 + 0.4 * (i + 0.5) / count) / stiffness;  // of x - z
  }
  static constexpr double stiffness = 0.8;

  /// After a period, from where x stands still at its farthest: sliders that slip at all are at their limits.
  Eigen::Vector4d period(double start, Eigen::Vector4d state, double farthest) const {
    constexpr int steps = 2000;
    const double side = state(0) < 0 ? -1 : 1;
    Vector z =
        (limits_.array() < farthest).select((state(0) - side * limits_.array()).matrix(), 0.0 * limits_);
    const double step = two_pi / w_ / steps;
    for (int i = 0; i < steps; ++i) {
      const double t = start + i * step;
      const Eigen::Vector4d k1 = rate(t, state, z);
      const Eigen::Vector4d k2 = rate(t + step / 2, state + step / 2 * k1, z);
      const Eigen::Vector4d k3 = rate(t + step / 2, state + step / 2 * k2, z);
      const Eigen::Vector4d k4 = rate(t + step, state + step * k3, z);
      state += step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      z = z.cwiseMin((state(0) + limits_.array()).matrix()).cwiseMax((state(0) - limits_.array()).matrix());
    }
    return state;
  }

 private:
  Eigen::Vector4d rate(double t, const Eigen::Vector4d& state, const Vector& z) const {
    const Eigen::Vector2d x = state.head<2>();
    const Eigen::Vector2d v = state.tail<2>();
    Eigen::Vector2d push = -s_.stiffness * (x + s_.damping * v) + (s_.load * std::polar(1.0, w_ * t)).real();
    push(0) -= stiffness * (x(0) - z.array()).cwiseMin(limits_.array()).cwiseMax(-limits_.array()).mean();
    Eigen::Vector4d all;
    all << v, push;
    return all;
  }

  Masses s_;
  double w_;
  Vector limits_;
};

}  // namespace

TEST_CASE("Disturbances of microslip are those of many sliders in time", "[stability][whole]") {
  const double eta = GENERATE(0.05, 0.14, 0.3);
  Masses s;
  const TemporaryFolder folder;
  std::string text = text_of(s, folder, 21, eta);
  const std::size_t first = text.find("[[element]]");
  text.replace(first, text.find("[branch]") - first,
               "[[element]]\nkind = \"iwan\"\nat = \"base\"\ncontact = 1\nstiffness = 0.8\n"
               "first_limit = 0.1\nspread = 0.4\n");
  const Case input = read_case(folder.write("case.toml", text));
  const TracedBranch traced = std::move(trace(input.branches.front()).front());
  const auto& problem = dynamic_cast<const FloquetResponse&>(*traced.base.disturbed);
  const BranchPoint& at = traced.branch.points.front();
  std::vector<Complex> found;
  for (const auto& one : problem.disturbances(at.unknowns, at.parameters, at.regime))
    found.push_back(std::exp(two_pi / eta * one.exponent));

  const std::vector<int>& orders = problem.system().orders;
  const auto motion = [&](Index dof) { return HarmonicVector(-problem.motion(at.unknowns, dof)); };
  const HarmonicVector x = motion(0);
  const HarmonicVector y = motion(1);
  const OddMotion slides(orders, x);
  const OddMotion closes(orders, y);
  const Angles turns = slides.turning_points();
  double farthest = 0;
  for (const double angle : turns.all()) {
    if (std::abs(slides.value(angle)) > std::abs(slides.value(farthest))) farthest = angle;
  }
  const double w = two_pi * eta;
  Eigen::Vector4d state(slides.value(farthest), closes.value(farthest), 0, w * closes.slopes(farthest).first);
  const double range = std::abs(state(0));
  const Sliders sliders(s, eta, 300);
  CHECK((sliders.period(farthest / w, state, range) - state).norm() < 1e-3 * state.norm());
  Matrix derivative(4, 4);
  for (Index i = 0; i < 4; ++i) {
    const Eigen::Vector4d way = 2e-3 * range * Eigen::Vector4d::Unit(i);  // over many sliders
    derivative.col(i) = (sliders.period(farthest / w, state + way, range) -
                         sliders.period(farthest / w, state - way, range)) /
                        (4e-3 * range);
  }
  const ComplexVector all = larger_than(found, 1e-3);
  CAPTURE(eta, range, all.transpose(), spectrum(derivative).transpose());
  CHECK(all.size() == 4);
  CHECK(worst_match(all, spectrum(derivative)) < 5e-3);
}
