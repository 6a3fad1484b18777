#include "cases/departures.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <set>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/motion/swing.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/problems/response/modulated_response.hpp"
#include "arcslip/problems/response/more_harmonics.hpp"

namespace arcslip {
namespace {

using continuation::BranchPoint;
using continuation::Guess;
using continuation::PointType;
using continuation::TraceOptions;
using problems::HarmonicProblem;

constexpr int most_doubled = 4;  // that are come to by doubling

/// In what a response of a system lies.
struct Balance {
  std::vector<int> harmonics;
  Index subharmonic_wave;
  auto operator<=>(const Balance&) const = default;
};

/// Those in which a branch may lie that leaves at a special point of this type: over two periods it travels
/// on one of the waves of half as many lengths.
std::vector<Balance> balances_beyond(const TracedBranch& traced, PointType type) {
  SystemParameters system = traced.request->problem.system;
  system.harmonics = traced.base.harmonics;
  const int highest = highest_order(system.harmonics);
  const int periods = system.periods();
  std::vector<Balance> all;
  if (type == PointType::symmetry_breaking && all_odd(system.harmonics))
    all.push_back({orders_up_to(highest, periods, false), system.subharmonic_wave});
  if (type == PointType::period_doubling && 2 * periods <= most_doubled) {
    for (const Index wave : subharmonic_waves(system.first_wave(), system.elements, 2))
      all.push_back({orders_up_to(2 * highest, 2 * periods, false), wave});
  }
  std::erase_if(all, [&](const Balance& one) { return std::ssize(one.harmonics) > most_orders(system); });
  return all;
}

/// A point by its branch and place, with that of the one of its kind before it.
struct Special {
  const TracedBranch* of;
  std::size_t point;
  std::size_t last;
};

/// The branch point that a special point is in a wider balance: the first on the way from some points before,
/// for other harmonics have it at another place.
std::optional<BranchPoint> branch_point_at(const Special& special, const HarmonicProblem& wider) {
  constexpr std::size_t most_before = 3;
  const auto& from = dynamic_cast<const HarmonicProblem&>(*special.of->base.problem);
  const std::size_t back = std::min(most_before, special.point - special.last - 1);
  if (special.point == 0) return std::nullopt;
  const BranchPoint& before = special.of->branch.points[special.point - std::max<std::size_t>(1, back)];
  const Index n = from.size();
  Guess start = carried(from, {before.unknowns, before.parameters, before.regime, {}}, wider);
  start.direction.resize(wider.size() + 1);
  start.direction
      << carried(from, {before.tangent.head(n), before.parameters, before.regime, {}}, wider).unknowns,
      before.tangent(n);
  TraceOptions options = unwatched(special.of->request->options);
  options.stop_at.clear();
  options.stop_after = {{PointType::branch_point, 1, ""}};
  options.max_points = 20;
  const continuation::Branch way = trace(wider, start, options);
  if (way.points.empty() || way.points.back().type != PointType::branch_point) return std::nullopt;
  return way.points.back();
}

/// The branches in one balance that leave these points. Throws std::invalid_argument where there is none.
std::vector<TracedBranch> departures_in(const Balance& balance, const std::vector<Special>& specials,
                                        const continuation::TimeBudget& time,
                                        const continuation::Observer& observer) {
  CaseBranch request = *specials.front().of->request;
  if (balance.harmonics.front() > 1 && structures_of(request.problem.system).whole() != nullptr)
    throw std::invalid_argument("whole rings are calculated over one period of the load");
  request.problem.system.harmonics = balance.harmonics;
  request.problem.system.subharmonic_wave = balance.subharmonic_wave;
  request.problem.harmonics_tolerance.reset();
  const auto begun = std::chrono::steady_clock::now();
  std::vector<TracedBranch> traced;
  const auto kept = std::make_shared<const CaseBranch>(request);
  const Built built = build(request.problem);
  const auto& wider = dynamic_cast<const HarmonicProblem&>(*built.problem);
  std::vector<BranchPoint> points;
  for (const Special& special : specials) {
    if (auto point = branch_point_at(special, wider)) points.push_back(std::move(*point));
  }
  TraceOptions options = time.rest();
  options.events.insert(options.events.end(), built.events.begin(), built.events.end());
  for (continuation::Branch& branch :
       trace_leaving(*built.problem, points, options, {.images = true}, observer))
    traced.push_back({kept, built, nullptr, std::move(branch), 0});
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begun;
  for (TracedBranch& one : traced) one.seconds = seconds.count() / static_cast<double>(traced.size());
  return traced;
}

/// What the modulated waves that leave a response are.
const ResponseKind& modulated_kind() {
  static const ResponseKind kind{.name = "modulated",
                                 .title = "modulated responses",
                                 .parameters = {"eta", "P"},
                                 .frequency = ResponseKind::Frequency::own,
                                 .extremum = "",
                                 .not_disturbed = "",
                                 .not_proven = "of two frequencies",
                                 .remark = "modulated response",
                                 .build = {}};
  return kind;
}

/// The modulated waves that leave a branch, each once though it may begin and end on it.
std::vector<TracedBranch> modulated_from(const TracedBranch& traced, const continuation::TimeBudget& time,
                                         const continuation::Observer& observer) {
  constexpr double near = 0.01;  // in the parameter, relative to it
  std::vector<TracedBranch> all;
  if (traced.base.disturbed == nullptr) return all;
  CaseBranch request = *traced.request;
  request.problem.response = &modulated_kind();
  request.options = unwatched(request.options);
  const auto kept = std::make_shared<const CaseBranch>(request);
  SystemParameters system = request.problem.system;
  system.harmonics = traced.base.harmonics;
  const auto& response = dynamic_cast<const HarmonicProblem&>(*traced.base.problem);
  const Index parameter = continuation::index_of(response.parameter_names(), request.options.parameter);
  const auto is_known = [&](const BranchPoint& point) {
    return std::any_of(all.begin(), all.end(), [&](const TracedBranch& one) {
      return !one.branch.points.empty() &&
             std::abs(one.branch.points.back().parameters(parameter) / point.parameters(parameter) - 1) <
                 near;
    });
  };
  for (const BranchPoint& point : traced.branch.points) {
    if (point.type != PointType::neimark_sacker || !time.goes_on() || is_known(point)) continue;
    const auto begun = std::chrono::steady_clock::now();
    TracedBranch one{kept, {traced.base.problem, {}, traced.base.harmonics}, nullptr, {}, 0};
    try {
      const std::optional<problems::ModulatedStart> start = problems::modulated_response(
          system, response, {point.unknowns, point.parameters, point.regime, {}}, parameter);
      if (!start)
        throw std::invalid_argument(fmt::format("none was found at {} = {:.10g}", request.options.parameter,
                                                point.parameters(parameter)));
      one.base.problem = start->problem;
      one.branch = trace(*start->problem, start->guess, unwatched(time.rest()), observer);
    } catch (const std::invalid_argument& error) {
      one.branch.explanation = fmt::format("of the modulated response: {}", error.what());
    }
    const auto is_same = [&](const TracedBranch& other) {
      return one.branch.points.empty() && other.branch.explanation == one.branch.explanation;
    };
    if (std::any_of(all.begin(), all.end(), is_same)) continue;  // said already
    one.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace

std::vector<TracedBranch> trace_departures(const std::vector<TracedBranch>& traced,
                                           const continuation::TimeBudget& time,
                                           const continuation::Observer& observer) {
  std::vector<TracedBranch> all;
  std::set<Balance> known;
  std::vector<TracedBranch> level = traced;
  while (!level.empty() && time.goes_on()) {
    std::map<Balance, std::vector<Special>> groups;
    for (const TracedBranch& one : level) {
      std::size_t last = 0;
      for (std::size_t i = 0; i < one.branch.points.size(); ++i) {
        const std::vector<Balance> balances = balances_beyond(one, one.branch.points[i].type);
        for (const Balance& balance : balances) groups[balance].push_back({&one, i, last});
        if (!balances.empty()) last = i;
      }
    }
    std::vector<TracedBranch> next;
    for (const auto& [balance, specials] : groups) {
      if (!known.insert(balance).second) continue;
      try {
        for (TracedBranch& one : departures_in(balance, specials, time, observer))
          next.push_back(std::move(one));
      } catch (const std::invalid_argument& error) {
        next.push_back({specials.front().of->request, specials.front().of->base, nullptr, {}, 0});
        next.back().branch.explanation =
            fmt::format("what leaves special points is not followed: {}", error.what());
      }
    }
    all.insert(all.end(), next.begin(), next.end());
    level = std::move(next);
  }
  std::vector<TracedBranch> modulated;
  for (const std::vector<TracedBranch>* branches : {&traced, &std::as_const(all)}) {
    for (const TracedBranch& one : *branches) {
      for (TracedBranch& more : modulated_from(one, time, observer)) modulated.push_back(std::move(more));
    }
  }
  all.insert(all.end(), modulated.begin(), modulated.end());
  return all;
}

}  // namespace arcslip
