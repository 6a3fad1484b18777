// What small disturbances dx meet in a settled loop of microslip. On a branch from (x_r, f_r)
//
//   df = df_r + F'(|x - x_r|/2) (dx - dx_r),
//
// a stiffness that varies with two memories, which are set where the motion turns back and kept until the
// loop that begins there is closed. At the farthest turning point the sliders that slip at all stand at their
// limits and the others on their springs: df_r = F'(A) dx_r, A half of the motion's range.

#include <algorithm>
#include <cmath>

#include "arcslip/elements/masing.hpp"
#include "arcslip/motion/periodic_motion.hpp"
#include "motion/bracketed_newton.hpp"

namespace arcslip {
namespace {

class MasingLaw {
 public:
  MasingLaw(std::shared_ptr<const Backbone> backbone, std::span<const int> orders, const HarmonicVector& x,
            double load)
      : backbone_(std::move(backbone)),
        motion_(std::make_shared<const PeriodicMotion>(orders, x, highest_order(orders))),
        load_(load),
        turn_(all_odd(orders) ? pi : two_pi) {}

  DisturbedLaw found() {
    const std::vector<double> turns = turning_points();
    if (turns.empty()) return DisturbedLaw::constant(Matrix::Constant(1, 1, backbone_->slope(0)));
    const auto [least, greatest] = std::minmax_element(turns.begin(), turns.end(), [&](double a, double b) {
      return motion_->value(a) < motion_->value(b);
    });
    const double range = turn_ < two_pi ? 2 * std::abs(motion_->value(*greatest))
                                        : motion_->value(*greatest) - motion_->value(*least);
    open(turns.front(), Vector::Constant(1, backbone_->slope(0.5 * range / load_)), {});
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const bool is_last = i + 1 == turns.size();
      const double to = is_last ? turns.front() + turn_ : turns[i + 1];
      pass(turns[i], to);
      if (is_last) continue;
      const double slope = slope_at(to, x_of(open_.back()));
      const Index last = memories_of(open_.back());
      open(to, Vector::Constant(1, slope), {{last + 1, 1.0}, {last, -slope}});
    }
    while (!open_.empty()) close(turns.front() + turn_);
    return law_;
  }

 private:
  /// Over a turn, from the farthest one on.
  std::vector<double> turning_points() const {
    std::vector<double> turns = motion_->derivative().zeros();
    const auto farthest = std::max_element(turns.begin(), turns.end(), [&](double a, double b) {
      return std::abs(motion_->value(a)) < std::abs(motion_->value(b));
    });
    if (turns.empty()) return turns;
    std::rotate(turns.begin(), farthest, turns.end());
    for (double& angle : turns) angle += angle < turns.front() ? two_pi : 0;
    const double half = turns.front() + turn_ - narrow_;
    std::erase_if(turns, [&](double angle) { return angle > half; });
    return turns;
  }

  double x_of(std::size_t which) const { return motion_->value(law_.memories[2 * which].begin); }
  static Index memories_of(std::size_t which) { return 2 * static_cast<Index>(which); }
  double slope_at(double angle, double from) const {
    return backbone_->slope(0.5 * std::abs(motion_->value(angle) - from) / load_);
  }

  /// dx and df of a turning point are kept.
  void open(double angle, const Vector& force, std::vector<std::pair<Index, double>> of) {
    open_.push_back(law_.memories.size() / 2);
    law_.memories.push_back({angle, 0, Vector::Ones(1)});
    law_.memories.push_back({angle, 0, force, std::move(of)});
  }
  void close(double angle) {
    const std::size_t first = 2 * open_.back();
    for (const std::size_t i : {first, first + 1}) law_.memories[i].width = angle - law_.memories[i].begin;
    open_.pop_back();
  }

  /// From one turning point to the next, closing loops on the way.
  void pass(double from, double to) {
    const double end = motion_->value(to);
    while (open_.size() >= 3) {
      const double level = x_of(open_[open_.size() - 2]);
      if (std::abs(end - x_of(open_.back())) <= std::abs(level - x_of(open_.back()))) break;
      const double closing = crossing(level, from, to);
      take(from, closing);
      close(closing);
      close(closing);
      from = closing;
    }
    take(from, to);
  }

  double crossing(double level, double from, double to) const {
    const auto above = [&](double theta) {
      const PeriodicMotion::Local at = motion_->at(theta);
      return std::pair(at.value - level, at.first);
    };
    return bracketed_newton(above, 0.5 * (from + to), from, to, motion_->value(to) > motion_->value(from));
  }

  /// One branch, between the corners of the backbone.
  void take(double from, double to) {
    const double last = x_of(open_.back());
    const double end = motion_->value(to);
    const double side = end < last ? -1 : 1;
    for (const double corner : backbone_->corners()) {
      const double level = last + side * 2 * load_ * corner;
      if (side * (level - motion_->value(from)) <= 0 || side * (end - level) <= 0) continue;
      const double at = crossing(level, from, to);
      add(from, at, last);
      from = at;
    }
    add(from, to, last);
  }

  void add(double from, double to, double last) {
    const Index memory = memories_of(open_.back());
    DisturbedLaw::Piece piece{from, to - from, Matrix::Zero(1, 1), {{memory + 1, Vector::Ones(1)}}};
    const auto slope = [backbone = backbone_, motion = motion_, load = load_, last](double theta) {
      return backbone->slope(0.5 * std::abs(motion->value(theta) - last) / load);
    };
    constexpr double per_harmonic = 12;  // of x, to powers of which the slope is a polynomial or nearly so
    piece.varying = std::make_shared<const VaryingLaw>(
        interpolated_slope(slope, backbone_->slope(0), per_harmonic * motion_->highest()));
    piece.from = memory;
    law_.pieces.push_back(std::move(piece));
  }

  static constexpr double narrow_ = 1e-9;
  std::shared_ptr<const Backbone> backbone_;
  std::shared_ptr<const PeriodicMotion> motion_;
  double load_;
  double turn_;
  std::vector<std::size_t> open_;  // turning points of loops that are not closed, the last one last
  DisturbedLaw law_;
};

}  // namespace

DisturbedLaw MasingElement::disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                                      bool /*beyond*/) const {
  return MasingLaw(backbone_, orders, x, load).found();
}

}  // namespace arcslip
