#include "arcslip/continuation/problem/derivative_check.hpp"
#include "catch.hpp"
#include "scalar_problem.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

/// u = p, and what is told is |u|, with a slope.
class Kink : public ScalarProblem {
 public:
  explicit Kink(double slope) : ScalarProblem(line("p", 1)), slope_(slope) {}
  double observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/, Index /*which*/,
                 Gradient& gradient) const override {
    gradient.unknowns(0) = slope_;
    gradient.parameters.setZero();
    return std::abs(u(0));
  }

 private:
  double slope_;
};

}  // namespace

TEST_CASE("Slopes at a kink are right between those of both sides, and nowhere else") {
  for (const double slope : {-1.0, -0.5, 0.0, 1.0})
    CHECK(check_derivatives(Kink(slope), Vector{{0.0}}, Vector{{0.0}}, {}).worst < 1e-9);
  for (const double slope : {-1.1, 1.01}) {
    const DerivativeReport report = check_derivatives(Kink(slope), Vector{{0.0}}, Vector{{0.0}}, {});
    CHECK(report.worst > 1e-3);
    CHECK(report.where == "d u/du0");
  }
  CHECK(check_derivatives(Kink(0.999), Vector{{1.0}}, Vector{{1.0}}, {}).worst > 1e-4);
}

TEST_CASE("Equations with a kink are told to have one") {
  const ScalarProblem one_side(
      {"p"}, [](double u, const Vector& p) { return std::abs(u) - p(0); },
      [](double, const Vector&) { return 1.0; }, {[](double, const Vector&) { return -1.0; }});
  CHECK(check_derivatives(one_side, Vector{{0.0}}, Vector{{0.0}}, {}).worst > 0.1);
}
