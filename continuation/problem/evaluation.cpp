#include "arcslip/continuation/problem/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace arcslip::continuation {
namespace {

constexpr std::uint64_t pattern = 0x7ff8'0a5c'51e9'0f11;  // a quiet nan, which sums and products keep
constexpr double unfilled = std::bit_cast<double>(pattern);

bool is_unfilled(double value) {
  constexpr std::uint64_t all_but_sign = ~(std::uint64_t{1} << 63);
  return (std::bit_cast<std::uint64_t>(value) & all_but_sign) == pattern;
}

[[noreturn]] void fail(const std::string& what) { throw std::logic_error("Problem::evaluate: " + what); }

template <class Target>
void require_size(const Target& target, const char* name, Index rows, Index columns) {
  if (target.rows() == rows && target.cols() == columns) return;
  fail(fmt::format("the {} is {} x {}; expected {} x {}, as it was given", name, target.rows(), target.cols(),
                   rows, columns));
}

/// A loop of its own: Eigen's take longer to begin than the few entries of most problems. Four sums at once,
/// as each waits for its last addition.
template <class Entries>
bool is_finite(const Entries& entries) {
  const double* entry = entries.data();
  const double* const end = entry + entries.size();
  double sum = 0;
  double others[3] = {0, 0, 0};
  for (; end - entry >= 4; entry += 4) {
    sum += 0 * entry[0];
    for (int i = 0; i < 3; ++i) others[i] += 0 * entry[i + 1];
  }
  for (; entry != end; ++entry) sum += 0 * *entry;
  return sum + others[0] + others[1] + others[2] == 0;
}

template <class Entries>
void unfill(Entries* entries) {
  if (entries != nullptr) std::fill_n(entries->data(), entries->size(), unfilled);
}

void require_filled(const Matrix& matrix, const char* name) {
  if (is_finite(matrix)) return;
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (Index i = 0; i < matrix.rows(); ++i) {
      if (is_unfilled(matrix(i, j))) fail(fmt::format("entry ({}, {}) of the {} is not filled", i, j, name));
    }
  }
}

/// Entries that are the same everywhere may have been filled once, when the pattern was laid out.
void check_sparse(const SparseMatrix& matrix, Index n) {
  require_size(matrix, "sparse_jacobian", n, n);
  if (!matrix.isCompressed()) fail("the sparse_jacobian is not compressed");
  if (matrix.nonZeros() == 0) fail("the problem is sparse but fills no sparse_jacobian");
}

/// Whether F is finite.
bool check_residual(const Vector& residual, Index n) {
  require_size(residual, "residual", n, 1);
  if (is_finite(residual)) return true;
  for (Index i = 0; i < n; ++i) {
    if (is_unfilled(residual(i))) fail(fmt::format("entry {} of the residual is not filled", i));
  }
  return false;
}

}  // namespace

bool evaluate(const Problem& problem, const Vector& u, const Vector& p, const Regime& regime,
              const Evaluation& out) {
  unfill(out.residual);
  unfill(out.jacobian);
  unfill(out.parameter_jacobian);
  if (!problem.evaluate(u, p, regime, out)) return false;
  const Index n = u.size();
  if (out.residual != nullptr && !check_residual(*out.residual, n)) return false;
  if (out.jacobian != nullptr) {
    require_size(*out.jacobian, "jacobian", n, n);
    require_filled(*out.jacobian, "jacobian");
  }
  if (out.parameter_jacobian != nullptr) {
    require_size(*out.parameter_jacobian, "parameter_jacobian", n, p.size());
    require_filled(*out.parameter_jacobian, "parameter_jacobian");
  }
  if (out.sparse_jacobian != nullptr) check_sparse(*out.sparse_jacobian, n);
  return true;
}

namespace {

void require_filled(const std::string& name, const Vector& values, Index size) {
  if (values.size() != size)
    throw std::logic_error(fmt::format("Problem: {} has {} entries; expected {}", name, values.size(), size));
  for (Index i = 0; i < size; ++i) {
    if (is_unfilled(values(i)))
      throw std::logic_error(fmt::format("Problem: entry {} of {} is not filled", i, name));
  }
}

void require_filled(const std::string& name, const Gradient& gradient, Index n, Index parameters) {
  require_filled(fmt::format("the gradient of {} by the unknowns", name), gradient.unknowns, n);
  require_filled(fmt::format("the gradient of {} by the parameters", name), gradient.parameters, parameters);
}

}  // namespace

void check_functions(const Problem& problem, const Vector& u, const Vector& p, const Regime& regime,
                     const std::vector<Index>& tracked) {
  const Index n = problem.size();
  const Index parameters = p.size();
  Vector unknown_scale = Vector::Constant(n, unfilled);
  Vector parameter_scale = Vector::Constant(parameters, unfilled);
  problem.scale(u, p, unknown_scale, parameter_scale);
  require_filled("the scale of the unknowns", unknown_scale, n);
  require_filled("the scale of the parameters", parameter_scale, parameters);
  const std::vector<Observable> observables = problem.observables();
  Vector values;
  problem.observe(u, p, regime, values);
  require_filled("observe", values, std::ssize(observables));
  problem.test(u, p, regime, values);
  require_filled("test", values, std::ssize(problem.test_types()));
  const auto blank = [&] {
    return Gradient{Vector::Constant(n, unfilled), Vector::Constant(parameters, unfilled)};
  };
  for (const Index which : tracked) {
    Gradient gradient = blank();
    problem.observe(u, p, regime, which, gradient);
    require_filled(observables[static_cast<std::size_t>(which)].name, gradient, n, parameters);
  }
  for (int border = 0; border < problem.border_count(regime); ++border) {
    Gradient gradient = blank();
    problem.border(u, p, regime, border, &gradient);
    require_filled(fmt::format("border {}", border), gradient, n, parameters);
  }
}

}  // namespace arcslip::continuation
