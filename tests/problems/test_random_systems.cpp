// Branches of random systems against the dense scan: no switch, peak or trough is missed, none is invented.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "arcslip/problems/response/forced_response.hpp"
#include "catch.hpp"
#include "dense_scan.hpp"
#include "random_systems.hpp"

namespace {

using namespace arcslip;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using problems::ForcedResponse;

struct Sweep {
  SystemParameters system;
  bool along_preload = false;
  double fixed = 1;  ///< the other parameter
  double from = 0;
  double to = 0;
};

Sweep over_eta(const SystemParameters& s) {
  const auto [from, to] = testing::resonance_range(s);
  return {s, false, s.preload, from, to};
}

/// Over twelve decades of preload.
Sweep over_preload(const SystemParameters& s, double eta) { return {s, true, eta, 1e-6, 1e6}; }

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : systems_(seed) {}

  Sweep over_eta() { return ::over_eta(systems_.system()); }

  /// At any frequency of the range of over_eta().
  Sweep over_preload() {
    const Sweep range = over_eta();
    return ::over_preload(range.system, systems_.log_uniform(range.from, range.to));
  }

 private:
  testing::RandomSystems systems_;
};

std::string describe(const Sweep& run) {
  const SystemParameters& s = run.system;
  return fmt::format(
      "{} n={} N={} M*={:.17g} gamma={:.17g} K_FD={:.17g} zeta_B={:.17g} zeta_D={:.17g}; {} = {:.17g}, {} "
      "from "
      "{:.17g} to {:.17g}",
      to_string(s.model), s.wave_number, s.elements, s.mass_ratio, s.frequency_ratio, s.interface_stiffness,
      s.base_damping, s.damper_damping, run.along_preload ? "eta" : "P", run.fixed,
      run.along_preload ? "P" : "eta", run.from, run.to);
}

Branch traced(const Sweep& run, const ForcedResponse& problem) {
  continuation::TraceOptions options;
  options.parameter = run.along_preload ? "P" : "eta";
  options.from = run.from;
  options.to = run.to;
  options.extrema_of = {"Y"};
  const continuation::Guess guess =
      run.along_preload ? problem.guess(run.fixed, run.from) : problem.guess(run.from, run.fixed);
  return continuation::trace(problem, guess, options);
}

dense::Scan scanned(const Sweep& run) {
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
struct FoundPoint {
  dense::Event::Kind kind;
  double at;
  double log_R;
  double log_Y;
  bool matched = false;
};

std::vector<FoundPoint> specials_of(const Sweep& run, const ForcedResponse& problem, const Branch& branch) {
  std::vector<FoundPoint> specials;
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
    specials.push_back({kind,
                        point.parameters(run.along_preload ? ForcedResponse::preload : ForcedResponse::eta),
                        point.unknowns(0), std::log(values(ForcedResponse::Y))});
  }
  return specials;
}

std::string name(dense::Event::Kind kind) {
  switch (kind) {
    case dense::Event::Kind::peak: return "peak";
    case dense::Event::Kind::trough: return "trough";
    case dense::Event::Kind::crossing: return "switch";
  }
  return "";
}

/// Extrema shallower than this are left out: the tracer compares slopes in double precision, where the last
/// digits of Y decide whether there is an extremum at all and where. One that it reports has to have the Y of
/// the scan's.
constexpr double shallow = 1e-9;

bool same_point(const dense::Event& event, const FoundPoint& s) {
  const bool flat = event.kind != dense::Event::Kind::crossing && event.depth <= shallow;
  return s.kind == event.kind && std::abs(s.at / event.at - 1) <= (flat ? 1e-3L : 1e-7L) &&
         std::abs(s.log_Y - event.log_Y) <= (flat ? 1e-9L : 1e-8L);
}

/// What is missing among the special points of a branch and what should not be there, in words.
std::vector<std::string> differences(const std::vector<dense::Event>& events,
                                     std::vector<FoundPoint> specials) {
  std::vector<std::string> found;
  for (const dense::Event& event : events) {
    const auto match = std::find_if(specials.begin(), specials.end(),
                                    [&](const FoundPoint& s) { return !s.matched && same_point(event, s); });
    if (match != specials.end()) {
      match->matched = true;
    } else if (event.kind == dense::Event::Kind::crossing || event.depth > shallow) {
      found.push_back(fmt::format("missed: {} at {:.15g}, Y = {:.12g}, depth {:.3g}", name(event.kind),
                                  static_cast<double>(event.at), static_cast<double>(std::exp(event.log_Y)),
                                  static_cast<double>(event.depth)));
    }
  }
  for (const FoundPoint& s : specials) {
    if (s.matched) continue;
    found.push_back(
        fmt::format("spurious: {} at {:.15g}, Y = {:.12g}", name(s.kind), s.at, std::exp(s.log_Y)));
  }
  return found;
}

constexpr double few_roundings = 4 * std::numeric_limits<double>::epsilon();

/// What the rounding of the parameter, or of a resonance, does to ln R. It exceeds any tolerance on
/// resonances with a Q of 1e10, which the interface has where it is far stiffer than the damper.
double rounding_of_response(const dense::Sample& sample) {
  return few_roundings * static_cast<double>(std::abs(sample.log_ratio_slope));
}

/// What the rounding of the parameter and of ln R does to the residual.
double rounding_of_residual(const dense::Sample& sample) {
  return few_roundings *
         static_cast<double>(sample.gain * (std::abs(sample.log_ratio_slope) + std::abs(sample.log_R)));
}

/// R and Y of the special points against the scan's own solution there.
std::vector<std::string> inaccuracies(dense::Scan& scan, const std::vector<FoundPoint>& specials) {
  std::vector<std::string> found;
  for (const FoundPoint& s : specials) {
    const dense::Sample own = scan.at(std::log(static_cast<dense::Real>(s.at)));
    const double allowed = 1e-8 + rounding_of_response(own);
    if (std::abs(own.log_R - s.log_R) <= allowed && std::abs(own.log_Y - s.log_Y) <= 1e-8L) continue;
    found.push_back(fmt::format("inaccurate: {} at {:.15g}, ln R off by {:.3g}, ln Y by {:.3g}", name(s.kind),
                                s.at, static_cast<double>(s.log_R - own.log_R),
                                static_cast<double>(s.log_Y - own.log_Y)));
  }
  return found;
}

/// What keeps the branch from being complete, solved and without folds, as that of any passive contact.
std::vector<std::string> defects(const Sweep& run, const Branch& branch, dense::Scan& scan) {
  if (!branch.complete()) {
    return {fmt::format("stopped: {} ({})", to_string(branch.stop), branch.explanation)};
  }
  std::vector<std::string> found;
  const Index parameter = run.along_preload ? ForcedResponse::preload : ForcedResponse::eta;
  const double last = branch.points.back().parameters(parameter);
  if (last != run.to) found.push_back(fmt::format("ends at {:.17g}", last));
  for (const BranchPoint& point : branch.points) {
    const double at = point.parameters(parameter);
    if (point.type == PointType::fold) found.push_back(fmt::format("fold at {:.15g}", at));
    if (point.residual <= 1e-9) continue;
    if (point.residual <= 1e-9 + rounding_of_residual(scan.at(std::log(static_cast<dense::Real>(at)))))
      continue;
    found.push_back(
        fmt::format("residual {:.3g} at {} at {:.15g}", point.residual, to_string(point.type), at));
  }
  return found;
}

std::vector<std::string> complaints(const Sweep& run) {
  const ForcedResponse problem(build_system(run.system));
  const Branch branch = traced(run, problem);
  dense::Scan scan = scanned(run);
  const std::vector<FoundPoint> specials = specials_of(run, problem, branch);
  std::vector<std::string> found = defects(run, branch, scan);
  for (std::string& text : differences(scan.events(), specials)) found.push_back(std::move(text));
  for (std::string& text : inaccuracies(scan, specials)) found.push_back(std::move(text));
  return found;
}

/// A system with force 1: model, n, N, M*, gamma, K_FD, zeta_B, zeta_D, P.
SystemParameters system(StructureModel model, Index n, Index elements, double mass_ratio,
                        double frequency_ratio, double interface_stiffness, double base_damping,
                        double damper_damping, double preload) {
  SystemParameters s;
  s.model = model;
  s.wave_number = n;
  s.elements = elements;
  s.mass_ratio = mass_ratio;
  s.frequency_ratio = frequency_ratio;
  s.interface_stiffness = interface_stiffness;
  s.base_damping = base_damping;
  s.damper_damping = damper_damping;
  s.preload = preload;
  return s;
}

}  // namespace

TEST_CASE("Branches over frequency of random systems hold what a dense scan finds", "[random]") {
  Draw draw(20080130);
  for (int i = 0; i < 200; ++i) {
    const Sweep run = draw.over_eta();
    CAPTURE(i, describe(run));
    CHECK(complaints(run) == std::vector<std::string>{});
  }
}

TEST_CASE("Branches over preload of random systems hold what a dense scan finds", "[random]") {
  Draw draw(11005);
  for (int i = 0; i < 40; ++i) {
    const Sweep run = draw.over_preload();
    CAPTURE(i, describe(run));
    CHECK(complaints(run) == std::vector<std::string>{});
  }
}

TEST_CASE("Branches of systems with crowded special points hold what a dense scan finds", "[random]") {
  constexpr auto rods = StructureModel::rods;
  constexpr auto beams = StructureModel::beams;
  const Sweep run = GENERATE(values<Sweep>({
      // a peak and a trough within one step
      over_eta(system(rods, 1, 60, 128.91801899840473, 3.7984944733185064, 816.17087308602504,
                      0.013396345133150436, 8.2752239299206803e-05, 0.018261121361845441)),
      over_eta(system(rods, 1, 162, 2.1777258878114063, 1.866765967577106, 2.7033793137959847,
                      0.087539651379974617, 0.0019498217454662166, 0.0024204493697463072)),
      over_eta(system(rods, 2, 91, 38.041150258491768, 0.49780676230338344, 90.853243563747526,
                      0.0013466033504590373, 0.00014097574308241087, 0.02386513617679618)),
      // a trough that follows so soon that the slope at the peak is noise
      over_eta(system(rods, 2, 152, 43.83124027619899, 2.5513519370489033, 4658.3215964716192,
                      0.00016049074971257441, 9.3952675736605134e-06, 0.020285424780061279)),
      over_eta(system(beams, 1, 178, 11.528281476263791, 3.4921920288376991, 1293912.0911475962,
                      3.2189044408441325e-06, 0.00065344610277128315, 0.11181285977751998)),
      over_eta(system(rods, 5, 15, 177.97534379251513, 2.5474717837608782, 11608.292182563422,
                      1.6773000410429387e-06, 3.8061075682369386e-06, 0.022995516474844428)),
      // a peak where rounding leaves more of the residual than usual
      over_eta(system(rods, 1, 152, 2.0574888370462059, 0.4916546490643533, 531295.36972885486,
                      0.00035037798002969257, 2.3049280314803523e-05, 0.60794616999605111)),
      // switches on a peak with a Q of 1e10
      over_eta(system(beams, 1, 163, 118.1156311118729, 3.913624892605601, 171771.67943972268,
                      4.2641270642755007e-05, 2.6962113086135585e-06, 3998.3463631428185)),
      over_eta(system(beams, 1, 195, 72.994837462422325, 0.37006985382366081, 45319.11370502424,
                      0.00035228695258553367, 1.0716050781699305e-06, 5431.8450758787867)),
      over_eta(system(rods, 1, 142, 98.877328345603132, 1.4399042634218615, 596655.64177905594,
                      1.0502744498948868e-06, 3.0208976265336793e-06, 86271.457318028042)),
      // extrema just before a switch
      over_preload(system(rods, 1, 129, 0.99683270040874672, 0.64334192227292086, 17.917293360361679,
                          0.054617479729876357, 0.000294315400635426, 1),
                   0.17581325458058905),
      over_preload(system(rods, 4, 37, 2.7173228658117625, 0.60494387621893253, 253956.96969298538,
                          4.3559205533162715e-05, 0.0010483912821816317, 1),
                   77.392961007114607),
      over_preload(system(rods, 3, 183, 8.0189689387578422, 2.0964028107078705, 81252.707288817939,
                          0.00050582070621894707, 0.0013241575035518793, 1),
                   44.378298182203174),
  }));
  CAPTURE(describe(run));
  CHECK(complaints(run) == std::vector<std::string>{});
}
