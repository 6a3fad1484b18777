#include "arcslip/problems/ridges/uncertainty.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <map>
#include <memory>
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

PeakDistribution::PeakDistribution(const Uncertainty& uncertainty, Inhomogeneity inhomogeneity) {
  if (uncertainty.samples == 0) throw std::invalid_argument("PeakDistribution: no samples");
  int scattered = 0;
  Uniform uniform(uncertainty.seed);
  const auto logarithms = [&](const Scatter& factor) {
    if (factor.kind != Scatter::Kind::none) ++scattered;
    std::vector<double> numbers = uniform.strata(uncertainty.samples);
    for (double& number : numbers) number = factor.log_quantile(number);
    return numbers;
  };
  const std::vector<double> friction = logarithms(uncertainty.friction);
  const std::vector<double> preload = logarithms(uncertainty.preload);
  const std::vector<double> force = logarithms(uncertainty.force);
  is_stratified_ = scattered <= 1;
  for (std::size_t i = 0; i < uncertainty.samples; ++i) {
    const double scale = inhomogeneity.has_springs ? 0 : force[i];
    const DesignFactors factors{inhomogeneity.grows ? friction[i] - scale : 0, force[i] - scale,
                                inhomogeneity.has_own_friction ? friction[i] : 0};
    const double shift = inhomogeneity.grows ? preload[i] : friction[i] + preload[i] - scale;
    samples_.push_back({shift, scale, factors});
  }
  std::sort(samples_.begin(), samples_.end(),
            [](const Sample& a, const Sample& b) { return a.shift < b.shift; });
}

PeakDistribution PeakDistribution::of_patterns(std::size_t count) {
  Uncertainty plain;
  plain.samples = count;
  PeakDistribution all(plain);
  all.is_stratified_ = false;
  return all;
}

std::vector<DesignFactors> PeakDistribution::factors() const {
  std::vector<DesignFactors> all;
  all.reserve(samples_.size());
  for (const Sample& sample : samples_) all.push_back(sample.factors);
  return all;
}

std::vector<double> PeakDistribution::values(const EnvelopeFamily& envelope, double x) const {
  std::vector<double> values;
  values.reserve(samples_.size());
  EnvelopeFamily::Walk walk(envelope);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& sample = samples_[i];
    values.push_back(sample.scale + walk.at(x + sample.shift, sample.factors, i));
  }
  return values;
}

std::vector<double> PeakDistribution::log_quantiles(const EnvelopeFamily& envelope, double x,
                                                    const std::vector<double>& probabilities) const {
  std::vector<double> all = values(envelope, x);
  std::vector<double> quantiles;
  for (const double probability : probabilities)
    quantiles.push_back(ranked(all, probability * static_cast<double>(all.size())));
  return quantiles;
}

std::vector<PeakDistribution::Quantile> PeakDistribution::quantiles(
    const EnvelopeFamily& envelope, double x, const std::vector<double>& probabilities) const {
  std::vector<double> all = values(envelope, x);
  const auto count = static_cast<double>(all.size());
  std::vector<Quantile> quantiles;
  for (const double p : probabilities) {
    // The strata of one factor alone hold one sample each.
    const double deviation = is_stratified_ ? 1 : std::max(1.0, std::sqrt(count * p * (1 - p)));
    const double below = ranked(all, p * count - deviation);
    const double above = ranked(all, p * count + deviation);
    quantiles.push_back({ranked(all, p * count), 0.5 * (above - below)});
  }
  return quantiles;
}

double PeakDistribution::lowest_quantile(const EnvelopeFamily& envelope, double from, double to,
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

namespace {

/// The preloads that quantiles are told at beside that where one is lowest.
std::vector<double> row_preloads(const PreloadRange& range, double optimum) {
  std::vector<double> preloads = {range.from, range.to, optimum};
  for (const double x : steps(0, std::log(range.to / range.from), row_step)) {
    const double preload = range.from * std::exp(x);
    if (preload > range.from && preload < range.to * (1 - 1e-12)) preloads.push_back(preload);
  }
  return preloads;
}

/// Of several values of a factor the range, as an axis of `count` values if there is more than one.
FactorAxis axis(const std::vector<DesignFactors>& all, double DesignFactors::*factor, std::size_t count) {
  const auto [first, last] = std::minmax_element(
      all.begin(), all.end(),
      [&](const DesignFactors& a, const DesignFactors& b) { return a.*factor < b.*factor; });
  return {(*first).*factor, (*last).*factor, (*first).*factor == (*last).*factor ? 1 : count};
}

/// Envelopes that are made but once.
class Envelopes {
 public:
  Envelopes(const PreloadRange& range, const PeakDistribution& peaks, const EnvelopeOver& envelope_over)
      : from_(range.from * std::exp(peaks.lowest())),
        to_(range.to * std::exp(peaks.highest())),
        envelope_over_(envelope_over) {}

  EnvelopeFamily::Curve operator()(const DesignFactors& factors) {
    EnvelopeFamily::Curve& known = known_[{factors.log_growth, factors.log_force, factors.log_friction}];
    if (known != nullptr) return known;
    const double growth = std::exp(factors.log_growth);
    auto [curve, error] = envelope_over_(factors, from_ * growth, to_ * growth);
    error_ = std::max(error_, error);
    known = std::make_shared<const EnvelopeCurve>(std::move(curve));
    return known;
  }

  double error() const { return error_; }  ///< the largest of all

 private:
  double from_;
  double to_;
  const EnvelopeOver& envelope_over_;
  double error_ = 0;
  std::map<std::array<double, DesignFactors::each().size()>, EnvelopeFamily::Curve> known_;
};

/// How quantiles change from one family to the next.
class Change {
 public:
  void add(const std::vector<PeakDistribution::Quantile>& before,
           const std::vector<PeakDistribution::Quantile>& now) {
    constexpr double part = 0.05;  // of the standard errors
    constexpr double negligible = 1e-4;
    for (std::size_t i = 0; i < now.size(); ++i) {
      sum_ += std::abs(now[i].log_value - before[i].log_value);
      allowed_ += std::max(negligible, part * now[i].error);
    }
  }

  /// A single one may jump where a sample passes an exchange of peaks.
  bool is_small() const { return sum_ <= allowed_; }

 private:
  double sum_ = 0;
  double allowed_ = 0;
};

/// The family that gives quantiles at these preloads as well as the samples do, and one that is coarser,
/// where there is one.
struct Sufficient {
  EnvelopeFamily family;
  std::optional<EnvelopeFamily> coarser = {};
};

Sufficient sufficient_family(const PeakDistribution& peaks, Envelopes& envelopes,
                             const std::vector<double>& preloads, std::vector<double> probabilities) {
  probabilities.push_back(UncertainPeaks::probability);
  const auto make = [&](const DesignFactors& factors) { return envelopes(factors); };
  const std::vector<DesignFactors> each = peaks.factors();
  using Quantiles = std::vector<std::vector<PeakDistribution::Quantile>>;
  Quantiles before;
  std::optional<EnvelopeFamily> coarser;
  for (std::size_t count = 3;; count = 2 * count - 1) {
    EnvelopeFamily::Axes axes;
    std::size_t designs = 1;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      axes[a] = axis(each, DesignFactors::each()[a], count);
      designs *= axes[a].count;
    }
    if (designs > 1 && designs >= each.size()) return {EnvelopeFamily(each, make)};
    EnvelopeFamily family(axes, make);
    if (designs == 1) return {std::move(family)};
    Quantiles now;
    Change change;
    for (std::size_t i = 0; i < preloads.size(); ++i) {
      now.push_back(peaks.quantiles(family, std::log(preloads[i]), probabilities));
      if (coarser) change.add(before[i], now[i]);
    }
    if (coarser && change.is_small()) return {std::move(family), std::move(coarser)};
    coarser = std::move(family);
    before = std::move(now);
  }
}

/// Fills what a distribution tells of the range.
void read_quantiles(const PeakDistribution& peaks, const EnvelopeFamily& family, const PreloadRange& range,
                    double optimum, const std::vector<double>& probabilities, UncertainPeaks& result) {
  const auto quantiles = [&](double preload, const std::vector<double>& of) {
    return peaks.quantiles(family, std::log(preload), of);
  };
  constexpr double p = UncertainPeaks::probability;
  const double lowest = peaks.lowest_quantile(family, std::log(range.from), std::log(range.to), p);
  result.preload = std::clamp(std::exp(lowest), range.from, range.to);
  const PeakDistribution::Quantile best = quantiles(result.preload, {p}).front();
  result.Y = std::exp(best.log_value);
  result.sampling_error = best.error;
  result.Y_nominal = std::exp(quantiles(optimum, {p}).front().log_value);
  std::vector<double> preloads = row_preloads(range, optimum);
  preloads.push_back(result.preload);
  std::sort(preloads.begin(), preloads.end());
  preloads.erase(std::unique(preloads.begin(), preloads.end()), preloads.end());
  for (const double preload : preloads) {
    QuantileRow& row = result.rows.emplace_back(QuantileRow{preload, {}, {}});
    for (const PeakDistribution::Quantile& quantile : quantiles(preload, probabilities)) {
      row.Y.push_back(std::exp(quantile.log_value));
      row.errors.push_back(quantile.error);
    }
  }
}

}  // namespace

UncertainPeaks study_patterns(const PreloadRange& range, const std::vector<EnvelopeFamily::Curve>& rings,
                              const std::vector<double>& quantiles, double optimum) {
  const PeakDistribution peaks = PeakDistribution::of_patterns(rings.size());
  auto next = rings.begin();
  const EnvelopeFamily family(peaks.factors(), [&next](const DesignFactors&) { return *next++; });
  UncertainPeaks result;
  read_quantiles(peaks, family, range, optimum, quantiles, result);
  for (const EnvelopeFamily::Curve& ring : rings) result.error = std::max(result.error, ring->error());
  return result;
}

SystemParameters scaled(SystemParameters system, const DesignFactors& factors) {
  system.preload_growth *= std::exp(factors.log_growth);
  system.force *= std::exp(factors.log_force);
  for (PlacedElement& placed : system.others) {
    for (std::size_t i = 0; i < placed.settings.size(); ++i)
      placed.settings[i] *= std::exp(placed.kind->settings[i].power_of_friction * factors.log_friction);
  }
  return system;
}

UncertainPeaks study_uncertainty(const SystemParameters& system, const PreloadRange& range,
                                 const Uncertainty& uncertainty, const PreloadStudy& nominal,
                                 const continuation::TraceOptions& options) {
  const auto envelope_over = [&](const DesignFactors& factors, double from, double to) {
    PreloadRange wide = range;
    wide.from = from;
    wide.to = to;
    wide.stop_at.clear();
    EnvelopeCurve envelope = study_envelope(scaled(system, factors), wide, envelope_tolerance, options);
    const double error = envelope.error();
    return std::pair(std::move(envelope), error);
  };
  return study_uncertainty(range, uncertainty, {system.preload_growth != 0}, nominal, envelope_over);
}

UncertainPeaks study_uncertainty(const PreloadRange& range, const Uncertainty& uncertainty,
                                 Inhomogeneity inhomogeneity, const PreloadStudy& nominal,
                                 const EnvelopeOver& envelope_over) {
  UncertainPeaks result;
  const PeakDistribution peaks(uncertainty, inhomogeneity);
  result.failure = nominal.failure;
  if (!nominal.optimum) return result;
  const double optimum = nominal.optimum->peak.preload;
  const std::vector<double> preloads = row_preloads(range, optimum);
  std::optional<Sufficient> found;
  try {
    Envelopes envelopes(range, peaks, envelope_over);
    found = sufficient_family(peaks, envelopes, preloads, uncertainty.quantiles);
    result.error = envelopes.error();
  } catch (const std::runtime_error& error) {
    result.failure = error.what();
    return result;
  }

  constexpr double p = UncertainPeaks::probability;
  read_quantiles(peaks, found->family, range, optimum, uncertainty.quantiles, result);
  if (found->coarser) {
    const auto change = [&](double preload, double Y) {
      return std::abs(peaks.log_quantiles(*found->coarser, std::log(preload), {p}).front() - std::log(Y));
    };
    result.error += std::max(change(result.preload, result.Y), change(optimum, result.Y_nominal));
  }
  return result;
}

}  // namespace arcslip::problems
