#pragma once

// Small rings and masses from case files, in time as their balances begin them.

#include <algorithm>
#include <cmath>
#include <string>

#include "arcslip/problems/response/more_harmonics.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_stability.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "ring_cases.hpp"
#include "temporary_folder.hpp"

namespace arcslip::testing {

using problems::HarmonicResponse;

/// A case of its own files.
inline Case case_of(const std::string& text) {
  const TemporaryFolder folder;
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n";
  folder.write("m.mtx", head + "3 3 2\n1 1 3\n2 2 2\n");
  folder.write("k.mtx", head + "3 3 5\n1 1 8\n2 1 -3\n2 2 12\n3 2 -5\n3 3 5\n");
  folder.write("n.mtx", head + "3 3 2\n1 1 1\n2 2 0.8\n");
  folder.write("l.mtx", head + "3 3 5\n1 1 2.2\n2 1 -1.5\n2 2 4\n3 2 -2.5\n3 3 2.5\n");
  return read_case(folder.write("case.toml", text));
}

inline std::string sectors(Index wave_number, Index count, int highest, const std::string& more = "") {
  const auto part = [](const std::string& name, const std::string& m, const std::string& k) {
    return fmt::format(
        "[system.{}]\nmass = \"{}.mtx\"\nstiffness = \"{}.mtx\"\nleft = [1]\nright = [3]\ncontact = [1, 2]\n"
        "damping_kind = \"viscous\"\nreference_frequency = 0.3\n",
        name, m, k);
  };
  return fmt::format(
             "[system]\nmodel = \"sector\"\nsectors = {}\nwave_number = {}\ncontact_stiffness = 2.0\n"
             "preload = 0.1\nforce = 1.0\ndamping = {{ base = 1e-2, damper = 2e-2 }}\n"
             "reduction_window = [0.05, 3.0]\nharmonics = {}\n{}",
             count, wave_number, highest, more) +
         part("base", "m", "k") + "load = { dof = [2], value = [1.0] }\n" + part("damper", "n", "l") +
         "[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 0.6\n";
}

inline std::string rods(int highest, const std::string& element) {
  return fmt::format(
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 5\nmass_ratio = 3.0\nfrequency_ratio = 1.5\n"
      "interface_stiffness = 40.0\ndamping = {{ base = 1e-2, damper = 2e-2 }}\nforce = 1.0\npreload = 0.3\n"
      "harmonics = {}\n[[element]]\nat = \"damper\"\n{}\n[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 3\n",
      highest, element);
}

inline const std::string lift_off =
    "[[element]]\nkind = \"friction\"\nat = \"contact\"\nnormal = 2\ntangential_stiffness = 1.0\n"
    "normal_stiffness = 1.5\nmu = 0.5\nnormal_per_preload = 0.5\n";
inline const std::string circle =
    "[[element]]\nkind = \"friction_2d\"\nat = \"contact\"\ncontact = 1\nsecond = 2\ntangential_stiffness = "
    "1.0\nmu = 0.5\nnormal_per_preload = 0.5\n";
inline const std::string iwan = "kind = \"iwan\"\nstiffness = 10.0\nfirst_limit = 0.1\nspread = 3.0\n";
inline const std::string iwan_4 =
    "kind = \"iwan_4\"\nslip_force = 3.0\nstiffness = 20.0\nchi = -0.4\nbeta = 0.2\n";

/// A response in time with the balance that it was begun with.
struct Timed {
  Timed(const Case& input, double eta)
      : system(input.branches.front().problem.system),
        problem(build_harmonic_system(system)),
        at(problem.guess(eta, system.preload)),
        motion(build_ring(system), eta, system.preload),
        start(motion.travelling(problems::ring_harmonics(problem, at))) {}

  /// Amplitudes of the first coordinates, relative differences; the largest.
  double difference() {
    const SettledMotion found = shoot(motion, start, 1e-9);
    CAPTURE(found.error, found.rounds);
    REQUIRE(found.settled);
    HarmonicRecord record(motion, {1}, true);
    next_state(motion, found.state, &record);
    Vector values;
    problem.observe(at.unknowns, at.parameters, at.regime, values);
    return std::abs(std::abs(record.base()(0)) / values(HarmonicResponse::Y) - 1);
  }

  SystemParameters system;
  HarmonicResponse problem;
  continuation::Guess at;
  RingMotion motion;
  RingState start;
};

/// Central differences of the flow over a time, in free states alone.
inline double derivative_error(RingMotion& motion, const RingState& start, double duration) {
  RingTangent tangent(motion);
  RingState end = start;
  motion.advance(end, duration, &tangent);
  const Matrix exact = tangent.at(end);
  const Index coordinates = start.position.size();
  double worst = 0;
  for (Index column = 0; column < exact.cols(); ++column) {
    if (column >= 2 * coordinates && exact.col(column).isZero(0)) continue;
    const bool velocity = column >= coordinates && column < 2 * coordinates;
    const double step = 1e-6 * start.position.norm() * (velocity ? motion.frequency() : 1.0);
    const auto moved = [&](double by) {
      RingState state = start;
      if (column < coordinates) state.position(column) += by;
      if (velocity) state.velocity(column - coordinates) += by;
      if (column >= 2 * coordinates) state.memory(column - 2 * coordinates) += by;
      motion.advance(state, duration);
      CHECK(state.phase == end.phase);
      return stacked(state);
    };
    const Vector difference = (moved(step) - moved(-step)) / (2 * step);
    worst = std::max(worst, (difference - exact.col(column)).norm() / std::max(1.0, difference.norm()));
  }
  return worst;
}

}  // namespace arcslip::testing
