// What is filled in between the points of branches that are drawn, against solutions there.

#include "arcslip/continuation/path/polyline.hpp"

#include <algorithm>
#include <cmath>

#include "case_runs.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

std::vector<double> observed(const TracedBranch& traced, const BranchPoint& point) {
  Vector values;
  traced.problem().observe(point.unknowns, point.parameters, point.regime, values);
  return {values.begin(), values.end()};
}

/// A branch of forced motion over eta, and as many of the points that are filled in as are asked for.
struct FilledIn {
  FilledIn(const std::string& of, const Settings& with, std::size_t wanted)
      : name(of), settings(with), run(of, with) {
    REQUIRE(run.traced.size() == 1);
    std::vector<double> values;
    const auto drawn = [&](const BranchPoint& point) -> const std::vector<double>& {
      return values = observed(run.traced[0], point);
    };
    const continuation::Branch& branch = run.traced[0].branch;
    auto all = continuation::polyline(branch, 0, drawn, &run.traced[0].problem()).points;
    std::erase_if(all, [](const BranchPoint& point) { return !std::isnan(point.residual); });
    REQUIRE(all.size() > branch.points.size());
    const double every = std::max(1.0, static_cast<double>(all.size()) / static_cast<double>(wanted));
    for (double i = 0; i < static_cast<double>(all.size()); i += every)
      points.push_back(all[static_cast<std::size_t>(i)]);
  }

  /// The solutions at the same values of eta.
  std::vector<BranchPoint> exact() const {
    std::string values;
    for (const BranchPoint& point : points) values += fmt::format(",{:.17g}", point.parameters(0));
    Settings landing = settings;
    landing.push_back("continuation.stop_at=[" + values.substr(1) + "]");
    const Run there(name, landing);
    return of_type(there.traced.at(0).branch, PointType::user);
  }

  std::string name;
  Settings settings;
  Run run;
  std::vector<BranchPoint> points;
};

}  // namespace

TEST_CASE("What is filled in where slips begin and steps are long is next to solutions", "[cases][numbers]") {
  const auto [name, setting] = GENERATE(std::pair("harmonics", "branch.for_each.harmonics=[3]"),
                                        std::pair("harmonics", "branch.for_each.harmonics=[9]"),
                                        std::pair("engine_orders", "system.harmonics=9"),
                                        std::pair("lift_off", "branch.parameter=\"eta\""));
  CAPTURE(name, setting);
  const FilledIn filled(name, {setting}, 600);
  const std::vector<BranchPoint> exact = filled.exact();
  REQUIRE(exact.size() == filled.points.size());
  const TracedBranch& traced = filled.run.traced[0];
  std::vector<double> greatest(observed(traced, exact[0]).size());
  for (const BranchPoint& point : exact) {
    const std::vector<double> values = observed(traced, point);
    for (std::size_t k = 0; k < values.size(); ++k)
      if (std::abs(values[k]) > greatest[k]) greatest[k] = std::abs(values[k]);
  }
  std::vector<double> off(greatest.size());
  double off_amplitude = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double Y = value(traced, exact[i], "Y");
    off_amplitude = std::max(off_amplitude, std::abs(value(traced, filled.points[i], "Y") / Y - 1));
    const std::vector<double> there = observed(traced, exact[i]), here = observed(traced, filled.points[i]);
    for (std::size_t k = 0; k < off.size(); ++k) {
      if (std::abs(here[k] - there[k]) > off[k]) off[k] = std::abs(here[k] - there[k]);
    }
  }
  CHECK(off_amplitude < 1e-3);
  const auto observables = traced.problem().observables();
  for (std::size_t k = 0; k < off.size(); ++k) {
    CAPTURE(observables[k].name);
    if (observables[k].name.starts_with("Y") || observables[k].name.starts_with("R"))
      CHECK(off[k] <= 0.01 * greatest[k]);
  }
}
