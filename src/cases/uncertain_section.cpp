#include "cases/uncertain_section.hpp"

#include <algorithm>
#include <functional>
#include <limits>

namespace arcslip {
namespace {

constexpr const char* path = "study.uncertain";
constexpr Index fewest_samples = 100;
constexpr Index most_samples = 1'000'000;

problems::Scatter read_scatter(const TomlDocument& document, const TomlSection& section,
                               const std::string& key) {
  using problems::Scatter;
  if (!section.has(key)) return {};
  const TomlSection factor(document, section.name(key));
  factor.allow_only({"lognormal", "uniform"});
  if (factor.has("lognormal") == factor.has("uniform"))
    section.fail(key, "expected { lognormal = ... } or { uniform = [...] }");
  Scatter scatter;
  if (factor.has("lognormal")) {
    scatter.kind = Scatter::Kind::lognormal;
    scatter.deviation =
        factor.number("lognormal", {[](double x) { return x > 0 && x <= 1; }, " > 0 and <= 1"});
    return scatter;
  }
  const std::vector<double> range = factor.numbers("uniform", positive());
  if (range.size() != 2 || !(range[0] < range[1]))
    factor.mismatch("uniform", "two factors of the nominal value, 0 < low < high");
  scatter.kind = Scatter::Kind::uniform;
  scatter.low = range[0];
  scatter.high = range[1];
  return scatter;
}

}  // namespace

bool scatters(const TomlDocument& document) {
  const toml::table* study = document.root().get_as<toml::table>("study");
  return study != nullptr && study->contains("uncertain");
}

problems::Uncertainty read_uncertainty(const TomlDocument& document) {
  const TomlSection section(document, path);
  section.allow_only({"mu", "preload", "force", "samples", "seed", "quantiles"});
  problems::Uncertainty uncertainty;
  uncertainty.friction = read_scatter(document, section, "mu");
  uncertainty.preload = read_scatter(document, section, "preload");
  uncertainty.force = read_scatter(document, section, "force");
  if (!section.has("mu") && !section.has("preload") && !section.has("force"))
    section.require("mu", "at least one of mu, preload and force");
  uncertainty.samples = static_cast<std::size_t>(section.integer(
      "samples", fewest_samples, most_samples, [] { return "an integer >= 100 and <= 1e6"; },
      static_cast<Index>(uncertainty.samples)));
  uncertainty.seed = static_cast<std::uint64_t>(section.integer(
      "seed", 0, std::numeric_limits<Index>::max(), [] { return "an integer >= 0"; },
      static_cast<Index>(uncertainty.seed)));
  if (section.has("quantiles")) {
    const std::vector<double> quantiles = section.numbers("quantiles", inside(0, 1));
    if (quantiles.empty() ||
        std::adjacent_find(quantiles.begin(), quantiles.end(), std::greater_equal<>()) != quantiles.end())
      section.mismatch("quantiles", "an array of rising numbers > 0 and < 1");
    uncertainty.quantiles = quantiles;
  }
  return uncertainty;
}

void resolve_uncertainty(const problems::Uncertainty& uncertainty, nlohmann::ordered_json& section) {
  section["samples"] = uncertainty.samples;
  section["seed"] = uncertainty.seed;
  section["quantiles"] = uncertainty.quantiles;
}

}  // namespace arcslip
