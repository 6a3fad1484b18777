#include "arcslip/problems/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace arcslip::problems {
namespace {

using continuation::BranchPoint;

constexpr int most_halvings = 40;
constexpr int halvings_before_exchange = 6;  // of the roles, so that folds are confined well
constexpr int halvings_of_range = 12;        // to show Im c < 0

int sign(double x) { return (x > 0) - (x < 0); }
int sign(const Interval& x) { return (x.lower() > 0) - (x.upper() < 0); }

double extent(const PlanePoint& from, const PlanePoint& to) {
  return std::hypot(std::log(to.parameter / from.parameter), to.rho - from.rho);
}

struct Box {
  PlanePoint from;
  PlanePoint to;
  Axis axis;
  double half_width;

  /// The way that the coordinate which is not `axis` goes.
  int direction() const {
    return axis == Axis::rho ? sign(to.parameter - from.parameter) : sign(to.rho - from.rho);
  }
};

/// Puts boxes together in the branch's order.
class Chain {
 public:
  explicit Chain(const EnclosedEquation& equation) : equation_(equation) {}

  /// Why a box does not go on from the last one; empty if it does.
  std::string add(const Box& box) {
    std::string reason = boxes_ == 0 ? "" : joint(box);
    if (!reason.empty()) return reason;
    if (box.axis == Axis::parameter) {
      if (boxes_ == 0 || last_.axis == Axis::rho) turns_.push_back({box.from.parameter, box.from.parameter, false});
      Turn& turn = turns_.back();
      turn.low = std::min({turn.low, box.from.parameter - box.half_width, box.to.parameter - box.half_width});
      turn.high = std::max({turn.high, box.from.parameter + box.half_width, box.to.parameter + box.half_width});
    } else if (box.direction() != 0) {
      if (boxes_ > 0 && last_.axis == Axis::parameter) turns_.back().certain = way_ == -box.direction();
      way_ = box.direction();
    }
    ++boxes_;
    widest_ = std::max(widest_, box.axis == Axis::rho ? box.half_width : box.half_width / box.from.parameter);
    last_ = box;
    return "";
  }

  void write(Certificate& certificate) const {
    certificate.boxes = boxes_;
    certificate.widest = widest_;
    certificate.turns = turns_;
  }

 private:
  std::string joint(const Box& box) const {
    const int direction = box.direction();
    if (box.axis == last_.axis) {
      const bool back = direction != 0 && direction == -last_.direction();
      return back ? "it turns back without a fold" : "";
    }
    const Box& upright = box.axis == Axis::rho ? box : last_;
    const Box& level = box.axis == Axis::rho ? last_ : box;
    const PlanePoint& at = box.from;
    try {
      const auto around = [](double x, double half_width) {
        return Interval(x) + Interval(-half_width, half_width);
      };
      const EnclosedGradient gradient = equation_.gradient(around(at.parameter, level.half_width),
                                                           around(at.rho, upright.half_width));
      const int slope = -sign(gradient.parameter) * sign(gradient.rho);
      if (slope == 0) return "boxes do not join where rho and the parameter exchange their roles";
      return level.direction() == slope * upright.direction() ? "" : "it turns back without a fold";
    } catch (const NoEnclosure& none) {
      return none.what();
    }
  }

  const EnclosedEquation& equation_;
  Box last_{};
  int way_ = 0;  // of the parameter, in the last box that was a function of it
  long boxes_ = 0;
  double widest_ = 0;
  std::vector<Turn> turns_;
};

/// Proves one segment after the other.
class Prover {
 public:
  Prover(const ForcedResponse& problem, ContactProblem::Parameter parameter, const Vector& parameters)
      : problem_(problem),
        parameter_(parameter),
        parameters_(parameters),
        equation_(problem.system(), parameter, parameters(1 - parameter)),
        chain_(equation_) {}

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

  /// Why there is no proof; empty if there is one.
  std::string prove(const PlanePoint& from, const PlanePoint& to, int halvings = 0) {
    if (from.parameter == to.parameter && from.rho == to.rho) return "";
    for (const Axis axis : {Axis::rho, Axis::parameter}) {
      if (axis == Axis::parameter && halvings < halvings_before_exchange) break;
      const auto half_width = equation_.certified_half_width(from, to, axis);
      if (half_width) return chain_.add({from, to, axis, *half_width});
    }
    if (halvings == most_halvings)
      return fmt::format("no box about the piece at {:.12g} holds a single solution", from.parameter);
    const PlanePoint middle = between(from, to);
    std::string reason = prove(from, middle, halvings + 1);
    return reason.empty() ? prove(middle, to, halvings + 1) : reason;
  }

  bool is_single_valued(double low, double high, int halvings = 0) const {
    if (equation_.is_passive({low, high})) return true;
    if (halvings == halvings_of_range || low == high) return false;
    const double middle = 0.5 * (low + high);
    return is_single_valued(low, middle, halvings + 1) && is_single_valued(middle, high, halvings + 1);
  }

  const Chain& chain() const { return chain_; }

 private:
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
      const double threshold =
          problem_.system().slip_threshold(parameters(ContactProblem::eta), parameters(ContactProblem::preload));
      const int regime = unknown(0) > std::log(threshold) ? ContactProblem::slip : ContactProblem::stick;
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
};

/// The first segment that is not proven.
std::optional<Certificate::Gap> first_gap(Prover& prover, const std::vector<BranchPoint>& points,
                                          const CertificateOptions& options) {
  if (points.size() < 2) return Certificate::Gap{0, "there is no second point"};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const PlanePoint from = prover.point(points[i]);
    const PlanePoint to = prover.point(points[i + 1]);
    std::string reason;
    for (const PlanePoint& end : {from, to}) {
      if (reason.empty()) reason = prover.check(end, options.tolerance);
    }
    if (reason.empty() && !(extent(from, to) <= 2 * options.max_step)) reason = "it is longer than a step";
    if (reason.empty()) reason = prover.prove(from, to);
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
  Prover prover(problem, parameter, first);
  certificate.gap = first_gap(prover, branch.points, options);
  prover.chain().write(certificate);
  certificate.from = first(parameter);
  certificate.to = branch.points.back().parameters(parameter);
  double low = first(ContactProblem::eta), high = low;
  for (const BranchPoint& point : branch.points) {
    low = std::min(low, point.parameters(ContactProblem::eta));
    high = std::max(high, point.parameters(ContactProblem::eta));
  }
  certificate.single_valued = prover.is_single_valued(low, high);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  certificate.seconds = seconds.count();
  return certificate;
}

}  // namespace arcslip::problems
