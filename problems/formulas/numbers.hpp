#pragma once

// Room for what tapes read and write, without allocation where it is little.

#include <boost/container/small_vector.hpp>

#include "arcslip/types.hpp"

namespace arcslip::problems {

using Numbers = boost::container::small_vector<double, 1024>;  // on the stack up to 8 kB
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Of any values.
inline Numbers room(Index count) {
  return Numbers(static_cast<std::size_t>(count), boost::container::default_init);
}

/// Unknowns, then parameters, as the tapes have them.
inline Numbers joined(const Vector& u, const Vector& p) {
  Numbers both(u.begin(), u.end());
  both.insert(both.end(), p.begin(), p.end());
  return both;
}

}  // namespace arcslip::problems
