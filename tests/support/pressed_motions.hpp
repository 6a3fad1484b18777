#pragma once

// Motions and settings of contacts under a normal force, drawn at random.

#include <vector>

#include "arcslip/elements/pressed/pressed_element.hpp"
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

/// The least or greatest normal force under a motion of which the closing displacement is this coordinate.
inline double extreme_press(const PressedSettings& s, const std::vector<int>& orders, const ComplexVector& x,
                            Index closing, bool greatest) {
  const PressedElement::Settings settings{s.friction, s.tangential_stiffness, s.normal_stiffness,
                                          s.normal_force, 0};
  return PressedElement::extreme_press(settings, orders, x, 1, closing, greatest).value;
}

/// Harmonics f0 c1 s1 c2 s2 c3 s3 of friction with k_t = 2, k_n = 2.5, mu = 0.75 under r = X cos
/// theta, N = k_n max(0, n0 + n1 cos(theta - phi)); the first is Caughey's loop.
struct PublishedLoop {
  double X, n0, n1, phi;
  std::vector<double> f;
};
inline std::vector<PublishedLoop> published_loops() {
  return {{5, 1.5, 0, 0, {0, 2.3063833, -2.5738338, 0, 0, .6750446, .5295127}},
          {5, 1.5, .9, pi / 2, {-.7799905, 2.2615872, -2.5517966, .7624896, .5069082, .6032107, .4563630}},
          {5, 1.5, .9, pi / 3, {-.1477671, 2.3472949, -2.4130291, 1.0788891, .4432549, .4690568, .4549281}},
          {5, 1.5, 2.1, pi / 3, {-.3646009, 2.4161268, -2.0987473, 2.1132815, .8470408, .0299844, .4077671}},
          {2, 1.5, .9, 0, {1.5391530, 2.9714227, -.9659197, .0790543, .2388725, -.1821661, .1865300}}};
}

}  // namespace arcslip::testing
