#include "places.hpp"

#include "app/freed_memory.hpp"

#ifndef ARCSLIP_MPIEXEC
#define ARCSLIP_MPIEXEC ""
#endif

namespace arcslip::testing {
namespace {

[[maybe_unused]] const bool as_the_program = (keep_freed_memory(), true);

}  // namespace

std::string source_folder() { return ARCSLIP_SOURCE_DIR; }
std::string program_path() { return ARCSLIP_PROGRAM; }
std::string mpiexec_path() { return ARCSLIP_MPIEXEC; }

}  // namespace arcslip::testing
