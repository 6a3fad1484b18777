#pragma once

// What a case asks for although it holds nothing of what it is likely meant for: a window of frequencies
// without resonance, preloads at which no contact slips. Said before the work.

#include <string>
#include <vector>

#include "arcslip/cases/study_case.hpp"

namespace arcslip {

/// A sentence for each kind of slip among the branches, of very many the first ones; none of library models.
std::vector<std::string> warnings_of(const CasePlan& plan);

/// The same of the designs of a study.
std::vector<std::string> warnings_of(const StudyCase& study);

}  // namespace arcslip
