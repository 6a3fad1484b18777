#include "arcslip/problems/response/more_harmonics.hpp"

#include <algorithm>

#include "arcslip/continuation/path/newton.hpp"

namespace arcslip::problems {

using continuation::Guess;

Guess carried(const HarmonicProblem& from, const Guess& at, const HarmonicProblem& to) {
  Guess guess{Vector::Zero(to.size()), at.parameters, at.regime};
  const std::vector<int>& orders = to.system().orders;
  for (Index i = 0; i < from.coordinates(); ++i) {
    for (Index a = 0; a < from.harmonics(); ++a) {
      const int order = from.system().orders[static_cast<std::size_t>(a)] * to.system().periods();
      if (order % from.system().periods() != 0) continue;
      const auto place =
          std::find(orders.begin(), orders.end(), order / from.system().periods()) - orders.begin();
      if (place == std::ssize(orders)) continue;
      guess.unknowns.segment<2>(2 * (i * to.harmonics() + place)) =
          at.unknowns.segment<2>(2 * (i * from.harmonics() + a));
    }
  }
  return guess;
}

std::optional<Guess> solved_in(const HarmonicProblem& to, const HarmonicProblem& from, const Guess& at) {
  Guess guess = carried(from, at, to);
  for (Index tries = 0; tries <= to.switch_count(); ++tries) {
    const continuation::Solution near = continuation::solve(to, guess);
    if (near.outcome != continuation::Correction::converged) return std::nullopt;
    guess.unknowns = near.unknowns;
    const int border = to.crossed_border(guess);
    if (border < 0) return guess;
    const std::optional<continuation::Regime> beyond = to.regime_beyond(guess.regime, border);
    if (!beyond) return std::nullopt;
    guess.regime = *beyond;
  }
  return std::nullopt;
}

}  // namespace arcslip::problems
