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

SlipBorder slip_border(const std::vector<int>& orders, const HarmonicVector& motion, double threshold,
                       bool slips) {
  return slip_border(orders, OddMotion(orders, motion).maximum(), threshold, slips);
}

SlipBorder slip_border(const std::vector<int>& orders, const OddMotion::Maximum& top, double threshold,
                       bool slips) {
  const double sign = slips ? -1 : 1;
  const double square = top.value * top.value;
  const double sum = square + threshold * threshold;
  const double slope = sign * 4 * threshold * threshold / (sum * sum);  // by A^2/2
  SlipBorder border{sign * (square - threshold * threshold) / sum, HarmonicVector(std::ssize(orders)),
                    -slope * square};
  for (Index a = 0; a < border.by_motion.size(); ++a) {
    border.by_motion(a) =
        slope * top.value * std::polar(1.0, -orders[static_cast<std::size_t>(a)] * top.angle);
  }
  return border;
}

}  // namespace arcslip::problems
