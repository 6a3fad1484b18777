#pragma once

// What a report shows of a folder of results.

#include <string>

namespace arcslip {

/// One JSON object: `arcslip` (this version), `by` (that of the results), where there is a run `run`, of
/// answer, summary, table (which is drawn), points and verified, where there is a study `study`, of answer,
/// summary, optimum, sweep, robust and quantiles, as far as there are these.
///
/// A table is { rows (in the file), every (of which each so many-th is kept), columns: { name: [...] } }, a
/// column of texts { words, at }, the n-th being words[at[n]]. Of nan and infinite numbers there is null.
/// Throws InputError.
std::string report_data(const std::string& folder);

}  // namespace arcslip
