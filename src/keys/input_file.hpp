#pragma once

// Files that are read whole: never more of them than they may hold, and never for ever.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace arcslip {

constexpr std::size_t largest_case_file = std::size_t{32} << 20;
constexpr std::size_t largest_list = std::size_t{64} << 20;   ///< of dofs or loads
constexpr std::size_t largest_matrix = std::size_t{2} << 30;  ///< as text

/// What a file, or a pipe, holds. `begins` sees its first bytes before the rest is read, and may throw.
/// Throws InputError for what cannot be read, is neither, is larger than `most` bytes, or a pipe from which
/// nothing comes for some seconds.
std::string read_text(const std::string& path, std::size_t most,
                      const std::function<void(std::string_view)>& begins = {});

}  // namespace arcslip
