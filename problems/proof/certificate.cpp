#include "arcslip/problems/proof/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace arcslip::problems {
namespace {

using continuation::BranchPoint;

constexpr int most_halvings = 40;
constexpr long most_boxes = 4096;       // for one segment
constexpr int halvings_at_fold = 8;     // before roles are exchanged: they confine the fold
constexpr int halvings_elsewhere = 24;  // before roles are exchanged, as at a fold that was missed
constexpr int halvings_of_range = 12;   // to show Im c < 0

int sign(double x) { return (x > 0) - (x < 0); }
int sign(const Interval& x) { return (x.lower() > 0) - (x.upper() < 0); }

/// In the lengths of the steps that lead from one point to another.
double extent(const PlanePoint& from, const PlanePoint& to, bool is_linear) {
  const double across = std::log(to.parameter / from.parameter);
  return is_linear ? std::abs(across) : std::hypot(across, to.rho - from.rho);
}

/// The way that the coordinate goes of which the other one is a function.
int direction(const TiltedBox& box) {
  return box.axis == Axis::rho ? sign(box.to.parameter - box.from.parameter)
                               : sign(box.to.rho - box.from.rho);
}

/// The boxes in the branch's order.
class Chain {
 public:
  explicit Chain(const EnclosedEquation& equation) : equation_(equation) {}

  long boxes() const { return boxes_; }
  long parameter_boxes() const { return parameter_boxes_; }
  Axis last_axis() const { return boxes_ == 0 ? Axis::rho : last_.axis; }

  /// Why a box does not go on from the last one; empty if it does.
  std::string objection(const TiltedBox& box) const {
    if (boxes_ == 0) return "";
    const char* back = "it turns back without a fold";
    if (box.axis == last_.axis) return direction(box) != 0 && direction(box) == -direction(last_) ? back : "";
    const bool rises = box.axis == Axis::rho;
    const int slope = slope_at(box.from, rises ? box : last_, rises ? last_ : box);
    if (slope == 0) return "boxes do not join where rho and the parameter exchange their roles";
    return direction(box) == slope * direction(last_) ? "" : back;
  }

  void add(const TiltedBox& box) {
    if (box.axis == Axis::parameter) {
      ++parameter_boxes_;
      const double w = box.half_width;
      const auto [low, high] = std::minmax(box.from.parameter, box.to.parameter);
      if (boxes_ == 0 || last_.axis == Axis::rho) turns_.push_back({low - w, high + w, false});
      turns_.back().low = std::min(turns_.back().low, low - w);
      turns_.back().high = std::max(turns_.back().high, high + w);
      widest_ = std::max(widest_, w / low);
    } else {
      const int way = direction(box);
      if (boxes_ > 0 && last_.axis == Axis::parameter) {
        turns_.back().certain = way_ == -way && way != 0;
        merge_last_turns();
      }
      if (way != 0) way_ = way;
      widest_ = std::max(widest_, box.half_width);
    }
    ++boxes_;
    last_ = box;
  }

  double widest() const { return widest_; }
  const std::vector<Turn>& turns() const { return turns_; }

 private:
  /// Two ranges that overlap become one, but where both hold a fold.
  void merge_last_turns() {
    if (turns_.size() < 2) return;
    Turn& turn = turns_[turns_.size() - 2];
    const Turn& last = turns_.back();
    if (turn.certain && last.certain) return;
    if (last.low > turn.high || last.high < turn.low) return;
    turn = {std::min(turn.low, last.low), std::max(turn.high, last.high), turn.certain || last.certain};
    turns_.pop_back();
  }

  /// The sign of drho/dq of the one curve in a rectangle about a point where boxes of different axes meet: it
  /// holds the zeros of both on the lines through the point. 0 where that is not sure.
  int slope_at(const PlanePoint& at, const TiltedBox& rho_box, const TiltedBox& parameter_box) const {
    try {
      const Interval residual = norm(equation_.residual(at));
      const auto around = [&](double x, const TiltedBox& box) {
        const double reach = (residual * inverse(Interval(box.slope))).upper();
        return Interval(x) + Interval(-reach, reach);
      };
      const EnclosedGradient gradient =
          equation_.gradient(around(at.parameter, parameter_box), around(at.rho, rho_box));
      return -sign(gradient.parameter) * sign(gradient.rho);
    } catch (const NoEnclosure&) {
      return 0;
    }
  }

  const EnclosedEquation& equation_;
  TiltedBox last_{};
  int way_ = 0;  // of the parameter, in the last box of which rho is the axis
  long boxes_ = 0;
  long parameter_boxes_ = 0;
  double widest_ = 0;
  std::vector<Turn> turns_;
};

/// Proves one segment after the other.
class Prover {
 public:
  /// `eta_low` and `eta_high` are the range of the branch.
  Prover(const ForcedResponse& problem, ContactProblem::Parameter parameter, const Vector& parameters,
         double eta_low, double eta_high)
      : problem_(problem),
        parameter_(parameter),
        parameters_(parameters),
        equation_(problem.system(), parameter, parameters(1 - parameter)),
        chain_(equation_),
        single_valued_(is_passive(eta_low, eta_high, halvings_of_range)) {}

  PlanePoint point(const BranchPoint& stored) const {
    return {stored.parameters(parameter_), stored.unknowns(0)};
  }

  /// Why a stored point is none of the branch; empty if it is one.
  std::string check(const PlanePoint& point, double tolerance) const {
    try {
      const double residual = norm(equation_.residual(point));
      return residual <= 2 * tolerance ? "" : fmt::format("|g| = {:.2g} there", residual);
    } catch (const NoEnclosure& none) {
      return none.what();
    }
  }

  /// Why there is no proof of a segment; empty if there is one. At a fold it may be that of a single
  /// parameter for each rho.
  std::string prove(const PlanePoint& from, const PlanePoint& to, bool at_fold) {
    halvings_before_exchange_ = at_fold ? halvings_at_fold : halvings_elsewhere;
    most_boxes_ = chain_.boxes() + most_boxes;
    return prove(from, to, 0);
  }

  bool single_valued() const { return single_valued_; }
  const Chain& chain() const { return chain_; }

 private:
  /// Of a unique response no fold is possible, so that the roles are exchanged freely; else only where it is
  /// needed, and late.
  std::vector<Axis> axes(int halvings) const {
    if (single_valued_ && chain_.last_axis() == Axis::parameter) return {Axis::parameter, Axis::rho};
    if (single_valued_ || halvings >= halvings_before_exchange_) return {Axis::rho, Axis::parameter};
    return {Axis::rho};
  }

  std::string prove(const PlanePoint& from, const PlanePoint& to, int halvings) {
    if (from.parameter == to.parameter && from.rho == to.rho) return "";
    std::string reason =
        fmt::format("no box about the piece from {:.12g} holds a single solution", from.parameter);
    for (const Axis axis : axes(halvings)) {
      const std::optional<TiltedBox> box = equation_.certified_box(from, to, axis);
      if (!box) continue;
      reason = chain_.objection(*box);
      if (!reason.empty()) continue;
      chain_.add(*box);
      return "";
    }
    if (halvings == most_halvings) return reason;
    if (chain_.boxes() >= most_boxes_) return fmt::format("it takes more than {} boxes", most_boxes);
    const PlanePoint middle = between(from, to);
    reason = prove(from, middle, halvings + 1);
    return reason.empty() ? prove(middle, to, halvings + 1) : reason;
  }

  bool is_passive(double low, double high, int halvings) const {
    if (equation_.is_passive(parameter_ == ContactProblem::eta ? Interval(low, high) : Interval(low)))
      return true;
    if (halvings == 0 || low == high) return false;
    const double middle = 0.5 * (low + high);
    return is_passive(low, middle, halvings - 1) && is_passive(middle, high, halvings - 1);
  }

  /// The point of the branch nearest to the middle of a piece, to rounding, by Newton's method; wherever it
  /// leads, the proof does not rest on it.
  PlanePoint between(const PlanePoint& from, const PlanePoint& to) const {
    constexpr int corrections = 6;
    Vector unknown(1), parameters = parameters_, residual(1);
    Matrix slope(1, 1), slopes(1, 2);
    double& q = parameters(parameter_);
    q = 0.5 * (from.parameter + to.parameter);
    unknown(0) = 0.5 * (from.rho + to.rho);
    const PlanePoint middle{q, unknown(0)};
    for (int i = 0; i < corrections; ++i) {
      const double threshold = problem_.system().slip_threshold(parameters(ContactProblem::eta),
                                                                parameters(ContactProblem::preload));
      const continuation::Regime regime =
          unknown(0) > std::log(threshold) ? ContactProblem::slip : ContactProblem::stick;
      if (!problem_.evaluate(unknown, parameters, regime, {&residual, &slope, &slopes})) return middle;
      const double by_log_q = q * slopes(0, parameter_);
      const double correction = -residual(0) / (slope(0, 0) * slope(0, 0) + by_log_q * by_log_q);
      unknown(0) += correction * slope(0, 0);
      q += correction * by_log_q * q;
    }
    return std::isfinite(q) && std::isfinite(unknown(0)) ? PlanePoint{q, unknown(0)} : middle;
  }

  const ForcedResponse& problem_;
  ContactProblem::Parameter parameter_;
  Vector parameters_;
  EnclosedEquation equation_;
  Chain chain_;
  bool single_valued_;
  long most_boxes_ = 0;
  int halvings_before_exchange_ = 0;
};

bool is_fold(const BranchPoint& point) {
  return point.type == continuation::PointType::fold || point.type == continuation::PointType::corner_fold;
}

/// The first segment that is not proven.
std::optional<Certificate::Gap> first_gap(const ForcedResponse& problem, Prover& prover,
                                          const std::vector<BranchPoint>& points,
                                          const CertificateOptions& options) {
  if (points.size() < 2) return Certificate::Gap{0, "there is no second point"};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (options.go_on && !options.go_on()) return Certificate::Gap{i, "interrupted"};
    const PlanePoint from = prover.point(points[i]);
    const PlanePoint to = prover.point(points[i + 1]);
    std::string reason = i == 0 ? prover.check(from, options.tolerance) : "";
    if (reason.empty()) reason = prover.check(to, options.tolerance);
    const bool is_linear = problem.is_linear(points[i].regime);
    if (reason.empty() && !(extent(from, to, is_linear) <= 2 * options.max_step))
      reason = "it is longer than a step";
    const bool at_fold = is_fold(points[i]) || is_fold(points[i + 1]);
    const long before = prover.chain().parameter_boxes();
    if (reason.empty()) reason = prover.prove(from, to, at_fold);
    const bool may_fold = !prover.single_valued() && prover.chain().parameter_boxes() > before;
    if (reason.empty() && may_fold && !at_fold) reason = "a fold within is not excluded";
    if (!reason.empty()) return Certificate::Gap{i, reason};
  }
  return std::nullopt;
}

}  // namespace

Certificate certify(const ForcedResponse& problem, const continuation::Branch& branch,
                    ContactProblem::Parameter parameter, const CertificateOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Certificate certificate;
  if (branch.points.empty()) {
    certificate.gap = {0, "there is no point"};
    return certificate;
  }
  const Vector& first = branch.points.front().parameters;
  double low = first(ContactProblem::eta), high = low;
  for (const BranchPoint& point : branch.points) {
    low = std::min(low, point.parameters(ContactProblem::eta));
    high = std::max(high, point.parameters(ContactProblem::eta));
  }
  Prover prover(problem, parameter, first, low, high);
  certificate.gap = first_gap(problem, prover, branch.points, options);
  certificate.from = first(parameter);
  certificate.to = branch.points.back().parameters(parameter);
  certificate.boxes = prover.chain().boxes();
  certificate.widest = prover.chain().widest();
  certificate.single_valued = prover.single_valued();
  if (!certificate.single_valued) certificate.turns = prover.chain().turns();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  certificate.seconds = seconds.count();
  return certificate;
}

}  // namespace arcslip::problems
