// Derivatives of the harmonic response by its unknowns: as a matrix, or condensed.

#include "arcslip/problems/response/harmonic_response.hpp"
#include "harmonic_jacobian.hpp"

namespace arcslip::problems {

std::unique_ptr<continuation::CondensedJacobian> HarmonicResponse::condensed_jacobian() const {
  if (size() <= matrix_up_to_ || system_.sectors == 1 || rigid_.count() > 0) return nullptr;
  std::vector<Index> sectors;
  const Index each = contacts() / system_.sectors;
  for (Index i = 0; i < coordinates_.size(); ++i)
    sectors.push_back(i < contacts() ? i / each : coordinates_[i].sector);
  return std::make_unique<HarmonicJacobian>(harmonics(), std::move(sectors));
}

/// How f/K - x of all harmonics in one coordinate changes with one harmonic of another one, by Re and Im.
void HarmonicResponse::set_change(const ElementForce& element, Index from, Index to, Index order,
                                  Rows& rows) const {
  const Index by = place(from, order);
  const double per_k = 1 / rows.order.stiffness(to);
  const auto linear = element.linear.col(by).segment(place(to, 0), harmonics());
  const auto conjugate = element.conjugate.col(by).segment(place(to, 0), harmonics());
  rows.sum = (linear + conjugate) * per_k;
  rows.difference = (linear - conjugate) * Complex(0, per_k);
  if (to != from) return;
  rows.sum(order) -= 1;
  rows.difference(order) -= Complex(0, 1);
}

/// Of the elements that are not linear.
void HarmonicResponse::fill_condensed(Rows& rows, const std::vector<ElementForce>& elements, const Vector& u,
                                      const continuation::Regime& regime) const {
  const Index n = harmonics();
  rows.condensed->clear_elements();
  for (Index e = 0; e < coordinates_.elements(); ++e) {
    const Index first = coordinates_.first(e);
    const Index own = coordinates_.element(e).coordinates();
    if (is_odd_ && is_linear(regime, first)) continue;  // f = x
    Matrix& change = rows.condensed->add_element(first, own);
    for (Index column = 0; column < own * n; ++column) {
      for (Index j = 0; j < own; ++j) {
        set_change(elements[at(e)], first + column / n, first + j, column % n, rows);
        for (Index a = 0; a < n; ++a) {
          const Index row = 2 * (j * n + a);
          change.block<2, 2>(row, 2 * column) << rows.sum(a).real(), rows.difference(a).real(),
              rows.sum(a).imag(), rows.difference(a).imag();
        }
      }
    }
  }
  rows.condensed->set_size(rows.residual, u);
}

/// Column by column, in which the harmonics of a coordinate's rows follow one another.
void HarmonicResponse::fill_jacobian(Rows& rows, const std::vector<ElementForce>& elements, const Vector& u,
                                     const continuation::Regime& regime, Matrix& jacobian) const {
  const Index n = harmonics();
  const Index m = coordinates_.size();
  jacobian.noalias() = (-1 / u.squaredNorm() * rows.residual) * u.transpose();
  for (Index column = 0; column < m * n; ++column) {
    const Index from = column / n;
    const Index order = column % n;
    jacobian(2 * column, 2 * column) += rows.weight(order);
    jacobian(2 * column + 1, 2 * column + 1) += rows.weight(order);
    if (is_odd_ && is_linear(regime, from)) continue;  // f = x
    const Index of = coordinates_.element_of(from);
    const Index first = coordinates_.first(of);
    for (Index j = first; j < first + coordinates_.element(of).coordinates(); ++j) {
      set_change(elements[at(of)], from, j, order, rows);
      for (Index i = 0; i < m; ++i) {
        const auto part = [&](Index real_column) {
          return Eigen::Map<Eigen::ArrayXcd>(
              reinterpret_cast<Complex*>(jacobian.col(real_column).data() + 2 * i * n), n);
        };
        const auto own = rows.own.col(j * m + i).array();
        part(2 * column) += own * rows.sum.array();
        part(2 * column + 1) += own * rows.difference.array();
      }
    }
  }
  if (rows.drifts.size() > 0) set_drifts(u, rows, &jacobian);
}

}  // namespace arcslip::problems
