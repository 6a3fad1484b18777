#include "arcslip/continuation/events.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

namespace arcslip::continuation {
namespace {

int sign_of(double value) { return (value > 0) - (value < 0); }

/// Zero of f(stepper) for s in [0, upper], where f has the values at_zero and at_upper of unlike signs.
template <class Function>
std::optional<double> locate(Stepper& stepper, double upper, double at_zero, double at_upper, Function f) {
  if (sign_of(at_zero) * sign_of(at_upper) >= 0) return std::nullopt;
  bool solved = true;
  const auto along = [&](double s) {
    solved = solved && stepper.probe(s);
    return solved ? f(stepper) : 0.0;
  };
  const auto close = [upper](double a, double b) { return std::abs(b - a) <= 1e-14 * upper; };
  std::uintmax_t iterations = 100;
  const auto [a, b] =
      boost::math::tools::toms748_solve(along, 0.0, upper, at_zero, at_upper, close, iterations);
  if (!solved) return std::nullopt;
  const double at_a = a > 0 ? std::abs(along(a)) : std::abs(at_zero);
  const double at_b = std::abs(along(b));
  return at_a < at_b ? a : b;
}

/// Looks for the end of the regime first: what lies beyond it is not the branch, so that extrema and folds are looked
/// for up to there only.
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
  void found(Event::Kind kind, Index index, std::optional<double> s) {
    if (!s) {
      result_.solved = false;
    } else if (!result_.first || *s < result_.first->s) {
      result_.first = Event{kind, index, *s};
    }
  }

  void fold() {
    if (signs_.parameter * sign_of(rate_at_upper_) >= 0) return;
    found(Event::Kind::fold, 0, locate(stepper_, upper_, stepper_.parameter_rate_from(), rate_at_upper_,
                                       [](Stepper& s) { return s.probed_parameter_rate(); }));
  }

  std::optional<double> locate_extremum(std::size_t monitor) {
    return locate(stepper_, upper_, stepper_.from()[monitor].slope, (*at_upper_)[monitor].slope,
                  [monitor](Stepper& s) { return s.probed()[monitor].slope; });
  }

  void extremum(Index i) {
    const auto m = static_cast<std::size_t>(i);
    if (signs_.observables[m] * sign_of_slope((*at_upper_)[m]) >= 0) return;
    // A step that starts on an extremum and comes back across it holds no second one.
    if (sign_of(stepper_.from()[m].slope) != signs_.observables[m]) return;
    found(Event::Kind::extremum, i, locate_extremum(m));
  }

  void border(Index b) {
    const auto m = static_cast<std::size_t>(stepper_.tracked_count() + b);
    const Monitor from = stepper_.from()[m];
    double upper = upper_;
    double value = (*at_upper_)[m].value;
    if (value <= 0) {
      if (!(from.slope > 0 && (*at_upper_)[m].slope < 0)) return;
      const std::optional<double> top = locate_extremum(m);  // the border function's highest point in the step
      if (!top || !stepper_.probe(*top)) return found(Event::Kind::crossing, b, std::nullopt);
      upper = *top;
      value = stepper_.probed()[m].value;
      if (value <= 0) return;
    }
    found(Event::Kind::crossing, b,
          locate(stepper_, upper, from.value, value, [m](Stepper& s) { return s.probed()[m].value; }));
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
  for (Index i = 0; i < tracked; ++i) observables.push_back(sign_of_slope(monitors[static_cast<std::size_t>(i)]));
}

void Signs::update(const std::vector<Monitor>& monitors, double parameter_rate) {
  if (sign_of(parameter_rate) != 0) parameter = sign_of(parameter_rate);
  for (std::size_t i = 0; i < observables.size(); ++i) {
    if (const int sign = sign_of_slope(monitors[i]); sign != 0) observables[i] = sign;
  }
}

EventSearch find_first_event(Stepper& stepper, const Signs& signs) { return Search(stepper, signs).run(); }

}  // namespace arcslip::continuation
