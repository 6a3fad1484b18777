#pragma once

// Curves of extrema that go on across borders. Within a regime an extremum is smooth, a zero of the
// observable's derivative along the branch. Where such a curve comes to a border, this derivative jumps there
// from 0 to some other value, and the extremum goes on as a corner along the border: on that side on which
// the slopes before and behind it have opposite signs. As a corner it goes on until one of the two slopes
// vanishes, and from there as a smooth extremum of that slope's regime. A curve so has no end on a border
// beyond which the branch goes on; where it turns back in its parameter, a peak and a trough meet, one of
// which may be a corner.
//
// Next to a border the derivative may grow like the square root of the distance. A curve of smooth extrema
// then touches the border, and Newton's method does not converge there. Hence it is left a little way before,
// and its end found on the border, along which the slopes are smooth.

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// What `trace_curve` does with a problem of extrema, through one that is smooth or a corner on a border.
Branch trace_extrema(ExtendedProblem& problem, const BasePoint& start, const TraceOptions& options,
                     const CurveWindow& window = {}, const Observer& observer = {});

}  // namespace arcslip::continuation
