// Problems with mistakes of their authors: each is found and named, and no right one is suspected.

#include <cmath>
#include <functional>
#include <random>

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/problem/directional_check.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// A line with a border far away, of which a slope is told.
class FarBorder : public ScalarProblem {
 public:
  explicit FarBorder(double slope) : ScalarProblem(line("p", 1)), slope_(slope) {}
  int border_count(const Regime& /*regime*/) const override { return 1; }
  double border(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/, int /*border*/,
                Gradient* gradient) const override {
    if (gradient != nullptr) *gradient = {vector_of({slope_}), vector_of({0})};
    return -1;
  }

 private:
  double slope_;
};

/// Freudenstein & Roth's problem with something done to what it gives.
class Mistaken : public FreudensteinRoth {
 public:
  using Spoil = std::function<void(const Vector& u, const Evaluation& out)>;
  explicit Mistaken(Spoil spoil) : spoil_(std::move(spoil)) {}
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    if (!FreudensteinRoth::evaluate(u, p, regime, out)) return false;
    spoil_(u, out);
    return true;
  }

 private:
  Spoil spoil_;
};

const Guess enz_start{vector_of({15, -2}), vector_of({0})};

std::string complaint(const Problem& problem) {
  try {
    return trace(problem, enz_start, over("x3", 0, 1)).points.empty() ? "no point" : "none";
  } catch (const std::logic_error& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("What a problem resizes or does not fill is named") {
  using Catch::Matchers::Equals;
  CHECK(complaint(FreudensteinRoth()) == "none");
  CHECK_THAT(complaint(Mistaken([](const Vector&, const Evaluation& out) {
               if (out.jacobian != nullptr) *out.jacobian = Matrix::Identity(3, 3);
             })),
             ContainsSubstring("the jacobian is 3 x 3; expected 2 x 2"));
  CHECK_THAT(complaint(Mistaken([](const Vector&, const Evaluation& out) {
               if (out.residual != nullptr) out.residual->conservativeResize(1);
             })),
             ContainsSubstring("the residual is 1 x 1; expected 2 x 1"));
  CHECK_THAT(complaint(Mistaken([](const Vector&, const Evaluation& out) {
               if (out.residual != nullptr) *out.residual = Vector::Zero(5);
             })),
             ContainsSubstring("the residual is 5 x 1; expected 2 x 1"));
  CHECK_THAT(complaint(Mistaken([](const Vector&, const Evaluation& out) {
               if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = Matrix::Zero(2, 2);
             })),
             ContainsSubstring("the parameter_jacobian is 2 x 2; expected 2 x 1"));
}

namespace {

/// The arch of the manual, which forgets one thing after the other.
class Forgetful : public Problem {
 public:
  explicit Forgetful(int forgotten) : forgotten_(forgotten) {}
  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    if (out.residual != nullptr) {
      (*out.residual)(0) = u(0) - p(0);
      if (forgotten_ != 0) (*out.residual)(1) = u(1) - u(0) * u(0);
    }
    if (out.jacobian != nullptr) {
      (*out.jacobian)(0, 0) = 1;
      if (forgotten_ != 1) (*out.jacobian)(0, 1) = 0;
      (*out.jacobian)(1, 0) = -2 * u(0);
      (*out.jacobian)(1, 1) = forgotten_ == 2 ? (*out.jacobian)(1, 1) + 1 : 1;
    }
    if (out.parameter_jacobian != nullptr && forgotten_ != 3) *out.parameter_jacobian << -1, 0;
    return true;
  }
  std::vector<Observable> observables() const override { return {{"sum", true}}; }
  void observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/,
               Vector& values) const override {
    values = Vector::Constant(forgotten_ == 4 ? 2 : 1, u.sum());
  }
  double observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/, Index /*which*/,
                 Gradient& gradient) const override {
    gradient.unknowns.setOnes();
    if (forgotten_ != 5) gradient.parameters.setZero();
    return u.sum();
  }

 private:
  int forgotten_;
};

std::string complaint(int forgotten) {
  TraceOptions options = over("p", 1, 2);
  options.extrema_of = {"sum"};
  try {
    const Branch branch = trace(Forgetful(forgotten), {vector_of({1, 1}), vector_of({1})}, options);
    return branch.complete() ? "none" : branch.explanation;
  } catch (const std::logic_error& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("Entries that a problem forgets are found at once and named") {
  CHECK(complaint(-1) == "none");
  CHECK_THAT(complaint(0), ContainsSubstring("entry 1 of the residual is not filled"));
  CHECK_THAT(complaint(1), ContainsSubstring("entry (0, 1) of the jacobian is not filled"));
  CHECK_THAT(complaint(2), ContainsSubstring("entry (1, 1) of the jacobian is not filled"));
  CHECK_THAT(complaint(3), ContainsSubstring("entry (0, 0) of the parameter_jacobian is not filled"));
  CHECK_THAT(complaint(4), ContainsSubstring("observe has 2 entries; expected 1"));
  CHECK_THAT(complaint(5), ContainsSubstring("the gradient of sum by the parameters is not filled"));
}

TEST_CASE("A Jacobian that is 5 % wrong is named, however the branch ends") {
  const auto spoilt = [](Index row, Index column, double factor) {
    return Mistaken([=](const Vector&, const Evaluation& out) {
      if (out.jacobian != nullptr) (*out.jacobian)(row, column) *= factor;
    });
  };
  for (const Index row : {0, 1}) {
    for (const Index column : {0, 1}) {
      const Branch branch = trace(spoilt(row, column, 1.05), enz_start, over("x3", 0, 1));
      INFO(branch.explanation);
      CHECK_THAT(branch.warning,
                 ContainsSubstring("the Jacobian differs from differences of the residual by 5 "
                                   "% in dF" +
                                   std::to_string(row) + "/du" + std::to_string(column)));
      CHECK_THAT(branch.explanation, ContainsSubstring(branch.warning));
    }
  }
  const Branch astray = trace(spoilt(0, 1, -3), enz_start, over("x3", 0, 1));
  CHECK_FALSE(astray.complete());
  CHECK_THAT(astray.explanation, ContainsSubstring("in dF0/du1"));
  const Branch by_parameter = trace(Mistaken([](const Vector&, const Evaluation& out) {
                                      if (out.parameter_jacobian != nullptr)
                                        (*out.parameter_jacobian)(1, 0) *= 0.9;
                                    }),
                                    enz_start, over("x3", 0, 1));
  CHECK_THAT(by_parameter.explanation, ContainsSubstring("by 10 % in dF1/dx3"));
}

TEST_CASE("A wrong entry is found among many, and a wrong gradient") {
  class Spoilt : public Bratu {
   public:
    using Bratu::Bratu;
    bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                  const Evaluation& out) const override {
      Bratu::evaluate(u, p, regime, out);
      if (out.jacobian != nullptr) (*out.jacobian)(70, 71) *= 1.0002;
      return true;
    }
  };
  const Branch branch = trace(Spoilt(99), {Vector::Zero(99), vector_of({0})}, over("L", 0, 3));
  CHECK_THAT(branch.warning, ContainsSubstring("by 0.02 % in dF70/du71"));

  class Slope : public Needle {
   public:
    using Needle::Needle;
    double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                   Gradient& gradient) const override {
      const double value = Needle::observe(u, p, regime, which, gradient);
      gradient.unknowns *= 1.1;
      return value;
    }
  };
  TraceOptions options = over("p", 0.5, 2);
  options.extrema_of = {"amplitude"};
  const Branch peak = trace(Slope(0.1), {vector_of({-3}), vector_of({0.5})}, options);
  CHECK_THAT(
      peak.explanation,
      ContainsSubstring("the gradient of amplitude differs from differences by 10 % in d amplitude/du0"));
}

TEST_CASE("Right derivatives are never suspected: beside corners and borders, on needles, with rounding") {
  const auto silent = [](const Problem& problem, const Vector& u, const Vector& p,
                         const Regime& regime = {}) {
    const auto found = find_wrong_derivative(problem, u, p, regime, {0}, {});
    INFO(found.value_or(""));
    CHECK_FALSE(found);
  };
  for (const double slope : {1e-18, -9e-15, 3e-14, -1e-11})
    silent(FarBorder(slope), vector_of({0.5}), vector_of({0.5}));
  CHECK(find_wrong_derivative(FarBorder(1e-10), vector_of({0.5}), vector_of({0.5}), {}, {0}, {}));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-14, 0);
  std::uniform_real_distribution<double> resolved(-9, 0);  // what is sharper no difference could see
  for (int i = 0; i < 300; ++i) {
    const double x = (i % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random));
    silent(HiddenCorner(1, 3), vector_of({x}), vector_of({x > 0 ? 3 * x : x}));
    silent(Bump(0.3), vector_of({-std::abs(x)}), vector_of({1 + x}), 0);
    silent(Needle(std::pow(10, exponent(random))), vector_of({0}), vector_of({1 + x}));
    // A smooth step and an oscillation, of any width and size.
    const double width = std::pow(10, resolved(random));
    const double size = std::pow(10, exponent(random));
    silent(ScalarProblem(
               {"p"}, [=](double u, const Vector& p) { return u - p(0) + size * std::tanh(u / width); },
               [=](double u, const Vector&) { return 1 + size / width / std::pow(std::cosh(u / width), 2); },
               {[](double, const Vector&) { return -1.0; }}),
           vector_of({x}), vector_of({0.3}));
    silent(ScalarProblem(
               {"p"}, [=](double u, const Vector& p) { return u - p(0) + size * std::sin(u / width); },
               [=](double u, const Vector&) { return 1 + size / width * std::cos(u / width); },
               {[](double, const Vector&) { return -1.0; }}),
           vector_of({x}), vector_of({0.3}));
    // Large terms that cancel leave little but rounding.
    const double large = std::pow(10, -exponent(random)) / 10;
    silent(ScalarProblem(
               {"p"}, [=](double u, const Vector& p) { return (u - p(0) + large) - large; },
               [=](double, const Vector&) { return 1.0; }, {[](double, const Vector&) { return -1.0; }}),
           vector_of({x}), vector_of({0.3}));
  }
}
