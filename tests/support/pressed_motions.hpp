#pragma once

// Motions and settings of contacts under a normal force, drawn at random.

#include <vector>

#include "arcslip/elements/pressed/pressed_contact.hpp"
#include "random_systems.hpp"

namespace arcslip::testing {

inline std::vector<int> from_zero_to(int highest) {
  std::vector<int> orders;
  for (int h = 0; h <= highest; ++h) orders.push_back(h);
  return orders;
}

inline ComplexVector random_course(RandomSystems& draw, int highest, double mean) {
  ComplexVector x(highest + 1);
  x(0) = draw.uniform(-mean, mean);
  for (int h = 1; h <= highest; ++h) x(h) = std::polar(draw.uniform(0, 1.5) / h, draw.uniform(-pi, pi));
  return x;
}

inline PressedSettings random_pressed(RandomSystems& draw) {
  return {draw.uniform(0.1, 1), draw.uniform(0.5, 2), draw.uniform(0, 2), draw.uniform(-1, 3)};
}

}  // namespace arcslip::testing
