#include "arcslip/time/ring_waves.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/structures.hpp"
#include "arcslip/assembly/system.hpp"
#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

/// The modes that count.
std::vector<ContactMode> noticeable(const ContactModes& structure, double slowest) {
  constexpr double fast = 1e5;  // over the slowest one
  constexpr double stiff = 1e-13;
  const auto flexibility = [&](const ContactMode& mode) {
    return mode.shape.squaredNorm() / (mode.frequency * mode.frequency + slowest * slowest);
  };
  double most = 0;
  for (const ContactMode& mode : structure.modes()) most = std::max(most, flexibility(mode));
  std::vector<ContactMode> all;
  for (const ContactMode& mode : structure.modes()) {
    if (mode.frequency <= fast * slowest || flexibility(mode) > stiff * most) all.push_back(mode);
  }
  return all;
}

std::vector<Oscillator> joined(const std::vector<Oscillator>& rigid) {
  const auto other = [&](const Oscillator& mode) { return mode.damping != rigid.front().damping; };
  if (rigid.size() < 2 || std::any_of(rigid.begin(), rigid.end(), other)) return rigid;
  ComplexMatrix shapes(std::ssize(rigid), rigid.front().shape.size());
  for (Index k = 0; k < shapes.rows(); ++k)
    shapes.row(k) = rigid[static_cast<std::size_t>(k)].shape.adjoint();
  const ComplexMatrix parts = fewest_rows(shapes);
  std::vector<Oscillator> all;
  for (Index k = 0; k < parts.rows(); ++k) {
    all.push_back(rigid.front());
    all.back().shape = parts.row(k).adjoint();
  }
  return all;
}

/// Real shapes in place of each group of modes of one frequency and damping, of a structure whose waves are
/// their own conjugates: sum s s^H over the group, all that the contacts know of it, is real.
std::vector<Oscillator> made_real(std::vector<Oscillator> modes) {
  constexpr double alike = 1e-9;  // well above what is left of equal frequencies by their computation
  std::sort(modes.begin(), modes.end(),
            [](const Oscillator& a, const Oscillator& b) { return a.frequency < b.frequency; });
  for (std::size_t first = 0; first < modes.size();) {
    std::size_t next = first + 1;
    while (next < modes.size() && modes[next].influence == modes[first].influence &&
           modes[next].frequency - modes[next - 1].frequency <= alike * modes[next].frequency)
      ++next;
    Matrix parts(modes[first].shape.size(), 2 * static_cast<Index>(next - first));
    for (std::size_t k = first; k < next; ++k)
      parts.middleCols(2 * static_cast<Index>(k - first), 2) << modes[k].shape.real(), modes[k].shape.imag();
    const SingularAxes<Matrix> axes = singular_axes(parts);
    for (std::size_t k = first; k < next; ++k) {
      const auto i = static_cast<Index>(k - first);
      modes[k].shape.setZero();
      if (i < axes.sizes.size()) modes[k].shape.real() = axes.directions.col(i) * axes.sizes(i);
    }
    first = next;
  }
  return modes;
}

/// Under a wave that runs the other way, without load.
ContactModes conjugate(const ContactModes& structure) {
  std::vector<ContactMode> modes = structure.modes();
  for (ContactMode& mode : modes) {
    mode.shape = mode.shape.conjugate().eval();
    mode.load = 0;
    mode.influence = mode.influence.conjugate();
  }
  return {structure.contacts(), std::move(modes), structure.loss()};
}

}  // namespace

double slowest_rate(const ContactModes& base, const ContactModes& damper) {
  double slowest = std::numeric_limits<double>::infinity();
  for (const ContactModes* structure : {&base, &damper}) {
    for (const ContactMode& mode : structure->modes()) {
      if (mode.frequency > 0) slowest = std::min(slowest, mode.frequency);
    }
  }
  return slowest;
}

std::vector<Oscillator> oscillators(const ContactModes& base, const ContactModes& damper, double slowest,
                                    bool real, std::span<const Coordinate> others) {
  std::vector<Oscillator> all;
  std::vector<Oscillator> rigid;
  for (const ContactModes* structure : {&base, &damper}) {
    // Modes of the base have the sign with which they move the contacts as those of the damper do.
    const auto entry = [&](const Coordinate& one) { return structure == &base ? -one.base : one.damper; };
    const Loss& loss = structure->loss();
    if (loss.structural != 0 || structure->is_solved())
      throw std::invalid_argument("stability needs modes with viscous or modal damping");
    std::vector<Oscillator> of_structure;
    for (const ContactMode& mode : noticeable(*structure, slowest)) {
      ContactVector shape(mode.shape.size() + std::ssize(others));
      shape.head(mode.shape.size()) = mode.shape;
      for (Index i = 0; i < std::ssize(others); ++i) {
        const Coordinate& one = others[static_cast<std::size_t>(i)];
        shape(mode.shape.size() + i) = entry(one) * mode.shape(one.dof);
      }
      of_structure.push_back({mode.frequency, loss.part_eta(mode.frequency) + mode.influence.damping,
                              std::move(shape), mode.influence.stiffness});
    }
    if (real) of_structure = made_real(std::move(of_structure));
    for (Oscillator& one : of_structure) (one.frequency > 0 ? all : rigid).push_back(std::move(one));
  }
  for (Oscillator& mode : joined(rigid)) all.push_back(std::move(mode));
  return all;
}

RingWaves::RingWaves(Index wave_number, Index nodes, Build build)
    : wave_number_(wave_number), nodes_(nodes), build_(std::move(build)) {}

Index RingWaves::within(Index wave) const { return (wave % nodes_ + nodes_) % nodes_; }

RingWaves::Structures RingWaves::structures(Index wave) const {
  const Index forward = within(wave);
  const Index least = std::min(forward, nodes_ - forward);
  const Structures found = build_(least);
  if (forward == least) return found;
  return {conjugate(found.base), conjugate(found.damper)};
}

std::vector<Oscillator> RingWaves::at(Index wave, std::span<const Coordinate> others) const {
  const Structures found = structures(wave);
  return oscillators(found.base, found.damper, slowest_rate(found.base, found.damper), within(2 * wave) == 0,
                     others);
}

RingNodes ring_nodes(const SystemParameters& parameters) {
  if (structures_of(parameters).whole() != nullptr) return {1, 0};
  return {parameters.elements, parameters.first_wave()};
}

RingWaves ring_waves(const SystemParameters& parameters, int highest) {
  SystemParameters wide = parameters;
  wide.force = 0;
  wide.eta_high = wide.eta_high * highest / parameters.periods();
  const RingNodes nodes = ring_nodes(parameters);
  return {nodes.wave_number, nodes.count, [wide](Index wave) {
            SystemParameters one = wide;
            one.wave_number = wave;
            ContactSystem system = build_wave(one);
            return RingWaves::Structures{std::move(system.base), std::move(system.damper)};
          }};
}

}  // namespace arcslip
