#include "arcslip/continuation/linear/condensed_jacobian.hpp"

namespace arcslip::continuation {

void CondensedJacobian::multiply(const Vector& x, Vector& out) const {
  couple(x, out);
  out += x;
  out.array() *= weight_.array();
  out -= row_.dot(x) * column_;
}

void CondensedJacobian::multiply_transposed(const Vector& x, Vector& out) const {
  const Vector weighted = weight_.cwiseProduct(x);
  couple_transposed(weighted, out);
  out += weighted;
  out -= column_.dot(x) * row_;
}

void CondensedJacobian::multiply_absolute(const Vector& x, Vector& out) const {
  couple_absolute(x, out);
  out += x.cwiseAbs();
  out.array() *= weight_.array().abs();
  out += row_.cwiseAbs().dot(x.cwiseAbs()) * column_.cwiseAbs();
}

}  // namespace arcslip::continuation
