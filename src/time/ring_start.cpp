// States that a motion of the ring begins with.

#include <cmath>

#include "arcslip/dense.hpp"
#include "arcslip/time/ring_motion.hpp"

namespace arcslip {

RingState RingMotion::at_rest() const {
  RingState state{
      0, Vector::Zero(ring_.coordinates()), Vector::Zero(ring_.coordinates()), Vector::Zero(memories_), {}};
  for (Index e = 0; e < elements(); ++e) state.phase.push_back(family(e).law->phase_at_rest());
  return state;
}

/// What a load of all coordinates moves by itself.
void RingMotion::add_harmonic(int order, const ComplexVector& load, RingState& state) const {
  const double w = order * frequency_;
  if (ring_.turns()) {
    ComplexMatrix stiffness = turned_stiffness_ + Complex(0, w) * turned_damping_;
    stiffness.diagonal() += ring_.stiffness + Complex(0, w) * ring_.damping;
    stiffness.diagonal().array() -= w * w;
    const ComplexVector p = solution_of(stiffness, load);
    state.position += p.real();
    state.velocity -= w * p.imag();
    return;
  }
  for (Index c = 0; c < ring_.coordinates(); ++c) {
    const Complex stiffness(ring_.stiffness(c) - w * w, w * ring_.damping(c));
    if (stiffness == 0.0) continue;  // a drift
    Complex p = load(c) / stiffness;
    if (ring_.coupling.size() > 0) {  // with the coordinate beside
      const Index b = ring_.beside[static_cast<std::size_t>(c)];
      p = (stiffness * load(c) + ring_.coupling(c) * load(b)) /
          (stiffness * stiffness - ring_.coupling(c) * ring_.coupling(b));
    }
    state.position(c) += p.real();
    state.velocity(c) += (Complex(0, w) * p).real();
  }
}

RingState RingMotion::travelling(const std::vector<RingHarmonic>& harmonics) const {
  RingState state = at_rest();
  const Index nodes = ring_.nodes();
  for (const RingLoad& load : ring_.loads) add_harmonic(load.order, load.amplitude, state);
  for (const RingHarmonic& harmonic : harmonics) {
    ComplexVector forces(ring_.motion.rows());
    for (Index row = 0; row < forces.size(); ++row) {
      const auto turns = static_cast<double>(harmonic.order * ring_.wave_number * (row % nodes) % nodes);
      forces(row) =
          harmonic.force(row / nodes) * std::polar(1.0, -two_pi * turns / static_cast<double>(nodes));
    }
    const ComplexVector loads = -(ring_.motion.transpose() * forces);
    add_harmonic(harmonic.order, loads, state);
    if (harmonic.order == 0) move_rigidly(harmonic.motion, loads, state);
  }
  begin_elements(harmonics, state);
  return state;
}

/// As far as the mean motion is beyond what the mean loads make of what they deform.
void RingMotion::move_rigidly(const ComplexVector& mean, const ComplexVector& loads, RingState& state) const {
  std::vector<Index> rigid;
  for (Index c = 0; c < ring_.coordinates(); ++c) {
    if (ring_.stiffness(c) == 0 && ring_.wave[static_cast<std::size_t>(c)] == 0) rigid.push_back(c);
  }
  if (rigid.empty()) return;
  RingState rest = at_rest();
  add_harmonic(0, loads, rest);
  for (const RingLoad& load : ring_.loads) {
    if (load.order == 0) add_harmonic(0, load.amplitude, rest);
  }
  Vector beyond = -(ring_.motion * rest.position);
  for (Index row = 0; row < beyond.size(); ++row) beyond(row) += mean(row / ring_.nodes()).real();
  state.position(rigid) += shortest(Matrix(ring_.motion(Eigen::all, rigid)), beyond);
}

/// Phases and memory, from a period of the motion of node 1 before the time that each node is behind it.
void RingMotion::begin_elements(const std::vector<RingHarmonic>& harmonics, RingState& state) const {
  constexpr Index samples_at_least = 1024;
  const Index nodes = ring_.nodes();
  const Index stride = samples_at_least / nodes + 1;
  const Index samples = stride * nodes;
  std::vector<Complex> turns;
  for (Index s = 0; s < samples; ++s)
    turns.push_back(std::polar(1.0, two_pi * static_cast<double>(s) / static_cast<double>(samples)));
  const auto sampled = [&](Index row, auto part, bool rate) {
    Vector x = Vector::Zero(samples);
    if (row < 0) return x;
    for (const RingHarmonic& one : harmonics) {
      Complex value = (one.*part)(row / nodes);
      if (rate) value *= Complex(0, one.order * frequency_);
      for (Index s = 0; s < samples; ++s)
        x(s) += (value * turns[static_cast<std::size_t>(one.order * s % samples)]).real();
    }
    return x;
  };
  for (const Family& one : families_) {
    const Vector x = sampled(one.sliding, &RingHarmonic::motion, false);
    const Vector x_rate = sampled(one.sliding, &RingHarmonic::motion, true);
    const Vector y = sampled(one.across, &RingHarmonic::motion, false);
    const Vector y_rate = sampled(one.across, &RingHarmonic::motion, true);
    const Vector g = sampled(one.closing, &RingHarmonic::motion, false);
    const Vector g_rate = sampled(one.closing, &RingHarmonic::motion, true);
    const Vector force = sampled(one.sliding, &RingHarmonic::force, false);
    const Vector force_across = sampled(one.across, &RingHarmonic::force, false);
    const Index first = (&one - families_.data()) * nodes;
    for (Index i = 0; i < nodes; ++i) {
      const Index now = (samples - ring_.wave_number * i % nodes * stride) % samples;
      Vector before(samples);  // up to now
      before << x.tail(samples - 1 - now), x.head(now + 1);
      std::vector<double> memory(static_cast<std::size_t>(one.law->memories()), 0.0);
      int& phase = state.phase[static_cast<std::size_t>(first + i)];
      one.law->begin(before, {x(now), x_rate(now), g(now), g_rate(now), y(now), y_rate(now)},
                     Complex(force(now), force_across(now)) / one.factor, phase, memory);
      for (std::size_t j = 0; j < memory.size(); ++j)
        state.memory(memory_place(first + i, static_cast<Index>(j))) = memory[j];
    }
  }
}

}  // namespace arcslip
