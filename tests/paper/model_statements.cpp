// Statements 6 and 7: the rods against closed forms, and the damper that the base drives.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "../support/paper_cases.hpp"
#include "../support/printed_rods.hpp"
#include "arcslip/problems/response/one_way_response.hpp"
#include "statement.hpp"

namespace arcslip::testing {
namespace {

using problems::ForcedResponse;
using problems::OneWayResponse;

Vector observe(const ForcedResponse& problem, double eta, double preload) {
  const continuation::Guess guess = problem.guess(eta, preload);
  Vector values;
  problem.observe(guess.unknowns, guess.parameters, guess.regime, values);
  return values;
}

/// The rods' phasors y and u with N elements: by amplitude and phase.
Motion finite_motion(SystemParameters rods, Index elements, double eta) {
  rods.elements = elements;
  const Vector values = observe(ForcedResponse(build_system(rods)), eta, rods.preload);
  return {std::polar(values(ForcedResponse::Y), -values(ForcedResponse::beta)),
          std::polar(values(ForcedResponse::U), -values(ForcedResponse::alpha))};
}

/// Distance of the rods with N elements to (27), (28), (31), at worst over frequencies in stick and in slip,
/// away from and near the resonances.
double distance_to_limit(Index wave_number, Index elements) {
  SystemParameters parameters = rods(1);
  parameters.wave_number = wave_number;
  parameters.interface_stiffness *= static_cast<double>(wave_number * wave_number);  // as stiff as the waves
  double worst = 0;
  int slipping = 0;
  for (const double eta : {0.7, 2.5, 3.3, 3.7, 4.2, 5.6, 6.1, 9.0}) {
    const double at = eta * static_cast<double>(wave_number);
    const PrintedRods limit(parameters, at);
    const Motion exact = limit.motion();
    const Motion finite = finite_motion(parameters, elements, at);
    worst = std::max({worst, std::abs(finite.y - exact.y) / std::abs(exact.y),
                      std::abs(finite.u - exact.u) / std::abs(exact.u)});
    slipping += static_cast<int>(limit.slips());
  }
  if (slipping == 0 || slipping == 8) throw std::logic_error("the rods were to stick and to slip");
  return worst;
}

/// The largest relative errors of the one-way model.
struct Errors {
  double Y = 0, U = 0, R = 0;
  double eta = 0;  ///< where that of R is

  double worst() const { return std::max({Y, U, R}); }
};

struct Range {
  double from, to;
};

Errors one_way_errors(double mass_ratio, const std::vector<Range>& ranges,
                      const std::vector<double>& preloads) {
  SystemParameters parameters = figure_8(1);
  parameters.mass_ratio = mass_ratio;
  const FrictionSystem system = build_system(parameters);
  const ForcedResponse coupled(system);
  const OneWayResponse driven(system);
  constexpr int samples = 400;
  Errors errors;
  for (const double preload : preloads) {
    for (const auto& [from, to] : ranges) {
      for (int i = 0; i <= samples; ++i) {
        const double eta = from * std::pow(to / from, static_cast<double>(i) / samples);
        const Vector exact = observe(coupled, eta, preload);
        const Vector model = observe(driven, eta, preload);
        const auto error = [&](Index which) { return std::abs(model(which) / exact(which) - 1); };
        errors.Y = std::max(errors.Y, error(ForcedResponse::Y));
        errors.U = std::max(errors.U, error(ForcedResponse::U));
        if (error(ForcedResponse::R) > errors.R) errors.eta = eta;
        errors.R = std::max(errors.R, error(ForcedResponse::R));
      }
    }
  }
  return errors;
}

}  // namespace

Statement convergence_of_rods() {
  Statement statement(6, "Rods: the finite-N response converges to (27), (28), (31) as N/n grows.");
  for (const Index n : {1, 3}) {
    double before = 0;
    for (const Index per_wave : {10, 100, 1000, 10'000, 100'000}) {
      const double distance = distance_to_limit(n, per_wave * n);
      const std::string what = fmt::format("n = {}, N/n = {}: distance of y and u to the limit", n, per_wave);
      const std::string measured = fmt::format("{:.2e}", distance);
      const double order = std::log10(before / distance);
      if (per_wave < 1000) {  // near a resonance too coarse for the error to have its order
        statement.require(before == 0 || distance < before, what, measured, before == 0 ? "" : "falls");
      } else {
        statement.require(std::abs(order - 2) < 0.01, what, measured,
                          fmt::format("falls as (n/N)^2 (order {:.3f})", order));
      }
      before = distance;
    }
    statement.require(before < 1e-8, fmt::format("n = {}: distance left", n), fmt::format("{:.2e}", before),
                      "< 1e-8");
  }
  return statement;
}

Statement damper_driven_by_the_base() {
  Statement statement(
      7,
      "A damper much lighter than the base, excited away from the base's own frequency: the one-way "
      "model is a good approximation.");
  const std::vector<double> preloads = {0.1, 1.0, 5.0, 10.0, 50.0};
  const std::vector<Range> away = {{0.5, 3}, {5, 50}};  // from eta = 4 by a quarter of it
  const auto row = [&](const std::string& what, double value, const std::string& required, bool holds) {
    statement.require(holds, what, fmt::format("{:.2e}", value), required);
  };
  const Errors light = one_way_errors(100, away, preloads);
  row("M* = 100, eta 0.5 to 3 and 5 to 50: error of Y", light.Y, "< 5 %", light.Y < 0.05);
  row("the same of U", light.U, "< 5 %", light.U < 0.05);
  row("the same of R", light.R, "< 5 %", light.R < 0.05);
  const double gain = light.worst() / one_way_errors(1000, away, preloads).worst();
  row("these over those of M* = 1000", gain, "10: falls as 1/M*", std::abs(gain - 10) < 0.5);
  const Errors slipping = one_way_errors(100, {{5, 50}}, {0.01});
  row("M* = 100, P = 0.01, slipping, eta 5 to 50: error of Y", slipping.Y, "< 10 %", slipping.Y < 0.1);
  row("the same of U", slipping.U, "< 10 %", slipping.U < 0.1);
  const Errors near = one_way_errors(100, {{3.96, 4.04}}, preloads);
  row("M* = 100, eta within 1 % of 4: error of Y", near.Y, "> 100 %: no approximation", near.Y > 1);
  const Errors heavy = one_way_errors(5, away, preloads);
  row("M* = 5, eta 0.5 to 3 and 5 to 50: largest error", heavy.worst(), "> 20 %: no approximation",
      heavy.worst() > 0.2);

  const Errors damper = one_way_errors(100, {{84.5, 86.2}}, preloads);
  statement.note(fmt::format(
      "One more frequency is to be avoided: eta = 85.3, where the stuck damper resonates on the interface. "
      "Errors within 1 % of it: Y {:.0f}-fold, R {:.0f}-fold.",
      damper.Y, damper.R));
  statement.note(
      fmt::format("Where slip sets in R rises a hundredfold within a narrow range, so that R is wrong there: "
                  "{:.1f}-fold at eta = {:.1f}, P = 0.01.",
                  slipping.R, slipping.eta));
  return statement;
}

}  // namespace arcslip::testing
