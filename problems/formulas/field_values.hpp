#pragma once

// Fields that are tapes.

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

}  // namespace arcslip::problems
