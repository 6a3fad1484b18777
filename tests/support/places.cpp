#include "places.hpp"

#ifndef ARCSLIP_MPIEXEC
#define ARCSLIP_MPIEXEC ""
#endif

namespace arcslip::testing {

std::string source_folder() { return ARCSLIP_SOURCE_DIR; }
std::string program_path() { return ARCSLIP_PROGRAM; }
std::string mpiexec_path() { return ARCSLIP_MPIEXEC; }

}  // namespace arcslip::testing
