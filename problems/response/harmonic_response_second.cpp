// Second derivatives of the harmonic response: with the forces and their derivatives moved as the elements
// say, F is a smooth function of the way along the direction, whatever happens within the loops.

#include <cmath>

#include "arcslip/continuation/problem/second_derivative.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "harmonic_jacobian.hpp"

namespace arcslip::problems {

bool HarmonicResponse::second(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const Vector& w, const Vector& du, const Vector& dp, Vector& out) const {
  if (!evaluate(u, p, regime, {})) return false;
  const std::vector<ElementForce> elements = forces(u, p, regime, true);
  const double log_load = (dp(preload) + 2 * growth({}, p) * p(eta) * dp(eta)) / pressing({}, p);
  std::optional<SystemParameter::At> varied;
  if (is_varied()) varied = variation({}, p);
  std::vector<ElementForce> changes;
  for (Index e = 0; e < coordinates_.elements(); ++e) {
    const double factor = force_factor(e, u, p);
    const double own_log_load = varied ? log_load + log_load_rate(e, {}, p) * dp(further) : log_load;
    ElementForce unscaled = elements[at(e)];
    unscaled.scale(1 / factor, true);
    const Element::Way way{element_motion(du, {}, e), own_log_load, varied ? dp(further) : 0};
    ElementForce change = with_element(e, u, p, [&](const Element& element) {
      const HarmonicVector x = element_motion(u, {}, e);
      ElementForce moved = element.change(unscaled, system_.orders, x, load(e, u, p), slips(regime, e), way);
      if (const auto viscous = viscous_of(element, u, p))
        moved.add_change(*viscous, x, way.motion, dp(eta), way.setting);
      return moved;
    });
    change.scale(factor, true);
    if (varied) change.add(elements[at(e)], log_force_rate(e, *varied) * dp(further));
    changes.push_back(std::move(change));
  }
  const Index parameters = p.size();
  const auto condensed = condensed_jacobian();
  Rows rows;
  rows.condensed = static_cast<HarmonicJacobian*>(condensed.get());
  Matrix jacobian;
  if (condensed == nullptr) jacobian.resize(size(), size());
  Matrix parameter_jacobian(size(), parameters);
  Vector by_unknowns(size());
  const auto along = [&](double h, Vector& value) {
    const Vector moved = p + h * dp;
    if (!has_value(moved)) return false;
    std::vector<ElementForce> there = elements;
    for (std::size_t k = 0; k < there.size(); ++k) there[k].add(changes[k], h);
    const Vector x = u + h * du;
    fill_rows(there, 1, x, moved, regime, rows, &parameter_jacobian);
    if (condensed != nullptr) {
      fill_condensed(rows, there, x, regime);
      condensed->multiply_transposed(w, by_unknowns);
    } else {
      fill_jacobian(rows, there, x, regime, jacobian);
      by_unknowns.noalias() = jacobian.transpose() * w;
    }
    value.resize(size() + parameters);
    value << by_unknowns, parameter_jacobian.transpose() * w;
    return value.allFinite();
  };
  Vector unknown_scale(size());
  Vector parameter_scale(parameters);
  scale(u, p, unknown_scale, parameter_scale);
  const double length = std::max(du.cwiseQuotient(unknown_scale).lpNorm<Eigen::Infinity>(),
                                 dp.cwiseQuotient(parameter_scale).lpNorm<Eigen::Infinity>());
  if (!(length > 0)) {
    out.setZero(size() + parameters);
    return true;
  }
  constexpr double first = 0.02;  // step, of the scale: resonances are resolved by those that follow
  return std::isfinite(continuation::differentiate(along, first / length, out).error);
}

}  // namespace arcslip::problems
