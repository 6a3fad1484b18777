// Enclosures hold what fifty digits give.

#include <boost/math/constants/constants.hpp>

#include "arcslip/interval/interval_response.hpp"
#include "arcslip/problems/proof/enclosed_equation.hpp"
#include "arcslip/structure/precise.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::EnclosedEquation;
using problems::ForcedResponse;
using problems::PlanePoint;

namespace {

constexpr int count = 1000;

bool holds(const Interval& interval, const PreciseReal& value) {
  return PreciseReal(interval.lower()) <= value && value <= PreciseReal(interval.upper());
}
bool holds(const ComplexInterval& interval, const PreciseComplex& value) {
  return holds(interval.real, value.real()) && holds(interval.imaginary, value.imag());
}

double relative_width(const Interval& x) { return (x.upper() - x.lower()) / std::abs(x.upper()); }

/// An interval about x, and a number in it. Every other one is a point.
struct Sample {
  Interval interval;
  double inside;
};

Sample around(RandomSystems& draw, double x) {
  if (draw.integer(0, 1) == 0) return {x, x};
  const double width = draw.log_uniform(1e-15, 0.3);
  const double low = x * (1 - width * draw.uniform(0, 1));
  const double high = x * (1 + width * draw.uniform(0, 1));
  const auto [least, most] = std::minmax({low, x, high});
  return {{least, most}, draw.integer(0, 2) == 0 ? least : draw.integer(0, 1) == 0 ? most : x};
}

/// phi, d phi/d ln(R/S) and their sum at x = S/R.
struct PreciseCoefficient {
  PreciseComplex phi = PreciseReal(1), phi_log = PreciseReal(0);
  PreciseComplex slope() const { return phi + phi_log; }
};

PreciseCoefficient precise_coefficient(const PreciseReal& x) {
  if (x >= 1) return {};
  const PreciseReal& pi = boost::math::constants::pi<PreciseReal>();
  const PreciseReal theta = 2 * asin(sqrt(x));
  return {PreciseComplex((theta - sin(2 * theta) / 2) / pi, 4 / pi * x * (1 - x)),
          PreciseComplex(-8 / pi * x * sqrt(x * (1 - x)), -4 / pi * x * (1 - 2 * x))};
}

struct PreciseResponse {
  PreciseComplex compliance, compliance_eta, free, free_eta;
};

PreciseResponse precise_response(const ModalModel& model, const PreciseReal& eta) {
  PreciseResponse sum;
  const Loss& loss = model.loss();
  for (const Mode& mode : model.modes()) {
    const PreciseReal f = mode.frequency;
    const PreciseReal by_eta = loss.viscous * f * f + loss.modal * f + loss.mass + mode.influence.damping;
    const PreciseComplex d(f * f - eta * eta - mode.influence.stiffness.real(),
                           by_eta * eta + loss.structural * f * f - mode.influence.stiffness.imag());
    const PreciseComplex reciprocal = PreciseComplex(1) / d;
    const PreciseComplex slope = -reciprocal * reciprocal * PreciseComplex(-2 * eta, by_eta);
    const PreciseComplex load(PreciseReal(mode.load_residue.real()), PreciseReal(mode.load_residue.imag()));
    sum.compliance += PreciseReal(mode.residue) * reciprocal;
    sum.compliance_eta += PreciseReal(mode.residue) * slope;
    sum.free += load * reciprocal;
    sum.free_eta += load * slope;
  }
  return sum;
}

PreciseReal squared(const PreciseComplex& z) { return z.real() * z.real() + z.imag() * z.imag(); }

/// g(rho, eta, P) and its derivatives by rho and by eta.
struct PreciseEquation {
  PreciseReal value, by_rho, by_eta;
};

PreciseEquation precise_equation(const FrictionSystem& system, double rho, double eta, double preload) {
  const PreciseReal load = PreciseReal(preload) + PreciseReal(system.preload_growth) * eta * eta;
  const PreciseCoefficient law = precise_coefficient(load * system.slip_per_preload * exp(PreciseReal(-rho)));
  const PreciseResponse base = precise_response(system.base, eta);
  const PreciseResponse damper = precise_response(system.damper, eta);
  const PreciseReal k = system.contact_stiffness;
  const PreciseComplex c = base.compliance + damper.compliance;
  const PreciseComplex closed = PreciseReal(1) + k * law.phi * c;
  const PreciseReal by_ratio = PreciseComplex(k * c * law.phi_log / closed).real();
  const PreciseComplex c_eta = base.compliance_eta + damper.compliance_eta;
  return {rho + log(squared(closed) / squared(base.free)) / 2, 1 + by_ratio,
          PreciseComplex(k * law.phi * c_eta / closed).real() -
              PreciseComplex(base.free_eta / base.free).real() -
              by_ratio * 2 * system.preload_growth * eta / load};
}

}  // namespace

TEST_CASE("Exponential and logarithm enclose fifty digits, in a few units of rounding at a point",
          "[interval]") {
  RandomSystems draw(1);
  int missed = 0;
  double widest = 0;
  for (int i = 0; i < count; ++i) {
    const double sign = draw.integer(0, 1) == 0 ? 1 : -1;
    const Sample x = around(draw, sign * draw.log_uniform(1e-12, 300));
    missed += !holds(exponential(x.interval), exp(PreciseReal(x.inside)));
    const Sample y = around(draw, draw.log_uniform(1e-3, 1e3));
    missed += !holds(logarithm(y.interval), log(PreciseReal(y.inside)));
    const double near = 1 + sign * draw.log_uniform(1e-12, 0.4);
    missed += !holds(logarithm(near), log(PreciseReal(near)));
    widest =
        std::max({widest, relative_width(exponential(x.inside)), std::abs(relative_width(logarithm(near)))});
  }
  CHECK(missed == 0);
  CHECK(widest < 2e-14);  // some twenty operations, each of 3 epsilon
}

TEST_CASE("What has no enclosure is refused", "[interval]") {
  CHECK_THROWS_AS(inverse(Interval(-1, 1)), NoEnclosure);
  CHECK_THROWS_AS(inverse(ComplexInterval{{-1, 1}, {-1, 1}}), NoEnclosure);
  CHECK_THROWS_AS(exponential(Interval(0, 800)), NoEnclosure);
  CHECK_THROWS_AS(logarithm(Interval(0, 1)), NoEnclosure);
  CHECK_THROWS_AS(enclose_coefficient(Interval(-1e-9, 1)), NoEnclosure);
  const Interval infinite(0, std::numeric_limits<double>::infinity());
  CHECK_THROWS_AS(logarithm(infinite), NoEnclosure);
  CHECK_THROWS_AS(joined(Interval(1e200) * Interval(1e200), 1), NoEnclosure);
}

TEST_CASE("The enclosed contact law holds fifty digits, from stick to R/S = 1e12", "[interval]") {
  RandomSystems draw(2);
  int missed = 0;
  double widest = 0;
  for (int i = 0; i < count; ++i) {
    const double ratio = draw.integer(0, 1) == 0 ? draw.log_uniform(1e-12, 1.5)
                                                 : 1 - draw.log_uniform(1e-15, 0.5);  // from below the border
    const Sample x = around(draw, ratio);
    const EnclosedCoefficient law = enclose_coefficient(x.interval);
    const PreciseCoefficient exact = precise_coefficient(x.inside);
    missed +=
        !holds(law.phi, exact.phi) + !holds(law.phi_log, exact.phi_log) + !holds(law.slope, exact.slope());
    widest = std::max(widest, relative_width(enclose_coefficient(x.inside).phi.real));
  }
  CHECK(missed == 0);
  CHECK(widest < 1e-13);  // of a series of up to fifty terms
}

TEST_CASE("Enclosed response, equation and gradient hold fifty digits", "[interval]") {
  RandomSystems draw(3);
  int missed = 0, finite = 0;
  for (int i = 0; i < count; ++i) {
    SystemParameters s = draw.system();
    s.elements = 2 * s.wave_number + 1;
    s.base_damping *= draw.integer(0, 1) == 0 ? 1 : -1;
    s.base_damping_kind = draw.integer(0, 1) == 0 ? DampingKind::viscous : DampingKind::structural;
    s.preload_growth = draw.integer(0, 1) == 0 ? 0 : 0.1 * s.preload;
    if (draw.integer(0, 1) == 0)
      s.influence = std::make_shared<const Influence>(
          Influence{{{1, draw.uniform(-1, 1)}}, {{s.wave_number, draw.uniform(-0.01, 0.01)}}, {}});
    const FrictionSystem system = build_system(s);
    const auto [from, to] = resonance_range(s);
    const Sample eta = around(draw, draw.log_uniform(from, to));
    const Sample rho = around(draw, std::log(system.slip_threshold(eta.inside, s.preload)) +
                                        (draw.integer(0, 2) == 0 ? 0 : draw.uniform(-1, 8)));
    try {
      const EnclosedResponse response = enclose_response(system.base, eta.interval);
      const PreciseResponse exact = precise_response(system.base, eta.inside);
      missed += !holds(response.compliance, exact.compliance) +
                !holds(response.compliance_eta, exact.compliance_eta) + !holds(response.free, exact.free) +
                !holds(response.free_eta, exact.free_eta);
      const EnclosedEquation equation(system, ForcedResponse::eta, s.preload);
      const PreciseEquation g = precise_equation(system, rho.inside, eta.inside, s.preload);
      missed += !holds(equation.residual({eta.inside, rho.inside}), g.value);
      const auto gradient = equation.gradient(eta.interval, rho.interval);
      missed += !holds(gradient.rho, g.by_rho) + !holds(gradient.parameter, g.by_eta);
      ++finite;
    } catch (const NoEnclosure&) {  // as of a wide interval about a resonance
    }
  }
  CHECK(missed == 0);
  CHECK(finite > count / 2);
}

TEST_CASE("On both sides of a certified box g has opposite signs, all along the box", "[interval]") {
  SystemParameters s = figure_8(1);
  s.base_damping = -1e-2;
  const ForcedResponse problem(build_system(s));
  const EnclosedEquation equation(problem.system(), ForcedResponse::eta, 1);
  const auto branch = trace_over_eta(problem, 1, 3.4, 4.1);
  RandomSystems draw(4);
  int boxes = 0, wrong = 0;
  for (int i = 0; i < 400; ++i) {
    const auto& first =
        branch.points[static_cast<std::size_t>(draw.integer(0, std::ssize(branch.points) - 1))];
    const auto& last =
        branch.points[static_cast<std::size_t>(draw.integer(0, std::ssize(branch.points) - 1))];
    const double part = draw.log_uniform(1e-3, 1);  // of the way; mostly off the branch
    const PlanePoint from{first.parameters(0), first.unknowns(0)};
    const PlanePoint to{from.parameter + part * (last.parameters(0) - from.parameter),
                        from.rho + part * (last.unknowns(0) - from.rho)};
    for (const auto axis : {problems::Axis::rho, problems::Axis::parameter}) {
      const auto box = equation.certified_box(from, to, axis);
      if (!box) continue;
      ++boxes;
      const auto g = [&](double a, double b) {
        const double q = from.parameter + a * (to.parameter - from.parameter);
        const double rho = from.rho + a * (to.rho - from.rho);
        const bool up = axis == problems::Axis::rho;
        return equation.residual({up ? q : q + b, up ? rho + b : rho});
      };
      for (const double a : {0.0, 0.2, 0.5, 0.9, 1.0}) {
        const Interval product = g(a, -box->half_width) * g(a, box->half_width);
        wrong += product.upper() >= 0;
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(boxes > 50);
}
