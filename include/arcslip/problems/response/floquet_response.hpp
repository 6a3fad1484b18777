#pragma once

// Forced responses and limit cycles that know their stability: the exponents of all disturbances
// (ring_disturbances.hpp) are the eigenvalues that the engine counts along the branch. A pair crosses the
// imaginary axis where a vibration with a second frequency branches off, and a real one zero at a fold; but
// where the response that branches off repeats itself otherwise than this one, node by node or half period
// by half period, it is a point where this symmetry breaks. Of an odd response no multiplier passes -1: that
// of a period is the square of that of half a period, which the response does twice with turned signs, and so
// would need a pair at +-j; of another one the period doubles there. A limit cycle's own velocity, whose
// multiplier is 1, does not count.
//
// At a fold the balance of harmonics is singular. Exponents taken exactly vanish there but for what the
// harmonics leave out, or a reduction to modes; so that they change their number where the branch turns, the
// sign of the determinant decides on that of the one nearest to zero.

#include <atomic>
#include <map>
#include <memory>
#include <set>

#include "arcslip/motion/swing.hpp"

#include "arcslip/assembly/system.hpp"
#include "arcslip/problems/response/harmonic_cycle.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/time/ring_disturbances.hpp"

namespace arcslip::problems {

/// A problem in harmonics with the exponents of its disturbances.
class Floquet {
 public:
  virtual ~Floquet() = default;

  /// Those of all cells.
  virtual std::vector<RingDisturbances::Disturbance> disturbances(
      const Vector& u, const Vector& p, const continuation::Regime& regime) const = 0;

  /// The largest |mu| of a period, and the wave that this disturbance mostly is.
  struct Worst {
    double growth;  ///< |mu|
    Index wave;     ///< of 0 .. N - 1
  };
  /// Of all cells.
  virtual Worst worst(const Vector& u, const Vector& p, const continuation::Regime& regime) const = 0;

  /// How far from here, in a parameter, the disturbance whose exponent is nearest to the imaginary axis has
  /// it there in the harmonics of `finer`; none without them, and where no such place is found.
  virtual std::optional<double> moved_by(const continuation::Guess& at, Index parameter) const = 0;

  /// The highest of those harmonics; 0 without them.
  virtual int finer_highest() const = 0;
};

/// What disturbances of a motion run through: the same at every point of a forced response, and with the
/// base's damping zeta_B of a limit cycle; or as strong as the flow that acts on the base is.
class DisturbedRing {
 public:
  /// Of the motion in the harmonics of `system`; asks `waves` for all structures at once.
  DisturbedRing(HarmonicSystem system, const RingWaves& waves);

  /// As they were given.
  const RingDisturbances& given() const { return *given_; }

  /// With another zeta_B, or its own, under so many times the flow.
  RingDisturbances at(std::optional<double> zeta, double influence) const;

 private:
  HarmonicSystem system_;
  RingWaves waves_;
  std::map<Index, RingWaves::Structures> under_;
  std::shared_ptr<const RingDisturbances> given_;
};

/// Of HarmonicResponse or HarmonicCycle.
template <class Motion>
class FloquetOf : public Motion, public Floquet {
 public:
  /// Observables beside those of Motion, at their end: `growth`, the largest |mu| of a period;
  /// `growth_error`, how far it is, estimated by the response in the harmonics of `finer`, from what all
  /// harmonics give, NaN without it and where there is no such response; `worst_wave`, of Worst;
  /// `stable`, 1 or 0 where the error leaves no doubt, else NaN. Throws std::invalid_argument as
  /// Motion and RingDisturbances do.
  FloquetOf(const HarmonicSystem& system, const RingWaves& waves,
            std::shared_ptr<const FloquetOf> finer = nullptr);

  /// Of a system whose response is not a sum over modes; `in_modes`: the same one as such, good to some
  /// tolerance, for disturbances.
  FloquetOf(const HarmonicSystem& system, const HarmonicSystem& in_modes, const RingWaves& waves,
            std::shared_ptr<const FloquetOf> finer);

  /// sigma, lambda = 2 pi sigma, of all cells of waves in which something may grow.
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                 ComplexVector& values) const override;

  continuation::PointType pair_crossing() const override { return continuation::PointType::neimark_sacker; }

  std::vector<continuation::PointType> test_types() const override;
  void test(const Vector& u, const Vector& p, const continuation::Regime& regime,
            Vector& values) const override;

  std::vector<continuation::Observable> observables() const override;
  using Motion::observe;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;

  std::vector<RingDisturbances::Disturbance> disturbances(const Vector& u, const Vector& p,
                                                          const continuation::Regime& regime) const override;
  Worst worst(const Vector& u, const Vector& p, const continuation::Regime& regime) const override;
  std::optional<double> moved_by(const continuation::Guess& at, Index parameter) const override;
  int finer_highest() const override { return finer_ ? highest_order(finer_->system().orders) : 0; }
  /// Without what is told of stability.
  void observe_quickly(const Vector& u, const Vector& p, const continuation::Regime& regime,
                       Vector& values) const override;

 private:
  static constexpr bool is_cycle = std::is_base_of_v<FreeVibration, Motion>;

  /// How often the motion repeats itself in a unit of time.
  double turns(const Vector& u, const Vector& p) const {
    return this->frequency(u, p) / this->system().periods();
  }
  DisturbedLaw law(Index element, const Vector& u, const Vector& p, const continuation::Regime& regime) const;
  std::vector<StickPattern> patterns(const Vector& u, const Vector& p,
                                     const continuation::Regime& regime) const;
  RingDisturbances::Disturbances found(const RingDisturbances& ring, const Vector& u, const Vector& p,
                                       const continuation::Regime& regime,
                                       std::span<const StickPattern> contacts, bool active) const;
  double influence(const Vector& p) const;
  template <class Use>
  auto with_ring(const Vector& p, const Use& use) const;
  struct Last;
  const Last& last(const Vector& u, const Vector& p, const continuation::Regime& regime) const;
  double growth_error(const Vector& u, const Vector& p, const continuation::Regime& regime,
                      double growth) const;
  struct Followed;
  std::optional<Followed> nearest(const continuation::Guess& at, std::optional<Complex> turned) const;

  DisturbedRing ring_;
  bool is_in_modes_ = true;  ///< as disturbances are
  std::shared_ptr<const FloquetOf> finer_;
  static std::atomic<long> made_;
  const long number_ = ++made_;  ///< of no other one, also at an address that is used anew
};

using FloquetResponse = FloquetOf<HarmonicResponse>;
using FloquetCycle = FloquetOf<HarmonicCycle>;

extern template class FloquetOf<HarmonicResponse>;
extern template class FloquetOf<HarmonicCycle>;

/// The numbers of waves, 0 .. N/2, under which it and the response by which it tells its error are disturbed.
std::set<Index> disturbed_waves(const SystemParameters& parameters);

/// The response or the cycle of `parameters`, and that in more harmonics by which it tells its error. Throws
/// SectorError.
std::shared_ptr<FloquetResponse> build_floquet_response(const SystemParameters& parameters);
std::shared_ptr<FloquetCycle> build_floquet_cycle(const SystemParameters& parameters);

}  // namespace arcslip::problems
