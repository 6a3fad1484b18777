#include "arcslip/continuation/branch.hpp"

namespace arcslip::continuation {

std::string_view to_string(PointType type) {
  switch (type) {
    case PointType::regular: return "regular";
    case PointType::start: return "start";
    case PointType::end: return "end";
    case PointType::regime_switch: return "switch";
    case PointType::fold: return "fold";
    case PointType::peak: return "peak";
    case PointType::trough: return "trough";
    case PointType::user: return "user";
  }
  return "";
}

std::string_view to_string(Stop stop) {
  switch (stop) {
    case Stop::reached_end: return "reached_end";
    case Stop::left_range: return "left_range";
    case Stop::max_points: return "max_points";
    case Stop::min_step: return "min_step";
    case Stop::interrupted: return "interrupted";
    case Stop::no_start: return "no_start";
    case Stop::grazing_border: return "grazing_border";
  }
  return "";
}

}  // namespace arcslip::continuation
