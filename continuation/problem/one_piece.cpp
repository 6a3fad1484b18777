#include "arcslip/continuation/problem/one_piece.hpp"

#include <stdexcept>

namespace arcslip::continuation {

OnePiece::OnePiece(std::shared_ptr<const Problem> pieces) : pieces_(std::move(pieces)) {
  if (pieces_ == nullptr) throw std::invalid_argument("OnePiece: no problem");
}

Regime regime_at(const Problem& problem, const Vector& u, const Vector& p, Regime start) {
  for (Index round = 0; round <= problem.switch_count(); ++round) {
    bool is_inside = true;
    for (int i = 0; i < problem.border_count(start); ++i) {
      if (!(problem.border(u, p, start, i, nullptr) > 0)) continue;
      const std::optional<Regime> beyond = problem.regime_beyond(start, i);
      if (!beyond) continue;
      start = *beyond;
      is_inside = false;
    }
    if (is_inside) break;
  }
  return start;
}

}  // namespace arcslip::continuation
