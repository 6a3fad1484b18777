#pragma once

// The base without damper, to which studies compare: its highest amplitude Y_nd_max at the first contact dof
// in a window of eta, and the damping with which it would be as low as with a damper.

#include "arcslip/problems/ridges/preload_study.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip::problems {

/// The highest amplitude of the base alone in the window, its ends included. Throws std::runtime_error where
/// nothing moves it.
Peak free_peak(const ContactModes& base, const PreloadRange& range);
Peak free_peak(const ModalModel& base, const PreloadRange& range);

/// That of one contact, whose base may have cubic springs: then it is traced, and the exception says so where
/// it cannot be.
Peak free_peak(FrictionSystem system, const PreloadRange& range, const continuation::TraceOptions& options);

/// zeta_B of the base alone, which is zeta with the highest peak `free`, whose highest peak would be Y; nan
/// where none has.
double equivalent_damping(const FrictionSystem& system, double zeta, const PreloadRange& range,
                          const Peak& free, double Y);

}  // namespace arcslip::problems
