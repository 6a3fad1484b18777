// Peaks under scatter: closed forms, level sets of the envelope, and responses traced one by one.

#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <functional>

#include "arcslip/problems/ridges/uncertainty.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"

using namespace arcslip;
using namespace arcslip::problems;
using namespace arcslip::testing;

namespace {

const boost::math::normal gauss;

Scatter lognormal(double deviation) { return {Scatter::Kind::lognormal, deviation, 1, 1}; }
Scatter uniform(double low, double high) { return {Scatter::Kind::uniform, 0, low, high}; }

/// A line from one x to another.
EnvelopePiece line(double from, double to, double value, double slope) {
  return {{from, value, slope}, {to, value + slope * (to - from), slope}};
}

/// |x|: two peaks that change places at x = 0.
EnvelopeCurve wedge() {
  return EnvelopeCurve(std::vector<EnvelopePiece>{line(-30, 0, 30, -1), line(0, 30, 0, 1)});
}

Uncertainty of_friction(double deviation, std::size_t samples) {
  Uncertainty uncertainty;
  uncertainty.friction = lognormal(deviation);
  uncertainty.samples = samples;
  return uncertainty;
}

double quantile(const PeakDistribution& peaks, const EnvelopeCurve& envelope, double x, double probability) {
  return peaks.log_quantiles(envelope, x, {probability}).front();
}

/// The value below which a monotone distribution function reaches p.
double inverse(const std::function<double(double)>& distribution, double p, double low, double high) {
  std::uintmax_t iterations = 200;
  const auto bracket =
      boost::math::tools::toms748_solve([&](double v) { return distribution(v) - p; }, low, high,
                                        boost::math::tools::eps_tolerance<double>(40), iterations);
  return 0.5 * (bracket.first + bracket.second);
}

/// Probability that envelope(x + deviation Z) <= value, Z standard normal, by the ends of the intervals in
/// which that holds.
double probability_below(const EnvelopeCurve& envelope, double x, double deviation, double value) {
  constexpr int cells = 4000;
  constexpr double widest = 5;
  const auto excess = [&](double z) { return envelope.at(x + deviation * z) - value; };
  double total = 0;
  double entered = -widest;
  double last = excess(-widest);
  for (int i = 1; i <= cells; ++i) {
    const double z = -widest + 2 * widest * i / cells;
    const double next = excess(z);
    if ((next > 0) != (last > 0)) {
      std::uintmax_t iterations = 100;
      const auto [a, b] =
          boost::math::tools::toms748_solve(excess, z - 2 * widest / cells, z, last, next,
                                            boost::math::tools::eps_tolerance<double>(40), iterations);
      if (next > 0) total += cdf(gauss, a) - cdf(gauss, entered);
      entered = b;
    }
    last = next;
  }
  return last > 0 ? total : total + cdf(gauss, widest) - cdf(gauss, entered);
}

/// The beams of figure 8 near their lower two resonances.
PreloadRange window(double from, double to) {
  PreloadRange range;
  range.from = from;
  range.to = to;
  range.eta_low = 0.5;
  range.eta_high = 6;
  return range;
}

const EnvelopeCurve& figure_8_envelope() {
  static const EnvelopeCurve envelope = study_envelope(figure_8(1), window(0.3, 4), 1e-6);
  return envelope;
}

/// ln of the highest peak of a response traced over eta.
double traced_peak(double force, double preload) {
  SystemParameters system = figure_8(preload);
  system.force = force;
  const ForcedResponse problem(build_system(system));
  double highest = 0;
  for (const auto& peak : of_type(trace_over_eta(problem, preload, 0.5, 6), continuation::PointType::peak))
    highest = std::max(highest, quantity(problem, peak, ForcedResponse::Y));
  return std::log(highest);
}

}  // namespace

// ---- The envelope ----

TEST_CASE("An envelope curve is the highest of its pieces, cubic between their ends", "[uncertainty]") {
  const EnvelopeCurve curve = wedge();
  for (const double x : {-30.0, -7.3, -1e-9, 0.0, 2.5, 30.0})
    CHECK_THAT(curve.at(x), WithinAbs(std::abs(x), 1e-13));  // rounding of values of 30
  const EnvelopePiece cubic{{1, 1, 3}, {2, 8, 12}};          // x^3
  CHECK_THAT(cubic.at(1.7), WithinRel(1.7 * 1.7 * 1.7, 1e-14));

  // One peak is the highest at both of its points, another one at both of its own between these.
  const EnvelopeCurve two(
      std::vector<EnvelopePiece>{line(0, 1, 0, 0), line(1, 2, 0, -1), line(1, 2, 0, 1), line(2, 3, 1, 0)});
  CHECK_THAT(two.at(1.5), WithinRel(0.5, 1e-14));
  EnvelopeCurve::Walk walk(two);
  for (const double x : {0.0, 0.5, 1.0, 1.25, 1.5, 2.0, 2.9, 3.0}) CHECK(walk.at(x) == two.at(x));

  using Pieces = std::vector<EnvelopePiece>;
  CHECK_THROWS_WITH(EnvelopeCurve(Pieces{line(0, 1, 0, 0), line(2, 3, 0, 0)}), ContainsSubstring("a gap"));
  CHECK_THROWS_WITH(EnvelopeCurve(Pieces{line(1, 1, 0, 0)}), ContainsSubstring("without length"));
  CHECK_THROWS_WITH(EnvelopeCurve(Pieces{}), ContainsSubstring("no pieces"));
  PreloadStudy failed;
  failed.failure = "no step";
  CHECK_THROWS_WITH(EnvelopeCurve(failed), ContainsSubstring("no step"));
}

TEST_CASE("Points of a peak that lie together are one point of its envelope", "[uncertainty]") {
  const auto height = [](double x) { return 0.2 * std::sin(2 * x); };
  const auto point = [&](double preload, PeakSite site) {
    Peak peak;
    peak.preload = preload;
    peak.Y = std::exp(height(std::log(preload)));
    peak.sensitivity.preload = 0.4 * std::cos(2 * std::log(preload));
    peak.site = site;
    peak.is_global = true;
    return peak;
  };
  const auto after = [](double preload, int places) {
    for (int i = 0; i < places; ++i) preload = std::nextafter(preload, 100.0);
    return preload;
  };
  // Beside a point within the curve, the last of a site, the first of the next one and the end; where P is
  // large one double has the logarithm of the next.
  const int places = GENERATE(1, 3, 1000, 100000);
  PeakBranch study;
  for (int i = 0; i <= 40; ++i) {
    const double preload = 10 * std::exp(0.02 * i);
    const PeakSite site = i <= 20 ? PeakSite::slip : PeakSite::corner;
    const bool before = i == 20 || i == 40;
    if (before) study.push_back(point(preload * (1 - 1e-16 * places), site));
    study.push_back(point(preload, site));
    if (i == 10 || i == 20) study.push_back(point(after(preload, places), i == 20 ? PeakSite::corner : site));
  }
  PreloadStudy whole;
  whole.branches = {study};
  const EnvelopeCurve curve(whole);
  for (double x = curve.from(); x < curve.to(); x += 0.003)
    CHECK_THAT(curve.at(x), WithinAbs(height(x), 2e-6));
  CHECK(curve.error() < 1e-5);
  CHECK(curve.places_wanted(1e-9).size() < 1000);
}

TEST_CASE("The envelope of figure 8 is that of responses traced one by one, within its own error",
          "[uncertainty]") {
  const EnvelopeCurve& envelope = figure_8_envelope();
  CHECK(envelope.error() > 1e-9);
  CHECK(envelope.error() <= 1e-6);
  CHECK(EnvelopeCurve(study_preload(figure_8(1), window(0.3, 4))).error() >
        1e-3);  // hence the further points
  for (const double preload : {0.31, 0.57, 0.77, 0.802, 0.847, 0.91, 1.0413, 1.3, 1.8348, 2.2, 3.97}) {
    INFO(preload);
    CHECK_THAT(envelope.at(std::log(preload)), WithinAbs(traced_peak(1, preload), envelope.error()));
  }
}

TEST_CASE("The peak of a damper with factors on friction, preload and force is f Y_max(P m q/f)",
          "[uncertainty]") {
  for (const auto& [m, q, f] : {std::array{0.8, 1.3, 1.1}, {1.2, 0.7, 0.6}, {1, 1, 1.5}}) {
    const double scaled = m * q / f;
    CHECK_THAT(traced_peak(f, m * q), WithinAbs(std::log(f) + traced_peak(1, scaled), 1e-8));
    CHECK_THAT(traced_peak(f, m * q), WithinAbs(std::log(f) + figure_8_envelope().at(std::log(scaled)),
                                                figure_8_envelope().error()));
  }
}

// ---- The distribution ----

TEST_CASE("Factors have the median and the limits that are asked for", "[uncertainty]") {
  CHECK(Scatter{}.log_quantile(0.3) == 0);
  CHECK_THAT(lognormal(0.2).log_quantile(0.95), WithinRel(0.2 * 1.6448536269514722, 1e-14));
  CHECK_THAT(lognormal(0.2).log_quantile(0.5), WithinAbs(0, 1e-16));
  CHECK_THAT(uniform(0.8, 1.25).log_quantile(0.5), WithinRel(std::log(1.025), 1e-14));
  CHECK_THAT(uniform(0.8, 1.25).log_quantile(1e-15), WithinRel(std::log(0.8), 1e-13));
}

TEST_CASE("The same seed gives the same samples with every standard library", "[uncertainty]") {
  // The first number of the 64-bit Mersenne Twister from its default seed, which its authors publish, is in
  // the lowest stratum.
  constexpr std::uint64_t first = 14514284786278117030U;
  Uncertainty uncertainty = of_friction(0.2, 1000);
  uncertainty.seed = 5489;
  const double u = static_cast<double>(first >> 11) * 0x1p-53 / 1000;
  CHECK_THAT(PeakDistribution(uncertainty).lowest(), WithinRel(0.2 * boost::math::quantile(gauss, u), 1e-12));
  const double same = quantile(PeakDistribution(uncertainty), wedge(), 0.1, 0.9);
  CHECK(quantile(PeakDistribution(uncertainty), wedge(), 0.1, 0.9) == same);
  uncertainty.seed = 5490;
  CHECK(quantile(PeakDistribution(uncertainty), wedge(), 0.1, 0.9) != same);
}

TEST_CASE("Quantiles differ from seed to seed by the error that they are told with, at a cliff too",
          "[uncertainty]") {
  // A cliff of slope -20 that 5 % of the samples are beyond, and next to it a gentle rise.
  const EnvelopeCurve envelope(std::vector<EnvelopePiece>{line(-9, 0, 180, -20), line(0, 9, 0, 0.5)});
  Uncertainty uncertainty = of_friction(0.2, 400);
  uncertainty.preload = uniform(0.8, 1.25);
  uncertainty.force = lognormal(0.1);
  for (const double x : {0.35, 1.5}) {
    double sum = 0;
    double squares = 0;
    double told = 0;
    constexpr int seeds = 200;
    for (int seed = 0; seed < seeds; ++seed) {
      uncertainty.seed = static_cast<std::uint64_t>(seed);
      const auto quantile = PeakDistribution(uncertainty).quantiles(envelope, x, {0.95}).front();
      sum += quantile.log_value;
      squares += std::pow(quantile.log_value, 2);
      told += quantile.error / seeds;
    }
    const double deviation = std::sqrt(squares / seeds - std::pow(sum / seeds, 2));
    INFO("x = " << x << ": " << deviation << ", told " << told);
    // A Latin hypercube does better than random numbers, least where one quantile has to do with all factors.
    CHECK(deviation < 1.2 * told);
    CHECK(deviation > 0.3 * told);
  }
}

TEST_CASE("Quantiles of a power law under one lognormal factor lie in their stratum", "[uncertainty]") {
  const auto [samples, p] =
      GENERATE(table<std::size_t, double>({{10, 0.5}, {999, 0.95}, {1000, 0.05}, {7, 0.999}}));
  const double slope = 1.7;
  const EnvelopeCurve envelope(std::vector<EnvelopePiece>{line(-9, 9, 0, slope)});
  const PeakDistribution peaks(of_friction(0.3, samples));
  const double rank = std::ceil(p * static_cast<double>(samples));
  const auto at = [&](double position) {
    const double u = position / static_cast<double>(samples);
    return slope * (0.4 + (u >= 1 ? INFINITY : 0.3 * boost::math::quantile(gauss, std::max(u, 1e-300))));
  };
  const double origin = -9 * slope;  // the line starts with the value 0 at x = -9
  const double value = quantile(peaks, envelope, 0.4, p) + origin;
  CHECK(value > at(rank - 1));
  CHECK(value < at(rank));
}

TEST_CASE("Quantiles of a power law under three factors are those of one lognormal", "[uncertainty]") {
  // ln Y = b x: ln of the peak is (1 - b) ln f + b (x + ln m + ln q), normal with this variance.
  const double b = -0.6;
  const EnvelopeCurve envelope(std::vector<EnvelopePiece>{line(-9, 9, -9 * b, b)});
  Uncertainty uncertainty;
  uncertainty.friction = lognormal(0.2);
  uncertainty.preload = lognormal(0.1);
  uncertainty.force = lognormal(0.3);
  uncertainty.samples = 4000;
  const double deviation = std::sqrt(1.6 * 1.6 * 0.09 + b * b * (0.04 + 0.01));
  const PeakDistribution peaks(uncertainty);
  for (const double p : {0.05, 0.5, 0.95}) {
    const double z = boost::math::quantile(gauss, p);
    // Five standard errors of an order statistic of independent samples; strata make it smaller.
    const double tolerance = 5 * deviation * std::sqrt(p * (1 - p) / 4000) / pdf(gauss, z);
    CHECK_THAT(quantile(peaks, envelope, 0.7, p), WithinAbs(0.7 * b + deviation * z, tolerance));
  }
}

TEST_CASE("Quantiles with two exchanging peaks are those of the folded normal distribution",
          "[uncertainty]") {
  constexpr std::size_t samples = 500;
  const double deviation = 0.2;
  const PeakDistribution peaks(of_friction(deviation, samples));
  for (const double x : {-0.35, -0.04, 0.0, 0.1}) {
    for (const double p : {0.05, 0.5, 0.95}) {
      const auto exact = [&](double at) {
        return inverse(
            [&](double v) { return cdf(gauss, (v - x) / deviation) - cdf(gauss, (-v - x) / deviation); }, at,
            0, 5);
      };
      // |x + s Z| <= v is one interval, whose ends each cut one stratum; one more for the rank.
      const double value = quantile(peaks, wedge(), x, p);
      CHECK(value > exact(p - 3.0 / samples));
      CHECK(value < exact(p + 3.0 / samples));
    }
  }
}

TEST_CASE("Quantiles of figure 8 under scattered friction are those of the envelope's level sets",
          "[uncertainty]") {
  constexpr std::size_t samples = 1000;
  const double deviation = 0.1;
  const EnvelopeCurve& envelope = figure_8_envelope();
  const PeakDistribution peaks(of_friction(deviation, samples));
  for (const double preload : {0.7, 1.0413, 1.9}) {
    const double x = std::log(preload);
    for (const double p : {0.05, 0.5, 0.95}) {
      INFO("P = " << preload << ", p = " << p);
      const double value = quantile(peaks, envelope, x, p);
      // Three intervals at most, whose ends each cut one stratum; one more for the rank.
      CHECK_THAT(probability_below(envelope, x, deviation, value), WithinAbs(p, 7.0 / samples));
    }
  }
}

TEST_CASE("The preload at which a quantile is lowest is found, of several minima the lowest",
          "[uncertainty]") {
  // By symmetry at the exchange of the wedge; the sampled quantile has its minimum within a few strata.
  const PeakDistribution peaks(of_friction(0.2, 2000));
  const double found = peaks.lowest_quantile(wedge(), -1, 2, 0.95);
  CHECK_THAT(found, WithinAbs(0, 0.01));
  CHECK_THAT(quantile(peaks, wedge(), found, 0.95),
             WithinRel(0.2 * boost::math::quantile(gauss, 0.975), 0.01));
  CHECK(peaks.lowest_quantile(wedge(), 0.5, 2, 0.95) == 0.5);  // an end of the range

  // Two wedges: a deep narrow one at x = -2, a shallow wide one at x = 1. Scatter fills the narrow one.
  const EnvelopeCurve valleys(std::vector<EnvelopePiece>{line(-9, -2, 69.5, -10), line(-2, -1.9, -0.5, 10),
                                                         line(-1.9, 1, 0.5, -0.1), line(1, 9, 0.21, 1)});
  const PeakDistribution narrow(of_friction(0.005, 500));
  const PeakDistribution wide(of_friction(0.2, 500));
  CHECK_THAT(narrow.lowest_quantile(valleys, -4, 4, 0.95), WithinAbs(-2, 0.005));
  CHECK(wide.lowest_quantile(valleys, -4, 4, 0.95) > 0);
}

// ---- Studies ----

TEST_CASE("Without scatter every quantile is the peak and the robust preload is the optimum",
          "[uncertainty]") {
  const PreloadRange range = window(0.8, 1.5);
  const PreloadStudy nominal = study_preload(figure_8(1), range);
  Uncertainty certain;
  certain.samples = 1;
  const UncertainPeaks peaks = study_uncertainty(figure_8(1), range, certain, nominal);
  REQUIRE(peaks.failure.empty());
  REQUIRE(nominal.optimum);
  CHECK_THAT(peaks.Y, WithinRel(nominal.optimum->peak.Y, 1e-6));
  CHECK_THAT(peaks.preload, WithinRel(nominal.optimum->peak.preload, 1e-3));  // Y is stationary there
  const EnvelopeCurve envelope = study_envelope(figure_8(1), range, 1e-7);
  CHECK(peaks.rows.front().preload == range.from);
  CHECK(peaks.rows.back().preload == range.to);
  for (const QuantileRow& row : peaks.rows) {
    for (const double Y : row.Y)
      CHECK_THAT(std::log(Y), WithinAbs(envelope.at(std::log(row.preload)), peaks.error + envelope.error()));
  }
}

TEST_CASE("The robust preload of figure 8 has a lower 95 % quantile than the optimum and its neighbours",
          "[uncertainty]") {
  const PreloadRange range = window(0.5, 3);
  const PreloadStudy nominal = study_preload(figure_8(1), range);
  Uncertainty uncertainty;
  uncertainty.friction = lognormal(0.2);
  uncertainty.preload = uniform(0.8, 1.25);
  uncertainty.force = lognormal(0.05);
  uncertainty.samples = 500;
  const UncertainPeaks peaks = study_uncertainty(figure_8(1), range, uncertainty, nominal);
  REQUIRE(peaks.failure.empty());
  CHECK(peaks.Y < 0.5 * peaks.Y_nominal);  // left of the optimum the peak rises steeply
  CHECK(peaks.preload > 1.1 * nominal.optimum->peak.preload);
  CHECK(peaks.error <= 1e-6);
  for (const QuantileRow& row : peaks.rows) {
    CHECK(std::is_sorted(row.Y.begin(), row.Y.end()));
    CHECK(row.Y.back() >= peaks.Y);
  }
  const auto highest_at = [&](double preload) {
    const auto row = std::find_if(peaks.rows.begin(), peaks.rows.end(),
                                  [&](const QuantileRow& one) { return one.preload == preload; });
    return row == peaks.rows.end() ? 0 : row->Y.back();
  };
  CHECK(highest_at(peaks.preload) == peaks.Y);
  CHECK(highest_at(nominal.optimum->peak.preload) == peaks.Y_nominal);
}

TEST_CASE("A study that failed has no quantiles", "[uncertainty]") {
  PreloadStudy failed;
  failed.failure = "lost";
  CHECK(study_uncertainty(figure_8(1), window(1, 1.2), of_friction(0.1, 10), failed).failure == "lost");
}
