// The first solution of a forced response: linear where all contacts stick and nothing else acts, else
// reached from there.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/problem/one_piece.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip::problems {

using continuation::Gradient;
using continuation::Guess;
using continuation::Regime;

/// The response at fixed eta and P over the share of the load that acts.
class HarmonicResponse::LoadPath : public continuation::Problem {
 public:
  LoadPath(const HarmonicResponse& response, Vector parameters)
      : response_(response), parameters_(std::move(parameters)) {}

  Index size() const override { return response_.size(); }
  std::vector<std::string> parameter_names() const override { return {"load"}; }
  std::unique_ptr<continuation::CondensedJacobian> condensed_jacobian() const override {
    return response_.condensed_jacobian();
  }

  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const continuation::Evaluation& out) const override {
    continuation::Evaluation inner = out;
    Matrix columns(size(), parameters_.size() + 1);
    if (out.parameter_jacobian != nullptr) inner.parameter_jacobian = &columns;
    if (!response_.evaluate(u, parameters_, regime, p(0), inner)) return false;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = columns.rightCols<1>();
    return true;
  }

  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    unknowns.setConstant(u.norm());
    parameters = p;
  }

  Index switch_count() const override { return response_.switch_count(); }
  std::string describe(const Regime& regime) const override { return response_.describe(regime); }
  int border_count(const Regime& regime) const override { return response_.border_count(regime); }
  double border(const Vector& u, const Vector& /*p*/, const Regime& regime, int border,
                Gradient* gradient) const override {
    if (gradient == nullptr) return response_.border(u, parameters_, regime, border, nullptr);
    Gradient inner{Vector(size()), Vector(parameters_.size())};
    const double value = response_.border(u, parameters_, regime, border, &inner);
    gradient->unknowns = inner.unknowns;
    gradient->parameters.setZero();
    return value;
  }
  std::optional<Regime> regime_beyond(const Regime& regime, int border) const override {
    return response_.regime_beyond(regime, border);
  }
  std::string reason_of_end() const override { return response_.reason_of_end(); }

 private:
  const HarmonicResponse& response_;
  Vector parameters_;
};

/// The end of a branch of `path` over one of its parameters; none where it comes back to its start.
std::optional<Guess> HarmonicResponse::reached(const continuation::Problem& path, const Guess& start,
                                               Index parameter, double to,
                                               const continuation::TraceOptions& limits) const {
  continuation::TraceOptions options;
  options.parameter = path.parameter_names()[static_cast<std::size_t>(parameter)];
  options.from = start.parameters(parameter);
  options.to = to;
  options.bound *= std::max(1.0, to / options.from);  // as under a load, which motions grow with
  options.branch_point_pairs = false;
  options.max_points = 10000;  // a hundred do, unless the branch winds round a negative damping
  options.max_seconds = limits.max_seconds;
  options.go_on = limits.go_on;
  const continuation::Branch branch = trace(path, start, options);
  const char* from = coordinates_.has_others() ? "a small force" : "a high preload";
  if (is_unfinished(branch.stop))
    throw continuation::Unfinished(branch.stop,
                                   fmt::format("on the way from {}: {}", from, branch.explanation));
  if (branch.stop == continuation::Stop::left_range) return std::nullopt;
  if (branch.stop != continuation::Stop::reached_end)
    throw std::invalid_argument(fmt::format("no way from {}: {}", from, branch.explanation));
  const continuation::BranchPoint& end = branch.points.back();
  return Guess{end.unknowns, end.parameters, end.regime};
}

Guess HarmonicResponse::guess(double eta_value, double preload_value,
                              const continuation::TraceOptions& limits) const {
  Vector parameters(2);
  parameters << eta_value, preload_value;
  if (is_varied()) {
    parameters.conservativeResize(3);
    parameters(further) = system_.varied->value;
  }
  return guess(parameters, limits);
}

Guess HarmonicResponse::guess(const Vector& parameters, const continuation::TraceOptions& limits) const {
  Guess guess{Vector::Zero(size()), parameters, 0};
  if (!has_value(parameters)) throw std::invalid_argument("eta and the preload must be positive");
  const double preload_value = parameters(preload);
  guess.regime = at_rest({}, parameters);
  Order order;
  bool is_sine = true;
  for (Index a = 0; a < harmonics(); ++a) {
    set_order(a, parameters, guess.regime, order);
    if (order.joint.free.isZero(0)) continue;
    is_sine = a == 0;
    ContactMatrix stuck = order.joint.compliance;  // but for elements beside the contacts
    for (Index j = 0; j < coordinates_.size(); ++j) {
      if (is_linear(guess.regime, j)) continue;
      stuck.col(j).setZero();
      stuck(j, j) = 1;
    }
    const ContactVector x = -solution_of(stuck, order.joint.free);
    for (Index i = 0; i < coordinates_.size(); ++i)
      guess.unknowns.segment<2>(2 * (i * harmonics() + a)) << x(i).real(), x(i).imag();
  }
  double holding = 0;  // load over that which lets nothing slip
  for (Index i = 0; i < contacts(); ++i) {
    const HarmonicVector x = motion(guess.unknowns, i);
    const double largest = is_sine ? std::abs(x(0)) : Swing::of(system_.orders, x).peak();
    holding = std::max(holding, largest / slip_threshold(i, guess.parameters));
  }
  if (!coordinates_.has_others()) {
    if (holding <= 1) return guess;
    guess.parameters(preload) =
        1.5 * holding * pressing({}, parameters) - pressing({}, parameters) + preload_value;
    // Contacts of a whole ring begin to slip one after the other, which joins smoothly.
    const std::shared_ptr<const HarmonicResponse> own(std::shared_ptr<const void>(), this);
    const continuation::OnePiece joined(own);
    const bool joins = system_.sectors > 1;
    auto end = joins ? reached(joined, guess, preload, preload_value, limits)
                     : reached(*this, guess, preload, preload_value, limits);
    if (end && joins)
      end->regime = continuation::regime_at(*this, end->unknowns, end->parameters, end->regime);
    if (end) return *end;
    throw std::invalid_argument("the way from a high preload leads back there");
  }
  const double part = 1 / std::max(1.0, holding);
  std::string why = "the way from a small force leads back there";
  double stuck = 0;  // share of the load that lets nothing slip
  if (const auto end = under_load(guess, part, limits, stuck, why)) return *end;
  Guess pressed = guess;  // by so much that all of it does not
  pressed.parameters(preload) /= stuck;
  std::string unheard;
  if (const auto high = under_load(pressed, part, limits, stuck, unheard)) {
    if (const auto end = reached(*this, *high, preload, preload_value, limits)) return *end;
  }
  throw std::invalid_argument(why);
}

/// The response under all of the load, by the way there from one that lets nothing slip, `stuck`: at most a
/// thousandth of `part` of it. None where no way leads there, and why.
std::optional<Guess> HarmonicResponse::under_load(const Guess& guess, double part,
                                                  const continuation::TraceOptions& limits, double& stuck,
                                                  std::string& why) const {
  // Near a resonance of what the elements make of it a branch may fold back below its first force.
  constexpr double least = 1e-12;
  for (double small = 1e-3; small > least; small *= 1e-3) {
    Guess start = guess;
    stuck = take_small(start, small * part);
    start.parameters = Vector::Constant(1, stuck);
    try {
      std::optional<Guess> end = reached(LoadPath(*this, guess.parameters), start, 0, 1, limits);
      if (!end) continue;
      end->parameters = guess.parameters;
      return end;
    } catch (const std::invalid_argument& error) {
      why = error.what();
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// Makes the stuck response that under a share of the load, at most `share`, which it returns: one under
/// which these do not slip, and what the elements beside the contacts do to it is nothing or, where they act
/// on the smallest motions, does so after steps of Newton's.
double HarmonicResponse::take_small(Guess& stuck, double share) const {
  constexpr double nothing = 1e-3;
  constexpr double smallest = 1e-100;
  constexpr double smallest_stiff = 1e-12;
  constexpr int most_steps = 20;
  Vector residual(size());
  Matrix jacobian(size(), size());
  const auto is_solved = [&](const Vector& u, double part, Matrix* by_unknowns) {
    return evaluate(u, stuck.parameters, stuck.regime, part, {&residual, by_unknowns}) &&
           residual.lpNorm<Eigen::Infinity>() < nothing &&
           continuation::regime_at(*this, u, stuck.parameters, stuck.regime) == stuck.regime;
  };
  const auto found = [&](Vector u, double part) {
    stuck.unknowns = std::move(u);
    return part;
  };
  for (double part = share; part > smallest; part *= 0.1) {
    if (is_solved(part * stuck.unknowns, part, nullptr)) return found(part * stuck.unknowns, part);
  }
  for (double part = share; part > smallest_stiff; part *= 0.1) {
    Vector u = part * stuck.unknowns;
    for (int step = 0; step < most_steps && u.allFinite(); ++step) {
      if (is_solved(u, part, &jacobian)) return found(std::move(u), part);
      jacobian += residual * u.transpose() / u.squaredNorm();  // as F is relative to |u|
      u -= solution_of(jacobian, residual);
    }
    if (is_solved(u, part, nullptr)) return found(std::move(u), part);
  }
  const std::string why = reason_of_end();
  throw std::invalid_argument(why.empty() ? "the response to a small force is not linear"
                                          : "no response to a small force: " + why);
}

}  // namespace arcslip::problems
