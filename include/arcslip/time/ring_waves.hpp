#pragma once

// Base and damper as disturbances of l = 0, 1, ..., N - 1 waves round the ring meet them: oscillators
//
//   p'' + damping p' + (frequency^2 - influence) p = -shape^H F,   x = sum shape p
//
// in time in units of 1/(2 pi), x the coordinates in which elements act (coordinates.hpp) of the node whose
// phase is 0, F the forces against them. Waves of l and N - l lengths are each other's conjugates.

#include <functional>
#include <vector>

#include "arcslip/assembly/coordinates.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

struct SystemParameters;

/// One mode of base or damper under a wave.
struct Oscillator {
  double frequency;       ///< in units of eta
  double damping;         ///< in the same units
  ContactVector shape;    ///< of the contacts, then of further coordinates
  Complex influence = 0;  ///< of a flow, in units of eta^2; complex of a wave that is not its own conjugate

  Complex stiffness() const { return frequency * frequency - influence; }  ///< of p
};

/// The oscillators of both structures under one wave, rigid ones at the end. Left out is what moves the
/// contacts by less than rounding at rates far above `slowest`, as the second modes of short elements do.
/// Rigid motions of the same damping act on the coordinates by sum s s^H alone: combinations of them that
/// move none, as base and damper together, would add a defective exponent and are left out. `real`: of a
/// wave that is its own conjugate, whose shapes are real but for their phases. `others`: coordinates beside
/// the contacts. Throws std::invalid_argument
/// where damping is structural, of which there is no motion in time, or where the response is not a sum over
/// modes.
std::vector<Oscillator> oscillators(const ContactModes& base, const ContactModes& damper, double slowest,
                                    bool real, std::span<const Coordinate> others = {});

/// The lowest frequency but 0 of both; infinite without any.
double slowest_rate(const ContactModes& base, const ContactModes& damper);

/// The structures under every wave. Builds them anew at each call.
class RingWaves {
 public:
  /// Both under one wave.
  struct Structures {
    ContactModes base;    ///< its load does not count
    ContactModes damper;  ///< the same
  };
  using Build = std::function<Structures(Index wave)>;  ///< under so many waves, 0 .. N/2

  /// Of a response that travels with n = `wave_number` waves round N = `nodes` nodes; `build` gives the
  /// structures under 0, ..., N/2 waves.
  RingWaves(Index wave_number, Index nodes, Build build);

  /// n and N.
  Index wave_number() const { return wave_number_; }
  Index nodes() const { return nodes_; }

  /// l between 0 and N - 1 for any whole number.
  Index within(Index wave) const;

  /// Under l waves, any whole number.
  Structures structures(Index wave) const;
  std::vector<Oscillator> at(Index wave, std::span<const Coordinate> others = {}) const;

 private:
  Index wave_number_;
  Index nodes_;
  Build build_;
};

/// The nodes round a ring of which each does what the next one did, and the waves in which they do. A whole
/// ring is a single node.
struct RingNodes {
  Index count;        ///< N
  Index wave_number;  ///< n
};
RingNodes ring_nodes(const SystemParameters& parameters);

/// Those of a system of rods, beams or sectors, or of a whole ring in modes; of sectors with the modes that
/// serve up to its harmonic `highest` in the window of eta. `at` throws SectorError.
RingWaves ring_waves(const SystemParameters& parameters, int highest);

}  // namespace arcslip
