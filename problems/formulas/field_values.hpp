#pragma once

// Fields that are tapes.

#include <algorithm>

#include "arcslip/continuation/cycles/field.hpp"
#include "arcslip/formulas/tape.hpp"
#include "numbers.hpp"

namespace arcslip::problems {

/// f by a tape of t, u and p in this order.
inline bool evaluate_field(const Tape& tape, double t, const Vector& u, const Vector& p,
                           const continuation::FieldValues& out) {
  const Index n = tape.results();
  Numbers at{t};
  at.insert(at.end(), u.begin(), u.end());
  at.insert(at.end(), p.begin(), p.end());
  const bool differentiated =
      out.by_unknowns != nullptr || out.by_parameters != nullptr || out.by_time != nullptr;
  Numbers values = room(n);
  Numbers gradients = room(differentiated ? n * std::ssize(at) : 0);
  if (!(differentiated ? tape.evaluate(at.data(), values.data(), gradients.data())
                       : tape.evaluate(at.data(), values.data())))
    return false;
  if (out.velocity != nullptr) *out.velocity = Eigen::Map<const Vector>(values.data(), n);
  const Eigen::Map<const Rows> rows(gradients.data(), differentiated ? n : 0, std::ssize(at));
  if (out.by_unknowns != nullptr) *out.by_unknowns = rows.middleCols(1, u.size());
  if (out.by_parameters != nullptr) *out.by_parameters = rows.rightCols(p.size());
  if (out.by_time != nullptr) *out.by_time = rows.leftCols(1);
  return true;
}

/// The same at several places, by a tape of u and p, or of t, u and p where times are given.
inline bool evaluate_columns(const Tape& tape, const Vector* times, const Matrix& u, const Vector& p,
                             const continuation::FieldColumns& out) {
  constexpr Index together = 32;  // places: few enough to stay near
  const Index n = tape.results();
  const Index first = times != nullptr ? 1 : 0;
  const Index width = first + n + p.size();
  const bool differentiated =
      out.by_unknowns != nullptr || out.by_parameters != nullptr || out.by_time != nullptr;
  Numbers at = room(width * std::min(together, u.cols()));
  Numbers gradients = room(differentiated ? n * std::ssize(at) : 0);
  Index place = 0;
  Index count = 0;
  /// Derivatives by so many variables from one on.
  const auto spread = [&](Matrix* by, Index from, Index variables) {
    if (by == nullptr) return;
    double* entry = by->data() + place * n * variables;
    for (Index k = 0; k < count; ++k) {
      for (Index c = 0; c < variables; ++c) {
        const double* gradient = gradients.data() + k * n * width + from + c;
        for (Index r = 0; r < n; ++r, gradient += width) *entry++ = *gradient;
      }
    }
  };
  for (; place < u.cols(); place += count) {
    count = std::min(together, u.cols() - place);
    double* x = at.data();
    for (Index k = place; k < place + count; ++k) {
      if (times != nullptr) *x++ = (*times)(k);
      x = std::copy_n(u.data() + k * n, n, x);
      x = std::copy_n(p.data(), p.size(), x);
    }
    if (!tape.evaluate(at.data(), count, out.velocity->data() + place * n,
                       differentiated ? gradients.data() : nullptr))
      return false;
    spread(out.by_time, 0, 1);
    spread(out.by_unknowns, first, n);
    spread(out.by_parameters, first + n, p.size());
  }
  return true;
}

}  // namespace arcslip::problems
