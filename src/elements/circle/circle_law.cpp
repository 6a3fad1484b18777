#include "elements/circle/circle_law.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace arcslip {
namespace {

using Phase = PressedArcs::Phase;

/// Slip over a period, wherever it is.
class Slip {
 public:
  Slip(const CircleMotion& motion, const CircleCourse& course) : motion_(motion) {
    for (const CircleCourse::Arc& arc : course.arcs())
      panels_.insert(panels_.end(), arc.panels.begin(), arc.panels.end());
  }

  struct Local {
    Complex direction;  // n
    double turning;     // phi'
    double settling;    // v/b
  };
  Local at(double theta) const { return at(theta, piece_at(theta)); }
  Complex direction(double theta) const {
    const Piece piece = piece_at(theta);
    return std::polar(1.0, piece.panel->phase_at(theta + piece.ahead));
  }

  /// One panel, and what has to be added to theta for its own.
  struct Piece {
    const SlipPanel* panel;
    double ahead;
  };
  Local at(double theta, const Piece& piece) const {
    const double angle = theta + piece.ahead;
    const CircleMotion::Local here = motion_.at(angle);
    const Complex n = std::polar(1.0, piece.panel->phase_at(angle));
    const Complex turned = here.rate * std::conj(n);
    return {n, turned.imag() / here.radius, (turned.real() - here.radius_rate) / here.radius};
  }

  /// The nearest one.
  Piece piece_at(double theta) const {
    Piece nearest{nullptr, 0};
    double least = 0;
    for (const SlipPanel& panel : panels_) {
      const double way = theta - panel.reach.begin - 0.5 * panel.reach.width;
      const double turns = two_pi * std::round(way / two_pi);
      const double outside = std::abs(way - turns) - 0.5 * panel.reach.width;
      if (nearest.panel != nullptr && outside >= least) continue;
      nearest = {&panel, -turns};
      least = outside;
    }
    return nearest;
  }

  /// Where pieces of it end, behind `begin`.
  std::vector<double> ends(double begin, double width) const {
    std::vector<double> all{begin + width};
    for (const SlipPanel& panel : panels_) {
      const double way = panel.reach.begin + panel.reach.width - begin;
      const double behind = way - two_pi * std::floor(way / two_pi);
      if (behind > 0 && behind < width) all.push_back(begin + behind);
    }
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  CircleMotion motion_;
  std::vector<SlipPanel> panels_;
};

class Builder {
 public:
  Builder(const CircleMotion& motion, const CircleCourse& course, bool closes, double turn)
      : motion_(motion),
        k_(motion.settings().tangential_stiffness),
        normal_(motion.settings().normal_stiffness),
        push_(motion.settings().friction * normal_),
        turn_(turn),
        size_(closes ? 3 : 2),
        slip_(std::make_shared<const Slip>(motion, course)) {
    law_.coordinates = size_;
    gather(course);
  }

  DisturbedLaw found() {
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      const Arc& arc = arcs_[i];
      if (arc.phase == Phase::stick) stick(arc, before(i));
      if (arc.phase == Phase::apart)
        law_.pieces.push_back({arc.begin, arc.width, Matrix::Zero(size_, size_)});
      if (arc.phase == Phase::slip) slip(arc, before(i));
    }
    return std::move(law_);
  }

 private:
  /// A part of slip in which m is not bound to follow t.dr.
  struct Flow {
    double begin;
    double width;
    Index memory;
  };
  struct Arc {
    Phase phase;
    double begin;
    double width;
    std::vector<Flow> flows = {};
    Index memory = -1;     // of stick: the first of its two
    bool touches = false;  // begins as the parts touch
  };

  const Arc& before(std::size_t i) const { return arcs_[(i + arcs_.size() - 1) % arcs_.size()]; }

  /// Arcs over a turn, from one that is no slip if there is any.
  void gather(const CircleCourse& course) {
    constexpr double narrow = 1e-9;
    for (const CircleCourse::Arc& arc : course.arcs()) {
      if (!(arc.width > narrow)) continue;  // as where the period begins on the circle
      if (!arcs_.empty() && arcs_.back().phase == arc.phase) {
        arcs_.back().width += arc.width;
      } else {
        arcs_.push_back({arc.phase, arc.begin, arc.width});
      }
    }
    if (arcs_.size() > 1 && arcs_.front().phase == arcs_.back().phase) {
      arcs_.front().begin -= arcs_.back().width;
      arcs_.front().width += arcs_.back().width;
      arcs_.pop_back();
    }
    const auto first =
        std::find_if(arcs_.begin(), arcs_.end(), [](const Arc& arc) { return arc.phase != Phase::slip; });
    for (auto arc = arcs_.begin(); first != arcs_.end() && arc != first; ++arc) arc->begin += two_pi;
    if (first != arcs_.end()) std::rotate(arcs_.begin(), first, arcs_.end());
    const double end = arcs_.front().begin + turn_ - narrow;
    std::erase_if(arcs_, [&](const Arc& arc) { return arc.begin > end; });
    if (arcs_.size() == 1) arcs_.front().width = turn_;
    Index memory = 0;
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      Arc& arc = arcs_[i];
      arc.touches = before(i).phase == Phase::apart;
      arc.memory = memory;
      if (arc.phase == Phase::stick) memory += 2;
      if (arc.phase == Phase::slip) {
        arc.flows = flows_of(arc);
        for (Flow& flow : arc.flows) flow.memory = memory++;
      }
    }
  }

  /// Where v/b is not that large: else m = t.dr to its inverse, and that part of the force is nothing in the
  /// short time before the parts come apart, or nearly so.
  std::vector<Flow> flows_of(const Arc& arc) const {
    constexpr double large = 3e4;
    constexpr double rounding = 1e-12;
    const auto is_bound = [&](double theta) { return !(std::abs(slip_->at(theta).settling) < large); };
    std::vector<double> angles = slip_->ends(arc.begin, arc.width);
    for (const double angle : motion_.press().derivative().zeros()) {
      const double behind = angle - arc.begin - two_pi * std::floor((angle - arc.begin) / two_pi);
      if (behind < arc.width) angles.push_back(arc.begin + behind);
    }
    std::sort(angles.begin(), angles.end());
    std::vector<Flow> flows;
    double from = arc.begin;
    bool was_bound = arc.touches || is_bound(from);
    if (!was_bound) flows.push_back({from, 0, 0});
    for (const double angle : angles) {
      const bool bound = is_bound(angle);
      double to = angle;
      for (double low = from; bound != was_bound && to - low > rounding;) {
        const double middle = 0.5 * (low + to);
        (is_bound(middle) == bound ? to : low) = middle;
      }
      if (!was_bound) flows.back().width = to - flows.back().begin;
      if (was_bound && !bound) flows.push_back({to, angle - to, 0});
      was_bound = bound;
      from = angle;
    }
    std::erase_if(flows, [](const Flow& flow) { return !(flow.width > 0); });
    return flows;
  }

  Vector of(double x, double y, double g) const { return Eigen::Vector3d(x, y, g).head(size_); }
  Matrix pressed() const {
    Matrix stiffness = Matrix::Zero(size_, size_);
    if (size_ > 2) stiffness(2, 2) = normal_;
    return stiffness;
  }

  void stick(const Arc& arc, const Arc& before) {
    Matrix stiffness = pressed();
    stiffness(0, 0) = stiffness(1, 1) = k_;
    law_.pieces.push_back({arc.begin, arc.width, stiffness});
    if (arcs_.size() == 1) return;
    law_.pieces.back().held = {{arc.memory, of(-k_, 0, 0)}, {arc.memory + 1, of(0, -k_, 0)}};
    for (const Index axis : {0, 1}) law_.memories.push_back(rested(arc, before, axis));
  }

  /// Whether m is known where slip ends.
  static bool flows_to_end(const Arc& arc) {
    return !arc.flows.empty() && arc.flows.back().begin + arc.flows.back().width >= arc.begin + arc.width;
  }

  /// dz along an axis as stick begins.
  DisturbedLaw::Memory rested(const Arc& arc, const Arc& before, Index axis) const {
    const Vector unit = axis == 0 ? of(1, 0, 0) : of(0, 1, 0);
    const auto rest = [unit](double /*theta*/) { return unit; };
    const auto part = [axis](Complex of_plane) { return axis == 0 ? of_plane.real() : of_plane.imag(); };
    if (arc.touches) {
      const CircleMotion::Local here = motion_.at(arc.begin);
      const double by_closing = -part(here.rate) / k_ * push_ / here.radius_rate;
      return {arc.begin, arc.width, unit + of(0, 0, by_closing), {}, rest};
    }
    const Complex n = slip_->direction(arc.begin);
    if (!flows_to_end(before))
      return {arc.begin, arc.width, unit + of(0, 0, -push_ / k_ * part(n)), {}, rest};
    return {arc.begin,
            arc.width,
            part(n) * of(n.real(), n.imag(), -push_ / k_),
            {{before.flows.back().memory, part(Complex(0, 1) * n)}},
            rest};
  }

  void slip(const Arc& arc, const Arc& before) {
    double at = arc.begin;
    for (const Flow& part : arc.flows) {
      edge(at, part.begin - at);
      law_.memories.push_back(begun(arc, before, part));
      double from = part.begin;
      for (const double to : slip_->ends(part.begin, part.width)) {
        flow(from, to, part.memory);
        from = to;
      }
      at = part.begin + part.width;
    }
    edge(at, arc.begin + arc.width - at);
  }

  /// m as it begins to flow.
  DisturbedLaw::Memory begun(const Arc& arc, const Arc& before, const Flow& part) const {
    const auto across = [size = size_, slip = slip_](double theta) {
      const Complex t = Complex(0, 1) * slip->direction(theta);
      return Vector(Eigen::Vector3d(t.real(), t.imag(), 0).head(size));
    };
    DisturbedLaw::Memory memory{part.begin, part.width, of(0, 0, 0), {}, across};
    const bool is_endless = &arc == &before;
    if (part.begin > arc.begin || arc.touches || (is_endless && !flows_to_end(arc))) {
      memory.set = across(part.begin);
    } else if (is_endless) {  // it slips for ever, and n turns its sign after half a period
      memory.of = {{arc.flows.back().memory, turn_ < two_pi ? -1 : 1}};
    } else {
      const Complex n = slip_->direction(part.begin);
      memory.of = {{before.memory, -n.imag()}, {before.memory + 1, n.real()}};
    }
    return memory;
  }

  /// Slip without m.
  void edge(double begin, double width) {
    if (!(width > 0)) return;
    const Complex n = slip_->direction(begin + 0.5 * width);
    Matrix stiffness = pressed();
    if (size_ > 2) stiffness.col(2).head<2>() = push_ * Eigen::Vector2d(n.real(), n.imag());
    law_.pieces.push_back({begin, width, stiffness});
  }

  /// Slip, cut into pieces over which what varies is resolved.
  void flow(double from, double to, Index memory) {
    constexpr double narrow = 1e-6;
    const Slip::Piece place = slip_->piece_at(0.5 * (from + to));
    const auto local = [slip = slip_, place](double theta) {
      const Slip::Local here = slip->at(theta, place);
      return Vector(
          Eigen::Vector4d(here.direction.real(), here.direction.imag(), here.turning, here.settling));
    };
    if (to - from > narrow && !is_resolved(local, from, to - from)) {
      const double middle = 0.5 * (from + to);
      flow(from, middle, memory);
      return flow(middle, to, memory);
    }
    DisturbedLaw::Piece piece{from, to - from, pressed()};
    double pace = 0;
    for (const double theta : {from, 0.5 * (from + to), to}) {
      const Slip::Local here = slip_->at(theta, place);
      pace = std::max(pace, std::abs(here.turning) + std::abs(here.settling));
    }
    VaryingLaw varying{{}, {}, k_ + push_, 0, pace};
    for (Index row = 0; row <= size_; ++row) {
      for (Index column = 0; column <= size_; ++column) {
        if (row != 2 || size_ == 2) varying.places.push_back({row, column});
      }
    }
    varying.terms = interpolated([slip = slip_, place, k = k_, push = push_, size = size_](double theta) {
      return rows(slip->at(theta, place), k, push, size);
    });
    piece.varying = std::make_shared<const VaryingLaw>(std::move(varying));
    piece.from = memory;
    law_.pieces.push_back(std::move(piece));
  }

  /// Of dT and dm/dtheta, by dr, dg and m, row by row.
  static Vector rows(const Slip::Local& here, double k, double push, Index size) {
    const Eigen::Vector2d n(here.direction.real(), here.direction.imag());
    const Eigen::Vector2d t(-n(1), n(0));
    Matrix all = Matrix::Zero(3, size + 1);
    all.topLeftCorner<2, 2>() = k * t * t.transpose();
    all.col(size).head<2>() = -k * t;
    all.row(2).head<2>() = -here.turning * n + here.settling * t;
    all(2, size) = -here.settling;
    if (size > 2) {
      all.col(2).head<2>() = push * n;
      all(2, 2) = here.turning * push / k;
    }
    return all.reshaped<Eigen::RowMajor>();
  }

  const CircleMotion& motion_;
  double k_;
  double normal_;
  double push_;  // mu k_n
  double turn_;
  Index size_;
  std::shared_ptr<const Slip> slip_;
  std::vector<Arc> arcs_;
  DisturbedLaw law_;
};

}  // namespace

DisturbedLaw circle_law(const CircleMotion& motion, const CircleCourse& course, bool closes, double turn) {
  return Builder(motion, course, closes, turn).found();
}

}  // namespace arcslip
