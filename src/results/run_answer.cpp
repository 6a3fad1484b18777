#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "arcslip/continuation/path/stop.hpp"
#include "cases/unit_names.hpp"
#include "results/answer.hpp"
#include "results/atlas_table.hpp"
#include "results/solution_results.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;
using nlohmann::literals::operator""_json_pointer;
using Sentences = std::vector<std::string>;

/// "preload = 1", of a branch what for_each sets on it.
std::string values_text(const ordered_json& branch) {
  std::string told;
  for (const auto& [key, value] : branch.at("values").items()) {
    told += (told.empty() ? "" : ", ") +
            setting_text(key, value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : value.dump());
  }
  return told.empty() ? fmt::format("branch {}", branch.at("branch").get<std::size_t>()) : told;
}

/// The highest peak of a branch among its special points; null without one.
const ordered_json* peak_of(const ordered_json& branch) {
  const ordered_json* highest = nullptr;
  if (!branch.at("peak").is_object()) return nullptr;
  for (const ordered_json& point : branch.at("special")) {
    if (point.at("type") == "peak" && point.contains("Y") &&
        (highest == nullptr || point.at("Y") > highest->at("Y")))
      highest = &point;
  }
  return highest;
}

/// How high a peak is and where; `parameter` is that of the branch.
std::string place_text(const ordered_json& peak, const std::string& parameter) {
  const auto number = [&](const std::string& name) { return peak.at(name).get<double>(); };
  const bool moves = without_unit(parameter) != "eta" && peak.contains(parameter);
  if (peak.contains("Y_m")) {
    return fmt::format("{} at {:.5g} Hz{}", length_text(number("Y_m")), number("frequency_Hz"),
                       moves ? fmt::format(", {} = {:.5g}", parameter, number(parameter)) : "");
  }
  return fmt::format("Y = {:.4g} at eta = {:.5g}{}", number("Y"), number("eta"),
                     moves ? fmt::format(", {} = {:.5g}", parameter, number(parameter)) : "");
}

/// The highest peaks of forced responses.
Sentences peaks_answer(const ordered_json& branches, const std::string& parameter) {
  struct Found {
    const ordered_json* branch;
    const ordered_json* peak;
    double height() const { return peak->at("Y").get<double>(); }
  };
  std::vector<Found> found;
  for (const ordered_json& branch : branches) {
    if (const ordered_json* peak = peak_of(branch)) found.push_back({&branch, peak});
  }
  if (found.empty()) return {};
  const auto place = [&](const Found& one) { return place_text(*one.peak, parameter); };
  const auto values = [](const Found& one) { return values_text(*one.branch); };
  const auto [low, high] = std::minmax_element(
      found.begin(), found.end(), [](const Found& a, const Found& b) { return a.height() < b.height(); });
  const double apart = high->height() / low->height();
  if (found.size() == 1) return {fmt::format("Highest peak {}.", place(*high))};
  if (apart < 1.005)
    return {fmt::format("On {} branches the highest peak is alike: {}.", found.size(), place(*high))};
  // More harmonics are no other design: what counts is how they change the answer.
  if (low->branch->at("values").size() == 1 && low->branch->at("values").contains("harmonics"))
    return {fmt::format("The highest peak is {} with {}, {} with {}.", place(found.front()),
                        values(found.front()), place(found.back()), values(found.back()))};
  return {
      fmt::format("Of {} branches the highest peak is lowest with {}: {}. It is highest with {}: {}, {:.3g} "
                  "times as high.",
                  found.size(), values(*low), place(*low), values(*high), place(*high), apart)};
}

using Count = std::pair<std::string, std::size_t>;  ///< of a type of special points

/// "peaks", "Hopf point".
std::string plural_of(const Count& count) {
  constexpr std::array named = {std::pair{"hopf", "Hopf point"},
                                std::pair{"neimark_sacker", "Neimark-Sacker point"},
                                std::pair{"bogdanov_takens", "Bogdanov-Takens point"},
                                std::pair{"zero_hopf", "zero-Hopf point"},
                                std::pair{"hopf_hopf", "double Hopf point"},
                                std::pair{"generalized_hopf", "generalised Hopf point"},
                                std::pair{"resonance_1_1", "1:1 resonance"},
                                std::pair{"resonance_1_2", "1:2 resonance"},
                                std::pair{"resonance_1_3", "1:3 resonance"},
                                std::pair{"resonance_1_4", "1:4 resonance"},
                                std::pair{"chenciner", "Chenciner point"},
                                std::pair{"generalized_period_doubling", "generalised period doubling"},
                                std::pair{"fold_flip", "fold-flip point"},
                                std::pair{"fold_neimark_sacker", "fold-Neimark-Sacker point"},
                                std::pair{"flip_neimark_sacker", "flip-Neimark-Sacker point"},
                                std::pair{"double_neimark_sacker", "double Neimark-Sacker point"},
                                std::pair{"symmetry_breaking", "breaking of symmetry"}};
  std::string name = count.first;
  std::replace(name.begin(), name.end(), '_', ' ');
  for (const auto& [type, words] : named) {
    if (count.first == type) name = words;
  }
  if (count.second == 1) return name;
  for (const std::string_view several : {"breaking", "further slip", "lift off"}) {
    if (name.starts_with(several)) return name.insert(several.size(), "s");
  }
  return name + (name.ends_with("ch") ? "es" : "s");
}

/// "5 branches of 2565 points in all, with 12 peaks, 9 switches, ...".
std::string count_answer(const ordered_json& branches) {
  std::vector<Count> counts;
  std::size_t points = 0;
  for (const ordered_json& branch : branches) {
    points += branch.at("points").get<std::size_t>();
    for (const ordered_json& point : branch.at("special")) {
      const std::string type = point.at("type").get<std::string>();
      if (type == "start" || type == "end" || type == "user") continue;
      const auto known =
          std::find_if(counts.begin(), counts.end(), [&](const auto& count) { return count.first == type; });
      if (known == counts.end()) {
        counts.emplace_back(type, 1);
      } else {
        ++known->second;
      }
    }
  }
  std::string text = fmt::format("{} branch{} of {} points in all", branches.size(),
                                 branches.size() == 1 ? "" : "es", points);
  for (std::size_t i = 0; i < counts.size(); ++i)
    text += fmt::format("{}{} {}", i == 0 ? ", with " : ", ", counts[i].second, plural_of(counts[i]));
  return text + ".";
}

/// Which Hopf points give birth to stable cycles: "Of 2 Hopf points 1 is supercritical, 1 subcritical."
Sentences hopf_answer(const ordered_json& branches) {
  std::size_t super = 0;
  std::size_t sub = 0;
  for (const ordered_json& branch : branches) {
    for (const ordered_json& point : branch.at("special")) {
      if (point.contains("lyapunov")) ++(point.at("lyapunov").get<double>() < 0 ? super : sub);
    }
  }
  if (super + sub == 0) return {};
  if (super + sub == 1)
    return {super == 1 ? "The Hopf point is supercritical: a stable cycle leaves it."
                       : "The Hopf point is subcritical: the cycle that leaves it is unstable."};
  return {fmt::format("Of {} Hopf points {} {} supercritical, {} subcritical.", super + sub, super,
                      super == 1 ? "is" : "are", sub)};
}

/// Where what leaves cycles is stable: "Of 2 period doublings 1 is supercritical, 1 subcritical."
Sentences multipliers_answer(const ordered_json& branches) {
  Sentences sentences;
  for (const auto& [type, name] : {std::pair{"period_doubling", "period doubling"},
                                   std::pair{"neimark_sacker", "Neimark-Sacker point"}}) {
    std::size_t super = 0;
    std::size_t all = 0;
    for (const ordered_json& branch : branches) {
      for (const ordered_json& point : branch.at("special")) {
        if (point.at("type") != type || !point.contains("coefficient")) continue;
        ++all;
        if (point.at("coefficient").get<double>() < 0) ++super;
      }
    }
    if (all == 1)
      sentences.push_back(fmt::format("The {} is {}.", name, super == 1 ? "supercritical" : "subcritical"));
    if (all > 1)
      sentences.push_back(fmt::format("Of {} {}s {} {} supercritical, {} subcritical.", all, name, super,
                                      super == 1 ? "is" : "are", all - super));
  }
  return sentences;
}

/// "Of 2 special points of cycles the parameter is known but not the orbit: ..."
Sentences unresolved_answer(const ordered_json& branches) {
  std::size_t count = 0;
  for (const ordered_json& branch : branches) {
    for (const ordered_json& point : branch.at("special")) count += point.value("resolved", true) ? 0 : 1;
  }
  if (count == 0) return {};
  return {
      fmt::format("Of {} special point{} of cycles the parameter is known but not the orbit: multipliers "
                  "pass by decades there from one number to the next.",
                  count, count == 1 ? "" : "s")};
}

/// "At the point l2 is negative: the cycle is stable." of as many points, at some of which the number is so.
std::string sign_answer(const char* name, const char* number, std::size_t negative, std::size_t all,
                        const char* cycle) {
  if (all == 1)
    return fmt::format("At the {} {} is {}: {} {}.", name, number, negative == 1 ? "negative" : "positive",
                       cycle, negative == 1 ? "is stable" : "is unstable");
  return fmt::format("Of {} {}s {} {} negative {}: there {} is stable.", all, name, negative,
                     negative == 1 ? "has" : "have", number, cycle);
}

/// What is stable near points of codimension two, and which cusps are none.
Sentences normal_forms_answer(const ordered_json& branches) {
  std::array<std::size_t, 3> all{};
  std::array<std::size_t, 3> so{};
  for (const ordered_json& branch : branches) {
    for (const ordered_json& point : branch.at("special")) {
      if (!point.contains("normal_form")) continue;
      const ordered_json& form = point.at("normal_form");
      const auto count = [&](std::size_t which, bool is_so) {
        ++all[which];
        if (is_so) ++so[which];
      };
      if (form.contains("l2")) count(0, form.at("l2").get<double>() < 0);
      if (point.at("type") == "bogdanov_takens") count(1, form.at("b").get<double>() < 0);
      if (form.contains("regular")) count(2, form.at("regular").get<bool>());
    }
  }
  Sentences sentences;
  if (all[0] > 0)
    sentences.push_back(
        sign_answer("generalised Hopf point", "l2", so[0], all[0], "the outer one of the two cycles"));
  if (all[1] > 0)
    sentences.push_back(sign_answer("Bogdanov-Takens point", "a b", so[1], all[1], "the cycle beside it"));
  if (so[2] < all[2])
    sentences.push_back(
        fmt::format("Of {} cusp{} {} not unfolded by the parameters, as where folds meet the trivial state "
                    "of a symmetry.",
                    all[2], all[2] == 1 ? "" : "s",
                    all[2] - so[2] == 1 ? "one is" : fmt::format("{} are", all[2] - so[2])));
  return sentences;
}

/// Which branches have lost symmetries of the whole ring.
Sentences symmetries_answer(const ordered_json& branches) {
  constexpr std::size_t most = 12;
  Sentences sentences;
  for (const ordered_json& branch : branches) {
    const std::size_t images = branch.value("images", std::size_t{1});
    if (images == 1 || sentences.size() == most) continue;
    const ordered_json& kept = branch.at("symmetries");
    std::string names;
    for (const ordered_json& name : kept)
      names += fmt::format("{}\"{}\"", names.empty() ? "" : " and ", name.get<std::string>());
    sentences.push_back(
        fmt::format("Branch {} has {}, one of {} images.", branch.at("branch").get<std::size_t>(),
                    names.empty() ? "lost all symmetries" : "kept of all symmetries " + names, images));
  }
  return sentences;
}

/// Which branches did not come to an end that is as good as any.
Sentences ends_answer(const ordered_json& branches) {
  constexpr std::size_t most = 3;
  Sentences sentences;
  std::size_t open = 0;
  for (const ordered_json& branch : branches) {
    const auto is_whole = [&](const char* part) {
      const auto stop = continuation::stop_named(branch.value(part, "reached_end"));
      return stop && is_end(*stop);
    };
    const bool is_cut_ahead = !is_whole("stop");
    if (!is_cut_ahead && is_whole("first_stop")) continue;
    if (++open <= most)
      sentences.push_back(
          fmt::format("Branch {} is not whole{}: {}.", branch.at("branch").get<std::size_t>(),
                      is_cut_ahead ? "" : " before its start",
                      branch.at(is_cut_ahead ? "explanation" : "first_explanation").get<std::string>()));
  }
  if (open > most) sentences.push_back(fmt::format("{} more branches are not whole.", open - most));
  return sentences;
}

Sentences certificates_answer(const ordered_json& branches) {
  std::size_t asked = 0;
  std::size_t proven = 0;
  for (const ordered_json& branch : branches) {
    if (!branch.contains("certificate")) continue;
    ++asked;
    if (branch.at("certificate").at("proven").get<bool>()) ++proven;
  }
  if (asked == 0) return {};
  return {fmt::format("{} of {} branches are proven by interval arithmetic: nothing was jumped.", proven,
                      branches.size())};
}

/// How many solutions there are, of each search for all of them.
Sentences solutions_answer(const ordered_json& branches) {
  Sentences sentences;
  for (const ordered_json& branch : branches) {
    if (!branch.contains("solutions")) continue;
    const ordered_json& told = branch.at("solutions");
    std::string text = solutions_sentence(told);
    if (sentences.empty() || sentences.back() != text) sentences.push_back(std::move(text));
  }
  return sentences;
}

Sentences surfaces_answer(const ordered_json& branches) {
  Sentences sentences;
  for (const ordered_json& branch : branches) {
    if (branch.contains("surface")) sentences.push_back(surface_sentence(branch.at("surface")));
  }
  return sentences;
}

}  // namespace

std::vector<std::string> run_answer(const ordered_json& summary) {
  const ordered_json& branches = summary.at("branches");
  const ordered_json input = summary.value("/case/branch"_json_pointer, ordered_json::object());
  const std::string response = input.value("response", "forced");
  Sentences sentences;
  if (response == "forced" || response == "one_way")
    sentences = peaks_answer(branches, input.value("parameter", "eta"));
  const Sentences surfaces = surfaces_answer(branches);
  if (surfaces.empty()) sentences.push_back(count_answer(branches));
  for (const Sentences& more :
       {surfaces, solutions_answer(branches), hopf_answer(branches), multipliers_answer(branches),
        unresolved_answer(branches), normal_forms_answer(branches), symmetries_answer(branches),
        ends_answer(branches), certificates_answer(branches)})
    sentences.insert(sentences.end(), more.begin(), more.end());
  if (summary.value("interrupted", false)) sentences.emplace_back("The run was interrupted.");
  return sentences;
}

std::string verification_answer(const ResultTable& verified) {
  std::size_t points = 0;
  std::size_t timed = 0;
  double by_harmonics = 0;
  double by_time = 0;
  const auto columns = verified.read({"type", "difference_harmonics", "difference_time"});
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    if (columns[0][i] == "interrupted") continue;
    ++points;
    by_harmonics = std::fmax(by_harmonics, std::abs(columns[1][i].get<double>()));
    const double difference = std::abs(columns[2][i].get<double>());
    if (std::isnan(difference)) continue;
    ++timed;
    by_time = std::max(by_time, difference);
  }
  if (points == 0) return "";
  std::string text = fmt::format(
      "{} points were solved anew: with more harmonics Y differs by at most {:.2g}", points, by_harmonics);
  if (timed > 0) text += fmt::format(", in time at {} of them by at most {:.2g}", timed, by_time);
  return text + ", relative.";
}

}  // namespace arcslip
