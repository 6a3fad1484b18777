// Time of an evaluation and of a point of whole rings over the number of sectors, of contacts and of
// harmonics: `benchmarks/whole_ring`.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>

#include "../support/whole_rings.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/one_piece.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using Clock = std::chrono::steady_clock;

namespace {

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void measure(Index sectors, WholeLoad::Course course, bool is_split) {
  const Index waves = std::max<Index>(1, (sectors + 6) / 12);  // of nearly the same frequency
  const SystemParameters one = blisk(1, sectors, waves, DampingKind::modal, {}, {{{0, 1}}});
  RingMake ring = ring_of(one, course);
  if (is_split) {
    ring.damper_ports = 1;
    ring.changes = {{false, {{{sectors - 1, 0, -1}, {0, 0, 1}}}, Matrix::Constant(1, 1, -5e6)}};
  }
  const problems::HarmonicResponse problem = response_of(whole_of(one, ring));
  const continuation::Guess at = problem.guess(552.8, 1);
  Vector residual(problem.size());
  Matrix jacobian(problem.size(), problem.size());
  Matrix by_parameters(problem.size(), 2);
  int evaluations = 0;
  const Clock::time_point begun = Clock::now();
  while (seconds_since(begun) < .5) {
    if (!problem.evaluate(at.unknowns, at.parameters, at.regime, {&residual, &jacobian, &by_parameters}))
      return;
    ++evaluations;
  }
  const double each = seconds_since(begun) / evaluations;
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = 540;
  options.to = 570;
  options.extrema_of = {"Y_3_max"};
  const continuation::Guess start = problem.guess(540, 1);
  const Clock::time_point traced = Clock::now();
  const continuation::Branch branch = trace(problem, start, options);
  const double whole = seconds_since(traced);
  fmt::print("{:4} {:>10} {:>5} {:12.0f} {:10.3f} {:8} {:10.2f} {:8.2f}  {}\n", sectors, to_string(course),
             is_split ? "split" : "", 1 / each, 1e3 * each, branch.points.size(),
             1e3 * whole / static_cast<double>(branch.points.size()), whole,
             branch.complete() ? "" : branch.explanation);
}

/// A disk of rows of masses, each on ground, of which so many in each sector rub on those of a ring.
SystemParameters disk(Index sectors, Index contacts, const std::vector<int>& harmonics) {
  std::vector<Spring> disk_springs{{0, contacts, 5e7}};
  std::vector<Spring> ring_springs{{0, contacts, 5e6}};
  for (Index i = 0; i < contacts; ++i) {
    disk_springs.push_back({i, -1, 6e5});
    ring_springs.push_back({i, -1, 5e3});
    if (i + 1 == contacts) continue;
    disk_springs.push_back({i, i + 1, 5e7});
    ring_springs.push_back({i, i + 1, 5e6});
  }
  Vector disk_masses = Vector::Constant(contacts + 1, 1.2 / static_cast<double>(contacts));
  Vector ring_masses = Vector::Constant(contacts + 1, .12 / static_cast<double>(contacts));
  disk_masses(contacts) = ring_masses(contacts) = 0;
  SectorPart base = sector_part(disk_masses, disk_springs, DampingKind::modal, {}, 0);
  SectorPart ring = sector_part(ring_masses, ring_springs, DampingKind::modal, {}, -1);
  for (Index i = 1; i < contacts; ++i) {
    base.sector.contacts.push_back(i);
    ring.sector.contacts.push_back(i);
  }
  SystemParameters system = blisk(1, sectors, std::max<Index>(1, sectors / 12));
  system.structures = std::make_shared<const SectorPair>(base, ring, 1e-12);
  system.contacts.assign(static_cast<std::size_t>(contacts), {1e6, 1 / 1e6});
  system.harmonics = harmonics;
  return system;
}

/// Of random limits, so that contacts stick and slip side by side; at half the load that lets most of them
/// slip.
void measure_mixed(Index sectors, Index contacts, const std::vector<int>& harmonics) {
  const SystemParameters one = disk(sectors, contacts, harmonics);
  RingContacts uneven;
  std::mt19937 random(1);
  std::lognormal_distribution<double> any(0, 1);
  for (Index i = 0; i < sectors * contacts; ++i) uneven.limit.push_back(any(random));
  const problems::HarmonicResponse problem =
      response_of(whole_of(one, ring_of(one, WholeLoad::Course::standing), uneven));
  const double eta = 1.02 * build_wave(one).base.modes().front().frequency;
  continuation::Guess at = problem.guess(eta, 1e6);
  std::vector<double> holding;
  for (Index i = 0; i < problem.contacts(); ++i)
    holding.push_back(std::abs(problem.motion(at.unknowns, i)(0)) / problem.slip_threshold(i, at.parameters));
  const auto half = holding.begin() + std::ssize(holding) / 2;
  std::nth_element(holding.begin(), half, holding.end());
  const double preload = 1e6 * *half;
  const Clock::time_point begun = Clock::now();
  const continuation::Guess start = problem.guess(eta, preload);
  const double first = seconds_since(begun);
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = eta;
  options.to = 1.001 * eta;
  options.max_points = 8;
  const continuation::OnePiece joined(std::make_shared<problems::HarmonicResponse>(problem));
  options.branch_point_pairs = false;
  const Clock::time_point traced = Clock::now();
  const auto branch = trace(joined, {start.unknowns, start.parameters, {}}, options);
  const double whole = seconds_since(traced);
  Index slips = 0;
  for (Index i = 0; i < problem.contacts(); ++i) slips += start.regime[i];
  fmt::print("{:4} {:9} {:10} {:9} {:6} of {:5} {:10.2f} {:13.1f} {:10.1f}\n", sectors, contacts,
             harmonics.size(), problem.size(), slips, problem.contacts(), first,
             1e3 * whole / static_cast<double>(branch.work.evaluations),
             1e3 * whole / static_cast<double>(branch.points.size()));
}

}  // namespace

int main() {
  fmt::print("   N       load        evaluations/s  ms each   points   ms/point  seconds\n");
  for (const Index sectors : {6, 12, 24, 50, 100}) {
    for (const auto course : {WholeLoad::Course::travelling, WholeLoad::Course::standing}) {
      measure(sectors, course, false);
      measure(sectors, course, true);
    }
  }
  fmt::print("\n   N  contacts  harmonics  unknowns  slipping       start, s  ms/evaluation   ms/point\n");
  for (const Index sectors : {6, 24, 100, 300}) {
    for (const Index contacts : {1, 3}) {
      for (const std::vector<int>& harmonics : std::vector<std::vector<int>>{{1}, {1, 3, 5}})
        measure_mixed(sectors, contacts, harmonics);
    }
  }
}
