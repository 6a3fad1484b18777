#pragma once

// A case file's text and what is read of it, or told of a mistake in it.

#include "arcslip/cases/case_file.hpp"
#include "arcslip/cases/study_case.hpp"
#include "mistakes.hpp"
#include "temporary_folder.hpp"

namespace arcslip::testing::case_texts {

/// A system without its preload.
inline const std::string beams = R"([system]
model = "beams"
wave_number = 2
elements = 30
mass_ratio = 5.0
frequency_ratio = 4.0
slenderness = 33.3
force = 1.0
)";

inline const std::string good = "title = \"A case\"\n" + beams + R"(preload = 1.0

[branch]
parameter = "eta"
from = 0.5
to = 120.0
)";

inline const std::string rods_under_force = R"([system]
model = "rods"
wave_number = 1
elements = 12
mass_ratio = 3.0
frequency_ratio = 1.5
interface_stiffness = 40.0
damping = { base = 1e-2, damper = 2e-2 }
force = 1.0
preload = 0.3
)";

inline Case read_text(const std::string& text, const std::vector<std::string>& settings = {}) {
  const TemporaryFolder folder;
  return read_case(folder.write("case.toml", text), settings);
}

inline StudyCase read_study_text(const std::string& text, const std::vector<std::string>& settings = {}) {
  const TemporaryFolder folder;
  return read_study(folder.write("case.toml", text), settings);
}

inline std::string error_of(const std::string& text, const std::vector<std::string>& settings = {}) {
  return testing::error_of([&] { read_text(text, settings); });
}

inline void check_refused(const std::string& text, const Mistake& mistake) {
  testing::check_message(error_of(replaced(text, mistake.from, mistake.to)), mistake);
}

}  // namespace arcslip::testing::case_texts
