// What a point of a branch costs over the number of contacts and harmonics: a chain of masses that all rub on
// ground, each with a limit of its own. As ratios measured in one run: the time of an evaluation with its
// factorisation over that of the factorisation alone, of a matrix with as many rows, which is the arithmetic
// that no way round is known of; and how many of these a point takes, its switches included.

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "arcslip/assembly/system.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"

namespace {

using namespace arcslip;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Of unit masses on springs, 20 to their neighbours and 0.05 to ground, with a contact of 0.1 each.
HarmonicSystem chain(Index contacts, int highest) {
  Matrix stiffness = Matrix::Zero(contacts, contacts);
  for (Index i = 0; i < contacts; ++i) {
    stiffness(i, i) += 0.05;
    if (i + 1 == contacts) continue;
    stiffness.block<2, 2>(i, i) += 20 * (Matrix(2, 2) << 1, -1, -1, 1).finished();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> found(stiffness);
  std::vector<ContactMode> modes;
  for (Index k = 0; k < contacts; ++k) {
    const Vector shape = found.eigenvectors().col(k) / two_pi;
    modes.push_back({std::sqrt(found.eigenvalues()(k)) / two_pi, shape.cast<Complex>(), 0.5 * shape(0)});
  }
  const Loss loss{.modal = 0.01};
  HarmonicSystem system{odd_up_to(highest), {}, {}, {}};
  for (std::size_t a = 0; a < system.orders.size(); ++a) {
    if (a == 1) {
      for (ContactMode& mode : modes) mode.load = 0;
    }
    system.base.emplace_back(contacts, modes, loss);
    system.damper.emplace_back(contacts, std::vector<ContactMode>{}, Loss{});
  }
  for (Index i = 0; i < contacts; ++i)
    system.contacts.push_back({0.1, 0.02 * (0.5 + std::fmod(0.618034 * static_cast<double>(i + 1), 1.0))});
  return system;
}

void report(Index contacts, int highest) {
  const problems::HarmonicResponse problem(chain(contacts, highest));
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = 0.03;
  options.to = 0.07;
  options.max_seconds = 60;
  const continuation::Guess guess = problem.guess(options.from, 1);
  const Clock::time_point start = Clock::now();
  const continuation::Branch branch = continuation::trace(problem, guess, options);
  const double each = seconds_since(start) / static_cast<double>(branch.work.factorizations);

  Matrix some = Matrix::Random(problem.size() + 1, problem.size() + 1);
  Eigen::PartialPivLU<Matrix> lu(problem.size() + 1);
  const int times = std::max(1, static_cast<int>(2e8 / std::pow(static_cast<double>(some.rows()), 3)));
  const Clock::time_point again = Clock::now();
  for (int i = 0; i < times; ++i) lu.compute(some);
  const double factored = seconds_since(again) / times;
  const auto switches = std::count_if(branch.points.begin(), branch.points.end(), [](const auto& point) {
    return point.type == continuation::PointType::regime_switch;
  });
  fmt::print(
      "{:3} contacts, H = {}: {:4} unknowns, {:7.3g} ms each of {:.0f} evaluations a point, "
      "{:.2f} of the factorisation alone; {} points with {} switches up to eta = {:.3g}\n",
      contacts, highest, problem.size(), 1e3 * each,
      static_cast<double>(branch.work.factorizations) / static_cast<double>(branch.points.size()),
      each / factored, branch.points.size(), switches, branch.points.back().parameters(0));
}

}  // namespace

int main() {
  for (const int highest : {1, 9}) {
    for (const Index contacts : {1, 10, 30, 100}) report(contacts, highest);
  }
}
