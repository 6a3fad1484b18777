#pragma once

// Formulas over boxes: all values that a tape has, and all gradients.

#include <optional>
#include <string>

#include "arcslip/formulas/tape.hpp"
#include "arcslip/interval/interval.hpp"

namespace arcslip {

/// What a tape does without an enclosure, in words; none if all of it has one.
std::optional<std::string> not_enclosed(const Tape& tape);

/// Fills the values, one for each result, and the derivatives by the first `by` variables, row by row, over
/// the box of all variables `x`. Throws NoEnclosure where a value is not sure to exist.
void enclose(const Tape& tape, const Interval* x, Index by, std::vector<Interval>& values,
             std::vector<Interval>& gradients);

}  // namespace arcslip
