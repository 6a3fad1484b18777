#pragma once

// e^{j(k theta_1 + l theta_2)} of lines.

#include <algorithm>
#include <cmath>
#include <vector>

#include "arcslip/elements/two_phases.hpp"

namespace arcslip {

inline int most(const std::vector<Line>& lines, int Line::*which) {
  int most = 0;
  for (const Line& line : lines) most = std::max(most, std::abs(line.*which));
  return most;
}

/// k + l s/w of each line.
inline Vector frequencies(const std::vector<Line>& lines, double ratio) {
  Vector q(std::ssize(lines));
  std::transform(lines.begin(), lines.end(), q.begin(),
                 [ratio](const Line& line) { return line.k + line.l * ratio; });
  return q;
}

/// By powers of those of k = 1 and l = 1.
class LineTurns {
 public:
  explicit LineTurns(const std::vector<Line>& lines)
      : lines_(lines), of_k_(most(lines, &Line::k) + 1), of_l_(most(lines, &Line::l) + 1) {}

  void set(double first, double second, ComplexVector& e) {
    set_powers(first, of_k_);
    set_powers(second, of_l_);
    e.resize(std::ssize(lines_));
    for (Index a = 0; a < e.size(); ++a) {
      const auto [k, l] = lines_[static_cast<std::size_t>(a)];
      e(a) = of_k_(k) * (l < 0 ? std::conj(of_l_(-l)) : of_l_(l));
    }
  }

 private:
  static void set_powers(double angle, ComplexVector& powers) {
    const Complex one = std::polar(1.0, angle);
    powers(0) = 1;
    for (Index i = 1; i < powers.size(); ++i) powers(i) = powers(i - 1) * one;
  }

  const std::vector<Line>& lines_;
  ComplexVector of_k_;
  ComplexVector of_l_;
};

}  // namespace arcslip
