#include "arcslip/problems/ridges/border_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "arcslip/problems/ridges/response_slopes.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::problems {
namespace {

enum Slope : std::size_t { stuck, slipping, ratio };
using Slopes = std::array<double, 3>;

Slopes slopes_at(const FrictionSystem& system, double eta) {
  const ResponseSlopes border = ResponseSlopes::on_border(system, eta);
  const AmplitudeSlopes stick = border.by_eta();
  return {stick.log_Y, border.slipping().by_eta().log_Y, stick.log_ratio};
}

struct Sample {
  double eta;
  Slopes slopes;
};

class Scan {
 public:
  Scan(const FrictionSystem& system, const std::vector<double>& etas) : system_(system) {
    for (const double eta : etas) {
      const Sample next{eta, slopes_at(system, eta)};
      if (!samples_.empty()) refine(Sample(samples_.back()), next, 0);
      samples_.push_back(next);
    }
  }

  std::vector<BorderPlace> places() const {
    std::vector<BorderPlace> found;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      found.push_back({samples_[i].eta});
      for (std::size_t k = 0; i + 1 < samples_.size() && k < 3; ++k) add_zero(i, k, found);
    }
    return found;
  }

 private:
  /// A resonance's slope from minus to plus infinity, from -1 to 1.
  static double bounded(const Sample& at, std::size_t k) {
    const double slope = at.eta * at.slopes[k];
    return slope / (1 + std::abs(slope));
  }

  void refine(const Sample& from, const Sample& to, int depth) {
    constexpr int deepest = 12;
    constexpr double close = 0.05;
    const double eta = 0.5 * (from.eta + to.eta);
    if (!(eta > from.eta && eta < to.eta)) return;
    const Sample middle{eta, slopes_at(system_, eta)};
    double worst = 0;
    for (std::size_t k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(bounded(middle, k) - 0.5 * (bounded(from, k) + bounded(to, k))));
    const bool split = worst > close && depth < deepest;
    if (split) refine(from, middle, depth + 1);
    samples_.push_back(middle);
    if (split) refine(middle, to, depth + 1);
  }

  void add_zero(std::size_t i, std::size_t k, std::vector<BorderPlace>& found) const {
    const Sample& a = samples_[i];
    const Sample& b = samples_[i + 1];
    const bool falls = a.slopes[k] > 0;
    if (falls == (b.slopes[k] > 0)) return;
    const auto slope = [&](double eta) { return slopes_at(system_, eta)[k]; };
    const double eta = zero_between(slope, a.eta, b.eta, a.slopes[k], b.slopes[k], 52);
    found.push_back({eta, true, k == stuck && falls, k == slipping});
  }

  const FrictionSystem& system_;
  std::vector<Sample> samples_;
};

}  // namespace

std::vector<BorderPlace> scan_border(const FrictionSystem& system, std::vector<double> etas,
                                     const std::vector<double>& marks) {
  etas.insert(etas.end(), marks.begin(), marks.end());
  std::sort(etas.begin(), etas.end());
  etas.erase(std::unique(etas.begin(), etas.end()), etas.end());
  std::vector<BorderPlace> places = Scan(system, etas).places();
  for (BorderPlace& place : places)
    place.is_mark = place.is_mark || std::count(marks.begin(), marks.end(), place.eta) > 0;
  std::stable_sort(places.begin(), places.end(),
                   [](const BorderPlace& a, const BorderPlace& b) { return a.eta < b.eta; });
  return places;
}

}  // namespace arcslip::problems
