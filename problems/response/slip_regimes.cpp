#include "arcslip/problems/response/slip_regimes.hpp"

#include <fmt/format.h>

namespace arcslip::problems {
namespace {

constexpr Index most_by_number = 12;

/// A hash of the pattern [FNV-1a], folded to 16 bits.
unsigned fingerprint(const continuation::Regime& regime, Index contacts) {
  std::uint32_t hash = 2166136261U;
  for (Index i = 0; i < contacts; ++i) hash = (hash ^ static_cast<std::uint32_t>(regime[i])) * 16777619U;
  return (hash >> 16 ^ hash) & 0xffffU;
}

}  // namespace

std::string slip_name(const continuation::Regime& regime, Index contacts) {
  Index slipping = 0;
  std::string numbers;
  for (Index i = 0; i < contacts; ++i) {
    if (!slips(regime, i)) continue;
    ++slipping;
    if (contacts <= most_by_number) numbers += fmt::format(" {}", i + 1);
  }
  if (slipping == 0) return "stick";
  if (slipping == contacts) return "slip";
  if (contacts <= most_by_number) return "slip" + numbers;
  return fmt::format("slip {} of {} #{:04x}", slipping, contacts, fingerprint(regime, contacts));
}

}  // namespace arcslip::problems
