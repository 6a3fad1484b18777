#pragma once

// Base, damper and their contacts in several harmonics. Under the travelling wave node i repeats node 1
// with the delay (i - 1) a/w, so that harmonic h travels with the propagation constant h a at the frequency
// h eta, and each has its own compliance, whatever N is:
//
//   r_h + C_h k f_h(r) = -y_0 delta_h1,   C_h(eta) = C_B(h eta; h a) + C_D(h eta; h a).
//
// A response that repeats itself after p periods of the load alone has harmonics h of eta/p, of which the
// load acts in that of h = p, and travels on m waves, p m = n modulo N, with a of m.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/assembly/coordinates.hpp"
#include "arcslip/assembly/system_parameter.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

struct SystemParameters;

/// All that a response in several harmonics needs to know.
struct HarmonicSystem {
  std::vector<int> orders;         ///< h: of a response p first, 1 as a rule, then ascending, perhaps from 0
  std::vector<ContactModes> base;  ///< of each order, with the load that it has
  std::vector<ContactModes> damper;            ///< of each order, without load
  std::vector<SectorContact> contacts;         ///< in the order of the structures' own
  double preload_growth = 0;                   ///< P_2 of the preload P + P_2 eta^2
  std::vector<ContactOutput> outputs = {};     ///< wanted, in the first harmonic
  std::vector<Coordinate> others = {};         ///< in which elements act beside the contacts
  bool one_way = false;                        ///< whether contacts do not act back on the base
  Loss base_loss_per_zeta = {};                ///< the base's loss over zeta_B
  Loss base_loss_fixed = {};                   ///< the rest of it
  std::optional<SystemParameter> varied = {};  ///< which may be continued beside eta and the preload

  /// Elements that stick for ever with these mean forces along their first coordinate, by number.
  std::map<Index, double> held = {};

  /// The outputs of each order, in which those of the first one come first; empty where it is that alone.
  std::vector<std::vector<ContactOutput>> outputs_of_orders = {};

  /// Of how many sectors contacts and outputs are, in turn; 1 where a wave tells the others.
  Index sectors = 1;
  /// Of a whole ring the load's wave, and in each order resonances, which no joined modes are looked for.
  Index wave_number = 0;
  std::vector<std::vector<double>> landmarks = {};
  /// The highest amplitude of the equal ring, where that of this one is told over it; NaN: not known.
  std::optional<double> equal_peak = {};

  /// p: eta is the frequency of this harmonic.
  int periods() const { return orders.front(); }

  /// What eta is multiplied by in the harmonic at this position among the orders.
  double multiple(Index order) const {
    return static_cast<double>(orders[static_cast<std::size_t>(order)]) / periods();
  }

  /// The same as text, "3" or "3/2".
  std::string name(Index order) const;

  /// An output in the harmonic at this position among the orders.
  const ContactOutput& output(Index which, Index order) const {
    const auto i = static_cast<std::size_t>(which);
    return order == 0 ? outputs[i] : outputs_of_orders[static_cast<std::size_t>(order)][i];
  }
};

/// The system at a value of its parameter `varied`, which it then has no more.
HarmonicSystem at_value(const HarmonicSystem& system, double value);

/// Throws std::invalid_argument where base, damper, orders and contacts do not fit, or a stiffness or
/// threshold is not positive.
void check(const HarmonicSystem& system);

/// The static stiffness of the structures in a coordinate, which an element's force is measured by where it
/// has none of its own.
double usual_stiffness(const HarmonicSystem& system, const Coordinate& coordinate);

/// Base, damper and contacts of `parameters` under their wave, loaded by its force. Throws SectorError.
ContactSystem build_wave(const SystemParameters& parameters);

/// The system whose load acts in the harmonic h of another: its wave, window of eta, and the load's
/// magnitude, negative where a real one is.
SystemParameters in_order(const SystemParameters& parameters, int h);

/// The same structures under a load that is turned in phase.
ContactSystem turned(ContactSystem system, const Complex& turn);

/// Base, damper and contacts of `parameters` in the harmonic h, under the load that acts in it. Throws
/// SectorError.
ContactSystem build_order(const SystemParameters& parameters, int h);

/// A system in the first harmonic alone.
HarmonicSystem one_harmonic(ContactSystem system);

/// The model of `parameters` in its harmonics. Throws SectorError.
HarmonicSystem build_harmonic_system(const SystemParameters& parameters);

}  // namespace arcslip
