#include "time/masing_law.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

constexpr Index degree = 4;
constexpr Index deepest = 24;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// F of a backbone as a continuous polynomial in each of its zones.
class BackbonePieces {
 public:
  explicit BackbonePieces(const Backbone& backbone) : backbone_(backbone) {
    const std::vector<double> corners = backbone.corners();
    scale_ = backbone.force(corners.back()).value;
    double from = 0;
    for (const double corner : corners) {
      if (corner > from) add(from, corner);
      from = std::max(from, corner);
    }
    zones_.push_back({from, backbone.force(from).value, {backbone.slope(from)}});
  }

  struct Zone {
    double begin;
    double value;                // F there
    std::vector<double> powers;  // of the distance from there
  };
  const Zone& zone(int which) const { return zones_[static_cast<std::size_t>(which)]; }
  double end(int which) const { return which + 1 < std::ssize(zones_) ? zone(which + 1).begin : infinite; }
  int at(double x) const {
    int which = 0;
    while (x >= end(which)) ++which;
    return which;
  }
  double value(double x) const { return sum(x, 0); }
  double slope(double x) const { return sum(x, 1); }

 private:
  double sum(double x, int derivative) const {
    const Zone& of = zone(at(x));
    double value = derivative == 0 ? of.value : 0;
    double power = 1;
    for (std::size_t k = 0; k < of.powers.size(); ++k) {
      const double next = power * (x - of.begin);
      value += of.powers[k] * (derivative == 0 ? next : static_cast<double>(k + 1) * power);
      power = next;
    }
    return value;
  }

  void add(double from, double to) {
    constexpr double tolerance = 1e-8;
    const double width = to - from;
    Matrix powers(degree, degree);
    Vector values(degree);
    const double start = backbone_.force(from).value;
    for (Index i = 0; i < degree; ++i) {  // at the points of Chebyshev and Lobatto
      const double s = 0.5 * (1 - std::cos(pi * static_cast<double>(i + 1) / degree));
      for (Index k = 0; k < degree; ++k) powers(i, k) = std::pow(s, k + 1);
      values(i) = backbone_.force(i + 1 == degree ? to : from + s * width).value - start;
    }
    const Vector terms = solution_of(powers, values);
    double error = 0;
    for (int i = 1; i < 16; ++i) {
      const double s = i / 16.0;
      double value = start;
      for (Index k = 0; k < degree; ++k) value += terms(k) * std::pow(s, k + 1);
      error = std::max(error, std::abs(value - backbone_.force(from + s * width).value));
    }
    if (error > tolerance * scale_ && width > 1e-9 * to) {
      const double middle = from > 0 ? 0.5 * (from + to) : 0.125 * to;  // powers of x bend most at 0
      add(from, middle);
      return add(middle, to);
    }
    Zone zone{from, start, {}};
    for (Index k = 0; k < degree; ++k) {
      const double term = std::abs(terms(k)) > 1e-13 * scale_ ? terms(k) : 0;
      zone.powers.push_back(term / std::pow(width, k + 1));
    }
    while (zone.powers.size() > 1 && zone.powers.back() == 0) zone.powers.pop_back();
    zones_.push_back(std::move(zone));
  }

  const Backbone& backbone_;
  double scale_;
  std::vector<Zone> zones_;
};

class MasingLaw final : public RingLaw {
 public:
  MasingLaw(const Backbone& backbone, double load) : pieces_(backbone), load_(load) {}

  Index memories() const override { return deepest; }
  double steepest() const override { return pieces_.slope(0); }
  int phase_at_rest() const override { return packed({1, 0, 0}); }

  RingBranch branch(int phase, std::span<const double> memory) const override {
    const Phase now = unpacked(phase);
    const BackbonePieces::Zone& zone = pieces_.zone(now.zone);
    const double unit = scale(now);
    RingBranch branch;
    double power = now.side * unit;
    for (const double term : zone.powers) {
      power *= now.side / unit;
      branch.powers.push_back(term * power);
    }
    branch.origin = turning(now, memory) + now.side * unit * zone.begin;
    branch.origin_memory = now.depth - 1;
    branch.offset = now.side * unit * zone.value;
    branch.by_memory.assign(static_cast<std::size_t>(now.depth), 0.0);
    double before = 0;
    for (int j = 0; j < now.depth; ++j) {  // forces at the turning points
      const double here = memory[static_cast<std::size_t>(j)];
      const double half = (j == 0 ? 1 : 2) * load_;
      const double way = std::abs(here - before) / half;
      branch.offset += std::copysign(half * pieces_.value(way), here - before);
      const double slope = pieces_.slope(way);
      branch.by_memory[static_cast<std::size_t>(j)] += slope;
      if (j > 0) branch.by_memory[static_cast<std::size_t>(j - 1)] -= slope;
      before = here;
    }
    return branch;
  }

  void events(int phase, std::span<const double> memory, std::vector<RingEvent>& events) const override {
    const Phase now = unpacked(phase);
    const double side = now.side;
    const double end = pieces_.end(now.zone);
    events.clear();
    events.push_back({RingEvent::Of::rate, -side});
    events.push_back({RingEvent::Of::place, side, 0, side * turning(now, memory) + scale(now) * end});
    if (now.depth == 0) return;
    // A little before the loop closes, so that cycles which just do so are one kind of motion. The two
    // branches touch: forces differ by the square of it.
    constexpr double early = 1e-6;
    const double last = turning(now, memory);
    const double close = now.depth == 1 ? -last : memory[static_cast<std::size_t>(now.depth - 2)];
    events.push_back({RingEvent::Of::place, side, 0, side * close - early * std::abs(close - last)});
  }

  RingMemoryChanges change(std::size_t which, const RingPlace& at, int& phase,
                           std::span<double> memory) const override {
    Phase now = unpacked(phase);
    RingMemoryChanges changes;
    if (which == 1) {
      ++now.zone;
    } else if (which == 2) {
      now.depth = std::max(0, now.depth - 2);
      now.zone = zone_of(now, at.x, memory);
    } else {
      if (now.depth > 0 || now.side * at.x > 0) {
        if (now.depth == deepest) throw std::runtime_error("microslip: too many loops within loops");
        changes.push_back({now.depth, 1});
        memory[static_cast<std::size_t>(now.depth++)] = at.x;
      }
      now.side = -now.side;
      now.zone = 0;
    }
    phase = packed(now);
    return changes;
  }

  bool needs(int phase, Index number) const override { return number < unpacked(phase).depth; }
  RingMemoryChange idle(int /*phase*/, const RingPlace& /*at*/, Index number,
                        std::span<double> memory) const override {
    memory[static_cast<std::size_t>(number)] = 0;
    return {number, 0, 0};
  }

  void begin(const Vector& x, const RingPlace& now, const Complex& /*force*/, int& phase,
             std::span<double> memory) const override {
    Index greatest = 0;
    x.cwiseAbs().maxCoeff(&greatest);
    std::fill(memory.begin(), memory.end(), 0.0);
    Phase course{x(greatest) > 0 ? -1 : 1, 0, 1};
    // A little less than the motion reaches, since it never forgets a place that it does not come back to.
    memory[0] = 0.999 * vertex(x, greatest);
    for (Index k = greatest + 1; k < x.size(); ++k) {
      if (course.side * (x(k) - x(k - 1)) < 0) {
        if (course.depth == deepest) break;
        memory[static_cast<std::size_t>(course.depth++)] = vertex(x, k - 1);
        course.side = -course.side;
      }
      while (course.depth > 2 &&
             course.side * (x(k) - memory[static_cast<std::size_t>(course.depth - 2)]) >= 0)
        course.depth -= 2;
    }
    for (auto j = static_cast<std::size_t>(course.depth); j < memory.size(); ++j) memory[j] = 0;
    course.zone = zone_of(course, now.x, memory);
    phase = packed(course);
  }

 private:
  struct Phase {
    int side;   // of the way
    int zone;   // of the backbone
    int depth;  // turning points in memory; 0 on the backbone
  };
  static int packed(const Phase& phase) {
    return phase.side * (1 + phase.depth + (deepest + 2) * phase.zone);
  }
  static Phase unpacked(int phase) {
    const int rest = std::abs(phase) - 1;
    return {phase > 0 ? 1 : -1, rest / (static_cast<int>(deepest) + 2),
            rest % (static_cast<int>(deepest) + 2)};
  }
  double scale(const Phase& phase) const { return phase.depth == 0 ? load_ : 2 * load_; }
  static double turning(const Phase& phase, std::span<const double> memory) {
    return phase.depth == 0 ? 0 : memory[static_cast<std::size_t>(phase.depth - 1)];
  }
  int zone_of(const Phase& phase, double x, std::span<const double> memory) const {
    return pieces_.at(phase.side * (x - turning(phase, memory)) / scale(phase));
  }

  /// Of the parabola through a sample and its neighbours.
  static double vertex(const Vector& x, Index k) {
    const double before = x((k + x.size() - 1) % x.size());
    const double behind = x((k + 1) % x.size());
    const double bend = before - 2 * x(k) + behind;
    return bend == 0 ? x(k) : x(k) - std::pow(behind - before, 2) / (8 * bend);
  }

  BackbonePieces pieces_;
  double load_;
};

}  // namespace

std::unique_ptr<const RingLaw> masing_law(const Backbone& backbone, double load) {
  return std::make_unique<MasingLaw>(backbone, load);
}

}  // namespace arcslip
