#pragma once

// Growth of small disturbances of a travelling response, exactly, where the waves that hang together are few.
//
// The response turns its sign after half a period, so that its contacts stick and slip anew every half
// period, and node i does so with the delay 2 n/N of one. Disturbances that are the same again but for a
// factor,
//
//   delta r_i(t) = e^{lambda t} e^{-2 pi j l i/N} sum_f R_f e^{jf(wt - 2 pi n i/N)},   f even or f odd,
//
// consist of the waves l + f n, of the frequencies Im lambda + f w. Friction couples all f that differ by an
// even number, and f + 2 M is the same wave as f, M = N/gcd(2 n, N): M waves hang together, and lambda is
// unique modulo 2 j w M. Of N nodes M have phases of their own, theta - pi k/M with k = 0 .. M - 1. While
// theta grows by pi/M each node does what the one before it has done in that time, so that the linear flow
// over it with nodes and waves turned back is a matrix G with eigenvalues
//
//   nu = e^{lambda pi/(M w)},   |mu| = |nu|^{2 M} over a period,
//
// each multiplier once. Between the moments at which a contact begins or ceases to stick the flow is the
// exponential of a matrix; a slider rests while its contact sticks, where r has been when it began to. Where
// the stiffness of smooth elements varies it is summed as a Taylor series to rounding, as the ring's motion
// is.
//
// A response that is not odd repeats itself after a whole period alone. Then all f hang together, over twice
// the angle: what is said here of f holds for 2 f, or 2 f + 1 of waves that stand half a wave aside.
//
// Where fewer f are given than hang together, M is their number: the others are taken for what these are.
//
// A mode that by itself grows more than e^16-fold in that time, as negative damping has it at high
// frequencies, would take the digits of all others. It is left to itself: nothing that friction does holds
// it.

#include <array>

#include "arcslip/time/ring_waves.hpp"
#include "arcslip/time/stick_pattern.hpp"

namespace arcslip {

/// Of one class of waves.
class TurnedFlow {
 public:
  /// One of them, with the oscillators that it meets.
  struct Wave {
    Index wave;                     ///< l + f n
    int order;                      ///< f
    std::vector<Oscillator> modes;  ///< of both structures
  };

  /// How the class stands to its conjugate.
  enum class Kind {
    general,        ///< of complex amplitudes
    self_conjugate  ///< l = -l modulo N: f and -f are conjugates, real motions need one of them
  };

  /// Of M = `nodes` waves with f in steps of 2; of a self-conjugate class those from f = 0 or 1 to at most M.
  /// `springs`: k of each contact; what is left of the waves' shapes is of further coordinates. `turn`, pi or
  /// 2 pi: the angle after which the response repeats itself but for its sign.
  TurnedFlow(Kind kind, Index nodes, const std::vector<Wave>& waves, const Vector& springs, double turn = pi);

  /// How the class stands to its conjugate, and M.
  Kind kind() const { return kind_; }
  Index nodes() const { return nodes_; }

  /// The largest |Im sigma|, eta M of an odd response.
  double edge(double eta) const { return pi / turn_ * static_cast<double>(nodes_) * eta; }

  /// Whether no disturbance can grow, since no mode gains energy.
  bool is_passive() const;

  /// sigma, lambda = 2 pi sigma, with |Im sigma| <= edge; of real nu the imaginary part is just 0 or the
  /// edge, of those on the unit circle to rounding the real part 0. In descending order of real parts,
  /// without those of sliders that forget themselves, |nu| < 1e-13, and of rigid motions that all sliders
  /// follow, which nothing resists; `own`: the response is one of these waves, and where no load drives it
  /// that of its velocity is left out.
  std::vector<Complex> exponents(double eta, std::span<const StickPattern> elements, bool own = false) const;

  /// The wave, of 0 .. N - 1, that the disturbance with this exponent mostly is, as disturbed_wave.hpp says;
  /// `ring`: N.
  Index wave_of(const Complex& exponent, double eta, std::span<const StickPattern> elements,
                Index ring) const;

  /// A coordinate of the motion: of a wave, or of two conjugate ones, which move by (a + jb)/sqrt 2 and its
  /// conjugate, the real part a or the imaginary part b behind it.
  struct Coordinate {
    /// Which part of its wave's amplitude it is, the wave l + f n, the f, and the oscillator.
    enum class Part { whole, real, imaginary } part;
    Index wave;
    int order;
    Oscillator mode;
  };

 private:
  /// Those that friction may hold, and those that it does not.
  struct Parts {
    std::vector<Coordinate> held;
    std::vector<Coordinate> free;
  };
  Parts parts(double eta) const;
  double step(double eta) const;  ///< time in which theta grows by turn/M
  template <class Use>
  auto with_flow(const std::vector<Coordinate>& held, double eta, std::span<const StickPattern> elements,
                 const Use& use) const;
  std::array<Complex, 2> free_exponents(const Coordinate& coordinate, double eta) const;

  Kind kind_;
  Index nodes_;
  std::vector<Coordinate> coordinates_;
  Vector springs_;
  double turn_;
};

}  // namespace arcslip
