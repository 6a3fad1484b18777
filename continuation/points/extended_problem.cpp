#include "arcslip/continuation/points/extended_problem.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/problem/directional_check.hpp"

namespace arcslip::continuation {

ExtendedProblem::ExtendedProblem(const Problem& base, Index active, Index conditions)
    : at_(base, true), base_(base), active_(active), conditions_(conditions), values_(conditions) {
  const Index parameters = static_cast<Index>(base.parameter_names().size());
  gradients_.setZero(conditions, base.size() + parameters + conditions - 1);
  scale_.setOnes(base.size());
  of_base_ = {Vector::Zero(base.size()), Vector::Zero(parameters)};
}

BasePoint ExtendedProblem::split(const Vector& unknowns, const Vector& parameters,
                                 const Regime& regime) const {
  const Index n = base_.size();
  BasePoint point{unknowns.head(n), Vector(parameters.size() + 1), regime, unknowns.tail(conditions_ - 1)};
  point.parameters.head(active_) = parameters.head(active_);
  point.parameters(active_) = unknowns(n);
  point.parameters.tail(parameters.size() - active_) = parameters.tail(parameters.size() - active_);
  return point;
}

void ExtendedProblem::join(const BasePoint& point, Vector& unknowns, Vector& parameters) const {
  const Index n = base_.size();
  const Index rest = point.parameters.size() - 1;
  unknowns.resize(size());
  parameters.resize(rest);
  unknowns.head(n) = point.unknowns;
  unknowns(n) = point.parameters(active_);
  unknowns.tail(conditions_ - 1) = point.extras;
  parameters.head(active_) = point.parameters.head(active_);
  parameters.tail(rest - active_) = point.parameters.tail(rest - active_);
}

bool ExtendedProblem::adapt(const BasePoint& point) {
  ++revision_;
  Vector parameter_scale(point.parameters.size());
  base_.scale(point.unknowns, point.parameters, scale_, parameter_scale);
  Vector at_zero = point.parameters;
  at_zero(active_) = 0;
  Vector unused(base_.size());
  base_.scale(point.unknowns, at_zero, unused, parameter_scale);
  active_observable_scale_ = parameter_scale(active_);
  return at_.evaluate(point.unknowns, point.parameters, point.regime);
}

void ExtendedProblem::each_border(const std::function<void(double*, Index)>& use) {
  use(scale_.data(), scale_.size());
  use(unfolding_.data(), unfolding_.size());
  use(&active_observable_scale_, 1);
}

std::vector<double> ExtendedProblem::borders() {
  std::vector<double> all;
  each_border([&](const double* numbers, Index count) { all.insert(all.end(), numbers, numbers + count); });
  return all;
}

void ExtendedProblem::set_borders(const std::vector<double>& numbers) {
  if (numbers.size() != borders().size())
    throw std::invalid_argument("resume: the checkpoint is one of a curve of other points");
  auto next = numbers.begin();
  each_border([&](double* target, Index count) {
    std::copy_n(next, count, target);
    next += count;
  });
}

bool ExtendedProblem::settle(const BasePoint& point) {
  Vector u;
  Vector p;
  join(point, u, p);
  Vector residual(size());
  Evaluation out;
  out.residual = &residual;
  return adapt(point) && evaluate(u, p, point.regime, out);
}

bool ExtendedProblem::follow(const BasePoint& point) {
  constexpr double worst_strain = 1.5;
  constexpr double most = 4;  // by which the conditions' slopes and the base's scale may have changed
  Vector unknown_scale(base_.size());
  Vector parameter_scale(point.parameters.size());
  base_.scale(point.unknowns, point.parameters, unknown_scale, parameter_scale);
  const auto growth = unknown_scale.array() / scale_.array();
  const double slope = last_steepness(point);
  const bool fits =
      strain() <= worst_strain && slope <= most && growth.maxCoeff() <= most && growth.minCoeff() >= 1 / most;
  return fits || adapt(point);
}

double ExtendedProblem::steepness(const BasePoint& point) {
  return conditions(point, values_, &gradients_) ? last_steepness(point) : 1;
}

double ExtendedProblem::last_steepness(const BasePoint& point) const {
  const Index n = base_.size();
  Vector unknown_scale(n);
  Vector parameter_scale(point.parameters.size());
  base_.scale(point.unknowns, point.parameters, unknown_scale, parameter_scale);
  double steepest = 1;
  for (const auto& row : gradients_.rowwise()) {
    const double by_unknowns = row.head(n).transpose().cwiseProduct(unknown_scale).norm();
    steepest = std::max(steepest, std::hypot(by_unknowns, row(n + active_) * parameter_scale(active_)));
  }
  return std::isfinite(steepest) ? steepest : 1;
}

std::vector<std::string> ExtendedProblem::parameter_names() const {
  std::vector<std::string> names = base_.parameter_names();
  names.erase(names.begin() + active_);
  return names;
}

bool ExtendedProblem::evaluate(const Vector& u, const Vector& p, const Regime& regime,
                               const Evaluation& out) const {
  const BasePoint point = split(u, p, regime);
  const bool derivatives =
      out.jacobian != nullptr || out.sparse_jacobian != nullptr || out.parameter_jacobian != nullptr;
  if (!at_.evaluate(point.unknowns, point.parameters, regime)) return false;
  if (out.residual != nullptr) {  // before the conditions, which may evaluate elsewhere
    out.residual->head(base_.size()) = at_.residual();
    if (unfolding_.size() > 0) out.residual->head(base_.size()) += point.extras(0) * unfolding_;
  }
  if (!conditions(point, values_, derivatives ? &gradients_ : nullptr)) return false;
  if (out.residual != nullptr) out.residual->tail(conditions_) = values_;
  if (out.jacobian != nullptr) fill_dense(gradients_, *out.jacobian);
  if (out.sparse_jacobian != nullptr) fill_sparse(gradients_, *out.sparse_jacobian);
  if (out.parameter_jacobian != nullptr) fill_parameters(gradients_, *out.parameter_jacobian);
  return true;
}

void ExtendedProblem::fill_dense(const Matrix& gradients, Matrix& out) const {
  const Index n = base_.size();
  const Index m = conditions_;
  const Index extras = m - 1;
  out.topLeftCorner(n, n) = at_.jacobian();
  out.col(n).head(n) = at_.parameter_jacobian().col(active_);
  out.topRightCorner(n, extras).setZero();
  if (unfolding_.size() > 0) out.col(n + 1).head(n) = unfolding_;
  out.bottomLeftCorner(m, n) = gradients.leftCols(n);
  out.col(n).tail(m) = gradients.col(n + active_);
  out.bottomRightCorner(m, extras) = gradients.rightCols(extras);
}

void ExtendedProblem::fill_sparse(const Matrix& gradients, SparseMatrix& out) const {
  const Index n = base_.size();
  const Index m = conditions_;
  const SparseMatrix& jacobian = at_.sparse_jacobian();
  out.resize(n + m, n + m);
  out.reserve(jacobian.nonZeros() + n * m + m * (n + m));
  for (Index c = 0; c < n; ++c) {
    out.startVec(c);
    for (SparseMatrix::InnerIterator entry(jacobian, c); entry; ++entry)
      out.insertBack(entry.row(), c) = entry.value();
    for (Index k = 0; k < m; ++k) out.insertBack(n + k, c) = gradients(k, c);
  }
  for (Index c = n; c < n + m; ++c) {
    out.startVec(c);
    const bool active = c == n;
    const bool unfolded = c == n + 1 && unfolding_.size() > 0;
    for (Index r = 0; (active || unfolded) && r < n; ++r)
      out.insertBack(r, c) = active ? at_.parameter_jacobian()(r, active_) : unfolding_(r);
    const Index source = active ? n + active_ : gradients.cols() - (n + m) + c;
    for (Index k = 0; k < m; ++k) out.insertBack(n + k, c) = gradients(k, source);
  }
  out.finalize();
}

void ExtendedProblem::fill_parameters(const Matrix& gradients, Matrix& out) const {
  const Index n = base_.size();
  for (Index k = 0; k < out.cols(); ++k) {
    const Index source = k < active_ ? k : k + 1;
    out.col(k).head(n) = at_.parameter_jacobian().col(source);
    out.col(k).tail(conditions_) = gradients.col(n + source);
  }
}

void ExtendedProblem::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  const BasePoint point = split(u, p, 0);
  const Index rest = p.size() - active_;
  Vector base_unknowns(base_.size());
  Vector base_parameters(point.parameters.size());
  base_.scale(point.unknowns, point.parameters, base_unknowns, base_parameters);
  unknowns.head(base_.size()) = base_unknowns;
  unknowns(base_.size()) = base_parameters(active_);
  unknowns.tail(conditions_ - 1) = point.extras.cwiseAbs().cwiseMax(1);
  parameters.head(active_) = base_parameters.head(active_);
  parameters.tail(rest) = base_parameters.tail(rest);
}

double ExtendedProblem::border(const Vector& u, const Vector& p, const Regime& regime, int border,
                               Gradient* gradient) const {
  const BasePoint point = split(u, p, regime);
  if (gradient == nullptr) return base_.border(point.unknowns, point.parameters, regime, border, nullptr);
  const double value = base_.border(point.unknowns, point.parameters, regime, border, &of_base_);
  take_gradient(*gradient);
  return value;
}

void ExtendedProblem::take_gradient(Gradient& out) const {
  const Index rest = of_base_.parameters.size() - 1 - active_;
  out.unknowns.setZero();
  out.unknowns.head(base_.size()) = of_base_.unknowns;
  out.unknowns(base_.size()) = of_base_.parameters(active_);
  out.parameters.head(active_) = of_base_.parameters.head(active_);
  out.parameters.tail(rest) = of_base_.parameters.tail(rest);
}

std::optional<std::string> ExtendedProblem::wrong_derivative(const Vector& u, const Vector& p,
                                                             const Regime& regime, Index parameter,
                                                             const std::vector<Index>& /*tracked*/) const {
  const BasePoint at = split(u, p, regime);
  const Index second = parameter < active_ ? parameter : parameter + 1;
  return find_wrong_derivative(base_, at.unknowns, at.parameters, regime, {active_, second}, {});
}

std::vector<Observable> ExtendedProblem::observables() const {
  std::vector<Observable> result{
      {base_.parameter_names()[static_cast<std::size_t>(active_)], true, active_observable_scale_}};
  for (const Observable& observable : base_.observables()) result.push_back(observable);
  return result;
}

void ExtendedProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  const BasePoint point = split(u, p, regime);
  Vector of_base;
  base_.observe(point.unknowns, point.parameters, regime, of_base);
  values.resize(of_base.size() + 1);
  values(0) = point.parameters(active_);
  values.tail(of_base.size()) = of_base;
}

double ExtendedProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                                Gradient& gradient) const {
  if (which == 0) {
    gradient.unknowns.setUnit(base_.size());
    gradient.parameters.setZero();
    return u(base_.size());
  }
  const BasePoint point = split(u, p, regime);
  const double value = base_.observe(point.unknowns, point.parameters, regime, which - 1, of_base_);
  take_gradient(gradient);
  return value;
}

}  // namespace arcslip::continuation
