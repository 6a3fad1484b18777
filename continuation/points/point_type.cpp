#include "arcslip/continuation/points/point_type.hpp"

namespace arcslip::continuation {

std::string_view to_string(PointType type) {
  switch (type) {
    case PointType::regular: return "regular";
    case PointType::start: return "start";
    case PointType::end: return "end";
    case PointType::regime_switch: return "switch";
    case PointType::fold: return "fold";
    case PointType::corner_fold: return "corner_fold";
    case PointType::branch_point: return "branch_point";
    case PointType::hopf: return "hopf";
    case PointType::peak: return "peak";
    case PointType::trough: return "trough";
    case PointType::user: return "user";
    case PointType::event: return "event";
    case PointType::cusp: return "cusp";
    case PointType::bogdanov_takens: return "bogdanov_takens";
    case PointType::zero_hopf: return "zero_hopf";
    case PointType::hopf_hopf: return "hopf_hopf";
    case PointType::neimark_sacker: return "neimark_sacker";
    case PointType::period_doubling: return "period_doubling";
    case PointType::symmetry_breaking: return "symmetry_breaking";
    case PointType::generalized_hopf: return "generalized_hopf";
    case PointType::resonance_1_1: return "resonance_1_1";
    case PointType::resonance_1_2: return "resonance_1_2";
    case PointType::resonance_1_3: return "resonance_1_3";
    case PointType::resonance_1_4: return "resonance_1_4";
    case PointType::chenciner: return "chenciner";
    case PointType::generalized_period_doubling: return "generalized_period_doubling";
    case PointType::fold_flip: return "fold_flip";
    case PointType::fold_neimark_sacker: return "fold_neimark_sacker";
    case PointType::flip_neimark_sacker: return "flip_neimark_sacker";
    case PointType::double_neimark_sacker: return "double_neimark_sacker";
    case PointType::isola_centre: return "isola_centre";
    case PointType::simple_bifurcation: return "simple_bifurcation";
  }
  return "";
}

std::optional<PointType> point_type(std::string_view name) {
  for (int i = 0; i <= static_cast<int>(PointType::simple_bifurcation); ++i) {
    if (to_string(static_cast<PointType>(i)) == name) return static_cast<PointType>(i);
  }
  return std::nullopt;
}

}  // namespace arcslip::continuation
