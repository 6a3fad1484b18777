#pragma once

// Ridges of Y over eta and preload without a solve: at given eta and R/S the preload follows explicitly,
//
//   P = (K_FD/K*) |y_0|/(R/S |1 + k phi(R/S) c|),   Y = |y_0| |1 + k phi c_D|/|1 + k phi c|,
//
// and so does G = d ln Y/d ln eta at fixed P. Ridges and valleys are the zeros of G in a rectangle, which is
// cut into cells until each is either free of zeros or crossed by one curve, nearly straight.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "dense_envelope.hpp"

namespace dense {

/// Where the ridges are looked for.
struct Range {
  Real low;
  Real high;
};

/// A piece of a ridge or valley in slip.
struct RidgePoint {
  Real log_eta;
  Real log_ratio;
  Real log_preload;
  Real log_Y;
  bool is_peak;
};

struct RidgePiece {
  RidgePoint a;
  RidgePoint b;
};

class RidgeMap {
 public:
  RidgeMap(const Case& c, const Window& window, const Range& preloads, Real step = 0.2L)
      : response_(c), log_low_(std::log(preloads.low)), log_high_(std::log(preloads.high)) {
    const std::vector<Real> columns = columns_of(response_, window);
    std::vector<Real> rows;
    for (Real u = lowest; u < deepest(columns); u += step) rows.push_back(u);
    std::vector<Node> below;
    std::vector<Node> above;
    for (const Real x : columns) below.push_back(at(x, rows.front()));
    for (std::size_t j = 1; j < rows.size(); ++j) {
      above.clear();
      for (const Real x : columns) above.push_back(at(x, rows[j]));
      for (std::size_t i = 0; i + 1 < columns.size(); ++i)
        cut({below[i], below[i + 1], above[i], above[i + 1]}, 0);
      std::swap(below, above);
    }
  }

  const std::vector<RidgePiece>& pieces() const { return pieces_; }
  const std::vector<RidgePoint>& folds() const { return folds_; }  ///< where dP = 0 along G = 0
  long samples() const { return samples_; }
  long unexplained() const { return unexplained_; }  ///< cells given up

 private:
  static constexpr Real lowest = -21;
  static constexpr Real flatness = 0.1L;  ///< of a cell: deviation from bilinear over the differences within

  struct Node {
    Real x;  ///< ln eta
    Real u;  ///< t = ln(R/S) = ln(1 + e^u)
    Real G;
    Real log_P;
    Real log_Y;
    Real t;
    Real direction;  ///< du/dx at fixed P
  };

  /// Lower left, lower right, upper left, upper right.
  using Cell = std::array<Node, 4>;

  Node at(Real x, Real u) const {
    ++samples_;
    const Real t = u > 40 ? u : std::log1p(std::exp(u));
    const Given given = response_.at_ratio(x, t, true);
    const Real by_u = u > 40 ? 1 : 1 / (1 + std::exp(-u));
    const Real least = log_low_ - 5;  // of P, which may even be negative
    const Real log_P = given.preload > 0 ? std::max(std::log(given.preload), least) : least;
    return {x, u, given.log_Y_slope, log_P, given.log_Y, t, given.log_ratio_slope / by_u};
  }

  /// u beyond which P is below the range everywhere.
  Real deepest(const std::vector<Real>& columns) const {
    Real u = 1;
    for (const Real x : columns) {
      while (at(x, u).log_P > log_low_) u += 0.5L;
    }
    return u + 1.5L;
  }

  bool outside(const Cell& c) const {
    const auto [low, high] = std::minmax({c[0].log_P, c[1].log_P, c[2].log_P, c[3].log_P});
    const Real margin = high - low;
    return low - margin > log_high_ || high + margin < log_low_;
  }

  /// How far the five nodes within the cell are from what its corners say, of a member of Node.
  static Real deviation(const Cell& c, const std::array<Node, 5>& m, Real Node::*f) {
    const auto mean = [&](int i, int j) { return (c[i].*f + c[j].*f) / 2; };
    const Real center = (mean(0, 1) + mean(2, 3)) / 2;
    return std::max({std::abs(m[0].*f - mean(0, 1)), std::abs(m[1].*f - mean(2, 3)),
                     std::abs(m[2].*f - mean(0, 2)), std::abs(m[3].*f - mean(1, 3)),
                     std::abs(m[4].*f - center), std::abs(mean(0, 3) - mean(1, 2)) / 2});
  }

  static Real span(const Cell& c, Real Node::*f) {
    const auto [low, high] = std::minmax({c[0].*f, c[1].*f, c[2].*f, c[3].*f});
    return high - low;
  }

  void cut(const Cell& c, int depth) {
    if (outside(c)) return;
    const Real x = (c[0].x + c[1].x) / 2;
    const Real u = (c[0].u + c[2].u) / 2;
    const std::array<Node, 5> m{at(x, c[0].u), at(x, c[2].u), at(c[0].x, u), at(c[1].x, u), at(x, u)};
    int positive = 0;
    Real least = std::abs(m[0].G);
    for (const auto* nodes = c.data();
         const Node& node : {nodes[0], nodes[1], nodes[2], nodes[3], m[0], m[1], m[2], m[3], m[4]}) {
      positive += node.G > 0 ? 1 : 0;
      least = std::min(least, std::abs(node.G));
    }
    const Real bend = deviation(c, m, &Node::G);
    if (positive % 9 == 0 && least > 4 * bend) return;
    const auto plain = [&](Real Node::*f) { return deviation(c, m, f) <= flatness * span(c, f) + 1e-12L; };
    const bool straight = plain(&Node::G) && plain(&Node::log_P) && plain(&Node::direction);
    if (straight && (positive % 9 == 0 || add_piece(c))) return;
    if (depth > 26) {
      ++unexplained_;
      return;
    }
    cut({c[0], m[0], m[2], m[4]}, depth + 1);
    cut({m[0], c[1], m[4], m[3]}, depth + 1);
    cut({m[2], m[4], c[2], m[1]}, depth + 1);
    cut({m[4], m[3], m[1], c[3]}, depth + 1);
  }

  /// The zero of G between two nodes of different signs.
  Node zero(Node a, Node b) const {
    Real f_a = a.G;
    Real f_b = b.G;
    Node best = std::abs(a.G) < std::abs(b.G) ? a : b;
    for (int i = 0; i < 100; ++i) {
      const Real weight = i % 4 == 3 ? 0.5L : f_a / (f_a - f_b);
      const Node next = at(a.x + weight * (b.x - a.x), a.u + weight * (b.u - a.u));
      best = next;
      if (next.G == 0) break;
      const bool left = (next.G < 0) == (a.G < 0);
      (left ? f_b : f_a) /= 2;
      (left ? a : b) = next;
      (left ? f_a : f_b) = next.G;
      if (std::abs(b.x - a.x) + std::abs(b.u - a.u) < 1e-17L) break;
    }
    return best;
  }

  /// dG/dx at fixed P: negative on a ridge.
  Real bending(const Node& n, const Cell& c) const {
    const Real width = c[1].x - c[0].x;
    const Real height = c[2].u - c[0].u;
    const Real h = 1e-4L * std::min(width, height / std::max(std::abs(n.direction), 1e-30L));
    return (at(n.x + h, n.u + n.direction * h).G - at(n.x - h, n.u - n.direction * h).G) / (2 * h);
  }

  RidgePoint point(const Node& n, Real bend) const { return {n.x, n.t, n.log_P, n.log_Y, bend < 0}; }

  /// A point of the curve near the middle of two others, if there is one close by.
  std::optional<Node> between(const Node& a, const Node& b, const Cell& c) const {
    const bool along_x = std::abs(c[0].G - c[1].G) > std::abs(c[0].G - c[2].G);  // towards the curve
    const Real x = (a.x + b.x) / 2;
    const Real u = (a.u + b.u) / 2;
    const Real size = along_x ? c[1].x - c[0].x : c[2].u - c[0].u;
    for (Real reach = std::abs(along_x ? b.x - a.x : b.u - a.u) / 8 + 1e-15L * size; reach < size / 2;
         reach *= 2) {
      const Node left = along_x ? at(x - reach, u) : at(x, u - reach);
      const Node right = along_x ? at(x + reach, u) : at(x, u + reach);
      if ((left.G > 0) != (right.G > 0)) return zero(left, right);
    }
    return {};
  }

  /// Of a cell where G is nearly linear: false if its edges do not show exactly one curve, or one whose
  /// bending at fixed P may have zeros unseen.
  bool add_piece(const Cell& c) {
    std::vector<Node> ends;
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(2, 3), std::pair(0, 2), std::pair(1, 3)}) {
      if ((c[i].G > 0) != (c[j].G > 0)) ends.push_back(zero(c[i], c[j]));
    }
    if (ends.size() != 2) return false;
    const std::optional<Node> middle = between(ends[0], ends[1], c);
    if (!middle) return false;
    const Real bend_a = bending(ends[0], c);
    const Real bend_b = bending(ends[1], c);
    const Real bow = std::abs(bending(*middle, c) - (bend_a + bend_b) / 2);
    const bool folds = bend_a * bend_b < 0;
    if (bow > (folds ? 0.1L * std::abs(bend_a - bend_b) : std::min(std::abs(bend_a), std::abs(bend_b)) / 2))
      return false;
    if (folds && !add_fold(c, ends[0], ends[1], bend_a)) return false;
    pieces_.push_back({point(ends[0], bend_a), point(ends[1], bend_b)});
    return true;
  }

  /// Halves the piece of the curve.
  bool add_fold(const Cell& c, Node a, Node b, Real bend_a) {
    for (int i = 0; i < 60 && std::abs(a.x - b.x) + std::abs(a.u - b.u) > 1e-16L; ++i) {
      const std::optional<Node> middle = between(a, b, c);
      if (!middle) return false;
      ((bending(*middle, c) > 0) == (bend_a > 0) ? a : b) = *middle;
    }
    if (a.log_P >= log_low_ && a.log_P <= log_high_) folds_.push_back(point(a, 0));
    return true;
  }

  Response response_;
  Real log_low_;
  Real log_high_;
  mutable long samples_ = 0;
  long unexplained_ = 0;
  std::vector<RidgePiece> pieces_;
  std::vector<RidgePoint> folds_;
};

}  // namespace dense
