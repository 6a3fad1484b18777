#include "sectors/dense_blocks.hpp"

#include <dlfcn.h>

#include <filesystem>

namespace arcslip::dense {

std::string library() {
  Dl_info found{};
  if (dladdr(dlsym(RTLD_DEFAULT, "zgemm_"), &found) == 0) return "BLAS within";
  std::error_code missing;
  const std::filesystem::path file = std::filesystem::canonical(found.dli_fname, missing);
  return missing ? found.dli_fname : file.filename().string();
}

}  // namespace arcslip::dense
