#include "arcslip/continuation/problem/derivative_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

#include "arcslip/continuation/problem/evaluation.hpp"
#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {
namespace {

constexpr double surely_wrong = 1e-6;  // far above the error of the differences
constexpr Index most_single = 1000;    // unknowns by which a scalar is differentiated one after the other
constexpr int directions = 20;         // in which all unknowns move at once where there are more

using Columns = std::vector<Index>;

/// Groups of columns without a row in common, of which the differences are taken at once [Curtis, Powell &
/// Reid 1974].
std::vector<Columns> group(const SparseMatrix& matrix) {
  std::vector<std::vector<std::size_t>> groups_of_row(static_cast<std::size_t>(matrix.rows()));
  std::vector<Columns> groups;
  std::vector<Index> excludes;  // the last column that has a row in common with the group
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      for (const std::size_t g : groups_of_row[static_cast<std::size_t>(entry.row())]) excludes[g] = j;
    }
    const auto free = std::find_if(excludes.begin(), excludes.end(), [j](Index last) { return last != j; });
    const auto g = static_cast<std::size_t>(free - excludes.begin());
    if (g == groups.size()) {
      groups.emplace_back();
      excludes.push_back(-1);
    }
    groups[g].push_back(j);
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      groups_of_row[static_cast<std::size_t>(entry.row())].push_back(g);
  }
  return groups;
}

std::vector<Columns> one_by_one(Index count) {
  std::vector<Columns> groups;
  for (Index j = 0; j < count; ++j) groups.push_back({j});
  return groups;
}

bool has_entry(const SparseMatrix& matrix, Index row, Index column) {
  SparseMatrix::InnerIterator entry(matrix, column);
  while (entry && entry.row() != row) ++entry;
  return static_cast<bool>(entry);
}

/// A function of (u, p), scalar or vector, and what is said to be its derivative along a direction of u.
struct Differentiated {
  std::string name;
  std::function<Vector(const Vector& u, const Vector& p)> value;
  std::function<Vector(const Vector& direction)> along;
  Matrix by_parameters;
  const SparseMatrix* pattern = nullptr;
  Vector here = {};  // its value, where it may have a kink: then any slope between both sides' is one
};

class Checker {
 public:
  Checker(const Problem& problem, const Vector& u, const Vector& p, const Regime& regime)
      : problem_(problem), u_(u), p_(p), regime_(regime), scale_u_(u.size()), scale_p_(p.size()) {
    problem.scale(u, p, scale_u_, scale_p_);
    signs_.setOnes(u.size());
  }

  DerivativeReport run() {
    check_residual();
    for (int b = 0; b < problem_.border_count(regime_); ++b) {
      check_scalar(fmt::format(" border {}", b), [this, b](const Vector& u, const Vector& p, Gradient& g) {
        return problem_.border(u, p, regime_, b, &g);
      });
    }
    const std::vector<Observable> observables = problem_.observables();
    for (std::size_t i = 0; i < observables.size(); ++i) {
      if (!observables[i].has_gradient) continue;
      const auto value = [this, i](const Vector& u, const Vector& p, Gradient& g) {
        return problem_.observe(u, p, regime_, static_cast<Index>(i), g);
      };
      Gradient unused{Vector(u_.size()), Vector(p_.size())};
      const double here = value(u_, p_, unused);
      check_scalar(" " + observables[i].name, [&](const Vector& u, const Vector& p, Gradient& g) {
        return observables[i].near(value(u, p, g), here);
      });
    }
    return report_;
  }

 private:
  void check_residual() {
    Linearization exact(problem_);
    if (!exact.evaluate(u_, p_, regime_)) {
      throw std::invalid_argument("check_derivatives: the problem cannot be evaluated here");
    }
    Differentiated f{"F", {}, {}, exact.parameter_jacobian()};
    f.value = [this](const Vector& u, const Vector& p) {
      Vector values(u.size());
      if (!evaluate(problem_, u, p, regime_, {&values})) values.setConstant(std::nan(""));
      return values;
    };
    f.along = [&exact](const Vector& direction) {
      Vector product(direction.size());
      exact.multiply(direction, product);
      return product;
    };
    if (exact.sparse()) f.pattern = &exact.sparse_jacobian();
    for (const Columns& columns : exact.sparse() ? group(*f.pattern) : one_by_one(u_.size()))
      compare(f, columns);
    compare_parameters(f);
  }

  template <class Scalar>
  void check_scalar(const std::string& name, Scalar scalar) {
    Gradient gradient{Vector(u_.size()), Vector(p_.size())};
    Gradient unused = gradient;
    scalar(u_, p_, gradient);
    Differentiated f{name, {}, {}, gradient.parameters.transpose()};
    f.value = [&](const Vector& u, const Vector& p) { return Vector{{scalar(u, p, unused)}}; };
    f.along = [&](const Vector& direction) { return Vector{{gradient.unknowns.dot(direction)}}; };
    f.here = f.value(u_, p_);
    compare_parameters(f);
    const std::vector<Columns> singles = one_by_one(u_.size());
    if (u_.size() <= most_single) {
      for (const Columns& columns : singles) compare(f, columns);
      return;
    }
    Columns all;
    for (const Columns& columns : singles) all.push_back(columns.front());
    std::mt19937 random(1);
    for (int i = 0; i < directions; ++i) {
      for (double& sign : signs_) sign = random() % 2 == 0 ? 1 : -1;
      compare(f, all);
    }
    signs_.setOnes();
  }

  /// Moves all these unknowns at once; where something is wrong, each half of them, until it has a name.
  void compare(const Differentiated& f, const Columns& columns) {
    Vector direction = Vector::Zero(u_.size());
    for (const Index j : columns) direction(j) = signs_(j) * scale_u_(j);
    const Vector errors =
        errors_of(f, f.along(direction), [&](double h) { return f.value(u_ + h * direction, p_); });
    const double largest = errors.maxCoeff<Eigen::PropagateNaN>();
    if (!is_worse(largest)) return;
    if (columns.size() > 1 && !(largest <= surely_wrong)) {
      const auto middle = columns.begin() + static_cast<std::ptrdiff_t>(columns.size() / 2);
      compare(f, Columns(columns.begin(), middle));
      return compare(f, Columns(middle, columns.end()));
    }
    note(f, errors, [&](Index row) {
      if (columns.size() > 1) return std::string("u");
      const Index column = columns.front();
      const bool lacking = f.pattern != nullptr && !has_entry(*f.pattern, row, column);
      return fmt::format("u{}{}", column, lacking ? ", which the pattern lacks" : "");
    });
  }

  void compare_parameters(const Differentiated& f) {
    for (Index j = 0; j < p_.size(); ++j) {
      const Vector direction = scale_p_(j) * Vector::Unit(p_.size(), j);
      const Vector errors = errors_of(f, f.by_parameters * direction,
                                      [&](double h) { return f.value(u_, p_ + h * direction); });
      note(f, errors, [&](Index) { return problem_.parameter_names()[static_cast<std::size_t>(j)]; });
    }
  }

  template <class Along>
  static Vector errors_of(const Differentiated& f, const Vector& exact, const Along& along) {
    const auto errors_by = [&](double h) -> Vector {
      const Vector up[2] = {along(h), along(2 * h)};
      const Vector down[2] = {along(-h), along(-2 * h)};
      const Vector difference = (8 * (up[0] - down[0]) - (up[1] - down[1])) / (12 * h);
      Vector errors = (exact - difference).cwiseAbs();
      if (f.here.size() > 0) {  // how far beside what lies between both sides' slopes
        const Vector ahead = (4 * up[0] - 3 * f.here - up[1]) / (2 * h);
        const Vector behind = (3 * f.here - 4 * down[0] + down[1]) / (2 * h);
        const Vector outside = (ahead.cwiseMin(behind) - exact).cwiseMax(exact - ahead.cwiseMax(behind));
        errors = errors.cwiseMin(outside.cwiseMax(0));
      }
      return errors.array() / (1 + exact.array().abs());
    };
    constexpr double widest = 5e-5;
    constexpr double narrowest = 5e-9;  // beside a needle
    constexpr double close = 1e-8;
    Vector errors = errors_by(widest);
    for (double width = widest / 10; width > narrowest && errors.allFinite() && errors.maxCoeff() > close;
         width /= 10)
      errors = errors.cwiseMin(errors_by(width));
    return errors;
  }

  /// What is not a number is worst.
  bool is_worse(double error) const { return !std::isnan(report_.worst) && !(error <= report_.worst); }

  template <class Name>
  void note(const Differentiated& f, const Vector& errors, const Name& name) {
    for (Index i = 0; i < errors.size(); ++i) {
      if (!is_worse(errors(i))) continue;
      report_ = {errors(i),
                 fmt::format("d{}{}/d{}", f.name, f.name == "F" ? fmt::format("{}", i) : "", name(i))};
    }
  }

  const Problem& problem_;
  const Vector& u_;
  const Vector& p_;
  Regime regime_;
  Vector scale_u_;
  Vector scale_p_;
  Vector signs_;  // of the directions' entries
  DerivativeReport report_;
};

}  // namespace

DerivativeReport check_derivatives(const Problem& problem, const Vector& u, const Vector& p,
                                   const Regime& regime) {
  return Checker(problem, u, p, regime).run();
}

}  // namespace arcslip::continuation
