#pragma once

// What `arcslip run --certify` proves, as text and as JSON.

#include <nlohmann/json.hpp>

#include "arcslip/cases/runs.hpp"

namespace arcslip {

nlohmann::ordered_json certificate_to_json(const problems::Certificate& certificate);

/// What a certificate proves, one line or two, or the segment that it cannot prove, one line.
std::string describe_certificate(std::size_t number, const TracedBranch& traced);

}  // namespace arcslip
