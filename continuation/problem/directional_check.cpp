#include "arcslip/continuation/problem/directional_check.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "arcslip/continuation/problem/evaluation.hpp"
#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {
namespace {

constexpr double quick_step =
    1e-6;  // of the problem's scale; rounding is 1e-10, curvature 1e-12 of the terms
constexpr double suspicious = 1e-6;
constexpr double wrong = 1e-5;
constexpr std::array<double, 5> steps = {1e-5, 1e-6, 1e-7, 1e-8, 1e-9};  // down to where rounding is 1e-7
// Of a value, along the scale: what the widest step changes it by is its rounding.
constexpr double unseen = std::numeric_limits<double>::epsilon() / steps.front();

/// A direction of (u, p).
struct Direction {
  Vector u;
  Vector p;
};

/// A function of (u, p), scalar or vector, and what is said to be its derivative.
struct Function {
  std::string name;
  std::string subject;  ///< "the Jacobian differs from differences of the residual"
  std::function<bool(const Vector& u, const Vector& p, Vector& values)> value;
  std::function<void(const Direction& direction, Vector& product)> derivative;
  std::function<void(const Direction& direction, Vector& sizes)>
      sizes;  ///< of the derivative's terms, summed
};

class Comparison {
 public:
  Comparison(const Problem& problem, const Vector& u, const Vector& p, const Regime& regime,
             const std::vector<Index>& parameters)
      : problem_(problem), u_(u), p_(p), regime_(regime) {
    Vector unknown_scale(u.size());
    Vector parameter_scale(p.size());
    problem.scale(u, p, unknown_scale, parameter_scale);
    // Random, lest errors cancel; none small, lest one be missed.
    std::mt19937 random(1);
    const auto component = [&] {
      const double size = 0.5 + 0.5 * static_cast<double>(random() % 1024) / 1024;
      return random() % 2 == 0 ? size : -size;
    };
    all_ = {Vector(u.size()), Vector::Zero(p.size())};
    for (Index j = 0; j < u.size(); ++j) all_.u(j) = component() * unknown_scale(j);
    for (const Index k : parameters) all_.p(k) = component() * parameter_scale(k);
  }

  /// What is wrong with a function's derivative, or nothing.
  std::optional<std::string> run(const Function& f) const {
    const std::optional<Index> row = row_that_differs(f);
    if (!row || !differs(f, all_, *row) || leaves_regime()) return std::nullopt;
    return describe(f, *row);
  }

 private:
  bool displaced(const Function& f, const Direction& direction, double h, Vector& values) const {
    return f.value(u_ + h * direction.u, p_ + h * direction.p, values) && values.allFinite();
  }

  /// The row in which the derivative is most unlike one difference, if that is suspicious.
  std::optional<Index> row_that_differs(const Function& f) const {
    Vector forward, backward, product, sizes;
    if (!displaced(f, all_, quick_step, forward) || !displaced(f, all_, -quick_step, backward))
      return std::nullopt;
    f.derivative(all_, product);
    f.sizes(all_, sizes);
    const Vector difference = (forward - backward) / (2 * quick_step);
    Index row = 0;
    const double largest =
        ((product - difference).array().abs() / sizes.array().max(difference.array().abs()).max(1e-300))
            .maxCoeff(&row);
    return largest > suspicious ? std::optional(row) : std::nullopt;
  }

  /// The difference of one row along a direction, if it is the same with every step, to a tenth of how far it
  /// is from the exact derivative, and to both sides.
  std::optional<double> difference(const Function& f, const Direction& direction, Index row,
                                   double exact) const {
    Vector forward, backward, here;
    if (!displaced(f, direction, 0, here)) return std::nullopt;
    std::optional<double> first;
    for (const double h : steps) {
      if (!displaced(f, direction, h, forward) || !displaced(f, direction, -h, backward)) return std::nullopt;
      const double right = (forward(row) - here(row)) / h;
      const double left = (here(row) - backward(row)) / h;
      const double central = 0.5 * (left + right);
      if (!first) first = central;
      const double apart = std::max(std::abs(right - left), std::abs(central - *first));
      if (!(apart <= 0.1 * std::abs(exact - *first)) || !(apart <= 0.01 * std::abs(*first)))
        return std::nullopt;
    }
    return agrees_afar(f, direction, row, *first, exact) ? first : std::nullopt;
  }

  /// Large terms that cancel leave a staircase of rounding, on which all small steps find 0.
  bool agrees_afar(const Function& f, const Direction& direction, Index row, double found,
                   double exact) const {
    constexpr double far = 0.1;
    if (std::abs(found) > 0.01 * std::abs(exact)) return true;
    Vector forward, backward;
    if (!displaced(f, direction, far, forward) || !displaced(f, direction, -far, backward)) return false;
    return std::abs((forward(row) - backward(row)) / (2 * far) - found) <= 0.1 * std::abs(exact - found);
  }

  bool differs(const Function& f, const Direction& direction, Index row) const {
    Vector product, sizes, here;
    f.derivative(direction, product);
    f.sizes(direction, sizes);
    const auto found = difference(f, direction, row, product(row));
    if (!found || !displaced(f, direction, 0, here)) return false;
    const double error = std::abs(product(row) - *found);
    return error > wrong * std::max(sizes(row), std::abs(*found)) && error > unseen * std::abs(here(row));
  }

  bool leaves_regime() const {
    for (const double h : {steps.front(), -steps.front()}) {
      for (int border = 0; border < problem_.border_count(regime_); ++border) {
        if (!(problem_.border(u_ + h * all_.u, p_ + h * all_.p, regime_, border, nullptr) < 0)) return true;
      }
    }
    return false;
  }

  /// How far the derivative of a row along some of the direction's entries is from the difference.
  double error_along(const Function& f, const Direction& direction, Index row) const {
    Vector product, forward, backward;
    f.derivative(direction, product);
    if (!displaced(f, direction, quick_step, forward) || !displaced(f, direction, -quick_step, backward))
      return 0;
    return std::abs(product(row) - (forward(row) - backward(row)) / (2 * quick_step));
  }

  /// The entries from `begin` up to `end` of the direction; those behind the unknowns are parameters.
  Direction part(Index begin, Index end) const {
    Direction result{Vector::Zero(u_.size()), Vector::Zero(p_.size())};
    for (Index j = begin; j < end; ++j) {
      if (j < u_.size()) {
        result.u(j) = all_.u(j);
      } else {
        result.p(j - u_.size()) = all_.p(j - u_.size());
      }
    }
    return result;
  }

  /// Halves the direction until one entry is left, each time for the half with the larger error.
  std::string describe(const Function& f, Index row) const {
    Index begin = 0;
    Index end = u_.size() + p_.size();
    while (end - begin > 1) {
      const Index middle = (begin + end) / 2;
      const bool lower = error_along(f, part(begin, middle), row) >= error_along(f, part(middle, end), row);
      (lower ? end : begin) = middle;
    }
    const Direction single = part(begin, end);
    Vector product;
    f.derivative(single, product);
    const std::string function = f.name == "F" ? fmt::format("F{}", row) : " " + f.name;
    const auto found = difference(f, single, row, product(row));
    if (!found) return fmt::format("{} in a derivative of{}", f.subject, function);
    const bool unknown = begin < u_.size();
    const double moved = unknown ? single.u(begin) : single.p(begin - u_.size());
    const std::string by = unknown ? fmt::format("u{}", begin)
                                   : problem_.parameter_names()[static_cast<std::size_t>(begin - u_.size())];
    const double exact = product(row) / moved;
    const double relative = std::abs(product(row) / *found - 1);
    return fmt::format("{}{} in d{}/d{}, where it is {:.6g} and they are {:.6g}", f.subject,
                       std::isfinite(relative) ? fmt::format(" by {:.2g} %", 100 * relative) : "", function,
                       by, exact, *found / moved);
  }

  const Problem& problem_;
  const Vector& u_;
  const Vector& p_;
  Regime regime_;
  Direction all_;
};

Function residual_of(const Problem& problem, const Linearization& at, const Regime& regime) {
  Function f{"F", "the Jacobian differs from differences of the residual", {}, {}, {}};
  f.value = [&problem, regime](const Vector& u, const Vector& p, Vector& values) {
    values.resize(u.size());
    return evaluate(problem, u, p, regime, {&values});
  };
  f.derivative = [&at](const Direction& direction, Vector& product) {
    product.resize(direction.u.size());
    at.multiply(direction.u, product);
    product += at.parameter_jacobian() * direction.p;
  };
  f.sizes = [&at](const Direction& direction, Vector& sizes) {
    sizes.resize(direction.u.size());
    at.multiply_absolute(direction.u, sizes);
    sizes += at.parameter_jacobian().cwiseAbs() * direction.p.cwiseAbs();
  };
  return f;
}

/// A scalar function from one that gives its value and its gradient.
template <class Scalar>
Function scalar_of(const std::string& name, const Gradient& gradient, Gradient& unused, Scalar scalar) {
  Function f{name, fmt::format("the gradient of {} differs from differences", name), {}, {}, {}};
  f.value = [&unused, scalar](const Vector& u, const Vector& p, Vector& values) {
    values = Vector::Constant(1, scalar(u, p, unused));
    return true;
  };
  f.derivative = [&gradient](const Direction& direction, Vector& product) {
    product = Vector::Constant(1, gradient.unknowns.dot(direction.u) + gradient.parameters.dot(direction.p));
  };
  f.sizes = [&gradient](const Direction& direction, Vector& sizes) {
    sizes = Vector::Constant(1, gradient.unknowns.cwiseAbs().dot(direction.u.cwiseAbs()) +
                                    gradient.parameters.cwiseAbs().dot(direction.p.cwiseAbs()));
  };
  return f;
}

}  // namespace

std::optional<std::string> find_wrong_derivative(const Problem& problem, const Vector& u, const Vector& p,
                                                 const Regime& regime, const std::vector<Index>& parameters,
                                                 const std::vector<Index>& observables) {
  Linearization at(problem);
  if (!at.evaluate(u, p, regime)) return std::nullopt;
  const Comparison comparison(problem, u, p, regime, parameters);
  if (auto found = comparison.run(residual_of(problem, at, regime))) return found;
  Gradient gradient{Vector(u.size()), Vector(p.size())};
  Gradient unused = gradient;
  const auto compare = [&](const std::string& name, const auto& scalar) {
    scalar(u, p, gradient);
    return comparison.run(scalar_of(name, gradient, unused, scalar));
  };
  const std::vector<Observable> all = problem.observables();
  for (const Index which : observables) {
    const Observable& observable = all[static_cast<std::size_t>(which)];
    const double here = problem.observe(u, p, regime, which, unused);
    auto found = compare(observable.name, [&](const Vector& at_u, const Vector& at_p, Gradient& g) {
      return observable.near(problem.observe(at_u, at_p, regime, which, g), here);
    });
    if (found) return found;
  }
  for (int border = 0; border < problem.border_count(regime); ++border) {
    auto found =
        compare(fmt::format("border {}", border), [&](const Vector& at_u, const Vector& at_p, Gradient& g) {
          return problem.border(at_u, at_p, regime, border, &g);
        });
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace arcslip::continuation
