#include "app/share.hpp"

#include <system_error>

namespace arcslip {

std::filesystem::path share_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path() : program.parent_path().parent_path() / "share/arcslip";
}

}  // namespace arcslip
