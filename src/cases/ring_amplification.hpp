#pragma once

// How much higher an unequal ring moves than the equal one.

#include <memory>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/continuation/path/trace.hpp"

namespace arcslip {

/// Whether the branch tells the amplification of a whole ring.
bool tells_amplification(const CaseBranch& branch);

/// Such a branch with the highest amplitude of the equal ring under the same load, over the same range, which
/// is not known where its response is not traced from end to end in time.
std::shared_ptr<const CaseBranch> with_equal_peak(const CaseBranch& branch,
                                                  const continuation::TimeBudget& time);

}  // namespace arcslip
