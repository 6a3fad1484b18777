#include "arcslip/problems/response/slip_regimes.hpp"

#include <fmt/format.h>

namespace arcslip::problems {

std::vector<std::string> slip_regimes(Index contacts) {
  std::vector<std::string> names = {"stick"};
  const int all = 1 << contacts;
  for (int regime = 1; regime < all; ++regime) {
    std::string name = "slip";
    for (Index i = 0; regime < all - 1 && i < contacts; ++i) {
      if (slips(regime, i)) name += fmt::format(" {}", i + 1);
    }
    names.push_back(name);
  }
  return names;
}

}  // namespace arcslip::problems
