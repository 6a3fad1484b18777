// Problems with mistakes of their authors: each is found and named.

#include <functional>

#include "arcslip/continuation/trace.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// Freudenstein & Roth's problem with something done to what it gives.
class Mistaken : public FreudensteinRoth {
 public:
  using Spoil = std::function<void(const Vector& u, const Evaluation& out)>;
  explicit Mistaken(Spoil spoil) : spoil_(std::move(spoil)) {}
  bool evaluate(const Vector& u, const Vector& p, int regime, const Evaluation& out) const override {
    if (!FreudensteinRoth::evaluate(u, p, regime, out)) return false;
    spoil_(u, out);
    return true;
  }

 private:
  Spoil spoil_;
};

const Guess start{vector_of({15, -2}), vector_of({0})};

std::string complaint(const Problem& problem) {
  try {
    trace(problem, start, over("x3", 0, 1));
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "none";
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

/// The arch of the README, which forgets one thing after the other.
class Forgetful : public Problem {
 public:
  explicit Forgetful(int forgotten) : forgotten_(forgotten) {}
  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, int /*regime*/, const Evaluation& out) const override {
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
  void observe(const Vector& u, const Vector& /*p*/, int /*regime*/, Vector& values) const override {
    values = Vector::Constant(forgotten_ == 4 ? 2 : 1, u.sum());
  }
  double observe(const Vector& u, const Vector& /*p*/, int /*regime*/, Index /*which*/,
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
