#pragma once

// How much of what tests repeat with other numbers is repeated under the sanitizers, where it takes ten times
// as long: what goes other ways in memory comes first.

namespace arcslip::testing {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

/// So many, or a quarter of them, at least 2, under the sanitizers.
constexpr int draws(int all) {
  if (!sanitized || all < 2) return all;
  return all < 8 ? 2 : all / 4;
}

}  // namespace arcslip::testing
