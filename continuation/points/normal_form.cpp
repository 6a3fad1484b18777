#include "arcslip/continuation/points/normal_form.hpp"

#include <cmath>
#include <limits>

namespace arcslip::continuation {
namespace {

BasePoint base_point(const Guess& guess, Index extras) {
  return {guess.unknowns, guess.parameters, guess.regime, Vector::Zero(extras)};
}

/// The directions in which a quadratic form vanishes, as coefficients of the basis; none if it is definite.
std::vector<Eigen::Vector2d> null_directions(const Eigen::Matrix2d& form, bool& degenerate) {
  const double size = form.cwiseAbs().maxCoeff();
  const double discriminant = form(0, 1) * form(0, 1) - form(0, 0) * form(1, 1);
  constexpr double rounding = 1e-12;  // of products of second derivatives by differences
  degenerate = !(std::abs(discriminant) > rounding * size * size);
  if (degenerate || discriminant < 0) return {};
  const double root = std::sqrt(discriminant);
  // a x^2 + 2 b x y + c y^2 = 0 without cancellation: x : y = -q : a and c : -q, q = b + sign(b) root
  const double q = form(0, 1) + std::copysign(root, form(0, 1));
  return {Eigen::Vector2d(-q, form(0, 0)).normalized(), Eigen::Vector2d(form(1, 1), -q).normalized()};
}

/// The pitchfork's coefficient: on the turning branch u = u* + x v + x^2/2 h and
///   psi^T (F_uuu v v v + 3 F_uu v h)/6 x^2 + psi^T F_zz v d (p_a - p_a*)/d_p = 0,   F_u h = -F_uu v v.
class CubicTerm {
 public:
  CubicTerm(const Problem& problem, Index parameter, const BranchPointProblem& at, const BasePoint& point)
      : problem_(problem),
        parameter_(parameter),
        point_(point),
        psi_(at.left_null()),
        scale_(at.null_scale()),
        at_(problem),
        second_(problem) {}

  /// v, n, of unit length, and the other branch's direction d, n + 1.
  double coefficient(const Vector& v, const Vector& d) {
    const Index n = v.size();
    const Vector none = Vector::Zero(point_.parameters.size());
    step_ = 0.02 / second_.length(point_.unknowns, point_.parameters, v, none);
    const Vector h = response(v);
    Vector third;
    const auto second_at = [&](double x, Vector& out) {
      Vector row;
      if (!second_.contract(point_.unknowns + x * v, point_.parameters, point_.regime, psi_, v, none, row))
        return false;
      out = Vector::Constant(1, row.head(n).dot(v));
      return true;
    };
    Vector row;
    if (h.size() == 0 || !std::isfinite(differentiate(second_at, step_, third).error) ||
        !second_.contract(point_.unknowns, point_.parameters, point_.regime, psi_, v, none, row)) {
      return std::nan("");
    }
    const double cubic = (third(0) + 3 * row.head(n).dot(h)) / 6;
    const double mixed = row.head(n).dot(d.head(n)) / d(n) + row(n + parameter_);
    return -cubic / mixed;
  }

  long evaluations() const { return at_.evaluations() + second_.evaluations(); }

 private:
  /// h with F_u h = -F_uu v v in the complement of v.
  Vector response(const Vector& v) {
    const Index n = v.size();
    Vector bend;
    const auto product = [&](double x, Vector& out) {
      out.resize(n);
      if (!at_.evaluate(point_.unknowns + x * v, point_.parameters, point_.regime)) return false;
      at_.multiply(v, out);
      return true;
    };
    if (!std::isfinite(differentiate(product, step_, bend).error)) return {};
    if (!at_.evaluate(point_.unknowns, point_.parameters, point_.regime)) return {};
    const auto solver = at_.make_solver(1);
    at_.fill(*solver, scale_.head(n));
    solver->columns().col(0) = psi_;
    solver->rows().row(0) = v.cwiseQuotient(scale_.head(n)).transpose();
    solver->corner().setZero();
    if (solver->factor() == 0) return {};
    Vector h(n + 1);
    h << -bend, 0;
    solver->solve(h);
    return scale_.head(n).cwiseProduct(h.head(n));
  }

  const Problem& problem_;
  Index parameter_;
  const BasePoint& point_;
  Vector psi_;
  Vector scale_;
  Linearization at_;
  SecondDerivative second_;
  double step_ = 0.02;
};

}  // namespace

std::optional<LocatedPoint> locate(ExtendedProblem& problem, const BasePoint& guess, double tolerance) {
  LocatedPoint located{guess, 0, 0};
  for (int round = 0; round < 2; ++round) {  // the second with the borders that belong to the point
    if (!problem.adapt(located.point)) return std::nullopt;
    Guess extended;
    problem.join(located.point, extended.unknowns, extended.parameters);
    extended.regime = guess.regime;
    const Solution solution = solve(problem, extended, {tolerance, 20, 1});
    if (solution.outcome != Correction::converged) return std::nullopt;
    located.point = problem.split(solution.unknowns, extended.parameters, guess.regime);
    located.residual = solution.residual;
    located.iterations += solution.iterations;
  }
  return located;
}

std::optional<FoldForm> fold_form(const Problem& problem, Index parameter, const Guess& fold) {
  FoldProblem extended(problem, parameter);
  const BasePoint point = base_point(fold, 0);
  if (!extended.settle(point)) return std::nullopt;
  FoldForm form{extended.right_null(), extended.left_null(), extended.quadratic(point)};
  Vector scale(problem.size());
  Vector parameter_scale(fold.parameters.size());
  problem.scale(fold.unknowns, fold.parameters, scale, parameter_scale);
  form.right /= form.right.cwiseQuotient(scale).norm();
  return form;
}

std::string_view to_string(BranchPointKind kind) {
  switch (kind) {
    case BranchPointKind::transcritical: return "transcritical";
    case BranchPointKind::pitchfork: return "pitchfork";
    case BranchPointKind::hilltop: return "hilltop";
    case BranchPointKind::isolated: return "isolated";
    case BranchPointKind::degenerate: return "degenerate";
  }
  return "";
}

std::optional<BranchPointForm> branch_point_form(const Problem& problem, Index parameter,
                                                 const Guess& branch_point, const Tolerances& tolerances) {
  BranchPointProblem extended(problem, parameter);
  const BasePoint point = base_point(branch_point, 1);
  if (!extended.settle(point)) return std::nullopt;
  const Index n = problem.size();
  const Matrix basis = extended.null_space();
  const Vector scale = extended.null_scale();
  SecondDerivative second(problem);
  Eigen::Matrix2d form;
  for (Index i = 0; i < 2; ++i) {
    Vector row;
    Vector dp = Vector::Zero(point.parameters.size());
    dp(parameter) = basis(n, i);
    if (!second.contract(point.unknowns, point.parameters, point.regime, extended.left_null(),
                         basis.col(i).head(n), dp, row)) {
      return std::nullopt;
    }
    for (Index j = 0; j < 2; ++j)
      form(i, j) = row.head(n).dot(basis.col(j).head(n)) + row(n + parameter) * basis(n, j);
  }
  form = 0.5 * (form + form.transpose().eval());

  BranchPointForm result;
  result.cubic = std::nan("");
  result.evaluations = extended.evaluations() + second.evaluations();
  bool degenerate = false;
  const std::vector<Eigen::Vector2d> roots = null_directions(form, degenerate);
  if (roots.empty()) {
    result.kind = degenerate ? BranchPointKind::degenerate : BranchPointKind::isolated;
    return result;
  }
  std::array<double, 2> rates{};  // of the parameter, in its scale
  for (std::size_t i = 0; i < 2; ++i) {
    Vector& d = result.directions[i];
    d = basis * roots[i];
    d /= d.cwiseQuotient(scale).norm();
    rates[i] = std::abs(d(n)) / scale(n);
    result.slopes[i] = d(n) / d.head(n).cwiseQuotient(scale.head(n)).norm();
  }
  if (rates[0] < rates[1]) {
    std::swap(result.directions[0], result.directions[1]);
    std::swap(result.slopes[0], result.slopes[1]);
    std::swap(rates[0], rates[1]);
  }
  result.kind = rates[0] < tolerances.turns   ? BranchPointKind::hilltop
                : rates[1] < tolerances.turns ? BranchPointKind::pitchfork
                                              : BranchPointKind::transcritical;
  if (result.kind == BranchPointKind::pitchfork) {
    result.slopes[1] = 0;
    Vector& turning = result.directions[1];
    turning -= turning(n) / result.directions[0](n) * result.directions[0];
    const Vector v = turning.head(n) / turning.head(n).cwiseQuotient(scale.head(n)).norm();
    CubicTerm cubic(problem, parameter, extended, point);
    result.cubic = cubic.coefficient(v, result.directions[0]);
    result.evaluations += cubic.evaluations();
  }
  return result;
}

PointType turn_of_folds(const Problem& problem, Index parameter, const Guess& fold) {
  const auto form = branch_point_form(problem, parameter, fold);
  if (!form) return PointType::fold;
  return form->kind == BranchPointKind::isolated        ? PointType::isola_centre
         : form->kind == BranchPointKind::transcritical ? PointType::simple_bifurcation
                                                        : PointType::fold;
}

}  // namespace arcslip::continuation
