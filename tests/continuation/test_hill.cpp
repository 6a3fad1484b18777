// Floquet exponents by Hill's method.

#include <cmath>
#include <numbers>
#include <random>

#include "arcslip/continuation/linear/hill.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "catch.hpp"
#include "monodromy.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

using Coefficients = std::vector<ComplexMatrix>;

/// y'' + (a - 2 q cos 2t) y = 0, w = 2.
Coefficients mathieu(double a, double q) {
  Coefficients A(2, ComplexMatrix::Zero(2, 2));
  A[0](0, 1) = 1;
  A[0](1, 0) = -a;
  A[1](1, 0) = q;
  return A;
}

Matrix at(const Coefficients& A, double wt) {
  Matrix sum = A[0].real();
  for (std::size_t k = 1; k < A.size(); ++k)
    sum += 2 * (A[k] * std::polar(1.0, static_cast<double>(k) * wt)).real();
  return sum;
}

ComplexVector brute_multipliers(const Coefficients& A, double w, int steps = 4000) {
  return spectrum(monodromy([&](double t) { return at(A, w * t); }, 2 * pi / w, steps));
}

ComplexVector multipliers(const FloquetExponents& floquet, double w) {
  return (floquet.exponents * (2 * pi / w)).array().exp();
}

}  // namespace

TEST_CASE("At Mathieu's characteristic values a multiplier is +1 or -1", "[hill]") {
  struct Row {
    double q, a;
    int sign;  // of the multiplier over the period pi: +1 of even, -1 of odd index
  };
  // DLMF 28, Abramowitz & Stegun table 20.1, to ten decimals
  const Row row = GENERATE(values<Row>({{1, -0.4551386041, 1},
                                        {1, -0.1102488170, -1},
                                        {1, 1.8591080725, -1},
                                        {1, 3.9170247730, 1},
                                        {1, 4.3713009827, 1},
                                        {5, -5.8000460209, 1},
                                        {5, -5.7900805986, -1},
                                        {5, 1.8581875415, -1},
                                        {5, 2.0994604455, 1},
                                        {5, 7.4491097395, 1},
                                        {10, -13.9369799567, 1},
                                        {10, -2.3991424000, -1},
                                        {10, -2.3821582360, 1},
                                        {10, 7.7173698498, 1}}));
  const Index h = GENERATE(10, 15);
  CAPTURE(row.q, row.a, h);
  // Both multipliers meet there, so that the exponents are the square root of any error; their sum, the trace
  // of the monodromy matrix, is smooth. In a it is as steep as 1e4, so that a is judged by its own digits.
  const auto trace = [&](double a) {
    const Complex sum = multipliers(floquet_exponents(mathieu(a, row.q), 2, 2 * h), 2).sum();
    CHECK(std::abs(sum.imag()) < 1e-12);
    return sum.real();
  };
  const double slope = (trace(row.a + 1e-6) - trace(row.a - 1e-6)) / 2e-6;
  const double correction = (2 * row.sign - trace(row.a)) / slope;
  CHECK_THAT(correction, WithinAbs(0, 6e-11));  // the published values have ten decimals
  const FloquetExponents there = floquet_exponents(mathieu(row.a + correction, row.q), 2, 2 * h);
  CHECK_THAT(multipliers(there, 2).sum().real(), WithinAbs(2 * row.sign, 1e-8));
  for (Index i = 0; i < 2; ++i) {
    CHECK(std::abs(there.rates(i) * there.rates(i)) < 1e-8);
    CHECK_THAT(std::abs(there.exponents(i).imag()), WithinAbs(row.sign > 0 ? 0 : 1, 1e-4));
  }
}

TEST_CASE("Mathieu's exponents in a gap and in a band are those of the monodromy matrix", "[hill]") {
  struct Row {
    double a, q;
    Index unstable;
  };
  // in the gap (b1, a1), in the gap (b2, a2), between a0 and b1, and above a2
  const Row row = GENERATE(values<Row>({{1, 1, 1}, {4.2, 1, 1}, {-0.3, 1, 0}, {6, 1, 0}}));
  CAPTURE(row.a);
  const Coefficients A = mathieu(row.a, row.q);
  const FloquetExponents floquet = floquet_exponents(A, 2, 20);
  CHECK(worst_match(brute_multipliers(A, 2), multipliers(floquet, 2)) < 1e-10);  // the Runge-Kutta method's
  for (const Complex& rate : floquet.rates) CHECK((rate.imag() == 0) == (row.unstable > 0));
  for (const Complex& rate : floquet.rates) CHECK((std::abs(rate.real()) < 1e-12) == (row.unstable == 0));
}

TEST_CASE("The exponents of random systems are those of their monodromy matrices", "[hill]") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  int negative = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Index n = 1 + trial % 4;
    Coefficients A(3, ComplexMatrix::Zero(n, n));
    for (std::size_t k = 0; k < A.size(); ++k) {
      for (Complex& entry : A[k].reshaped()) entry = Complex(normal(random), k == 0 ? 0 : normal(random));
      A[k] *= 0.4;
    }
    const double w = 1 + std::abs(normal(random));
    CAPTURE(trial, n, w);
    const FloquetExponents floquet = floquet_exponents(A, w, 28 + trial % 2);
    const ComplexVector brute = brute_multipliers(A, w);
    CHECK(worst_match(brute, multipliers(floquet, w)) < 1e-8 * std::max(1.0, brute.cwiseAbs().maxCoeff()));
    CHECK_THAT(floquet.exponents.sum().real(), WithinAbs(A[0].trace().real(), 1e-10));  // Liouville
    for (Index i = 0; i < n; ++i) {
      const Complex multiplier = std::exp(floquet.exponents(i) * (2 * pi / w));
      const double size = std::log(std::abs(multiplier)) * w / (2 * pi);
      CHECK_THAT(floquet.rates(i).real(), WithinAbs(size, 1e-12));
      CHECK(std::abs(floquet.exponents(i).imag()) <= w / 2 * (1 + 1e-12));
      negative += static_cast<int>(floquet.rates(i).imag() == 0 && multiplier.real() < 0);
    }
  }
  CHECK(negative > 5);
}

TEST_CASE("Modes far faster than the period keep their exponents", "[hill]") {
  // Copies of the slow mode lie nearer to zero than any of the fast one's.
  Coefficients A(2, ComplexMatrix::Zero(4, 4));
  A[0](0, 1) = A[0](2, 3) = 1;
  A[0](1, 0) = -0.09;
  A[0](1, 1) = -0.02;
  A[0](3, 2) = -900;
  A[0](3, 3) = -0.4;
  A[1](1, 2) = A[1](3, 0) = A[1](1, 0) = 0.01;
  const FloquetExponents floquet = floquet_exponents(A, 1, 10);
  const ComplexVector brute = brute_multipliers(A, 1, 20000);
  CHECK(worst_match(brute, multipliers(floquet, 1)) < 1e-8);  // 100 steps a radian, of error 1e-12
}
