#include "arcslip/continuation/events.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>

namespace arcslip::continuation {
namespace {

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
  std::vector<std::pair<double, double>> seen;  // s and the value there
  const auto along = [&](double s) {
    solved = solved && stepper.probe(s);
    seen.emplace_back(s, solved ? f(stepper) : 0.0);
    return seen.back().second;
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
      // No zero in sight, or the step begins on it, by the last bits behind it.
      const bool begins_there = std::abs(at_lower) < 1e-6 * std::abs(bracket.at_upper);
      return {begins_there ? Zero::State::found : Zero::State::absent, 0};
    }
  }
  const auto close = [&](double a, double b) { return std::abs(b - a) <= 1e-14 * bracket.upper; };
  std::uintmax_t iterations = 100;
  const auto [a, b] = boost::math::tools::toms748_solve(along, lower, bracket.upper, at_lower,
                                                        bracket.at_upper, close, iterations);
  if (!solved) return {Zero::State::failed};
  const auto size_at = [&](double s) {
    const auto at = std::find_if(seen.begin(), seen.end(), [s](const auto& pair) { return pair.first == s; });
    return std::abs(at != seen.end() ? at->second : s == lower ? at_lower : bracket.at_upper);
  };
  return {Zero::State::found, size_at(a) < size_at(b) ? a : b};
}

/// Looks for the end of the regime first: what lies beyond it is not the branch, so that everything else is
/// looked for up to there only.
class Search {
 public:
  Search(Stepper& stepper, Watch& watch, const Signs& signs)
      : stepper_(stepper),
        watch_(watch),
        signs_(signs),
        upper_(stepper.distance()),
        at_upper_(&stepper.to()),
        rate_at_upper_(stepper.parameter_rate_to()) {}

  EventSearch run() {
    const auto borders = static_cast<Index>(at_upper_->size()) - stepper_.tracked_count();
    for (Index b = 0; b < borders; ++b) border(b);
    if (result_.solved && !result_.events.empty()) {
      double first = upper_;
      for (const Event& event : result_.events) first = std::min(first, event.s);
      result_.solved = end_at(first) && stepper_.resolved(upper_, stepper_.probed());
    }
    if (!result_.solved) return result_;
    search_inside();
    while (search_before_first()) {
    }
    return result_;
  }

 private:
  void note(Event::Kind kind, PointType type, Index index, const Zero& zero) {
    if (zero.state == Zero::State::failed) result_.solved = false;
    if (zero.state == Zero::State::found) result_.events.push_back({kind, type, index, zero.s});
  }

  /// Leaves out of the search what lies behind s.
  bool end_at(double s) {
    if (!stepper_.probe(s)) return false;
    upper_ = s;
    cut_ = stepper_.probed();
    at_upper_ = &cut_;
    rate_at_upper_ = stepper_.probed_parameter_rate();
    return true;
  }

  void search_inside() {
    look_at_upper();
    fold();
    for (Index i = 0; i < stepper_.tracked_count(); ++i) extremum(i);
    if (stepper_.crossing() && stepper_.crossing()->s <= upper_)
      note(Event::Kind::crossing, PointType::branch_point, 0, {Zero::State::found, stepper_.crossing()->s});
    for (std::size_t i = 0; i < functions_at_upper_.size(); ++i) function(i);
    eigenvalues();
    keep_first();
  }

  /// The step is to end at the first event. What changes its sign twice within all of the step, and so was
  /// not seen, may do so once up to there. Returns whether something was found.
  bool search_before_first() {
    const std::vector<Event> known = result_.events;
    if (!result_.solved || known.empty()) return false;
    const double first = known.front().s;
    if (!(first > 0 && first < upper_)) return false;
    if (known.front().kind == Event::Kind::crossing) return false;  // a probe there would be singular
    if (!end_at(first)) return false;
    result_.events.clear();
    search_inside();
    const auto earlier = [&](const Event& event) { return event.s < first - 1e-9 * stepper_.distance(); };
    const bool found = result_.solved && std::any_of(result_.events.begin(), result_.events.end(), earlier);
    if (!found) result_ = {true, known};
    return found;
  }

  /// Within what part of the step a fold is one with such a point. On the turning branch of a pitchfork the
  /// parameter's rate, by which folds are located, is noise up to a distance of about rounding^(1/3).
  double blur(const Event& event) const {
    const auto& crossing = stepper_.crossing();
    const bool turns = event.type == PointType::branch_point && crossing &&
                       std::abs(crossing->point.tangent(crossing->point.tangent.size() - 1)) < 1e-6;
    return turns ? 1e-2 : 1e-4;
  }

  /// Keeps the first event and those at the very same point. A fold beside a branch point or a cusp, where
  /// what it is located by is noise, is that point.
  void keep_first() {
    auto& events = result_.events;
    std::erase_if(events, [&](const Event& event) {
      return event.type == PointType::fold &&
             std::any_of(events.begin(), events.end(), [&](const Event& other) {
               return explains_fold(other.type) &&
                      std::abs(other.s - event.s) < blur(other) * stepper_.distance();
             });
    });
    double first = upper_;
    for (const Event& event : events) first = std::min(first, event.s);
    std::erase_if(events, [&](const Event& event) { return event.s > first + 1e-12 * stepper_.distance(); });
  }

  void fold() {
    if (signs_.parameter * sign_of(rate_at_upper_) > 0) return hidden_fold();
    if (signs_.parameter * sign_of(rate_at_upper_) < 0) fold_before(upper_, rate_at_upper_);
  }

  void fold_before(double s, double rate) {
    note(Event::Kind::fold, PointType::fold, 0,
         locate(stepper_, {s, stepper_.parameter_rate_from(), signs_.parameter, rate},
                [](Stepper& stepper) { return stepper.probed_parameter_rate(); }));
  }

  /// Two folds in one step, the second of which turns the parameter back.
  void hidden_fold() {
    const std::optional<double> suspected = stepper_.suspected_folds();
    if (!suspected || *suspected >= upper_) return;
    double least = std::numeric_limits<double>::infinity();  // rate of the parameter in its direction
    double lowest = 0;
    const auto rate = [&](double s) {
      if (least < 0 || !result_.solved) return least;  // there it is
      result_.solved = stepper_.probe(s);
      const double value = signs_.parameter * stepper_.probed_parameter_rate();
      if (value < least) lowest = s;
      least = std::min(least, value);
      return value;
    };
    const double ends = std::min(std::abs(stepper_.parameter_rate_from()), std::abs(rate_at_upper_));
    if (rate(*suspected) > 0.2 * ends) return;
    std::uintmax_t iterations = 40;
    boost::math::tools::brent_find_minima(rate, 0.0, upper_, 24, iterations);
    if (least < 0 && result_.solved) fold_before(lowest, signs_.parameter * least);
  }

  Zero locate_extremum(std::size_t monitor, int before) {
    return locate(stepper_, {upper_, stepper_.from()[monitor].slope, before, (*at_upper_)[monitor].slope},
                  [monitor](Stepper& s) { return s.probed()[monitor].slope; });
  }

  void extremum(Index i) {
    const auto m = static_cast<std::size_t>(i);
    const int before = signs_.observables[m];
    if (before * sign_of_slope(stepper_, m, (*at_upper_)[m]) >= 0) return;
    note(Event::Kind::extremum, before > 0 ? PointType::peak : PointType::trough, i,
         locate_extremum(m, before));
  }

  /// A branch that comes beyond a border by less than the tolerance, as where it all but touches it, stays.
  void border(Index b) {
    const auto m = static_cast<std::size_t>(stepper_.tracked_count() + b);
    const double touch = stepper_.tolerance();
    const Monitor from = stepper_.from()[m];
    const Monitor to = (*at_upper_)[m];
    double upper = upper_;
    double value = to.value;
    if (value <= rounding || (value <= touch && to.slope < 0)) {
      if (!(from.slope > 0 && to.slope < 0)) return;
      const Zero top = locate_extremum(m, 1);  // the border function's highest point in the step
      if (top.state != Zero::State::found || !stepper_.probe(top.s)) {
        result_.solved = false;
        return;
      }
      upper = top.s;
      value = stepper_.probed()[m].value;
      if (value <= touch) return;
    }
    const bool begins_beyond = from.value > rounding && from.value <= touch && from.slope > 0;
    const Zero zero = begins_beyond ? Zero{Zero::State::found, 0} : locate_border(m, upper, value);
    if (zero.state == Zero::State::absent)
      result_.solved = false;  // beyond the border, yet nowhere across it
    note(Event::Kind::border, PointType::regime_switch, b, zero);
  }

  /// Of a step that begins on the border and goes nowhere inside, it is where the value leaves rounding.
  Zero locate_border(std::size_t m, double upper, double value) {
    const double at_zero = stepper_.from()[m].value;
    const auto where_it_is = [&](double level) {
      return locate(stepper_, {upper, at_zero - level, -1, value - level},
                    [=](Stepper& s) { return s.probed()[m].value - level; });
    };
    const Zero zero = where_it_is(0);
    const bool at_once = zero.state == Zero::State::found && zero.s == 0 && std::abs(at_zero) <= rounding;
    return at_once && value > rounding ? where_it_is(rounding) : zero;
  }

  void look_at_upper() {
    if (watch_.empty()) return;
    watch_.look(at_upper_ == &cut_ ? stepper_.probed_point() : stepper_.there());
    functions_at_upper_ = watch_.functions();
    eigenvalues_at_upper_ = watch_.eigenvalues();
  }

  /// Zeros of tests and user's functions. A function may jump instead; then there is no zero.
  void function(std::size_t i) {
    const int before = signs_.functions[i];
    const double at_upper = functions_at_upper_[i];
    if (before != 0 && at_upper == 0)
      return note(Event::Kind::function, watch_.type(i), static_cast<Index>(i), {Zero::State::found, upper_});
    if (before * sign_of(at_upper) >= 0) return;
    const auto value = [&](Stepper& stepper) {
      watch_.look(stepper.probed_point());
      return watch_.functions()[i];
    };
    watch_.look(stepper_.here());
    const Zero zero = locate(stepper_, {upper_, watch_.functions()[i], before, at_upper}, value);
    if (zero.state == Zero::State::found && stepper_.probe(zero.s) &&
        std::abs(value(stepper_)) > 1e-6 * std::abs(at_upper)) {
      return;
    }
    note(Event::Kind::function, watch_.type(i), static_cast<Index>(i), zero);
  }

  /// Pairs of eigenvalues on the imaginary axis: sorted by their real parts, each real part is continuous
  /// along the branch, and those between the old and the new number of unstable ones have crossed.
  void eigenvalues() {
    const auto after = static_cast<int>((eigenvalues_at_upper_.real().array() > 0).count());
    if (signs_.unstable < 0 || eigenvalues_at_upper_.size() == 0) return;
    const int way = after > signs_.unstable ? 1 : -1;
    const int first = way > 0 ? signs_.unstable : signs_.unstable - 1;  // crosses before the others
    for (int i = first; i != first + after - signs_.unstable; i += way) {
      const auto value = [&](Stepper& stepper) {
        watch_.look(stepper.probed_point());
        return i < watch_.eigenvalues().size() ? watch_.eigenvalues()(i).real() : 0;
      };
      watch_.look(stepper_.here());
      const double here = watch_.eigenvalues()(i).real();
      if (here == 0 || eigenvalues_at_upper_(i).real() == 0)
        continue;  // on the axis all along, or split there
      const Zero zero = locate(stepper_, {upper_, here, -way, eigenvalues_at_upper_(i).real()}, value);
      if (zero.state != Zero::State::found || !stepper_.probe(zero.s)) continue;
      value(stepper_);
      const Complex at_zero = watch_.eigenvalues()(i);
      const double largest = watch_.eigenvalues().cwiseAbs().maxCoeff();
      if (std::abs(at_zero.imag()) <= 1e-6 * largest) continue;  // a real one, or two beside zero: a fold
      if (std::abs(at_zero.real()) > 1e-6 * std::abs(at_zero.imag())) continue;
      note(Event::Kind::pair, watch_.pair_crossing(), i, zero);
      return;
    }
  }

  static constexpr double rounding = 1e-13;  // of a border function where it vanishes

  Stepper& stepper_;
  Watch& watch_;
  const Signs& signs_;
  double upper_;
  const std::vector<Monitor>* at_upper_;
  std::vector<Monitor> cut_;  // the monitors at the crossing
  double rate_at_upper_;
  std::vector<double> functions_at_upper_;
  ComplexVector eigenvalues_at_upper_;
  EventSearch result_;
};

}  // namespace

bool explains_fold(PointType type) {
  return type == PointType::branch_point || type == PointType::cusp || type == PointType::bogdanov_takens;
}

EventSearch find_first_events(Stepper& stepper, Watch& watch, const Signs& signs) {
  return Search(stepper, watch, signs).run();
}

}  // namespace arcslip::continuation
