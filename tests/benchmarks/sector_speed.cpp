// Cost of finite-element sectors, in times of one sparse factorisation: of a full solve at each eta
// (goal: 1.2 of the factorisations alone), of a response traced with full solves, over the factorisations
// that it needs, and of one by way of the modes (goal: 5 + modes/10 factorisations). Annular plates with a
// contact at the rim, near their lowest frequency at n = 3. Arguments are further sizes in dofs: 100000 takes
// some minutes.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "../../src/sectors/complex_factors.hpp"
#include "../../src/sectors/full_receptance.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/sectors/annular_plate.hpp"
#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/sectors/sector_solver.hpp"

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

continuation::TraceOptions over_window() {
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = eta_low;
  options.to = eta_high;
  options.extrema_of = {"Y"};
  return options;
}

/// A response by way of the modes.
SectorModes reduced_response(const FiniteSector& sector) {
  SectorModes modes = sector_modes(sector, wave, {eta_low, eta_high, 1e-8, loss});
  const problems::ForcedResponse problem({modal_model(modes, 1, loss), {}, 1e7, 1e-7});
  trace(problem, problem.guess(eta_low, 1), over_window());
  return modes;
}

/// One with full solves: its seconds over those of the factorisations alone, and how many these are.
std::string full_response(const FiniteSector& sector, double factorisation) {
  const Clock::time_point start = Clock::now();
  const FullReceptance solves(sector, wave, loss);
  const ContactModes base =
      ContactModes(1, {}, {}).solved_by([&](double eta, double load) { return solves.at(eta, load); }, 1);
  const problems::HarmonicResponse problem(one_harmonic({base, ContactModes(1, {}, {}), {{1e7, 1e-7}}}));
  trace(problem, problem.guess(eta_low, 1), over_window());
  const double time = std::chrono::duration<double>(Clock::now() - start).count();
  const int count = solves.factorisations();
  return fmt::format("{:.2f} of {}", time / (count * factorisation), count);
}

void measure(double dofs) {
  constexpr Index traced_in_full = 2000;
  const FiniteSector sector = plate(std::lround(std::sqrt(dofs / 4)));
  SectorReduction reduction(sector);
  reduction.set_forward(wave.forward());
  const double w = 2 * std::numbers::pi * 2000;
  const ComplexSparseMatrix z = reduction.stiffness() * Complex(1, 2e-3) - w * w * reduction.mass();
  ComplexFactors factors(z);
  const double factorisation = seconds([&] { factors.factor(z); });
  factors.release();

  double full = 0;
  {
    SectorSolver solver(sector, wave.forward(), loss);
    double eta = 2000;
    full = seconds([&] { solver.at(eta += 1); });
  }
  const std::string traced = reduction.size() <= traced_in_full ? full_response(sector, factorisation) : "-";
  SectorModes modes;
  const double reduced = seconds([&] { modes = reduced_response(sector); });
  fmt::print("{:>8} {:>10.1f} {:>8.2f} {:>14} {:>7} {:>8} {:>6.1f} {:>9.1e} {:>12.1f} {:>7.0f}\n",
             reduction.size(), 1e3 * factorisation, full / factorisation, traced, modes.frequencies.size(),
             modes.factorisations, 5 + 0.1 * static_cast<double>(modes.frequencies.size()), modes.error,
             reduced / factorisation, peak_megabytes());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  fmt::print("{:>8} {:>10} {:>8} {:>14} {:>7} {:>8} {:>6} {:>9} {:>12} {:>7}\n", "dofs", "factor ms",
             "full/f", "full path/f", "modes", "factors", "goal", "error", "response/f", "MB");
  for (const double dofs : {1e2, 1e3, 1e4}) measure(dofs);
  for (int i = 1; i < count; ++i) measure(std::stod(arguments[i]));
  return 0;
}
