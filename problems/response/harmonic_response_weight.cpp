// What the rows of a harmonic are weighted by.

#include <cmath>

#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip::problems {

/// So that rows tell the error of x itself. Of a whole ring what counts is how far the load moves it where
/// all is linear, |A^{-1} x0|/|x0| with A = 1 + C K in place of |A^{-1}|: at resonances of waves that the
/// load does not drive, which may have no damping at all, rows would else all vanish, whatever x is.
void HarmonicResponse::set_weight(Order& order) const {
  double square = order.inverse.squaredNorm();
  if (system_.sectors > 1) {
    const auto load = order.joint.free.head(order.inverse.rows());
    order.driven.noalias() = order.inverse * load;
    square = load.isZero(0) ? 0 : order.driven.squaredNorm() / load.squaredNorm();
  }
  order.weight = 1 / std::sqrt(1 + square);
}

/// How fast the logarithm of the weight changes, over its square, with these changes of A and -x0.
double HarmonicResponse::weight_slope(Order& order, const ContactMatrix& compliance,
                                      const ContactVector& free) const {
  const Index m = order.inverse.rows();
  if (system_.sectors > 1) {
    const auto load = order.joint.free.head(m);
    if (load.isZero(0)) return 0;
    const double size = load.squaredNorm();
    const ContactVector change =
        order.inverse * (free.head(m) - compliance.topLeftCorner(m, m) * order.driven);
    return order.driven.squaredNorm() / (size * size) * load.dot(free.head(m)).real() -
           order.driven.dot(change).real() / size;
  }
  order.product.noalias() = compliance * order.solver();
  order.turned.noalias() = order.solver() * order.product;
  if (order.turned.rows() > m) order.turned = order.turned.topLeftCorner(m, m).eval();
  return order.inverse.conjugate().cwiseProduct(order.turned).sum().real();
}

}  // namespace arcslip::problems
