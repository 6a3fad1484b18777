#include "cases/ring_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <charconv>
#include <cmath>
#include <random>

#include "cases/named_file.hpp"

namespace arcslip {
namespace {

constexpr std::string_view gaps = " \t\r";

std::vector<double> numbers_between(std::string_view line, const std::string& place) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = std::min(line.find(','), line.size());
    std::string_view cell = line.substr(0, comma);
    cell.remove_prefix(std::min(cell.find_first_not_of(gaps), cell.size()));
    cell = cell.substr(0, cell.find_last_not_of(gaps) + 1);
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
      throw MatrixTextError(fmt::format("{}: expected finite numbers between commas", place));
    numbers.push_back(value);
    if (comma == line.size()) return numbers;
    line.remove_prefix(comma + 1);
  }
}

std::vector<std::vector<double>> number_rows_of(std::string_view text, const std::string& file) {
  std::vector<std::vector<double>> rows;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(gaps) == line.npos) continue;
    rows.push_back(numbers_between(line, fmt::format("{}:{}", file, number)));
  }
  return rows;
}

std::vector<double> scattered_factors(const TomlSection& section, Index sectors, Index pattern) {
  ScatterSettings settings;
  scatter_keys().read(settings, section);
  if (pattern == 0) return std::vector<double>(static_cast<std::size_t>(sectors), 1.0);
  const std::uint64_t seed =
      seed_of_pattern(static_cast<std::uint64_t>(settings.seed), static_cast<std::uint64_t>(pattern));
  std::vector<double> factors = scattered(sectors, seed, settings.correlation);
  const double variance = std::log1p(settings.scatter * settings.scatter);
  for (double& one : factors) {
    one = settings.law == ScatterSettings::Law::normal ? 1 + settings.scatter * one
                                                       : std::exp(std::sqrt(variance) * one - variance / 2);
    if (!(one > 0))
      section.fail("scatter",
                   fmt::format("expected factors above 0, got one of {:g}; lognormal ones are", one));
  }
  return factors;
}

}  // namespace

std::uint64_t seed_of_pattern(std::uint64_t seed, std::uint64_t pattern) {
  if (pattern == 1) return seed;
  const auto mixed = [](std::uint64_t x) {  // the finaliser of splitmix64
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  };
  return mixed(mixed(seed + 0x9e3779b97f4a7c15) + pattern);
}

std::vector<double> scattered(Index count, std::uint64_t seed, double correlation) {
  std::mt19937_64 engine(seed);
  std::vector<double> own;
  for (Index i = 0; i < count; ++i) {
    const double u = (static_cast<double>(engine() >> 11) + 0.5) * 0x1p-53;
    own.push_back(boost::math::quantile(boost::math::normal(), u));
  }
  if (!(correlation > 0)) return own;
  std::vector<double> weights;  // of the distance d; their correlation is exp(-(d/L)^2/2)
  double norm = 0;
  for (Index d = 0; d < count; ++d) {
    const auto distance = static_cast<double>(std::min(d, count - d));
    weights.push_back(std::exp(-std::pow(distance / correlation, 2)));
    norm += weights.back() * weights.back();
  }
  std::vector<double> all;
  for (Index i = 0; i < count; ++i) {
    double sum = 0;
    for (Index k = 0; k < count; ++k)
      sum += weights[static_cast<std::size_t>((i - k + count) % count)] * own[static_cast<std::size_t>(k)];
    all.push_back(sum / std::sqrt(norm));
  }
  return all;
}

const KeyTable<ScatterSettings>& scatter_keys() {
  using S = ScatterSettings;
  using K = Key<S>;
  static const KeyTable<S> keys{
      {K("scatter", &S::scatter, inside(0, 10), "standard deviation of the factors, whose mean is 1",
         required),
       K("seed", &S::seed, at_least(0, 9e15), "of the numbers, which are the same everywhere"),
       K("correlation", &S::correlation, at_least(0),
         "L: sectors at a distance d are correlated as exp(-(d/L)^2/2); 0: not at all", unit("sectors")),
       K::choice("law", &S::law, {{"lognormal", S::Law::lognormal}, {"normal", S::Law::normal}},
                 "how the factors are distributed", "")}};
  return keys;
}

std::vector<std::vector<double>> number_rows(const TomlSection& section, const std::string& key) {
  return parsed(section, key, largest_list, nullptr,
                [](const std::string& text, const std::string& path) { return number_rows_of(text, path); });
}

std::vector<std::vector<double>> listed_rows(const TomlSection& section, const std::string& key,
                                             const std::string& expected) {
  const toml::node& node = section.require(key, expected);
  if (node.is_string() && node.value<std::string>()->ends_with(".csv")) return number_rows(section, key);
  const toml::array* array = node.as_array();
  if (array == nullptr) section.mismatch(key, expected);
  std::vector<std::vector<double>> rows;
  for (const toml::node& one : *array) {
    std::vector<double> row;
    const toml::array* several = one.as_array();
    for (std::size_t i = 0; i < (several == nullptr ? 1 : several->size()); ++i) {
      const std::optional<double> number = exact_number(several == nullptr ? one : *several->get(i));
      if (!number || !std::isfinite(*number)) section.mismatch(key, expected);
      row.push_back(*number);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<double> factors_of_sectors(const TomlSection& section, const std::string& key, Index sectors,
                                       Index each, Index pattern) {
  const char* expected = "a list of numbers, a CSV file, or a table { scatter = ..., seed = ... }";
  const toml::node& node = section.require(key, expected);
  std::vector<double> numbers;
  if (node.is_table()) {
    numbers = scattered_factors(section.inside(key, expected), sectors, pattern);
  } else if (node.is_string()) {
    for (const std::vector<double>& row : number_rows(section, key))
      numbers.insert(numbers.end(), row.begin(), row.end());
    if (std::any_of(numbers.begin(), numbers.end(), [](double one) { return !(one > 0); }))
      section.fail(key, "expected numbers > 0 in the file");
  } else if (node.is_array()) {
    numbers = section.numbers(key, positive());
  } else {
    section.mismatch(key, expected);
  }
  const Index size = std::ssize(numbers);
  if (size != sectors && size != sectors * each)
    section.fail(
        key, fmt::format("expected {} numbers, one for each sector{}, got {}", sectors,
                         each > 1 ? fmt::format(", or {}, one for each contact", sectors * each) : "", size));
  if (size == sectors * each) return numbers;
  std::vector<double> all;
  for (const double one : numbers) all.insert(all.end(), static_cast<std::size_t>(each), one);
  return all;
}

std::vector<Index> listed_sectors(const TomlSection& section, const std::string& key, Index sectors) {
  const NumberRule rule{
      [=](double one) { return one >= 1 && one <= static_cast<double>(sectors) && one == std::floor(one); },
      fmt::format(" that is a sector from 1 to {}", sectors)};
  std::vector<Index> all;
  for (const double one : section.numbers(key, rule)) {
    const Index sector = static_cast<Index>(one) - 1;
    if (std::find(all.begin(), all.end(), sector) != all.end())
      section.fail(key, fmt::format("expected sectors that differ, got {} twice", sector + 1));
    all.push_back(sector);
  }
  return all;
}

}  // namespace arcslip
