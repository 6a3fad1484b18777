#pragma once

// One way along a curve of special points.

#include <functional>
#include <string>

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// The label of the event by which a curve leaves its window.
inline const std::string end_of_window = "the window's end";

/// Options with the events that end a curve whose base has n unknowns: at the window's ends of the active
/// parameter, which is unknown n.
TraceOptions within_window(const TraceOptions& options, const CurveWindow& window, Index n);

/// Part of a curve, which `trace` traces with an observer: the borders of its conditions follow it. One that
/// ends on an end of its window has reached its end.
Branch follow_curve(ExtendedProblem& problem, const Observer& observer,
                    const std::function<Branch(const Observer& follow)>& trace);

TraceOptions without_journal(const TraceOptions& options);

/// Half a curve, begun or gone on with as the journal knows it, if there is one.
Branch kept_half(ExtendedProblem& problem, Journal* journal, const std::function<Branch()>& begin,
                 const std::function<Branch(Branch begun)>& go_on);

/// Of two reasons why the halves of a curve ended, the one that a user has to know is the curve's.
Branch most_telling(Branch curve, const std::string& why_first_ended);

}  // namespace arcslip::continuation
