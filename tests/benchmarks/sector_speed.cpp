// Cost of finite-element sectors, in times of one sparse factorisation: of a full solve at each eta
// (goal: 1.2 of the factorisations alone) and of a response by way of the modes (goal: 5 + modes/10
// factorisations). Annular plates with a contact at the rim, near their lowest frequency at n = 3, of 1e2 to
// 1e5 dofs.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numbers>
#include <string>

#include "../../src/complex_factors.hpp"
#include "arcslip/annular_plate.hpp"
#include "arcslip/problems/forced_response.hpp"
#include "arcslip/sector_modes.hpp"
#include "arcslip/sector_solver.hpp"

namespace {

using namespace arcslip;
using Clock = std::chrono::steady_clock;

constexpr SectorWave wave{3, 24};
constexpr Loss loss{.structural = 2e-3};
constexpr double eta_low = 1800;
constexpr double eta_high = 2400;

/// Seconds that `work` takes, the least of several times where it is short.
template <class Work>
double seconds(const Work& work) {
  double least = 1e300;
  double all = 0;
  for (int i = 0; i < 5 && all < 3; ++i) {
    const Clock::time_point start = Clock::now();
    work();
    const double time = std::chrono::duration<double>(Clock::now() - start).count();
    least = std::min(least, time);
    all += time;
  }
  return least;
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

FiniteSector plate(Index elements) {
  FiniteSector sector = annular_plate_sector({.inner_radius = 0.06,
                                              .outer_radius = 0.15,
                                              .thickness = 0.012,
                                              .youngs_modulus = 1.1e11,
                                              .poisson_ratio = 0.26,
                                              .density = 7200,
                                              .sectors = wave.sectors,
                                              .radial_elements = elements,
                                              .angular_elements = elements});
  sector.contacts.resize(1);
  sector.outputs.clear();
  sector.load(sector.contacts.front()) = 1;
  return sector;
}

void measure(Index elements) {
  const FiniteSector sector = plate(elements);
  SectorReduction reduction(sector);
  reduction.set_forward(wave.forward());
  const double w = 2 * std::numbers::pi * 2000;
  const ComplexSparseMatrix z = reduction.stiffness() * Complex(1, 2e-3) - w * w * reduction.mass();
  ComplexFactors factors(z);
  const double factorisation = seconds([&] { factors.factor(z); });

  SectorSolver solver(sector, wave.forward(), loss);
  double eta = 2000;
  const double full = seconds([&] { solver.at(eta += 1); });

  SectorModes modes;
  const double reduced = seconds([&] {
    modes = sector_modes(sector, wave, {eta_low, eta_high, 1e-8, loss});
    FrictionSystem system{modal_model(modes, 1, loss), {}, 1e7, 1e-7};
    const problems::ForcedResponse problem(system);
    continuation::TraceOptions options;
    options.parameter = "eta";
    options.from = eta_low;
    options.to = eta_high;
    options.extrema_of = {"Y"};
    trace(problem, problem.guess(eta_low, 1), options);
  });
  fmt::print("{:>8} {:>12.2f} {:>10.2f} {:>8} {:>8} {:>8.1f} {:>14} {:>16.1f} {:>8.0f}\n", reduction.size(),
             1e3 * factorisation, full / factorisation, modes.frequencies.size(), modes.factorisations,
             5 + 0.1 * static_cast<double>(modes.frequencies.size()), fmt::format("{:.1e}", modes.error),
             reduced / factorisation, peak_megabytes());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  fmt::print("{:>8} {:>12} {:>10} {:>8} {:>8} {:>8} {:>14} {:>16} {:>8}\n", "dofs", "factor ms", "full/f",
             "modes", "factors", "goal", "error", "response/f", "MB");
  for (const Index elements : {5, 16, 50}) measure(elements);
  for (int i = 1; i < count; ++i) measure(std::stol(arguments[i]));
  return 0;
}
