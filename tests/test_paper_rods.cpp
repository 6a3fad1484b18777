// The closed forms (27)-(32) of the paper, as printed, for N/n -> infinity: a route to the rods' response
// that shares nothing with the program but the parameters.

#include <boost/math/tools/toms748_solve.hpp>
#include <numbers>

#include "catch.hpp"
#include "paper_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::ForcedResponse;

namespace {

/// (29)-(32) in the paper's own symbols.
class PrintedRods {
 public:
  PrintedRods(const SystemParameters& q, double eta)
      : force_(q.force * q.stiffness_ratio() / q.interface_stiffness) {
    const double pi = std::numbers::pi;
    const auto n = static_cast<double>(q.wave_number);
    D1_ = 4 * pi * pi / q.interface_stiffness * (q.stiffness_ratio() * n * n - q.mass_ratio * eta * eta);
    D2_ = 8 * pi * pi / (q.interface_stiffness * q.frequency_ratio) * q.stiffness_ratio() * q.base_damping *
          eta * n * n;
    D3_ = 4 * pi * pi / q.interface_stiffness * (n * n - eta * eta);
    D4_ = 8 * pi * pi / q.interface_stiffness * q.damper_damping * eta * n * n;
    S_ = q.preload * q.stiffness_ratio() / q.interface_stiffness;
  }

  /// Left minus right side of (31), over the right.
  double residual(double R) const {
    const auto [c, s] = motion(R);
    const double first = D1_ * c - D2_ * s - cosine(R);
    const double second = D1_ * s + D2_ * c + sine(R);
    return (first * first + second * second) / (force_ * force_) - 1;
  }

  double Y(double R) const {
    const auto [c, s] = motion(R);
    return std::hypot(c, s);
  }

  double solve_slip() const {
    std::uintmax_t iterations = 200;
    double high = 2 * S_;
    while (residual(high) < 0) high *= 2;
    const auto bracket =
        boost::math::tools::toms748_solve([this](double R) { return residual(R); }, S_, high,
                                          boost::math::tools::eps_tolerance<double>(52), iterations);
    return bracket.first;
  }

  /// (27), (28) as complex equations: (D_1 + 1 + j D_2) y = F K*/K_FD + u, (D_3 + 1 + j D_4) u = y.
  double stick_Y() const {
    const Complex damper(D3_ + 1, D4_);
    return std::abs(force_ * damper / (Complex(D1_ + 1, D2_) * damper - 1.0));
  }

  bool slips() const {
    const Complex damper(D3_ + 1, D4_);
    const Complex y = force_ * damper / (Complex(D1_ + 1, D2_) * damper - 1.0);
    return std::abs(y / damper - y) > S_;
  }

 private:
  double angle(double R) const { return std::acos(1 - 2 * S_ / R); }
  double cosine(double R) const {
    return R * (angle(R) - 0.5 * std::sin(2 * angle(R))) / std::numbers::pi;
  }                                                                                  // F_c
  double sine(double R) const { return -4 * S_ * (1 - S_ / R) / std::numbers::pi; }  // F_s

  /// Y_c and Y_s of (32).
  std::pair<double, double> motion(double R) const {
    const double square = D3_ * D3_ + D4_ * D4_;
    return {(sine(R) * D4_ - cosine(R) * D3_) / square - R, (cosine(R) * D4_ + sine(R) * D3_) / square};
  }

  double force_, D1_, D2_, D3_, D4_, S_;
};

double program_Y(SystemParameters parameters, Index elements, double eta) {
  parameters.elements = elements;
  const ForcedResponse problem(build_system(parameters));
  const continuation::Guess guess = problem.guess(eta, parameters.preload);
  Vector values;
  problem.observe(guess.unknowns, guess.parameters, guess.regime, values);
  return values(ForcedResponse::Y);
}

}  // namespace

TEST_CASE("Rods of very fine mesh have the response of (27), (28) and (31), (32) as printed") {
  const double preload = GENERATE(0.1, 1.0, 10.0);
  const SystemParameters parameters = rods(preload);
  int slipping = 0;
  for (const double eta : {0.7, 2.5, 3.3, 3.48, 3.7, 4.2, 5.6, 5.97, 6.1, 9.0}) {
    const PrintedRods printed(parameters, eta);
    const double expected = printed.slips() ? printed.Y(printed.solve_slip()) : printed.stick_Y();
    slipping += static_cast<int>(printed.slips());
    CHECK_THAT(program_Y(parameters, 1000000, eta),
               WithinRel(expected, 1e-8));  // mesh: (pi/N)^2 near a resonance
  }
  CHECK(slipping >= 1);
}

TEST_CASE("Rods converge to (31) as (n/N)^2") {
  const SystemParameters parameters = rods(1);
  for (const double eta : {3.3, 5.6}) {
    const PrintedRods printed(parameters, eta);
    const double exact = printed.Y(printed.solve_slip());
    const double coarse = std::abs(program_Y(parameters, 200, eta) - exact);
    const double fine = std::abs(program_Y(parameters, 400, eta) - exact);
    CHECK_THAT(coarse / fine, WithinRel(4.0, 0.01));
  }
}
