#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

namespace arcslip::testing {

/// Least of several runs, which is the one that nothing disturbed, in seconds a run.
template <class Run>
double least_seconds(int runs, Run run) {
  using Clock = std::chrono::steady_clock;
  double least = HUGE_VAL;
  for (int i = 0; i < runs; ++i) {
    const Clock::time_point start = Clock::now();
    run();
    least = std::min(least, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return least;
}

}  // namespace arcslip::testing
