#include "arcslip/continuation/events/corner.hpp"

#include <algorithm>

namespace arcslip::continuation {
namespace {

/// A border that is reached at the corner, and its rate along the piece's direction.
struct Reached {
  int border;
  double rate;
  double least;  // of a rate that is not rounding

  bool is_left() const { return rate < -least; }
};

/// One piece that meets the corner, with one of its two directions.
struct Piece {
  Regime regime;
  Vector direction;  ///< in the problem's scale, of unit length
  double sense;      ///< sign of the determinant that the direction closes
  std::vector<Reached> borders;

  bool leaves_corner() const {
    return !borders.empty() && std::all_of(borders.begin(), borders.end(),
                                           [](const Reached& reached) { return reached.is_left(); });
  }
  void turn() {
    direction = -direction;
    sense = -sense;
    for (Reached& reached : borders) reached.rate = -reached.rate;
  }
};

/// The pieces that meet at a corner.
class Pieces {
 public:
  Pieces(const Problem& problem, Index parameter, const Guess& corner, const Tolerances& tolerances)
      : problem_(problem),
        parameter_(parameter),
        tolerances_(tolerances),
        corrector_(problem, parameter, {}),
        point_(corrector_.make_point()),
        gradient_{Vector::Zero(problem.size()), Vector::Zero(corner.parameters.size())} {
    point_.unknowns = corner.unknowns;
    point_.parameters = corner.parameters;
    point_.regime = corner.regime;
    corrector_.set_scale(point_);
  }

  /// The borders that are reached; none if the point lies outside the regime.
  std::optional<std::vector<int>> reached(const Regime& regime) const {
    std::vector<int> borders;
    for (int b = 0; b < problem_.border_count(regime); ++b) {
      const double value = problem_.border(point_.unknowns, point_.parameters, regime, b, nullptr);
      if (value > tolerances_.together) return std::nullopt;
      if (value >= -tolerances_.together) borders.push_back(b);
    }
    return borders;
  }

  /// None where the solutions of this regime do not pass through the corner as one smooth curve.
  std::optional<Piece> piece(const Regime& regime) {
    const auto borders = reached(regime);
    if (!borders) return std::nullopt;
    point_.regime = regime;
    const Index n = problem_.size();
    // The unit vectors as borders in turn: one of them is not orthogonal to the tangent.
    Correction result = Correction::singular;
    for (Index k = n; k >= 0 && result == Correction::singular; --k)
      result = corrector_.linearise(point_, Vector::Unit(n + 1, k));
    if (result != Correction::converged || !(point_.residual <= tolerances_.together)) return std::nullopt;
    Piece piece{regime, corrector_.direction().normalized(), corrector_.orientation(), {}};
    for (const int b : *borders) {
      problem_.border(point_.unknowns, point_.parameters, regime, b, &gradient_);
      piece.borders.push_back(
          {b, rate(gradient_, parameter_, point_.scale, piece.direction), tolerances_.leaves});
    }
    return piece;
  }

  Guess guess(const Piece& piece) const {
    return {point_.unknowns, point_.parameters, piece.regime, point_.scale.cwiseProduct(piece.direction)};
  }

  /// A regime beyond some borders of another one, all at once.
  Regime beyond(const Regime& regime, const std::vector<int>& borders) const {
    Regime result = regime;
    for (const int border : borders) {
      const auto next = problem_.regime_beyond(regime, border);
      if (!next) continue;
      for (Index i = 0; i < problem_.switch_count(); ++i) {
        if ((*next)[i] != regime[i]) result = result.with(i, (*next)[i]);
      }
    }
    return result;
  }

 private:
  const Problem& problem_;
  Index parameter_;
  Tolerances tolerances_;
  Corrector corrector_;
  CurvePoint point_;
  Gradient gradient_;
};

/// All regimes that the corner belongs to, in their order; empty where there are more than `most`.
std::vector<Regime> meeting_regimes(const Pieces& pieces, const Regime& own, std::size_t most) {
  std::vector<Regime> found{own};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto borders = pieces.reached(found[i]);
    for (const int border : borders.value_or(std::vector<int>{})) {
      const Regime next = pieces.beyond(found[i], {border});
      if (std::find(found.begin(), found.end(), next) != found.end()) continue;
      if (found.size() == most) return {};
      found.push_back(next);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The piece that leaves the corner in a sense, looked for from the corner's own regime: first beyond all
/// borders that are not left there, then beyond the first that is not, again and again [Murty 1974], in as
/// many rounds as `most`.
std::optional<Piece> leaving_in(Pieces& pieces, double sense, const Regime& own, std::size_t most) {
  Regime regime = own;
  for (std::size_t round = 0; round < most; ++round) {
    auto piece = pieces.piece(regime);
    if (!piece) return std::nullopt;
    if (piece->sense * sense < 0) piece->turn();
    if (piece->leaves_corner()) return piece;
    std::vector<int> kept;
    for (const Reached& reached : piece->borders) {
      if (!reached.is_left()) kept.push_back(reached.border);
    }
    if (round > 0) kept.resize(std::min<std::size_t>(kept.size(), 1));
    regime = pieces.beyond(regime, kept);
  }
  return std::nullopt;
}

}  // namespace

std::vector<Guess> leaving_pieces(const Problem& problem, Index parameter, const Guess& corner,
                                  const Tolerances& tolerances) {
  Pieces pieces(problem, parameter, corner, tolerances);
  const auto borders = pieces.reached(corner.regime);
  if (!borders) return {};
  std::vector<Guess> found;
  std::vector<Regime> regimes;
  if (std::ssize(*borders) <= most_exact)
    regimes = meeting_regimes(pieces, corner.regime, std::size_t{1} << most_exact);
  for (const Regime& regime : regimes) {
    auto piece = pieces.piece(regime);
    for (int way = 0; piece && way < 2; ++way) {
      if (piece->leaves_corner()) found.push_back(pieces.guess(*piece));
      piece->turn();
    }
  }
  if (!regimes.empty()) return found;
  for (const double sense : {1.0, -1.0}) {
    const auto piece = leaving_in(pieces, sense, corner.regime, borders->size() * borders->size());
    if (piece) found.push_back(pieces.guess(*piece));
  }
  return found;
}

}  // namespace arcslip::continuation
