#include "arcslip/continuation/cycles/torus.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {
namespace {

/// The derivative by an angle of what is periodic in it.
Matrix periodic_derivative(const CollocationRule& rule) {
  Matrix result = rule.derivatives().leftCols(rule.degree());
  result.col(0) += rule.derivatives().col(rule.degree());
  return result / two_pi;
}

}  // namespace

/// du/dtheta_1 and du/dtheta_2 on the grid.
struct Torus::Slopes {
  Matrix first;
  Matrix second;
};

Torus::Torus(std::shared_ptr<const Field> field, TorusGrid grid, double omega_1, const Vector& p)
    : field_(std::move(field)),
      grid_(std::move(grid)),
      first_(CollocationRule::trigonometric(grid_.waves_1)),
      second_(CollocationRule::trigonometric(grid_.waves_2)),
      by_first_(periodic_derivative(first_)),
      by_second_(periodic_derivative(second_)),
      scale_(field_->size()),
      rate_(std::abs(omega_1)) {
  Vector unused(p.size());
  field_->scale(grid_.values.cwiseAbs().rowwise().maxCoeff(), p, scale_, unused);
  const Vector weights = scale_.cwiseAbs2().cwiseInverse();
  const auto normed = [&](const Matrix& change) {
    const Matrix weighted = weights.asDiagonal() * change;
    return Vector(weighted.reshaped() / weighted.cwiseProduct(change).sum());
  };
  const Slopes along = slopes(grid_.values);
  phases_.resize(grid_.values.size(), 2);
  phases_ << normed(along.first), normed(along.second);
  Matrix part = grid_.values;
  const auto rows = part.reshaped(field_->size() * count(0), count(1));
  const Vector mean = rows.rowwise().mean();
  part.reshaped(field_->size() * count(0), count(1)).colwise() -= mean;
  apart_ = normed(part);
}

double Torus::duration(const Vector& p, Vector* by_parameters) const {
  const double period = field_->period(p, by_parameters);
  if (by_parameters != nullptr) *by_parameters *= grid_.periods;
  return grid_.periods * period;
}

double Torus::omega_1(const Vector& u, const Vector& p, Vector* by_parameters) const {
  if (has_first_rate()) {
    if (by_parameters != nullptr) by_parameters->setZero(p.size());
    return u(u.size() - 2);
  }
  const double length = duration(p, by_parameters);
  if (by_parameters != nullptr) *by_parameters *= -two_pi / (length * length);
  return two_pi / length;
}

Torus::Slopes Torus::slopes(const Matrix& values) const {
  const Index n = values.rows();
  Slopes result{Matrix(n, values.cols()), Matrix(n, values.cols())};
  const Vector growth = first_.derivatives().col(count(0)) / two_pi;
  for (Index j = 0; j < count(1); ++j) {
    auto slice = result.first.middleCols(j * count(0), count(0));
    slice.noalias() = values.middleCols(j * count(0), count(0)) * by_first_.transpose();
    slice += grid_.winding * growth.transpose();
  }
  result.second.reshaped(n * count(0), count(1)) =
      values.reshaped(n * count(0), count(1)) * by_second_.transpose();
  return result;
}

void Torus::fill_slopes(double first, double second, Matrix& jacobian) const {
  const Index n = field_->size();
  const Vector in_units = (scale_ * rate_).cwiseInverse();
  for (Index j = 0; j < count(1); ++j) {
    for (Index i = 0; i < count(0); ++i) {
      const Index row = (j * count(0) + i) * n;
      for (Index k = 0; k < count(0); ++k)
        jacobian.block(row, (j * count(0) + k) * n, n, n).diagonal() += first * by_first_(i, k) * in_units;
      for (Index k = 0; k < count(1); ++k)
        jacobian.block(row, (k * count(0) + i) * n, n, n).diagonal() += second * by_second_(j, k) * in_units;
    }
  }
}

void Torus::fill_conditions(const Vector& u, const Evaluation& out) const {
  const Index unknowns = phases_.rows();
  const Index conditions = size() - unknowns;
  const auto weights = phases_.rightCols(conditions).transpose();
  if (out.residual != nullptr)
    out.residual->tail(conditions) = weights * (u.head(unknowns) - grid_.values.reshaped());
  if (out.jacobian != nullptr) out.jacobian->bottomLeftCorner(conditions, unknowns) = weights;
}

bool Torus::evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                     const Evaluation& out) const {
  const Index n = field_->size();
  const bool derivatives = out.jacobian != nullptr || out.parameter_jacobian != nullptr;
  Vector rate_by_parameters;
  const double rate = omega_1(u, p, &rate_by_parameters);
  Vector duration_by_parameters;
  const double length = has_first_rate() ? 0 : duration(p, &duration_by_parameters);
  const Slopes along = slopes(values(u));
  const Vector in_units = (scale_ * rate_).cwiseInverse();
  Vector place(n);
  Vector velocity(n);
  Vector by_time(n);
  Matrix by_unknowns(n, n);
  Matrix by_parameters(n, p.size());
  FieldValues wanted{&velocity};
  if (derivatives) wanted = {&velocity, &by_unknowns, &by_parameters, has_first_rate() ? nullptr : &by_time};
  if (out.jacobian != nullptr) out.jacobian->setZero();
  if (out.parameter_jacobian != nullptr) out.parameter_jacobian->setZero();
  for (Index at = 0; at < along.first.cols(); ++at) {
    const double s = first_.points()(at % count(0));
    place = values(u).col(at);
    if (!field_->evaluate(s * length, place, p, wanted)) return false;
    if (out.residual != nullptr)
      out.residual->segment(at * n, n) =
          in_units.cwiseProduct(rate * along.first.col(at) + omega_2(u) * along.second.col(at) - velocity);
    if (out.jacobian != nullptr) {
      out.jacobian->block(at * n, at * n, n, n) = in_units.asDiagonal() * -by_unknowns;
      out.jacobian->col(size() - 1).segment(at * n, n) = in_units.cwiseProduct(along.second.col(at));
      if (has_first_rate())
        out.jacobian->col(size() - 2).segment(at * n, n) = in_units.cwiseProduct(along.first.col(at));
    }
    if (out.parameter_jacobian == nullptr) continue;
    if (!has_first_rate()) {
      by_parameters.noalias() += s * by_time * duration_by_parameters.transpose();
      by_parameters.noalias() -= along.first.col(at) * rate_by_parameters.transpose();
    }
    out.parameter_jacobian->middleRows(at * n, n) = in_units.asDiagonal() * -by_parameters;
  }
  if (out.jacobian != nullptr) fill_slopes(rate, omega_2(u), *out.jacobian);
  fill_conditions(u, out);
  return true;
}

void Torus::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  Vector sizes(field_->size());
  field_->scale(values(u).cwiseAbs().rowwise().maxCoeff(), p, sizes, parameters);
  unknowns.head(phases_.rows()) = sizes.replicate(count(0) * count(1), 1);
  unknowns.tail(size() - phases_.rows()).setConstant(std::abs(omega_1(u, p)));
}

double Torus::tail(const Vector& u, int angle) const {
  const Vector range = ranges(values(u), scale_);
  const OrbitMesh mesh(rule(angle), 1);
  const Index m = count(angle);
  Matrix slice(field_->size(), m + 1);
  double largest = 0;
  for (Index other = 0; other < count(1 - angle); ++other) {
    for (Index k = 0; k < m; ++k)
      slice.col(k) = values(u).col(angle == 0 ? other * m + k : k * count(0) + other);
    slice.col(m) = slice.col(0);
    if (angle == 0) slice.col(m) += grid_.winding;
    largest = std::max(largest, mesh.errors(slice, range)(0));
  }
  return largest;
}

double Torus::phase_grip(const Vector& u) const {
  const Slopes along = slopes(values(u));
  const Vector weights = scale_.cwiseAbs2().cwiseInverse();
  double least = 1;
  for (const int angle : {0, 1}) {
    if (angle == 0 && !has_first_rate()) continue;
    const Matrix& change = angle == 0 ? along.first : along.second;
    const Vector own = (weights.asDiagonal() * change).reshaped();
    least = std::min(least, own.dot(phases_.col(angle)) / (own.norm() * phases_.col(angle).norm()));
  }
  return least;
}

}  // namespace arcslip::continuation
