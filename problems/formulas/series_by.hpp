#pragma once

// Series of tapes.

#include <vector>

#include "arcslip/formulas/tape.hpp"
#include "arcslip/types.hpp"

namespace arcslip::problems {

/// The results along u(h) by a tape of the time, where that is not null, u and p in this order: see
/// Problem::series.
inline bool series_by(const Tape& tape, const double* t, const Matrix& u, const Vector& p, Matrix& out) {
  if (u.cols() > taylor::order + 1) return false;
  std::vector<Series> at;
  if (t != nullptr) at.push_back({*t});
  for (Index i = 0; i < u.rows(); ++i) {
    Series& one = at.emplace_back(Series{});
    for (Index k = 0; k < u.cols(); ++k) one[static_cast<std::size_t>(k)] = u(i, k);
  }
  for (const double value : p) at.push_back({value});
  std::vector<Series> values(static_cast<std::size_t>(tape.results()));
  if (!tape.series(at.data(), values.data())) return false;
  out.resize(tape.results(), u.cols());
  for (Index i = 0; i < out.rows(); ++i) {
    for (Index k = 0; k < out.cols(); ++k)
      out(i, k) = values[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  }
  return true;
}

}  // namespace arcslip::problems
