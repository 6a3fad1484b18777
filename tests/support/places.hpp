#pragma once

// Where the tests find things. The paths are compiled in here alone, so that no other object depends on them.

#include <string>

namespace arcslip::testing {

std::string source_folder();  ///< of the project
std::string program_path();   ///< of the built arcslip
std::string mpiexec_path();   ///< empty in builds without MPI

}  // namespace arcslip::testing
