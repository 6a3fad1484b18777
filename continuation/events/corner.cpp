#include "arcslip/continuation/events/corner.hpp"

#include <cmath>

namespace arcslip::continuation {
namespace {

/// Rates of the borders that are reached, along a unit direction in units of `scale`; none if the point lies
/// outside the regime.
std::optional<std::vector<double>> border_rates(const Problem& problem, Index parameter, const Guess& at,
                                                const Vector& scale, const Vector& direction,
                                                double tolerance) {
  Gradient gradient{Vector::Zero(problem.size()), Vector::Zero(at.parameters.size())};
  std::vector<double> rates;
  for (int b = 0; b < problem.border_count(at.regime); ++b) {
    const double value = problem.border(at.unknowns, at.parameters, at.regime, b, &gradient);
    if (value > tolerance) return std::nullopt;
    if (value < -tolerance) continue;
    rates.push_back(rate(gradient, parameter, scale, direction));
  }
  return rates;
}

}  // namespace

std::vector<Guess> leaving_pieces(const Problem& problem, Index parameter, const Guess& corner,
                                  double tolerance) {
  std::vector<Guess> pieces;
  Corrector corrector(problem, parameter, {});
  const Index n = problem.size();
  for (int regime = 0; regime < static_cast<int>(problem.regime_names().size()); ++regime) {
    CurvePoint point = corrector.make_point();
    point.unknowns = corner.unknowns;
    point.parameters = corner.parameters;
    point.regime = regime;
    corrector.set_scale(point);
    if (!border_rates(problem, parameter, {point.unknowns, point.parameters, regime, {}}, point.scale,
                      point.tangent, tolerance))
      continue;
    // The unit vectors as borders in turn: one of them is not orthogonal to the tangent.
    Correction result = Correction::singular;
    for (Index k = n; k >= 0 && result == Correction::singular; --k)
      result = corrector.linearise(point, Vector::Unit(n + 1, k));
    if (result != Correction::converged || !(point.residual <= tolerance)) continue;
    const Vector tangent = corrector.direction().normalized();
    for (const double sign : {1.0, -1.0}) {
      const Guess piece{point.unknowns, point.parameters, regime, sign * point.scale.cwiseProduct(tangent)};
      const auto rates = border_rates(problem, parameter, piece, point.scale, sign * tangent, tolerance);
      const bool leaves =
          rates && !rates->empty() &&
          std::all_of(rates->begin(), rates->end(), [](double rate) { return rate < -1e-12; });
      if (leaves) pieces.push_back(piece);
    }
  }
  return pieces;
}

}  // namespace arcslip::continuation
