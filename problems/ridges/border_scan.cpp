#include "arcslip/problems/ridges/border_scan.hpp"

#include <algorithm>
#include <limits>

#include "arcslip/problems/ridges/response_slopes.hpp"
#include "arcslip/problems/ridges/slope_scan.hpp"

namespace arcslip::problems {

std::vector<BorderPlace> scan_border(const FrictionSystem& system, std::vector<double> etas,
                                     const std::vector<double>& marks) {
  enum Slope : std::size_t { stuck, slipping, ratio };
  etas.insert(etas.end(), marks.begin(), marks.end());
  std::sort(etas.begin(), etas.end());
  etas.erase(std::unique(etas.begin(), etas.end()), etas.end());
  const auto at = [&](double eta) {
    const ResponseSlopes border = ResponseSlopes::on_border(system, eta);
    const AmplitudeSlopes stick = border.by_eta();
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return std::array<ValueAndSlope, 3>{{{border.log_Y(), stick.log_Y},
                                         {unknown, border.slipping().by_eta().log_Y},
                                         {unknown, stick.log_ratio}}};
  };
  const SlopeScan<3, decltype(at)> scan(etas, at);
  std::vector<BorderPlace> places;
  for (std::size_t i = 0; i < scan.samples().size(); ++i) {
    places.push_back({scan.samples()[i].eta});
    for (const Slope k : {stuck, slipping, ratio}) {
      if (const auto zero = scan.zero_behind(i, k))
        places.push_back({zero->eta, true, k == stuck && zero->falls, k == slipping});
    }
  }
  for (BorderPlace& place : places)
    place.is_mark = place.is_mark || std::count(marks.begin(), marks.end(), place.eta) > 0;
  std::stable_sort(places.begin(), places.end(),
                   [](const BorderPlace& a, const BorderPlace& b) { return a.eta < b.eta; });
  return places;
}

}  // namespace arcslip::problems
