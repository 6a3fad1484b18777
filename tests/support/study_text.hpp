#pragma once

// Studies for tests, as case files: a few designs of the paper's beams over a narrow range of preloads.

#include <string>

namespace arcslip::testing {

inline const std::string study_system = R"([system]
model = "beams"
wave_number = 1
elements = 30
mass_ratio = 5.0
frequency_ratio = 4.0
slenderness = 33.3
force = 1.0
)";

/// `for_each` and further keys of [study] follow.
inline const std::string study_text = study_system + R"([study]
parameter = "P"
from = 0.9
to = 1.2
eta = [3.0, 5.0]
)";

/// 24 designs.
inline const std::string chart_text =
    study_text +
    "for_each = { mass_ratio = [5, 10, 20, 50], frequency_ratio = { from = 3.5, to = 4.5, count = 6 } }\n";

}  // namespace arcslip::testing
