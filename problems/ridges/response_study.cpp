#include "arcslip/problems/ridges/response_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

namespace arcslip::problems {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double equally_high = 1e-9;  // of ln Y: peaks that are both the highest

/// What is read of the observables at a peak.
class Readings {
 public:
  Readings(const continuation::Problem& problem, const StudiedContacts& contacts)
      : problem_(problem), names_(continuation::observable_names(problem)), contacts_(contacts) {
    eta_ = continuation::index_of(problem.parameter_names(), "eta");
    preload_ = continuation::index_of(problem.parameter_names(), "P");
    ratio_ = continuation::index_of(names_, "R_over_S");
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i].starts_with("dissipated")) losses_.push_back(static_cast<Index>(i));
    }
    for (const std::string& name : contacts.others)
      energies_.push_back(continuation::index_of(names_, "energy_" + name));
  }

  Peak peak(const ResponsePeak& found) {
    problem_.observe(found.at.unknowns, found.at.parameters, found.at.regime, values_);
    Peak peak;
    peak.eta = found.place;
    peak.preload = found.at.parameters(preload_);
    peak.Y = std::exp(found.log_height);
    peak.R_over_S = values_(ratio_);
    peak.dissipated = values_(losses_.front());
    const auto is_lost = [&](Index i) { return values_(i) > 0; };
    const bool slips = std::any_of(losses_.begin(), losses_.end(), is_lost) ||
                       std::any_of(energies_.begin(), energies_.end(), is_lost);
    peak.site = slips ? PeakSite::slip : PeakSite::stick;
    if (found.site == ResponsePeakSite::corner) peak.site = PeakSite::corner;
    if (found.site == ResponsePeakSite::edge) peak.site = PeakSite::edge;
    const double by_mu = contacts_.is_by_load ? found.slope * load(peak) / peak.preload : unknown;
    peak.sensitivity = {found.slope, by_mu, contacts_.is_homogeneous ? 1 - by_mu : unknown, unknown, unknown};
    return peak;
  }

  /// Lost per cycle in all nodes at the peak that was read last.
  double energy(const Peak& peak) const {
    double sum = 0;
    for (std::size_t i = 0; i < contacts_.contacts.size() && i < losses_.size(); ++i) {
      const double S = contacts_.contacts[i].slip_per_preload * load(peak);
      sum += contacts_.contacts[i].stiffness * S * S * values_(losses_[i]);
    }
    for (const Index i : energies_) sum += values_(i);
    return contacts_.nodes * sum;
  }

 private:
  double load(const Peak& peak) const {
    return peak.preload + contacts_.preload_growth * peak.eta * peak.eta;
  }

  const continuation::Problem& problem_;
  std::vector<std::string> names_;
  const StudiedContacts& contacts_;
  Index eta_, preload_, ratio_;
  std::vector<Index> losses_;    // of the contacts in their order
  std::vector<Index> energies_;  // of the elements beside them
  Vector values_;
};

/// Each peak of each sample, chained with that of the sample before it that it goes on from.
class Ridges {
 public:
  Ridges(const HighestPeak& highest, const PreloadRange& range, const HighestPeak::Lowest& lowest)
      : samples_(highest.samples()), range_(range), lowest_(lowest) {}

  std::vector<PeakBranch> branches(Readings& readings) const {
    std::vector<PeakBranch> all;
    std::vector<std::size_t> of_last;  // the branch of each peak of the last sample
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const PeakSample& sample = samples_[s];
      std::vector<std::size_t> branch_of(sample.peaks.size(), samples_.size() * samples_.size());
      std::vector<bool> goes_on(sample.peaks.size(), false);
      if (s > 0) {
        for (const auto& [i, k] : joined_peaks(samples_[s - 1], sample)) {
          branch_of[k] = of_last[i];
          goes_on[k] = true;
        }
      }
      for (std::size_t k = 0; k < sample.peaks.size(); ++k) {
        if (!goes_on[k]) {
          branch_of[k] = all.size();
          all.emplace_back();
        }
        Peak peak = readings.peak(sample.peaks[k]);
        peak.is_global = is_highest(sample, k);
        peak.type = type_of(s, k, goes_on[k]);
        all[branch_of[k]].push_back(peak);
      }
      of_last = std::move(branch_of);
    }
    for (PeakBranch& branch : all) {
      Peak& last = branch.back();
      if (last.preload != range_.to && last.type == PeakType::regular) last.type = PeakType::death;
    }
    return all;
  }

 private:
  static bool is_highest(const PeakSample& sample, std::size_t k) {
    return sample.peaks[k].log_height >= sample.highest().log_height - equally_high;
  }

  PeakType type_of(std::size_t s, std::size_t k, bool goes_on) const {
    const PeakSample& sample = samples_[s];
    const bool is_optimum = sample.x == lowest_.x && is_highest(sample, k);
    if (is_optimum) return PeakType::optimum;
    if (s == 0) return PeakType::start;
    if (s + 1 == samples_.size()) return PeakType::end;
    const bool is_exchange =
        is_highest(sample, k) &&
        std::count_if(sample.peaks.begin(), sample.peaks.end(), [&](const ResponsePeak& peak) {
          return peak.log_height >= sample.highest().log_height - equally_high;
        }) > 1;
    if (is_exchange) return PeakType::exchange;
    if (!goes_on) return PeakType::birth;
    const std::vector<double>& listed = range_.stop_at;
    return std::count(listed.begin(), listed.end(), sample.value) > 0 ? PeakType::user : PeakType::regular;
  }

  const std::vector<PeakSample>& samples_;
  const PreloadRange& range_;
  const HighestPeak::Lowest& lowest_;
};

}  // namespace

PreloadStudy study_response(ResponsePeaks& responses, const PreloadRange& range,
                            const StudiedContacts& contacts, const StudyPrecision& precision) {
  PreloadStudy study;
  try {
    HighestPeak highest(responses, range.from, range.to, range.stop_at, precision.looks);
    const HighestPeak::Lowest lowest = highest.lowest(precision.range);
    constexpr std::size_t most_samples = 300;
    if (precision.envelope > 0) highest.refine(precision.envelope, most_samples);
    if (precision.looks == HighestPeak::Looks::whole) highest.settle_exchanges();
    Readings readings(*responses.response().problem, contacts);
    study.branches = Ridges(highest, range, lowest).branches(readings);
    const PeakSample& sample = highest.sample(lowest.x);
    Optimum optimum;
    optimum.kind = lowest.kind;
    if (lowest.other) optimum.other = readings.peak(sample.peaks[*lowest.other]);
    optimum.peak = readings.peak(sample.peaks[lowest.peak]);
    optimum.peak.type = PeakType::optimum;
    optimum.peak.is_global = true;
    optimum.energy = readings.energy(optimum.peak);
    optimum.damping = unknown;
    optimum.low = highest.value(lowest.low);
    optimum.high = highest.value(lowest.high);
    study.optimum = optimum;
  } catch (const std::bad_alloc&) {
    throw;  // no property of the system
  } catch (const std::exception& error) {
    study.failure = error.what();
  }
  return study;
}

}  // namespace arcslip::problems
