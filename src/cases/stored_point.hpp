#pragma once

// A point that a run has left in DIR/summary.json, to begin a branch from.

#include "arcslip/cases/case_file.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

/// Unknowns that a special point of summary.json has with it, at most.
inline constexpr Index most_stored_unknowns = 1000;

/// "DIR:branch/point" of the key `from_point`. Throws InputError where there is no such point, or none with
/// its unknowns.
StoredPoint read_stored_point(const TomlSection& section);

}  // namespace arcslip
