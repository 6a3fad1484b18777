#pragma once

// The first rise of a polynomial through zero, certified: in the Bernstein basis its coefficients bound it
// and their sign changes bound the number of its roots (Descartes), so that an interval is cut until it holds
// no root or a single one. None is missed, however close to another.

#include <optional>

#include "arcslip/types.hpp"

namespace arcslip {

/// The least x in [0, 1] from which f(x) = sum_m c_m x^m is positive; 0 where f(0) > 0, nothing where f <= 0.
std::optional<double> first_crossing(const Vector& coefficients);

}  // namespace arcslip
