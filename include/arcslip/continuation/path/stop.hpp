#pragma once

// Why a branch ends.

#include <optional>
#include <string_view>

namespace arcslip::continuation {

/// The reason, which Branch::explanation says in a sentence.
enum class Stop {
  reached_end,      ///< the last value was reached
  closed_loop,      ///< the branch came back to its start
  own_image,        ///< it has a symmetry again that it had lost: what follows is its image under this
  requested,        ///< `stop_after` was satisfied
  left_range,       ///< the branch came back to its first value
  left_regime,      ///< it ended on a border that nothing lies beyond
  infinite_period,  ///< of cycles: they come to rest on their way
  unbounded,        ///< an unknown grew beyond `bound`
  max_points,       ///< as many points as allowed were stored
  time_limit,       ///< `max_seconds` have passed
  interrupted,      ///< the observer asked for it
  no_value,         ///< the problem cannot be evaluated further on
  min_step,         ///< no step of at least `min_step` is acceptable
  asymptotic,       ///< the branch comes ever nearer to a value on which it has no point
  repeats,          ///< it goes round a loop that its start is not on
  grazing_border,   ///< the piece beyond a border does not leave it
  no_start          ///< there is no solution near the guess
};

/// As written to files: `reached_end`, `left_range`, and so on.
std::string_view to_string(Stop stop);

/// The reason of this name, or none.
std::optional<Stop> stop_named(std::string_view name);

/// Whether a branch that stops so has come to an end of its own or to one that was asked for.
bool is_end(Stop stop);

/// Whether it would go on where it was left.
bool is_unfinished(Stop stop);

}  // namespace arcslip::continuation
