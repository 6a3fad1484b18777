#include "arcslip/problems/ridges/uncertainty.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

namespace arcslip::problems {
namespace {

constexpr double scan_step = 0.02;           // of ln P
constexpr double row_step = 0.05;            // about 46 rows a decade
constexpr double envelope_tolerance = 1e-6;  // of ln Y, which costs no more than a coarser one

/// Numbers > 0 and < 1 that are the same with every standard library, whose distributions are not.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}

  double draw() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }

  /// One number in each of `count` equal strata, in random order.
  std::vector<double> strata(std::size_t count) {
    std::vector<double> numbers(count);
    for (std::size_t i = 0; i < count; ++i)
      numbers[i] = (static_cast<double>(i) + draw()) / static_cast<double>(count);
    for (std::size_t i = count; i-- > 1;) {
      const auto other = static_cast<std::size_t>(draw() * static_cast<double>(i + 1));
      std::swap(numbers[i], numbers[other]);
    }
    return numbers;
  }

 private:
  std::mt19937_64 engine_;
};

/// `count` + 1 numbers from one to another, in equal steps of at most `step`.
std::vector<double> steps(double from, double to, double step) {
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil((to - from) / step)));
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i)
    numbers.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(count));
  numbers.push_back(to);
  return numbers;
}

/// Of values, which are put in another order, the one at position ceil(rank), counted from one.
double ranked(std::vector<double>& values, double rank) {
  const double place = std::clamp(std::ceil(rank), 1.0, static_cast<double>(values.size()));
  const auto position = values.begin() + static_cast<std::ptrdiff_t>(place) - 1;
  std::nth_element(values.begin(), position, values.end());
  return *position;
}

}  // namespace

double Scatter::log_quantile(double u) const {
  if (kind == Kind::none) return 0;
  if (kind == Kind::uniform) return std::log(low + u * (high - low));
  return deviation * boost::math::quantile(boost::math::normal(), u);
}

PeakDistribution::PeakDistribution(const Uncertainty& uncertainty) {
  if (uncertainty.samples == 0) throw std::invalid_argument("PeakDistribution: no samples");
  Uniform uniform(uncertainty.seed);
  samples_.assign(uncertainty.samples, {0, 0});
  const auto scatter = [&](const Scatter& factor, double shift_sign, bool is_force) {
    if (factor.kind != Scatter::Kind::none) ++factors_;
    const std::vector<double> numbers = uniform.strata(samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double log_factor = factor.log_quantile(numbers[i]);
      samples_[i].shift += shift_sign * log_factor;
      if (is_force) samples_[i].log_force = log_factor;
    }
  };
  scatter(uncertainty.friction, 1, false);
  scatter(uncertainty.preload, 1, false);
  scatter(uncertainty.force, -1, true);
  std::sort(samples_.begin(), samples_.end(),
            [](const Sample& a, const Sample& b) { return a.shift < b.shift; });
}

std::vector<double> PeakDistribution::values(const EnvelopeCurve& envelope, double x) const {
  std::vector<double> values;
  values.reserve(samples_.size());
  EnvelopeCurve::Walk walk(envelope);
  for (const Sample& sample : samples_) values.push_back(sample.log_force + walk.at(x + sample.shift));
  return values;
}

std::vector<double> PeakDistribution::log_quantiles(const EnvelopeCurve& envelope, double x,
                                                    const std::vector<double>& probabilities) const {
  std::vector<double> all = values(envelope, x);
  std::vector<double> quantiles;
  for (const double probability : probabilities)
    quantiles.push_back(ranked(all, probability * static_cast<double>(all.size())));
  return quantiles;
}

std::vector<PeakDistribution::Quantile> PeakDistribution::quantiles(
    const EnvelopeCurve& envelope, double x, const std::vector<double>& probabilities) const {
  std::vector<double> all = values(envelope, x);
  const auto count = static_cast<double>(all.size());
  std::vector<Quantile> quantiles;
  for (const double p : probabilities) {
    // The strata of one factor alone hold one sample each.
    const double deviation = factors_ > 1 ? std::max(1.0, std::sqrt(count * p * (1 - p))) : 1;
    const double below = ranked(all, p * count - deviation);
    const double above = ranked(all, p * count + deviation);
    quantiles.push_back({ranked(all, p * count), 0.5 * (above - below)});
  }
  return quantiles;
}

double PeakDistribution::lowest_quantile(const EnvelopeCurve& envelope, double from, double to,
                                         double probability) const {
  const auto quantile = [&](double x) { return log_quantiles(envelope, x, {probability}).front(); };
  std::vector<double> places = steps(from, to, scan_step);
  for (const double place : envelope.places()) {
    if (place > from && place < to) places.push_back(place);
  }
  std::sort(places.begin(), places.end());
  std::vector<double> values;
  values.reserve(places.size());
  for (const double place : places) values.push_back(quantile(place));

  const double least = *std::min_element(values.begin(), values.end());
  double best = least;
  double best_place =
      places[static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin())];
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, places.size() - 1);
    if (values[i] > values[before] || values[i] > values[after]) continue;
    // Between its neighbours it falls no further than it does on the way from them, as slopes go.
    const double fall = std::max(values[before], values[after]) - values[i];
    if (values[i] - fall > least) continue;
    std::uintmax_t iterations = 60;
    const auto [x, value] =
        boost::math::tools::brent_find_minima(quantile, places[before], places[after], 26, iterations);
    if (value < best) {
      best = value;
      best_place = x;
    }
  }
  return best_place;
}

UncertainPeaks study_uncertainty(const SystemParameters& system, const PreloadRange& range,
                                 const Uncertainty& uncertainty, const PreloadStudy& nominal,
                                 const continuation::TraceOptions& options) {
  if (system.preload_growth != 0)
    throw std::invalid_argument("study_uncertainty: the preload must not grow with the frequency");
  return study_uncertainty(range, uncertainty, nominal, [&](double from, double to) {
    PreloadRange wide = range;
    wide.from = from;
    wide.to = to;
    wide.stop_at.clear();
    EnvelopeCurve envelope = study_envelope(system, wide, envelope_tolerance, options);
    const double error = envelope.error();
    return std::pair(std::move(envelope), error);
  });
}

UncertainPeaks study_uncertainty(const PreloadRange& range, const Uncertainty& uncertainty,
                                 const PreloadStudy& nominal, const EnvelopeOver& envelope_over) {
  UncertainPeaks result;
  const PeakDistribution peaks(uncertainty);
  result.failure = nominal.failure;
  if (!nominal.optimum) return result;
  std::optional<EnvelopeCurve> studied;
  try {
    auto [curve, error] =
        envelope_over(range.from * std::exp(peaks.lowest()), range.to * std::exp(peaks.highest()));
    studied.emplace(std::move(curve));
    result.error = error;
  } catch (const std::runtime_error& error) {
    result.failure = error.what();
    return result;
  }
  const EnvelopeCurve& envelope = *studied;

  const auto quantiles = [&](double preload, const std::vector<double>& probabilities) {
    return peaks.quantiles(envelope, std::log(preload), probabilities);
  };
  constexpr double p = UncertainPeaks::probability;
  const double optimum = nominal.optimum->peak.preload;
  const double lowest = peaks.lowest_quantile(envelope, std::log(range.from), std::log(range.to), p);
  result.preload = std::clamp(std::exp(lowest), range.from, range.to);
  const PeakDistribution::Quantile best = quantiles(result.preload, {p}).front();
  result.Y = std::exp(best.log_value);
  result.sampling_error = best.error;
  result.Y_nominal = std::exp(quantiles(optimum, {p}).front().log_value);
  std::vector<double> preloads = {range.from, range.to, result.preload, optimum};
  for (const double x : steps(0, std::log(range.to / range.from), row_step)) {
    const double preload = range.from * std::exp(x);
    if (preload > range.from && preload < range.to * (1 - 1e-12)) preloads.push_back(preload);
  }
  std::sort(preloads.begin(), preloads.end());
  preloads.erase(std::unique(preloads.begin(), preloads.end()), preloads.end());
  for (const double preload : preloads) {
    QuantileRow& row = result.rows.emplace_back(QuantileRow{preload, {}, {}});
    for (const PeakDistribution::Quantile& quantile : quantiles(preload, uncertainty.quantiles)) {
      row.Y.push_back(std::exp(quantile.log_value));
      row.errors.push_back(quantile.error);
    }
  }
  return result;
}

}  // namespace arcslip::problems
