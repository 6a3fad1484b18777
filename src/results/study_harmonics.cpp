#include "results/study_harmonics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "arcslip/motion/swing.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_checks = 24;
constexpr double misleads = 0.5;  // of the height

std::vector<int> orders_of(const StoredDesign& stored, const StudyDesign& design) {
  if (stored.harmonics.empty()) return design.system.harmonics;
  std::vector<int> orders;
  std::istringstream text(stored.harmonics);
  for (int h = 0; text >> h;) orders.push_back(h);
  return orders;
}

/// How far off the height is, up or down.
double severity(const HarmonicsCheck& check) { return std::abs(std::log1p(check.moved_by)); }

bool is_misled(const HarmonicsCheck& check) {
  return check.failure.empty() && (!check.same_peak || severity(check) > std::log1p(misleads));
}

std::string size_of(double moved_by) {
  if (moved_by > 1) return fmt::format("{:.3g} times as high", 1 + moved_by);
  if (std::abs(moved_by) < 1e-4) return "as high to 0.01 %";
  return fmt::format("{:.3g} % {}", 100 * std::abs(moved_by), moved_by > 0 ? "higher" : "lower");
}

std::string told(const HarmonicsCheck& check, const char* with) {
  return fmt::format(
      "{} the harmonics {}, ..., {} the highest peak at P = {:.8g} is {}: {:.6g}, at eta = {:.6g}{}.", with,
      all_odd(check.harmonics) ? "1, 3" : "0, 1, 2", check.harmonics.back(), check.preload,
      size_of(check.moved_by), check.Y, check.eta, check.same_peak ? "" : ", and is another peak");
}

}  // namespace

std::vector<HarmonicsCheck> check_best_preloads(const StudyCase& study, const StudyStore& store,
                                                const std::function<bool()>& go_on) {
  const std::size_t apart = (study.count + most_checks - 1) / most_checks;
  std::vector<StoredDesign> chosen;
  store.visit(StudyStore::Which::all, [&](const StoredDesign& stored) {
    if (stored.kind != "failed" && stored.curve % apart == 0) chosen.push_back(stored);
    return true;
  });
  std::vector<HarmonicsCheck> checks;
  for (const StoredDesign& stored : chosen) {
    if (!go_on()) break;
    const StudyDesign design = study.design(stored.item);
    HarmonicsCheck check = check_harmonics(study, design, orders_of(stored, design), stored.preload);
    check.curve = stored.curve;
    checks.push_back(std::move(check));
  }
  return checks;
}

std::vector<std::string> sentences_of(const std::vector<HarmonicsCheck>& checks, std::size_t count) {
  std::vector<const HarmonicsCheck*> done;
  std::vector<std::string> sentences;
  for (const HarmonicsCheck& check : checks) {
    if (check.failure.empty()) done.push_back(&check);
  }
  if (done.size() < checks.size()) {
    const auto failed = std::find_if(checks.begin(), checks.end(),
                                     [](const HarmonicsCheck& check) { return !check.failure.empty(); });
    sentences.push_back(fmt::format("What more harmonics would change{} is not known: {}.",
                                    count == 1 ? "" : fmt::format(" in design {}", failed->curve),
                                    failed->failure));
  }
  if (done.empty()) return sentences;
  if (count == 1) {
    sentences.push_back(told(*done.front(), "With"));
    return sentences;
  }
  const auto others =
      std::count_if(done.begin(), done.end(), [](const auto* check) { return !check->same_peak; });
  const auto worst = *std::max_element(
      done.begin(), done.end(), [](const auto* a, const auto* b) { return severity(*a) < severity(*b); });
  sentences.push_back(
      fmt::format("More harmonics were tried at the best preloads of {} of {} designs; in {} another peak "
                  "rules. The height "
                  "changes most in design {}: {}",
                  done.size(), count, others, worst->curve, told(*worst, "with")));
  return sentences;
}

std::vector<std::string> warnings_of(const std::vector<HarmonicsCheck>& checks) {
  std::vector<const HarmonicsCheck*> misled;
  for (const HarmonicsCheck& check : checks) {
    if (is_misled(check)) misled.push_back(&check);
  }
  if (misled.empty()) return {};
  const auto worst = *std::max_element(
      misled.begin(), misled.end(), [](const auto* a, const auto* b) { return severity(*a) < severity(*b); });
  return {
      fmt::format("the harmonics of [system] mislead in {} of {} designs that were tried, most in design {}. "
                  "{} harmonics = {} would tell.",
                  misled.size(), checks.size(), worst->curve, told(*worst, "with"), worst->harmonics.back())};
}

ordered_json to_json(const std::vector<HarmonicsCheck>& checks) {
  ordered_json list = ordered_json::array();
  for (const HarmonicsCheck& check : checks) {
    ordered_json entry = {
        {"curve", check.curve}, {"P", check.preload}, {"harmonics", check.harmonics.back()}};
    if (check.failure.empty()) {
      entry.update(ordered_json{
          {"eta", check.eta}, {"Y", check.Y}, {"moved_by", check.moved_by}, {"same_peak", check.same_peak}});
    } else {
      entry["failure"] = check.failure;
    }
    list.push_back(entry);
  }
  return list;
}

ordered_json harmonics_of(const StudyCase& study, const StudyStore& store) {
  ordered_json list = ordered_json::array();
  store.visit(StudyStore::Which::all, [&](const StoredDesign& stored) {
    if (!stored.harmonics.empty())
      list.push_back({{"curve", stored.curve}, {"orders", orders_of(stored, study.design(stored.item))}});
    return true;
  });
  return list;
}

}  // namespace arcslip
