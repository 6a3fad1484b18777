#pragma once

// Motions with two frequencies w and s, and the forces of elements under them, which are of the same form:
//
//   x(t) = x_00 + Re sum x_kl e^{j(k theta_1 + l theta_2)},   theta_1 = w t,   theta_2 = s t + p.
//
// Where an element remembers what was, it is followed as in time over lines theta_2 = p + (s/w) theta_1:
// along one of them x is a sum of harmonics q = k + l s/w, whose slip begins and ends where its zeros are, so
// that integrals over theta_1 are closed. Over p, evenly spread, they are summed: exactly, but for lines of
// the force whose l differs from one that is wanted by the number of p.

#include <functional>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// The frequency k w + l s: of these and their negatives the one with k > 0, or k = 0 and l >= 0.
struct Line {
  int k;  ///< of w
  int l;  ///< of s
  bool operator==(const Line&) const = default;
};

/// The lines of a force in one coordinate and, where they are wanted, its derivatives: df = linear dx +
/// conjugate conj(dx), of the real x_00 half each.
struct LineForce {
  ComplexVector force;        ///< f_kl, against x
  ComplexMatrix linear;       ///< lines x lines
  ComplexMatrix conjugate;    ///< the same
  ComplexVector by_log_load;  ///< df_kl/d ln(load)
  ComplexVector by_ratio;     ///< df_kl/d(s/w)
};

/// Which lines there are, and over how many p is summed. Immutable.
class TwoPhases {
 public:
  TwoPhases(std::vector<Line> lines, Index places);

  const std::vector<Line>& lines() const { return lines_; }
  Index places() const { return places_; }

  /// A spring of stiffness k in series with a slider that yields at S, which is proportional to the load; it
  /// is as it is left when it is loaded from zero. s/w is `ratio`.
  void slide(double stiffness, double threshold, const ComplexVector& x, double ratio, bool derivatives,
             LineForce& out) const;

  /// A smooth function of the displacement, with its derivative as second.
  using Law = std::function<std::pair<double, double>(double x)>;
  void act(const Law& law, const ComplexVector& x, bool derivatives, LineForce& out) const;

  /// No force.
  void rest(LineForce& out) const;

  /// The greatest |x|, as sampled.
  double greatest(const ComplexVector& x) const;

 private:
  double share(Index a) const;

  /// The lines of conj(e_a) e_b, or of e_a e_b, of all pairs of lines, each once.
  class Pairs {
   public:
    Pairs(const std::vector<Line>& of, int sign);
    std::vector<Line> lines;

    /// What a pair has of a value for each of these lines.
    Complex of(const Eigen::Ref<const ComplexVector>& values, Index a, Index b) const {
      const int place = places_(a, b);
      return place < 0 ? std::conj(values(-place - 1)) : values(place - 1);
    }

   private:
    Eigen::MatrixXi places_;  // from 1 on, below 0 for its conjugate
  };

  std::vector<Line> lines_;
  Index places_;
  Pairs differences_;
  Pairs sums_;
  int most_k_;
  int most_l_;
};

}  // namespace arcslip
