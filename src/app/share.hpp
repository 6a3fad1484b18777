#pragma once

// What the program finds beside itself: ../share/arcslip, in the build tree as after installation.

#include <filesystem>

namespace arcslip {

/// The folder; empty where the program cannot tell where it is.
std::filesystem::path share_folder();

}  // namespace arcslip
