#pragma once

// The harmonics of [system]: those of the load, of odd elements and others, and over several of its periods.

#include "cases/structure_kind.hpp"

namespace arcslip {

inline constexpr double usual_harmonics_tolerance = 1e-4;
inline constexpr Index most_periods = 12;  ///< over which a response may repeat itself

/// The harmonics in which friction is balanced: up to a highest one, listed, or found while tracing.
void read_orders(FrictionSettings& settings, const TomlSection& section);

/// Adds the mean and the even harmonics that elements which are not odd, or the case, call for, and those
/// between of a response over several periods.
void complete_orders(const TomlSection& section, SystemParameters& system);

/// Refuses structures that cannot travel as the waves of the harmonics.
void check_waves(const TomlSection& section, const SystemParameters& system);

}  // namespace arcslip
