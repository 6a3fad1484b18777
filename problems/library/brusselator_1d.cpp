#include "arcslip/problems/library/brusselator_1d.hpp"

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {
namespace {

/// D/(L h)^2 of x and y.
struct Exchange {
  Exchange(const Vector& p, Index points) {
    const double per_length = static_cast<double>(points + 1) / p(0);
    x = p(3) * per_length * per_length;
    y = p(4) * per_length * per_length;
  }
  double x;
  double y;
};

}  // namespace

bool BrusselatorLine::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                               const continuation::Evaluation& out) const {
  const double a = p(1);
  const double b = p(2);
  const Exchange exchange(p, points_);
  for (Index i = 0; i < points_; ++i) {
    const double x = u(2 * i);
    const double y = u(2 * i + 1);
    const bool is_first = i == 0;
    const bool is_last = i + 1 == points_;
    const double x_bend = (is_first ? a : u(2 * i - 2)) - 2 * x + (is_last ? a : u(2 * i + 2));
    const double y_bend = (is_first ? b / a : u(2 * i - 1)) - 2 * y + (is_last ? b / a : u(2 * i + 3));
    if (out.residual != nullptr) {
      (*out.residual)(2 * i) = exchange.x * x_bend + x * x * y - (b + 1) * x + a;
      (*out.residual)(2 * i + 1) = exchange.y * y_bend - x * x * y + b * x;
    }
    if (out.parameter_jacobian == nullptr) continue;
    const int at_ends = static_cast<int>(is_first) + static_cast<int>(is_last);
    out.parameter_jacobian->row(2 * i) << -2 * exchange.x * x_bend / p(0), 1 + at_ends * exchange.x, -x,
        exchange.x * x_bend / p(3), 0;
    out.parameter_jacobian->row(2 * i + 1) << -2 * exchange.y * y_bend / p(0),
        -at_ends * exchange.y * b / (a * a), x + at_ends * exchange.y / a, 0, exchange.y * y_bend / p(4);
  }
  if (out.sparse_jacobian != nullptr) fill(u, p, *out.sparse_jacobian);
  return true;
}

void BrusselatorLine::fill(const Vector& u, const Vector& p, SparseMatrix& jacobian) const {
  const Exchange exchange(p, points_);
  jacobian.resize(size(), size());
  jacobian.reserve(4 * size());
  for (Index i = 0; i < points_; ++i) {
    const double x = u(2 * i);
    const double y = u(2 * i + 1);
    for (const bool of_x : {true, false}) {
      const Index column = 2 * i + (of_x ? 0 : 1);
      const double neighbour = of_x ? exchange.x : exchange.y;
      jacobian.startVec(column);
      if (i > 0) jacobian.insertBack(column - 2, column) = neighbour;
      jacobian.insertBack(2 * i, column) = of_x ? -2 * exchange.x + 2 * x * y - p(2) - 1 : x * x;
      jacobian.insertBack(2 * i + 1, column) = of_x ? p(2) - 2 * x * y : -2 * exchange.y - x * x;
      if (i + 1 < points_) jacobian.insertBack(column + 2, column) = neighbour;
    }
  }
  jacobian.finalize();
}

void BrusselatorLine::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              Vector& values) const {
  continuation::Gradient unused{Vector(size()), Vector(p.size())};
  values.setConstant(1, observe(u, p, regime, 0, unused));
}

double BrusselatorLine::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                                Index /*which*/, continuation::Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  double value = 0;
  for (const Index i : {(points_ - 1) / 2, points_ / 2}) {
    gradient.unknowns(2 * i) += 0.5;
    value += 0.5 * u(2 * i);
  }
  return value;
}

LibraryModel brusselator_1d_model() {
  const auto rest = [](const continuation::Problem& problem, const Vector& p) -> Vector {
    return Vector{{p(1), p(2) / p(1)}}.replicate(problem.size() / 2, 1);
  };
  const auto build = [](const LibraryModel::Values& values) -> std::unique_ptr<continuation::Problem> {
    return std::make_unique<BrusselatorLine>(static_cast<Index>(values[5]));
  };
  return {"brusselator_1d",
          "Brusselator on a line",
          {positive("L", 0.3, "length"),
           positive("A", 2, "feed"),
           positive("B", 5.45, "second feed"),
           positive("D_x", 0.008, "diffusion of x"),
           positive("D_y", 0.004, "diffusion of y"),
           {"intervals", 128, 2, 1e6, true, "how many the line is divided into"}},
          build,
          guess_at(rest)};
}

}  // namespace arcslip::problems
