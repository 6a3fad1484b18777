#include "arcslip/continuation/events/events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "arcslip/continuation/events/border_crossing.hpp"
#include "arcslip/continuation/events/zero_search.hpp"

namespace arcslip::continuation {
namespace {

constexpr double aside = 1e-3;  // of the step: where the pair of a smaller one must be, too
constexpr double plainly = 10;  // times what it falls by to a zero that it passes straight: its value

bool any_of_type(const std::vector<Event>& events, std::initializer_list<PointType> types) {
  return std::any_of(events.begin(), events.end(), [&](const Event& event) {
    return std::find(types.begin(), types.end(), event.type) != types.end();
  });
}

class Search {
 public:
  Search(Stepper& stepper, Watch& watch, const Signs& signs)
      : stepper_(stepper),
        watch_(watch),
        signs_(signs),
        tolerances_(stepper.tolerances()),
        functions_at_end_(watch.functions()),
        eigenvalues_at_end_(watch.eigenvalues()),
        readings_(stepper, watch, functions_at_end_, eigenvalues_at_end_),
        zeros_(stepper, readings_),
        upper_(stepper.distance()) {}

  /// What lies beyond the end of the regime is not the branch, so that all else is looked for up to there.
  EventSearch run() {
    borders();
    if (result_.solved) search_inside();
    if (result_.solved) explain();
    return std::move(result_);
  }

 private:
  void borders() {
    const auto count = static_cast<Index>(stepper_.to().size()) - stepper_.tracked_count();
    std::vector<Event> reached;
    for (Index b = 0; b < count && result_.solved; ++b) {
      const Zero zero = border_crossing(stepper_, b);
      if (zero.state == Zero::State::failed) result_.solved = false;
      if (zero.state == Zero::State::found)
        reached.push_back({Event::Kind::border, PointType::regime_switch, b, zero.s});
    }
    if (!result_.solved || reached.empty()) return;
    for (const Event& event : reached) note(event);
    result_.solved = stepper_.probe(upper_) && stepper_.resolved(upper_, stepper_.probed());
  }

  /// Keeps the events of the first place only; the others are looked for up to there.
  void note(Event event) {
    const double near = tolerances_.one_place * stepper_.distance();
    if (event.s > upper_ + near) return;
    if (event.s < upper_ - near) {
      result_.events.clear();
      upper_ = event.s;
    }
    event.s = upper_;
    ends_at_event_ = true;
    result_.events.push_back(event);
  }

  void note(Event::Kind kind, PointType type, Index index, const Zero& zero) {
    if (zero.state == Zero::State::failed) result_.solved = false;
    if (zero.state == Zero::State::found && result_.solved) note({kind, type, index, zero.s});
  }

  void search_inside() {
    if (stepper_.crossing())
      note({Event::Kind::crossing, PointType::branch_point, 0, stepper_.crossing()->s});
    functions(false);
    zeros_.jumps_count = true;
    if (result_.solved) fold();
    for (Index i = 0; i < stepper_.tracked_count() && result_.solved; ++i) extremum(i);
    functions(true);
    if (result_.solved) eigenvalues();
  }

  /// Another event at the same place may say what an event is: a parameter turns at a pitchfork, all that
  /// depends on the parameters alone turns at a cusp, and where Hopf points meet a zero eigenvalue curves of
  /// them may cross.
  void explain() {
    auto& events = result_.events;
    for (Event& event : events) {
      switch (event.kind) {
        case Event::Kind::fold:
          event.told =
              !any_of_type(events, {PointType::branch_point, PointType::cusp, PointType::bogdanov_takens});
          break;
        case Event::Kind::extremum: event.told = !any_of_type(events, {PointType::cusp}); break;
        case Event::Kind::crossing:
          event.told = !any_of_type(events, {PointType::cusp, PointType::bogdanov_takens,
                                             PointType::zero_hopf, PointType::hopf_hopf});
          break;
        default: break;
      }
    }
  }

  bool is_whole() const { return upper_ == stepper_.distance(); }

  /// A reading at the upper end, of which `end` is that at the end of the whole step.
  double at_upper(std::size_t which, double end) {
    return is_whole() ? end : readings_.value(which, upper_).value_or(0);
  }

  double chord() const { return stepper_.chord() * upper_ / stepper_.distance(); }

  /// Two folds in one step, the second of which turns the parameter back, show in how far it has come.
  void fold() {
    const double after = at_upper(Readings::rate, stepper_.parameter_rate_to());
    const bool turns = signs_.parameter * sign_of(after) < 0 || stepper_.may_turn_twice();
    note(Event::Kind::fold, PointType::fold, 0, turn(Readings::rate, signs_.parameter, turns));
  }

  /// The zero of a derivative along the branch; all of those that are made of parameters vanish at a cusp.
  Zero turn(std::size_t which, int sign, bool changes) {
    bool at_cusp = false;
    if (any_of_type(result_.events, {PointType::cusp})) {
      const std::optional<double> here = readings_.value(which, 0);
      const std::optional<Node> there = readings_.node(which, upper_);
      if (!here || !there) return {Zero::State::failed};
      const double fall = -sign * there->slope;  // where it only touches zero there is none
      at_cusp = std::abs(there->value) <= tolerances_.as_cusp * fall * stepper_.distance() &&
                std::abs(*here) < plainly * fall * upper_;
    }
    if (!changes && !at_cusp) return {Zero::State::absent};
    const Zero zero = zeros_.first(which, sign, 0, upper_,
                                   at_cusp ? std::numeric_limits<double>::infinity() : tolerances_.located);
    return at_cusp && zero.state == Zero::State::absent ? Zero{Zero::State::found, upper_} : zero;
  }

  /// Pairs of them are left to the step, which has to resolve the observable.
  void extremum(Index i) {
    const auto m = static_cast<std::size_t>(i);
    const int before = signs_.observables[m];
    const double after = at_upper(readings_.slope(i), sign_of_slope(stepper_, m, stepper_.to()[m]));
    note(Event::Kind::extremum, before > 0 ? PointType::peak : PointType::trough, i,
         turn(readings_.slope(i), before, before * sign_of(after) < 0));
  }

  /// Zeros of the problem's tests, or of the user's functions.
  void functions(bool of_user) {
    zeros_.jumps_count = false;
    for (std::size_t i = 0; i < functions_at_end_.size() && result_.solved; ++i)
      if ((watch_.type(i) == PointType::event) == of_user) function(i);
  }

  void function(std::size_t i) {
    const double end = functions_at_end_[i];
    const auto index = static_cast<Index>(i);
    if (!std::isfinite(end) || !std::isfinite(watch_.kept().front().functions[i])) return;  // no zero is told
    if (!is_whole() && !readings_.value(readings_.function(index), upper_)) return;
    const int before = signs_.functions[i];
    const double after = at_upper(readings_.function(index), end);
    const bool changes = before != 0 && before != sign_of(after);
    if (!changes && !watch_.function_may_vanish(i, chord(), after)) return;
    note(Event::Kind::function, watch_.type(i), index,
         zeros_.first(readings_.function(index), before, 0, upper_, tolerances_.located));
  }

  /// Eigenvalues on the imaginary axis. In descending order each real part is continuous along the branch;
  /// the first to vanish is that of the last unstable one or of the first stable one.
  void eigenvalues() {
    const Index count = eigenvalues_at_end_.size();
    if (signs_.unstable < 0 || count == 0) return;
    Index unstable = unstable_at_start();
    zeros_.least_touched = tolerances_.significant * eigenvalues_at_end_.cwiseAbs().maxCoeff();
    double from = 0;
    for (Index tries = 0; tries < count; ++tries) {
      Zero next;
      Index crosses = 0;
      for (const Index i : {unstable - 1, unstable}) {
        if (i < 0 || i >= count || (from == 0 && !may_cross_axis(i, i < unstable ? 1 : -1))) continue;
        const Zero zero = cross_axis(i, i < unstable ? 1 : -1, from);
        if (zero.state == Zero::State::failed) return note(Event::Kind::pair, PointType::regular, 0, zero);
        if (zero.state == Zero::State::absent || (next.state == Zero::State::found && zero.s >= next.s))
          continue;
        next = zero;
        crosses = i;
      }
      if (next.state != Zero::State::found || note_on_axis(crosses, crosses < unstable, next.s)) return;
      unstable += crosses < unstable ? -1 : 1;
      from = next.s;
    }
  }

  /// As was counted, where the step begins on the axis; else the values themselves tell.
  Index unstable_at_start() const {
    const auto& here = watch_.kept().front().rates;
    const Index both = std::min(eigenvalues_at_end_.size(), static_cast<Index>(here.size()));
    double way = 0;
    for (Index i = 0; i < both; ++i)
      way = std::max(way, std::abs(eigenvalues_at_end_(i).real() - here[static_cast<std::size_t>(i)]));
    const double near =
        std::max(tolerances_.rough * eigenvalues_at_end_.cwiseAbs().maxCoeff(), tolerances_.coincides * way);
    const auto above = [&](double bound) {
      return std::count_if(here.begin(), here.end(), [=](double rate) { return rate > bound; });
    };
    return std::clamp<Index>(signs_.unstable, above(near), above(-near));
  }

  Zero cross_axis(Index i, int sign, double from) {
    const std::size_t which = readings_.real_part(i);
    const std::optional<double> a = readings_.value(which, from);
    const std::optional<double> b = readings_.value(which, upper_);
    const double floor = tolerances_.rough * eigenvalues_at_end_.cwiseAbs().maxCoeff();
    if (!a || !b || std::max(std::abs(*a), std::abs(*b)) > floor)
      return zeros_.first(which, sign, from, upper_, tolerances_.just_passed);
    return zeros_.by_sign({from, *a, 0}, {upper_, *b, 0}, sign, which);
  }

  bool may_cross_axis(Index i, int sign) {
    const auto k = static_cast<std::size_t>(i);
    const double end = at_upper(readings_.real_part(i), eigenvalues_at_end_(i).real());
    const auto& here = watch_.kept().front().rates;
    const double rounding = tolerances_.on_axis * eigenvalues_at_end_.cwiseAbs().maxCoeff();
    if (k < here.size() && std::abs(here[k]) <= rounding && std::abs(end) <= rounding) return false;
    return sign_of(end) != sign || watch_.rate_may_vanish(k, chord(), end);
  }

  /// Names what vanishes with the i-th real part at s. False if it is nothing: a real eigenvalue that the
  /// branch has no name for.
  bool note_on_axis(Index i, bool falls, double s) {
    if (!stepper_.probe(s)) {
      result_.solved = false;
      return true;
    }
    watch_.look(stepper_.probed_point());
    const ComplexVector values = watch_.eigenvalues();
    if (i >= values.size()) return true;
    const auto way_of = [&](Index j) {
      const auto part = [&](double place) {
        return readings_.value(readings_.real_part(j), place).value_or(0);
      };
      return std::max(std::abs(part(0)), std::abs(part(is_whole() ? upper_ : stepper_.distance())));
    };
    const double near = std::max(10 * std::abs(values(i).real()), tolerances_.coincides * way_of(i));
    int pairs = 0;
    bool real = false;
    for (Index j = 0; j < values.size(); ++j) {
      const bool lies_there = std::abs(values(j).real()) <= near && (j == i || way_of(j) > 1e3 * near);
      if (!lies_there) continue;
      const bool is_pair = is_imaginary(values, j, s);
      pairs += static_cast<int>(is_pair && values(j).imag() > 0);
      real = real || !is_pair;
    }
    const int way = falls ? -1 : 1;
    const bool named = watch_.real_crossing() != PointType::regular;
    if (pairs > 0) note({Event::Kind::pair, watch_.pair_crossing(), i, s, true, 2 * way * pairs});
    if (real && named) note({Event::Kind::real, watch_.real_crossing(), i, s, true, way});
    return pairs > 0 || (real && named) || (ends_at_event_ && s == upper_);
  }

  /// Whether an eigenvalue on the axis is one of a pair, and not of two real ones that meet in zero, where
  /// rounding parts them.
  bool is_imaginary(const ComplexVector& values, Index i, double s) {
    const double size = std::abs(values(i).imag());
    const double largest = std::max(values.cwiseAbs().maxCoeff(), eigenvalues_at_end_.cwiseAbs().maxCoeff());
    if (size == 0 || size > tolerances_.surely_imaginary * largest) return size != 0;
    for (const double way : {-1.0, 1.0}) {
      const double place = s + way * aside * stepper_.distance();
      if (place < 0 || place > stepper_.distance()) continue;
      if (!stepper_.probe(place)) return false;
      watch_.look(stepper_.probed_point());
      const ComplexVector& there = watch_.eigenvalues();
      if (i >= there.size() || std::abs(std::abs(there(i).imag()) - size) > 0.5 * size) return false;
    }
    return true;
  }

  Stepper& stepper_;
  Watch& watch_;
  const Signs& signs_;
  const Tolerances& tolerances_;
  std::vector<double> functions_at_end_;
  ComplexVector eigenvalues_at_end_;
  Readings readings_;
  ZeroSearch zeros_;
  double upper_;
  bool ends_at_event_ = false;
  EventSearch result_;
};

}  // namespace

EventSearch find_first_events(Stepper& stepper, Watch& watch, const Signs& signs) {
  return Search(stepper, watch, signs).run();
}

}  // namespace arcslip::continuation
