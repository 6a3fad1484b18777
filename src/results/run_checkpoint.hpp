#pragma once

// run.checkpoint: from where a run that was interrupted goes on.

#include <string>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/continuation/path/journal.hpp"

namespace arcslip {

/// What a run had done when it began with what it was then doing.
struct RunCheckpoint {
  std::size_t requests = 0;  ///< of the plan
  std::size_t branches = 0;  ///< in the results of these
  std::size_t points = 0;    ///< of these branches
  bool complete = true;      ///< whether they were all traced to their end
  std::string header;        ///< of the table of branches by then
};

/// With the journal of what was being done. Throws OutputError.
void write_checkpoint(const std::string& folder, const CasePlan& plan, const RunCheckpoint& checkpoint,
                      const continuation::Journal& journal);

/// Throws InputError where the folder has no interrupted run of this plan by this version of arcslip.
RunCheckpoint read_checkpoint(const std::string& folder, const CasePlan& plan,
                              continuation::Journal& journal);

void remove_checkpoint(const std::string& folder);

}  // namespace arcslip
