// Branches of random systems against the dense scan: no switch, peak or trough is missed, none is invented.

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "arcslip/problems/forced_response.hpp"
#include "catch.hpp"
#include "dense_scan.hpp"

namespace {

using namespace arcslip;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using problems::ForcedResponse;

struct Run {
  SystemParameters system;
  bool along_preload = false;
  double fixed = 1;  ///< the other parameter
  double from = 0;
  double to = 0;
};

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  /// std::uniform_real_distribution differs from library to library.
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  Index integer(Index low, Index high) {
    return low + static_cast<Index>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

  SystemParameters system() {
    SystemParameters s;
    s.model = integer(0, 1) == 0 ? StructureModel::rods : StructureModel::beams;
    s.wave_number = integer(1, 5);
    s.elements = integer(2 * s.wave_number + 1, 200);
    s.mass_ratio = log_uniform(0.2, 200);
    s.frequency_ratio = log_uniform(0.3, 8);
    s.interface_stiffness = log_uniform(1e-2, 1e7);
    s.base_damping = log_uniform(1e-6, 0.1);
    s.damper_damping = log_uniform(1e-6, 0.1);
    s.preload = log_uniform(1e-6, 1e6);
    return s;
  }

  /// Over all resonances of the first pair of modes.
  Run over_eta() {
    Run run;
    run.system = system();
    const SystemParameters& s = run.system;
    const auto n = static_cast<double>(s.wave_number);
    const bool rods = s.model == StructureModel::rods;
    const double damper = rods ? n : n * n;
    const double base = damper * s.frequency_ratio;
    const double stuck = std::sqrt(s.interface_stiffness * (1 + 1 / s.mass_ratio)) / (rods ? 6.28 : 39.5);
    run.fixed = s.preload;
    run.from = 0.2 * std::min(base, damper);
    run.to = 5 * std::max({base, damper, stuck});
    return run;
  }

  /// Over twelve decades of preload, at any frequency of that range.
  Run over_preload() {
    Run run = over_eta();
    run.along_preload = true;
    run.fixed = log_uniform(run.from, run.to);
    run.from = 1e-6;
    run.to = 1e6;
    return run;
  }

 private:
  std::mt19937_64 engine_;
};

std::string describe(const Run& run) {
  const SystemParameters& s = run.system;
  return fmt::format(
      "{} n={} N={} M*={:.17g} gamma={:.17g} K_FD={:.17g} zeta_B={:.17g} zeta_D={:.17g}; {} = {:.17g}, {} from "
      "{:.17g} to {:.17g}",
      to_string(s.model), s.wave_number, s.elements, s.mass_ratio, s.frequency_ratio, s.interface_stiffness,
      s.base_damping, s.damper_damping, run.along_preload ? "eta" : "P", run.fixed, run.along_preload ? "P" : "eta",
      run.from, run.to);
}

Branch traced(const Run& run, const ForcedResponse& problem) {
  continuation::TraceOptions options;
  options.parameter = run.along_preload ? "P" : "eta";
  options.from = run.from;
  options.to = run.to;
  options.extrema_of = {"Y"};
  const continuation::Guess guess =
      run.along_preload ? problem.guess(run.fixed, run.from) : problem.guess(run.from, run.fixed);
  return continuation::trace(problem, guess, options);
}

dense::Scan scanned(const Run& run) {
  const SystemParameters& s = run.system;
  const dense::Case c{s.model == StructureModel::beams,
                      static_cast<int>(s.wave_number),
                      static_cast<int>(s.elements),
                      s.mass_ratio,
                      s.frequency_ratio,
                      s.interface_stiffness,
                      s.base_damping,
                      s.damper_damping,
                      s.force};
  return {c, run.along_preload, run.fixed, run.from, run.to};
}

/// A special point of a branch, in the terms of the scan.
struct Special {
  dense::Event::Kind kind;
  double at;
  double log_R;
  double log_Y;
  bool matched = false;
};

std::vector<Special> specials_of(const Run& run, const ForcedResponse& problem, const Branch& branch) {
  std::vector<Special> specials;
  Vector values;
  for (const BranchPoint& point : branch.points) {
    dense::Event::Kind kind{};
    switch (point.type) {
      case PointType::peak: kind = dense::Event::Kind::peak; break;
      case PointType::trough: kind = dense::Event::Kind::trough; break;
      case PointType::regime_switch: kind = dense::Event::Kind::crossing; break;
      default: continue;
    }
    problem.observe(point.unknowns, point.parameters, point.regime, values);
    specials.push_back({kind, point.parameters(run.along_preload ? ForcedResponse::preload : ForcedResponse::eta),
                        point.unknowns(0), std::log(values(ForcedResponse::Y))});
  }
  return specials;
}

const char* name(dense::Event::Kind kind) {
  switch (kind) {
    case dense::Event::Kind::peak: return "peak";
    case dense::Event::Kind::trough: return "trough";
    case dense::Event::Kind::crossing: return "switch";
  }
  return "";
}

/// Extrema shallower than this are left out: the tracer compares slopes in double precision, where the last digits
/// of Y decide whether there is an extremum at all, and the scan cannot tell it what rounding will say.
constexpr double shallow = 1e-9;

/// What is wrong with the special points of a branch, in words.
std::vector<std::string> differences(const std::vector<dense::Event>& events, std::vector<Special> specials) {
  std::vector<std::string> found;
  for (const dense::Event& event : events) {
    const auto same = [&](const Special& s) {
      return !s.matched && s.kind == event.kind && std::abs(s.at / event.at - 1) <= 1e-7L &&
             std::abs(s.log_Y - event.log_Y) <= 1e-8L;
    };
    const auto match = std::find_if(specials.begin(), specials.end(), same);
    if (match != specials.end()) {
      match->matched = true;
    } else if (event.kind == dense::Event::Kind::crossing || event.depth > shallow) {
      found.push_back(fmt::format("missed: {} at {:.15g}, Y = {:.12g}, depth {:.3g}", name(event.kind),
                                  static_cast<double>(event.at), static_cast<double>(std::exp(event.log_Y)),
                                  static_cast<double>(event.depth)));
    }
  }
  for (const Special& s : specials) {
    if (s.matched) continue;
    found.push_back(fmt::format("spurious: {} at {:.15g}, Y = {:.12g}", name(s.kind), s.at, std::exp(s.log_Y)));
  }
  return found;
}

/// R and Y of the special points against the scan's own solution there.
std::vector<std::string> inaccuracies(dense::Scan& scan, const std::vector<Special>& specials) {
  std::vector<std::string> found;
  for (const Special& s : specials) {
    const dense::Sample own = scan.at(std::log(static_cast<dense::Real>(s.at)));
    if (std::abs(own.log_R - s.log_R) <= 1e-8L && std::abs(own.log_Y - s.log_Y) <= 1e-8L) continue;
    found.push_back(fmt::format("inaccurate: {} at {:.15g}, ln R off by {:.3g}, ln Y by {:.3g}", name(s.kind), s.at,
                                static_cast<double>(s.log_R - own.log_R),
                                static_cast<double>(s.log_Y - own.log_Y)));
  }
  return found;
}

/// What every branch of a passive contact has to be: complete, without folds, solved.
std::vector<std::string> defects(const Run& run, const Branch& branch) {
  std::vector<std::string> found;
  if (!branch.complete()) {
    found.push_back(fmt::format("stopped: {} ({})", to_string(branch.stop), branch.explanation));
    return found;
  }
  const double last = branch.points.back().parameters(run.along_preload ? 1 : 0);
  if (last != run.to) found.push_back(fmt::format("ends at {:.17g}", last));
  for (const BranchPoint& point : branch.points) {
    if (point.type == PointType::fold) found.push_back(fmt::format("fold at {:.15g}", point.parameters(0)));
    if (!(point.residual <= 1e-9)) {
      found.push_back(fmt::format("residual {:.3g} at {:.15g}", point.residual, point.parameters(0)));
    }
  }
  return found;
}

std::vector<std::string> complaints(const Run& run) {
  const ForcedResponse problem(build_system(run.system));
  const Branch branch = traced(run, problem);
  std::vector<std::string> found = defects(run, branch);
  dense::Scan scan = scanned(run);
  const std::vector<Special> specials = specials_of(run, problem, branch);
  for (std::string& text : differences(scan.events(), specials)) found.push_back(std::move(text));
  for (std::string& text : inaccuracies(scan, specials)) found.push_back(std::move(text));
  return found;
}

}  // namespace

TEST_CASE("Branches over frequency of random systems hold what a dense scan finds", "[random]") {
  Draw draw(20080130);
  for (int i = 0; i < 200; ++i) {
    const Run run = draw.over_eta();
    CAPTURE(i, describe(run));
    CHECK(complaints(run) == std::vector<std::string>{});
  }
}

TEST_CASE("Branches over preload of random systems hold what a dense scan finds", "[random]") {
  Draw draw(11005);
  for (int i = 0; i < 40; ++i) {
    const Run run = draw.over_preload();
    CAPTURE(i, describe(run));
    CHECK(complaints(run) == std::vector<std::string>{});
  }
}
