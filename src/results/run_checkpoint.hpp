#pragma once

// run.checkpoint: from where a run goes on that was interrupted, or had branches without time to be whole.

#include <map>
#include <string>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/continuation/path/journal.hpp"

namespace arcslip {

/// What a run had done when it began with the first that is not whole.
struct RunCheckpoint {
  std::size_t requests = 0;  ///< of the plan
  std::size_t branches = 0;  ///< in the results of these
  std::size_t points = 0;    ///< of these branches
  bool complete = true;      ///< whether they were all traced to their end
  std::string header;        ///< of the table of branches by then
};

/// Of the requests that are not whole, by their number in the plan.
using Journals = std::map<std::size_t, continuation::Journal>;

/// Throws OutputError.
void write_checkpoint(const std::string& folder, const CasePlan& plan, const RunCheckpoint& checkpoint,
                      const Journals& journals);

/// Throws InputError where the folder has no run to go on with of this plan, but for its `max_seconds`, by
/// this version of arcslip.
RunCheckpoint read_checkpoint(const std::string& folder, const CasePlan& plan, Journals& journals);

/// Where two cases differ first, but for the time that they have; "" if they are the same.
std::string case_difference(nlohmann::json then, nlohmann::json now);

void remove_checkpoint(const std::string& folder);

}  // namespace arcslip
