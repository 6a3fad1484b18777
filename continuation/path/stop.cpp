#include "arcslip/continuation/path/stop.hpp"

namespace arcslip::continuation {

std::string_view to_string(Stop stop) {
  switch (stop) {
    case Stop::reached_end: return "reached_end";
    case Stop::closed_loop: return "closed_loop";
    case Stop::own_image: return "own_image";
    case Stop::requested: return "requested";
    case Stop::left_range: return "left_range";
    case Stop::left_regime: return "left_regime";
    case Stop::infinite_period: return "infinite_period";
    case Stop::unbounded: return "unbounded";
    case Stop::max_points: return "max_points";
    case Stop::time_limit: return "time_limit";
    case Stop::interrupted: return "interrupted";
    case Stop::no_value: return "no_value";
    case Stop::min_step: return "min_step";
    case Stop::asymptotic: return "asymptotic";
    case Stop::repeats: return "repeats";
    case Stop::grazing_border: return "grazing_border";
    case Stop::no_start: return "no_start";
  }
  return "";
}

std::optional<Stop> stop_named(std::string_view name) {
  for (int i = 0; i <= static_cast<int>(Stop::no_start); ++i) {
    if (name == to_string(static_cast<Stop>(i))) return static_cast<Stop>(i);
  }
  return std::nullopt;
}

bool is_end(Stop stop) {
  return stop == Stop::reached_end || stop == Stop::left_range || stop == Stop::closed_loop ||
         stop == Stop::own_image || stop == Stop::requested || stop == Stop::left_regime ||
         stop == Stop::infinite_period;
}

bool is_unfinished(Stop stop) { return stop == Stop::interrupted || stop == Stop::time_limit; }

}  // namespace arcslip::continuation
