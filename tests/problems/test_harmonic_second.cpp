// Second derivatives of the harmonic response.

#include <cmath>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "catch.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::problems;
using arcslip::testing::RandomSystems;

namespace {

Vector random_vector(RandomSystems& random, Index size) {
  Vector vector(size);
  for (double& entry : vector) entry = random.uniform(-1, 1);
  return vector;
}

}  // namespace

TEST_CASE("Second derivatives of the response are those of differences of its Jacobian", "[random]") {
  RandomSystems random(7);
  SystemParameters system;
  system.mass_ratio = 5;
  system.frequency_ratio = 4;
  system.interface_stiffness = 1000;
  system.preload_growth = 0.02;
  system.harmonics = odd_up_to(7);
  const HarmonicResponse problem(build_harmonic_system(system));
  const Index n = problem.size();
  int compared = 0;
  for (int i = 0; i < 40; ++i) {
    // Motions well beyond the border, with higher harmonics large enough to slip several times.
    Vector p(2);
    p << random.uniform(2, 5), random.uniform(0.5, 2);
    Vector u = random_vector(random, n) * problem.slip_threshold(0, p);
    u.head<2>() *= random.uniform(2, 8);
    const int regime = 1;
    if (problem.border(u, p, regime, 0, nullptr) > -0.1) continue;
    const Vector w = random_vector(random, n);
    const Vector du = random_vector(random, n) * u.norm();
    const Vector dp = random_vector(random, 2);
    Vector exact;
    REQUIRE(problem.second(u, p, regime, w, du, dp, exact));
    Matrix jacobian(n, n);
    Matrix by_parameters(n, 2);
    const auto gradient = [&](double h, Vector& out) {
      if (!problem.evaluate(u + h * du, p + h * dp, regime, {nullptr, &jacobian, &by_parameters}))
        return false;
      out.resize(n + 2);
      out << jacobian.transpose() * w, by_parameters.transpose() * w;
      return true;
    };
    Vector differences;
    const continuation::Difference found = continuation::differentiate(gradient, 1e-3, differences);
    // Where the number of slips changes within the steps there are no differences to compare with.
    if (!(found.error < 1e-7 * differences.norm())) continue;
    ++compared;
    INFO("motion " << i << ", error of differences " << found.error);
    CHECK((exact - differences).norm() < 1e-6 * differences.norm());
  }
  CHECK(compared > 20);
}
