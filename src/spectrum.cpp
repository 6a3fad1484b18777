#include "arcslip/spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace arcslip {

ComplexVector spectrum(const Matrix& matrix) {
  ComplexVector values = matrix.eigenvalues();
  std::sort(values.begin(), values.end(),
            [](const Complex& a, const Complex& b) { return std::abs(a) > std::abs(b); });
  return values;
}

}  // namespace arcslip
