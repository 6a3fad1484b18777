// What a ring of all nodes in time costs: a period of its motion, the way from a balance of one harmonic to
// its periodic motion, and the derivative over a turn, nT/N, by which that is found and its stability told.
// Each over the time of the derivative's eigenvalues, in the same run. Beams of figure 8 at P = 1, which
// slip in one part of the period alone, where eta = 3.468, or most of the time. Goals for 30 nodes: 20 to
// the periodic motion, 2 for the derivative.
//
// usage: time_speed [largest number of nodes, default 30]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "../support/least_seconds.hpp"
#include "../support/ring_cases.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "arcslip/time/ring_response.hpp"

namespace {

using namespace arcslip;
using testing::least_seconds;

SystemParameters figure_8(Index nodes) {
  SystemParameters system;
  system.elements = nodes;
  system.mass_ratio = 5;
  system.frequency_ratio = 4;
  system.interface_stiffness = 12 * std::pow(33.3, 4) / 1.3;
  system.base_damping = system.damper_damping = 1e-4;
  return system;
}

void report(Index nodes, double eta) {
  const SystemParameters system = figure_8(nodes);
  RingMotion motion(build_ring(system), eta, 1);
  const RingState guess = motion.travelling({testing::one_harmonic(system, eta, 1)});
  const int runs = nodes < 40 ? 3 : 1;
  SettledMotion found{};
  const double all = least_seconds(runs, [&] { found = shoot(motion, guess, 1e-11); });
  if (!found.settled) std::abort();
  const double period = least_seconds(runs, [&] {
    RingState state = found.state;
    motion.advance(state, motion.period());
  });
  StateDerivative turn{};
  const double derivative = least_seconds(runs, [&] { turn = next_derivative(motion, found.state); });
  const double eigenvalues = least_seconds(runs, [&] {
    if (spectrum(turn.derivative).size() == 0) std::abort();
  });
  fmt::print("{:>5} {:>6} {:>5} {:>6} {:>11.4g} {:>9.3g} {:>9.3g} {:>10.3g}\n", nodes, eta,
             turn.derivative.rows(), found.rounds, 1e3 * eigenvalues, period / eigenvalues, all / eigenvalues,
             derivative / eigenvalues);
}

}  // namespace

int main(int argc, char** argv) {
  const long largest = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 30;
  fmt::print("{:>5} {:>6} {:>5} {:>6} {:>11} {:>9} {:>9} {:>10}\n", "nodes", "eta", "size", "rounds",
             "eigenv./ms", "period", "periodic", "derivative");
  for (const Index nodes : {12, 30, 60}) {
    if (nodes > largest) break;
    for (const double eta : {3.468, 3.841}) report(nodes, eta);
  }
  return 0;
}
