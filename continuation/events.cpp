#include "arcslip/continuation/events.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

namespace arcslip::continuation {
namespace {

int sign_of(double value) { return (value > 0) - (value < 0); }

struct Zero {
  enum class State { found, absent, failed };
  State state;
  double s = 0;
};

/// A function of the branch within the step: positive before its zero and negative behind it, or the other
/// way round.
struct Bracket {
  double upper;     ///< the zero lies in (0, upper)
  double at_zero;   ///< value at 0; noise if another zero has just been located there
  int before;       ///< sign before the zero
  double at_upper;  ///< of the other sign
};

/// Locates the zero. Where the value at 0 may be noise, a point that shows the sign before the zero is looked
/// for.
template <class Function>
Zero locate(Stepper& stepper, const Bracket& bracket, Function f) {
  bool solved = true;
  const auto along = [&](double s) {
    solved = solved && stepper.probe(s);
    return solved ? f(stepper) : 0.0;
  };
  double lower = 0;
  double at_lower = bracket.at_zero;
  if (sign_of(at_lower) != bracket.before || std::abs(at_lower) < 0.01 * std::abs(bracket.at_upper)) {
    double s = 0.5 * bracket.upper;
    double value = along(s);
    while (solved && sign_of(value) != bracket.before && s > 1e-12 * bracket.upper) value = along(s *= 0.5);
    if (!solved) return {Zero::State::failed};
    if (sign_of(value) == bracket.before) {
      lower = s;
      at_lower = value;
    } else if (sign_of(at_lower) != bracket.before) {
      return {Zero::State::absent};
    }
  }
  const auto close = [&](double a, double b) { return std::abs(b - a) <= 1e-14 * bracket.upper; };
  std::uintmax_t iterations = 100;
  const auto [a, b] = boost::math::tools::toms748_solve(along, lower, bracket.upper, at_lower,
                                                        bracket.at_upper, close, iterations);
  const double at_a = a > lower ? std::abs(along(a)) : std::abs(at_lower);
  const double at_b = std::abs(along(b));
  return {solved ? Zero::State::found : Zero::State::failed, at_a < at_b ? a : b};
}

/// Looks for the end of the regime first: what lies beyond it is not the branch, so that extrema and folds
/// are looked for up to there only.
class Search {
 public:
  Search(Stepper& stepper, const Signs& signs)
      : stepper_(stepper),
        signs_(signs),
        upper_(stepper.distance()),
        at_upper_(&stepper.to()),
        rate_at_upper_(stepper.parameter_rate_to()) {}

  EventSearch run() {
    const auto borders = static_cast<Index>(at_upper_->size()) - stepper_.tracked_count();
    for (Index b = 0; b < borders; ++b) border(b);
    if (result_.solved && result_.first) {
      upper_ = result_.first->s;
      result_.solved = stepper_.probe(upper_) && stepper_.resolved(upper_, stepper_.probed());
      cut_ = stepper_.probed();
      at_upper_ = &cut_;
      rate_at_upper_ = stepper_.probed_parameter_rate();
    }
    if (!result_.solved) return result_;
    fold();
    for (Index i = 0; i < stepper_.tracked_count(); ++i) extremum(i);
    return result_;
  }

 private:
  void note(Event::Kind kind, Index index, const Zero& zero) {
    if (zero.state == Zero::State::failed) result_.solved = false;
    if (zero.state != Zero::State::found) return;
    if (!result_.first || zero.s < result_.first->s) result_.first = Event{kind, index, zero.s};
  }

  void fold() {
    if (signs_.parameter * sign_of(rate_at_upper_) >= 0) return;
    note(Event::Kind::fold, 0,
         locate(stepper_, {upper_, stepper_.parameter_rate_from(), signs_.parameter, rate_at_upper_},
                [](Stepper& s) { return s.probed_parameter_rate(); }));
  }

  Zero locate_extremum(std::size_t monitor, int before) {
    return locate(stepper_, {upper_, stepper_.from()[monitor].slope, before, (*at_upper_)[monitor].slope},
                  [monitor](Stepper& s) { return s.probed()[monitor].slope; });
  }

  void extremum(Index i) {
    const auto m = static_cast<std::size_t>(i);
    const int before = signs_.observables[m];
    if (before * sign_of_slope((*at_upper_)[m]) >= 0) return;
    note(Event::Kind::extremum, i, locate_extremum(m, before));
  }

  void border(Index b) {
    const auto m = static_cast<std::size_t>(stepper_.tracked_count() + b);
    const Monitor from = stepper_.from()[m];
    double upper = upper_;
    double value = (*at_upper_)[m].value;
    if (std::abs(from.value) <= 1e-12 && from.slope > 0) {  // an extremum lies on the border, to rounding
      note(Event::Kind::crossing, b, {Zero::State::found, 0});
      return;
    }
    if (value <= 0) {
      if (!(from.slope > 0 && (*at_upper_)[m].slope < 0)) return;
      const Zero top = locate_extremum(m, 1);  // the border function's highest point in the step
      if (top.state != Zero::State::found || !stepper_.probe(top.s)) {
        result_.solved = false;
        return;
      }
      upper = top.s;
      value = stepper_.probed()[m].value;
      if (value <= 0) return;
    }
    const Zero zero =
        locate(stepper_, {upper, from.value, -1, value}, [m](Stepper& s) { return s.probed()[m].value; });
    if (zero.state == Zero::State::absent)
      result_.solved = false;  // beyond the border, yet nowhere across it
    note(Event::Kind::crossing, b, zero);
  }

  Stepper& stepper_;
  const Signs& signs_;
  double upper_;
  const std::vector<Monitor>* at_upper_;
  std::vector<Monitor> cut_;  // the monitors at the crossing
  double rate_at_upper_;
  EventSearch result_;
};

}  // namespace

int sign_of_slope(const Monitor& monitor) {
  return std::abs(monitor.slope) <= 1e-14 * std::abs(monitor.value) ? 0 : sign_of(monitor.slope);
}

void Signs::reset(const std::vector<Monitor>& monitors, Index tracked, double parameter_rate) {
  parameter = sign_of(parameter_rate);
  observables.clear();
  for (Index i = 0; i < tracked; ++i)
    observables.push_back(sign_of_slope(monitors[static_cast<std::size_t>(i)]));
}

void Signs::update(const std::vector<Monitor>& monitors, double parameter_rate) {
  if (sign_of(parameter_rate) != 0) parameter = sign_of(parameter_rate);
  for (std::size_t i = 0; i < observables.size(); ++i) {
    if (const int sign = sign_of_slope(monitors[i]); sign != 0) observables[i] = sign;
  }
}

EventSearch find_first_event(Stepper& stepper, const Signs& signs) { return Search(stepper, signs).run(); }

}  // namespace arcslip::continuation
