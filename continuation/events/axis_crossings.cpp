// Eigenvalues on the imaginary axis. In descending order each real part is continuous along the branch; the
// first to vanish is that of the last unstable one or of the first stable one.

#include <algorithm>
#include <cmath>
#include <optional>

#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {
namespace {

constexpr double apart = 0.01;  // of the step: two places of it
constexpr double aside = 1e-3;  // of the step: where the pair of a smaller one must be, too

/// In one step.
class AxisSearch {
 public:
  explicit AxisSearch(StepSearch& step)
      : step_(step),
        at_end_(step.eigenvalues_at_end),
        here_(step.watch.kept().front().rates),
        largest_(at_end_.cwiseAbs().maxCoeff()),
        zeros_(step.stepper, step.readings,
               {.jumps_count = false, .least_touched = step.tolerances.significant * largest_}) {}

  void run() {
    if (step_.is_whole() && pairs_pass_each_other()) return step_.fail();
    const Index count = at_end_.size();
    double from = 0;
    const std::optional<Index> counted = unstable_at_start(from);
    if (!counted) return;
    Index unstable = *counted;
    for (Index tries = 0; tries < count; ++tries) {
      Zero next;
      Index crosses = 0;
      for (const Index i : {unstable - 1, unstable}) {
        if (i < 0 || i >= count || (tries == 0 && !may_cross(i, i < unstable ? 1 : -1))) continue;
        const Zero zero = cross(i, i < unstable ? 1 : -1, from);
        if (zero.state == Zero::State::failed) return step_.fail();
        if (zero.state == Zero::State::absent || (next.state == Zero::State::found && zero.s >= next.s))
          continue;
        next = zero;
        crosses = i;
      }
      if (next.state != Zero::State::found || note(crosses, crosses < unstable, next.s)) return;
      unstable += crosses < unstable ? -1 : 1;
      from = next.s;
    }
  }

 private:
  /// Whether one pair comes to the axis and another leaves it apart from that, as the nearest at both ends
  /// tell: the real parts in order need not change their signs then.
  bool pairs_pass_each_other() const {
    const Look& here = step_.watch.kept().front();
    const double told = step_.tolerances.significant * largest_;
    double place[2] = {-1, -1};  // of the last that rises and of the last that falls, in steps
    for (const Complex& end : at_end_) {
      if (!(end.imag() > 0)) continue;
      std::size_t nearest = here.turns.size();
      double least = HUGE_VAL;
      for (std::size_t i = 0; i < here.turns.size(); ++i) {
        const double distance = std::abs(Complex(here.rates[i], here.turns[i]) - end);
        if (!(here.turns[i] > 0) || !(distance < least)) continue;
        least = distance;
        nearest = i;
      }
      if (nearest == here.turns.size() || here.rates[nearest] * end.real() >= 0) continue;
      if (std::min(std::abs(here.rates[nearest]), std::abs(end.real())) <= told) continue;
      place[end.real() > 0 ? 0 : 1] = here.rates[nearest] / (here.rates[nearest] - end.real());
    }
    return place[0] >= 0 && place[1] >= 0 && std::abs(place[0] - place[1]) > apart;
  }

  /// As was counted, where the step begins on the axis; else the values themselves tell. On a branch point
  /// one of them vanishes, as well as that is located: which way it goes tells where it is ahead. Where some
  /// were told to vanish it shows a little ahead, `from` where they are looked for then. None where a branch
  /// begins on a point at which several vanish, and that does not show.
  std::optional<Index> unstable_at_start(double& from) {
    const Index both = std::min(at_end_.size(), static_cast<Index>(here_.size()));
    double way = 0;
    for (Index i = 0; i < both; ++i)
      way = std::max(way, std::abs(at_end_(i).real() - here_[static_cast<std::size_t>(i)]));
    double near = std::max(step_.tolerances.rough * largest_, step_.tolerances.coincides * way);
    const bool on_branch_point = std::isinf(step_.stepper.step().here.log_determinant);
    if (on_branch_point) {
      double least = way;
      for (const double rate : here_) least = std::min(least, std::abs(rate));
      near = std::max(near, 2 * least);
    }
    const auto above = [&](double bound) {
      return std::count_if(here_.begin(), here_.end(), [=](double rate) { return rate > bound; });
    };
    Index counted = step_.signs.unstable;
    if (on_branch_point) {
      counted = above(near);
      for (Index i = counted; i < above(-near); ++i) {
        const std::optional<Node> node = step_.readings.node(step_.readings.real_part(i), 0);
        counted += static_cast<Index>(node && node->slope > 0);
      }
    }
    const Index least = above(near);
    const Index most = above(-near);
    if ((step_.signs.at_crossing || on_branch_point) && least < most) {
      if (const std::optional<Index> ahead = unstable_ahead(least, most, from)) return ahead;
      if (!step_.signs.at_crossing && most - least > 1) return std::nullopt;
    }
    return std::clamp<Index>(counted, least, most);
  }

  /// How many are unstable just ahead, at `place`, of which those from `least` on, less than `most`, vanish
  /// here; none where that is not told. Beside a branch point a place may lie on the other branch, so that
  /// the next one is to tell the same.
  std::optional<Index> unstable_ahead(Index least, Index most, double& place) {
    const double plainly = 10 * step_.tolerances.rough * largest_;
    std::optional<Index> last;
    for (double ahead = 1e-6; ahead <= aside; ahead *= 10) {
      const double s = ahead * step_.upper();
      const auto value = [&](Index k) {
        return step_.readings.value(step_.readings.real_part(k), s).value_or(0);
      };
      bool is_told = (least == 0 || value(least - 1) > 0) && (most == at_end_.size() || value(most) < 0);
      Index unstable = least;
      for (Index k = least; k < most; ++k) {
        unstable += static_cast<Index>(value(k) > 0);
        is_told = is_told && std::abs(value(k)) > plainly;
      }
      if (!is_told) continue;
      if (last == unstable) return last;
      last = unstable;
      place = s;
    }
    return last;
  }

  bool may_cross(Index i, int sign) {
    const auto k = static_cast<std::size_t>(i);
    const double end = step_.at_upper(step_.readings.real_part(i), at_end_(i).real());
    const double rounding = step_.tolerances.on_axis * largest_;
    if (k < here_.size() && std::abs(here_[k]) <= rounding && std::abs(end) <= rounding)
      return std::abs(step_.readings.value(step_.readings.real_part(i), 0.5 * step_.upper()).value_or(0)) >
             rounding;
    const bool ends_there = step_.ends_at_event() && k < here_.size() &&
                            std::abs(end) <= step_.tolerances.coincides * std::abs(here_[k]);
    return ends_there || sign_of(end) != sign || step_.watch.rate_may_vanish(k, step_.chord(), end);
  }

  Zero cross(Index i, int sign, double from) {
    const std::size_t which = step_.readings.real_part(i);
    const double upper = step_.upper();
    const std::optional<double> a = step_.readings.value(which, from);
    const std::optional<double> b = step_.readings.value(which, upper);
    const auto is_rough = [&](const std::optional<double>& value) {
      return value && std::abs(*value) <= step_.tolerances.rough * largest_;
    };
    // not where it comes from one zero to the next, as from a pair on the axis to a fold
    if (!is_rough(a) || !is_rough(b) || !is_rough(step_.readings.value(which, 0.5 * (from + upper))))
      return zeros_.first(which, sign, from, upper, step_.tolerances.just_passed);
    return zeros_.by_sign({from, *a, 0}, {upper, *b, 0}, sign, which);
  }

  /// How far the j-th real part is from zero at the end where it is farther.
  double way_of(Index j) {
    const auto part = [&](double place) {
      return std::abs(step_.readings.value(step_.readings.real_part(j), place).value_or(0));
    };
    return std::max(part(0), part(step_.stepper.step().distance));
  }

  /// Names what vanishes with the i-th real part at s. False if it is nothing: a real eigenvalue that the
  /// branch has no name for.
  bool note(Index i, bool falls, double s) {
    if (!step_.stepper.prober().probe(s)) {
      step_.fail();
      return true;
    }
    step_.watch.look(step_.stepper.prober().probed().point);
    const ComplexVector values = step_.watch.eigenvalues();
    if (i >= values.size()) return true;
    const double near = std::max(10 * std::abs(values(i).real()), step_.tolerances.coincides * way_of(i));
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
    const bool named = step_.watch.real_crossing() != PointType::regular;
    if (pairs > 0) step_.note({&axis_crossings, step_.watch.pair_crossing(), i, s, true, 2 * way * pairs});
    if (real && named) step_.note({&axis_crossings, step_.watch.real_crossing(), i, s, true, way});
    return pairs > 0 || (real && named) || (step_.ends_at_event() && s == step_.upper());
  }

  /// Whether an eigenvalue on the axis is one of a pair, and not of two real ones that meet in zero, where
  /// rounding parts them.
  bool is_imaginary(const ComplexVector& values, Index i, double s) {
    const double size = std::abs(values(i).imag());
    const double largest = std::max(values.cwiseAbs().maxCoeff(), largest_);
    if (size == 0 || size > step_.tolerances.surely_imaginary * largest) return size != 0;
    for (const double way : {-1.0, 1.0}) {
      const double place = s + way * aside * step_.stepper.step().distance;
      if (place < 0 || place > step_.stepper.step().distance) continue;
      if (!step_.stepper.prober().probe(place)) return false;
      step_.watch.look(step_.stepper.prober().probed().point);
      const ComplexVector& there = step_.watch.eigenvalues();
      if (i >= there.size() || std::abs(std::abs(there(i).imag()) - size) > 0.5 * size) return false;
    }
    return true;
  }

  StepSearch& step_;
  const ComplexVector& at_end_;
  const std::vector<double>& here_;  // real parts where the step begins
  double largest_;
  ZeroSearch zeros_;
};

}  // namespace

const EventKind axis_crossings{
    [](StepSearch& step) {
      if (step.signs.unstable >= 0 && step.eigenvalues_at_end.size() > 0) AxisSearch(step).run();
    },
    [](const Event& event, const Passage& passage) { passage.behind.unstable += event.unstable; }};

}  // namespace arcslip::continuation
