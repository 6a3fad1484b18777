#include "arcslip/time/ring.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/motion/swing.hpp"
#include "arcslip/time/ring_law.hpp"
#include "arcslip/time/ring_waves.hpp"

namespace arcslip {
namespace {

/// Modes of one frequency, damping and influence, as elements, load and the base's contact see them.
struct Group {
  double frequency;
  double damping;
  Complex influence;     ///< as in Oscillator
  ComplexMatrix shapes;  ///< coordinates x modes
  ComplexVector base;    ///< modes: of the first contact dof
  ComplexVector load;    ///< modes
};

using Rows = std::vector<Coordinate>;

void add_modes(const ContactModes& structure, bool is_base, const Rows& rows, std::vector<Group>& groups) {
  constexpr double alike = 1e-9;  // well above what is left of equal frequencies by their computation
  const Loss& loss = structure.loss();
  if (structure.is_solved() || loss.structural != 0)
    throw std::invalid_argument("motion in time needs modes, with viscous or modal damping");
  for (const ContactMode& mode : structure.modes()) {
    const double damping = two_pi * (loss.part_eta(mode.frequency) + mode.influence.damping);
    const Complex influence = mode.influence.stiffness;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& one) {
      return std::abs(one.frequency - mode.frequency) <= alike * mode.frequency &&
             std::abs(one.damping - damping) <= alike * std::abs(damping) && one.influence == influence;
    });
    if (group == groups.end()) group = groups.insert(group, {mode.frequency, damping, influence, {}, {}, {}});
    const Index last = group->load.size();
    group->shapes.conservativeResize(std::ssize(rows), last + 1);
    for (Index c = 0; c < std::ssize(rows); ++c) {
      const Coordinate& row = rows[static_cast<std::size_t>(c)];
      group->shapes(c, last) = two_pi * row.move(is_base) * mode.shape(row.dof);
    }
    group->base.conservativeResize(last + 1);
    group->base(last) = is_base ? two_pi * mode.shape(0) : 0;
    group->load.conservativeResize(last + 1);
    group->load(last) = is_base ? two_pi * mode.load : 0;
  }
}

std::vector<Group> groups_of(const ContactModes& base, const ContactModes& damper, const Rows& rows) {
  std::vector<Group> groups;
  add_modes(base, true, rows, groups);
  add_modes(damper, false, rows, groups);
  return groups;
}

/// Leaves out what moves the elements by less than rounding, at rates far above the slowest one.
void drop_unnoticeable(std::vector<Group>& groups) {
  constexpr double fast = 1e5;  // over the slowest one
  constexpr double stiff = 1e-13;
  double slowest = std::numeric_limits<double>::infinity();
  for (const Group& one : groups) {
    if (one.frequency > 0) slowest = std::min(slowest, one.frequency);
  }
  if (std::isinf(slowest)) return;
  const auto flexibility = [&](const Group& one) {
    return one.shapes.squaredNorm() / (one.frequency * one.frequency + slowest * slowest);
  };
  double most = 0;
  for (const Group& one : groups) most = std::max(most, flexibility(one));
  std::erase_if(groups, [&](const Group& one) {
    return one.frequency > fast * slowest && flexibility(one) <= stiff * most;
  });
}

/// The axes of a group: shapes = axes parts, real ones of a wave that is its own conjugate.
struct Axes {
  ComplexMatrix shapes;  ///< coordinates x axes, orthogonal
  ComplexMatrix parts(const ComplexMatrix& of) const {
    const Vector squares = shapes.colwise().squaredNorm();
    return squares.cwiseInverse().asDiagonal() * (shapes.adjoint() * of);
  }
};

Axes axes_of(const Group& group, bool real) {
  constexpr double negligible = 1e-10;
  const auto kept = [](const auto& axes, Index most) {
    const Vector& sizes = axes.sizes;
    Index rank = 0;
    while (rank < std::min(most, sizes.size()) && sizes(rank) > 0 && sizes(rank) > negligible * sizes(0))
      ++rank;
    return ComplexMatrix(axes.directions.leftCols(rank) * sizes.head(rank).asDiagonal());
  };
  if (!real) return {kept(singular_axes(group.shapes), group.load.size())};
  Matrix both(group.shapes.rows(), 2 * group.shapes.cols());
  both << group.shapes.real(), group.shapes.imag();
  return {kept(singular_axes(both), group.load.size())};
}

/// One axis of a group, as one or two coordinates of the ring.
struct Place {
  Index wave;
  std::size_t group;
  Index first;  ///< coordinate of its first axis
};

/// Puts together the ring's coordinates, wave by wave.
class Builder {
 public:
  Builder(Ring& ring, const SystemParameters& parameters, Rows rows)
      : ring_(ring), parameters_(parameters), rows_(std::move(rows)) {}

  void add_wave(Index wave, const RingWaves::Structures& structures) {
    std::vector<Group> groups = groups_of(structures.base, structures.damper, rows_);
    drop_unnoticeable(groups);
    for (const Group& group : groups) {
      const Axes found = axes_of(group, is_real(wave));
      const ComplexVector base = found.parts(group.shapes).conjugate() * group.base;
      known_[wave].push_back({group.frequency, group.damping, group.influence, found, base, size_});
      const Kept& kept = known_[wave].back();
      // Rigid motions that move no element would be defective; others by themselves tell of stability.
      const Index axes = group.frequency > 0 ? group.load.size() : kept.axes.shapes.cols();
      for (Index k = 0; k < axes; ++k) {
        const Index count = is_real(wave) ? 1 : 2;
        for (Index part = 0; part < count; ++part) {
          const Complex stiffness = stiffness_of(group);
          stiffness_.push_back(stiffness.real());
          damping_.push_back(group.damping);
          coupling_.push_back(count == 1 ? 0 : part == 0 ? stiffness.imag() : -stiffness.imag());
          ring_.wave.push_back(wave);
          ring_.beside.push_back(count == 1 ? size_ : size_ + 1 - 2 * part);
          ++size_;
        }
      }
    }
  }

  /// Once all waves are there.
  void finish() {
    ring_.stiffness = Vector::Map(stiffness_.data(), size_);
    ring_.damping = Vector::Map(damping_.data(), size_);
    if (std::any_of(coupling_.begin(), coupling_.end(), [](double one) { return one != 0; }))
      ring_.coupling = Vector::Map(coupling_.data(), size_);
    const Index nodes = ring_.nodes();
    ring_.motion = Matrix::Zero(nodes * std::ssize(rows_), size_);
    ring_.base = Matrix::Zero(nodes, size_);
    for (const auto& [wave, all] : known_) {
      for (const Kept& kept : all) {
        Index place = kept.first;
        for (Index k = 0; k < kept.axes.shapes.cols(); ++k, place += is_real(wave) ? 1 : 2) {
          for (Index c = 0; c < std::ssize(rows_); ++c)
            fill(wave, place, kept.axes.shapes(c, k), ring_.motion.middleRows(c * nodes, nodes));
          fill(wave, place, kept.base(k), ring_.base);
        }
      }
    }
  }

  void add_load(int order) {
    SystemParameters of_order = in_order(parameters_, order);
    if (of_order.force == 0) return;
    of_order.eta_low = parameters_.eta_low;  // the same modes as the ring has
    of_order.eta_high = parameters_.eta_high * highest_order(parameters_.harmonics) / parameters_.periods();
    const Index nodes = ring_.nodes();
    const Index forward = (of_order.wave_number % nodes + nodes) % nodes;
    const Index wave = std::min(forward, nodes - forward);
    const bool backward = forward != wave;
    const ContactSystem system = turned(build_wave(of_order), parameters_.load_turn(order));
    RingLoad load{order, ComplexVector::Zero(size_)};
    const Rows base_rows = rows_;
    for (const Group& group : groups_of(system.base, system.damper, base_rows)) {
      const auto& all = known_[wave];
      const auto kept = std::find_if(all.begin(), all.end(), [&](const Kept& one) {
        return std::abs(one.frequency - group.frequency) <= 1e-8 * group.frequency &&
               std::abs(one.damping - group.damping) <= 1e-8 * std::abs(group.damping) &&
               (backward ? std::conj(one.influence) : one.influence) == group.influence;
      });
      ComplexMatrix parts(0, group.load.size());
      if (kept != all.end()) {
        const Axes axes{backward ? kept->axes.shapes.conjugate().eval() : kept->axes.shapes};
        parts = axes.parts(group.shapes);
        const ComplexVector amplitude = parts * group.load;
        for (Index k = 0; k < amplitude.size(); ++k) push(wave, backward, kept->first, k, amplitude(k), load);
      }
      const ComplexVector rest = group.load - parts.adjoint() * (parts * group.load);
      const Complex residue = group.base.transpose() * rest;
      if (std::abs(residue) > 1e-14 * group.base.norm() * group.load.norm())
        ring_.unseen.push_back({order, residue, stiffness_of(group), group.damping});
    }
    ring_.loads.push_back(std::move(load));
  }

 private:
  struct Kept {
    double frequency;
    double damping;
    Complex influence;
    Axes axes;
    ComplexVector base;  ///< of each axis
    Index first;         ///< coordinate
  };

  static Complex stiffness_of(const Group& group) {
    return std::pow(two_pi, 2) * (group.frequency * group.frequency - group.influence);
  }

  bool is_real(Index wave) const { return 2 * wave % ring_.nodes() == 0; }

  /// Columns of one axis, of this shape at node 1.
  template <class Block>
  void fill(Index wave, Index place, const Complex& shape, Block&& block) const {
    const auto nodes = static_cast<double>(ring_.nodes());
    for (Index i = 0; i < ring_.nodes(); ++i) {
      const Complex here =
          shape * std::polar(1.0, -two_pi * static_cast<double>(wave * i % ring_.nodes()) / nodes);
      if (is_real(wave)) {
        block(i, place) = here.real() / std::sqrt(nodes);
      } else {
        block(i, place) = std::sqrt(2 / nodes) * here.real();
        block(i, place + 1) = -std::sqrt(2 / nodes) * here.imag();
      }
    }
  }

  void push(Index wave, bool backward, Index first, Index axis, const Complex& amplitude,
            RingLoad& load) const {
    const auto nodes = static_cast<double>(ring_.nodes());
    if (is_real(wave)) {
      load.amplitude(first + axis) += std::sqrt(nodes) * amplitude;
    } else {
      load.amplitude(first + 2 * axis) += std::sqrt(nodes / 2) * amplitude;
      load.amplitude(first + 2 * axis + 1) +=
          Complex(0, backward ? 1 : -1) * std::sqrt(nodes / 2) * amplitude;
    }
  }

  Ring& ring_;
  const SystemParameters& parameters_;
  Rows rows_;
  std::map<Index, std::vector<Kept>> known_;
  std::vector<double> stiffness_;
  std::vector<double> damping_;
  std::vector<double> coupling_;
  Index size_ = 0;
};

SystemParameters in_modes(const SystemParameters& parameters) {
  SystemParameters modal = parameters;
  if (const auto structures = structures_of(parameters).in_modes()) modal.structures = structures;
  return modal;
}

/// The load of a whole ring that turns in each of its harmonics, over the window `wide`, in whose modes it
/// is.
void add_turning_loads(const WholeRing& whole, const SystemParameters& wide, Ring& ring) {
  for (const int order : wide.harmonics) {
    SystemParameters loaded = wide;
    const SystemParameters of_order = in_order(wide, order);
    loaded.force = of_order.force;
    loaded.wave_number = of_order.wave_number;
    if (loaded.force == 0) continue;
    const ContactModes base = whole.turning(loaded).base;
    ring.loads.push_back({order, ComplexVector::Zero(ring.coordinates())});
    for (std::size_t c = 0; c < base.modes().size(); ++c)
      ring.loads.back().amplitude(static_cast<Index>(c)) =
          two_pi * wide.load_turn(order) * base.modes()[c].load;
  }
}

/// The modes at rest of a whole ring that turns, all of them, with their loads.
void fill_turning(const SystemParameters& parameters, const Rows& rows, Ring& ring) {
  const WholeRing& whole = *structures_of(parameters).whole();
  SystemParameters wide = parameters;
  wide.eta_high *= static_cast<double>(highest_order(parameters.harmonics)) / parameters.periods();
  TurningWholeModes all = whole.turning(wide);
  const Index first = std::ssize(all.base.modes());
  const Index size = all.gyroscopic.rows();
  ring.stiffness.resize(size);
  ring.damping.resize(size);
  ring.motion.resize(std::ssize(rows), size);
  ring.base = Matrix::Zero(1, size);
  for (Index c = 0; c < size; ++c) {
    const bool is_base = c < first;
    const ContactModes& part = is_base ? all.base : all.damper;
    const ContactMode& mode = part.modes()[static_cast<std::size_t>(is_base ? c : c - first)];
    if (part.loss().structural != 0)
      throw std::invalid_argument("motion in time needs viscous or modal damping");
    if (mode.is_rigid())
      throw std::invalid_argument("parts that turn have a motion in time where something holds them at rest");
    ring.stiffness(c) = std::pow(two_pi * mode.frequency, 2);
    ring.damping(c) = two_pi * part.loss().part_eta(mode.frequency);
    for (Index i = 0; i < std::ssize(rows); ++i) {
      const Coordinate& row = rows[static_cast<std::size_t>(i)];
      ring.motion(i, c) = two_pi * row.move(is_base) * mode.shape(row.dof).real();
    }
    if (is_base) ring.base(0, c) = two_pi * mode.shape(0).real();
    ring.wave.push_back(0);
    ring.beside.push_back(c);
  }
  ring.gyroscopic = std::move(all.gyroscopic);
  ring.stiffness_speed2 = std::move(all.stiffness_speed2);
  ring.rotation = parameters.rotation;
  add_turning_loads(whole, wide, ring);
}

void add_elements(const Coordinates& coordinates, Ring& ring) {
  for (Index e = 0; e < coordinates.elements(); ++e) {
    const Index first = coordinates.first(e);
    const Coordinate& one = coordinates[first];
    const auto law = ring_law(*one.element, 1);
    if (law == nullptr) continue;
    const Index slides = law->circle() == nullptr ? 1 : 2;
    const auto row = [&](Index which, bool exists) { return exists ? (first + which) * ring.nodes() : -1; };
    ring.elements.push_back({one.element, row(0, true), row(1, slides > 1),
                             row(slides, one.element->coordinates() > slides), one.factor});
  }
}

}  // namespace

Matrix Ring::turned(const Matrix& columns) const {
  Matrix all(columns.rows(), columns.cols());
  const double node = (wave_number < 0 ? -two_pi : two_pi) / static_cast<double>(nodes());
  for (Index c = 0; c < coordinates(); ++c) {
    const auto k = static_cast<std::size_t>(c);
    const double angle = node * static_cast<double>(wave[k]);
    all.row(c) = std::cos(angle) * columns.row(c);
    if (beside[k] != c) all.row(c) += (beside[k] > c ? 1 : -1) * std::sin(angle) * columns.row(beside[k]);
  }
  return all;
}

Matrix Ring::moved_back(const Matrix& rows) const {
  Matrix next(rows.rows(), rows.cols());
  const Index most = nodes() - 1;
  for (Index first = 0; first < rows.rows(); first += nodes()) {
    if (wave_number < 0) {
      next.row(first) = rows.row(first + most);
      next.middleRows(first + 1, most) = rows.middleRows(first, most);
    } else {
      next.middleRows(first, most) = rows.middleRows(first + 1, most);
      next.row(first + most) = rows.row(first);
    }
  }
  return next;
}

Ring build_ring(const SystemParameters& given) {
  const SystemParameters parameters = in_modes(given);
  if (!structures_of(parameters).has_equations())
    throw std::invalid_argument("structures that are known by their responses alone have no motion in time");
  if (parameters.influence && parameters.influence->is_complex())
    throw std::invalid_argument(
        "complex influence coefficients, which are meant at one frequency, have no motion in time");
  if (feels_rotation(parameters) && structures_of(parameters).whole() == nullptr)
    throw std::invalid_argument("structures that turn have a motion in time as whole rings alone");
  if (parameters.one_way)
    throw std::invalid_argument("contacts that do not act back on the base have no motion in time here");
  const bool turns = feels_rotation(parameters);
  const HarmonicSystem system = build_harmonic_system(turns ? given : parameters);
  const Coordinates coordinates(system);
  Rows rows;
  for (Index c = 0; c < coordinates.size(); ++c) rows.push_back(coordinates[c]);
  Ring ring;
  const RingWaves waves = ring_waves(parameters, highest_order(parameters.harmonics));
  ring.node_count = waves.nodes();
  ring.wave_number = waves.wave_number();
  ring.periods = parameters.periods();
  ring.preload_growth = parameters.preload_growth;
  add_elements(coordinates, ring);
  if (turns) {
    fill_turning(parameters, rows, ring);
    return ring;
  }
  Builder builder(ring, parameters, std::move(rows));
  for (Index wave = 0; 2 * wave <= ring.nodes(); ++wave) builder.add_wave(wave, waves.structures(wave));
  builder.finish();
  for (const int order : parameters.harmonics) builder.add_load(order);
  return ring;
}

}  // namespace arcslip
