#pragma once

// Fifty-digit arithmetic for setting a system up.
//
// The lowest stiffness of a reduced beam is a^4 times its largest entry (a = 2 pi n/N), so that double
// precision loses everything from N = 10^4 on. Elements are therefore assembled, reduced and turned into
// modes in fifty digits, once for each system, and rounded to double at the very end.

#include <Eigen/Core>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_complex.hpp>

namespace arcslip {

/// Real and complex numbers of fifty digits, and matrices of these.
using PreciseReal =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
using PreciseComplex = boost::multiprecision::number<
    boost::multiprecision::complex_adaptor<boost::multiprecision::cpp_bin_float<50>>,
    boost::multiprecision::et_off>;
using PreciseMatrix = Eigen::Matrix<PreciseReal, Eigen::Dynamic, Eigen::Dynamic>;
using PreciseComplexMatrix = Eigen::Matrix<PreciseComplex, Eigen::Dynamic, Eigen::Dynamic>;
using PreciseComplexVector = Eigen::Matrix<PreciseComplex, Eigen::Dynamic, 1>;

}  // namespace arcslip

namespace Eigen {

/// What Eigen asks of these numbers.
template <>
struct NumTraits<arcslip::PreciseReal> : GenericNumTraits<arcslip::PreciseReal> {
  /// Decimals that are sure.
  static int digits10() { return std::numeric_limits<arcslip::PreciseReal>::digits10; }
};

/// The same of complex ones.
template <>
struct NumTraits<arcslip::PreciseComplex> : GenericNumTraits<arcslip::PreciseComplex> {
  /// Related types, costs and limits.
  using Real = arcslip::PreciseReal;
  using NonInteger = arcslip::PreciseComplex;
  using Literal = arcslip::PreciseComplex;
  enum { IsComplex = 1, RequireInitialization = 1, ReadCost = 1, AddCost = 2, MulCost = 6 };
  static Real epsilon() { return std::numeric_limits<Real>::epsilon(); }
  static Real dummy_precision() { return 1000 * epsilon(); }
  static int digits10() { return std::numeric_limits<Real>::digits10; }
};

}  // namespace Eigen
