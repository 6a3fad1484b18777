#include "arcslip/time/ring.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/assembly/reduced_pair.hpp"

namespace arcslip {
namespace {

// The lowest stiffness of a ring of beams is some N^-4 of the largest: long double keeps it to rounding.
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// Modes of one structure, scaled to unit modal mass; the first one is its rigid motion.
struct Modes {
  LongVector stiffness;
  LongMatrix shapes;  ///< dofs x modes
  LongMatrix turn;    ///< modes x modes
  long double mass;   ///< of the whole structure
};

LongMatrix assemble(const PreciseMatrix& element, Index nodes) {
  const Index dofs = element.rows() / 2;  // of one node
  const LongMatrix block = element.cast<long double>();
  LongMatrix whole = LongMatrix::Zero(nodes * dofs, nodes * dofs);
  for (Index i = 0; i < nodes; ++i) {
    const Index place[] = {i * dofs, (i + 1) % nodes * dofs};
    for (Index a : {0, 1}) {
      for (Index b : {0, 1}) {
        whole.block(place[a], place[b], dofs, dofs) += block.block(a * dofs, b * dofs, dofs, dofs);
      }
    }
  }
  return whole;
}

/// Rows of `whole` moved so that those of node i are the ones of node i + 1.
LongMatrix turned(const LongMatrix& whole, Index dofs) {
  LongMatrix next(whole.rows(), whole.cols());
  next.topRows(whole.rows() - dofs) = whole.bottomRows(whole.rows() - dofs);
  next.bottomRows(dofs) = whole.topRows(dofs);
  return next;
}

Modes modes_of(const ChainElement& element, Index nodes) {
  const Index dofs = element.mass.rows() / 2;
  const LongMatrix mass = assemble(element.mass, nodes);
  const Eigen::GeneralizedSelfAdjointEigenSolver<LongMatrix> solver(assemble(element.stiffness, nodes), mass);
  Modes modes{solver.eigenvalues(), solver.eigenvectors(), {}, 0};
  LongVector rigid = LongVector::Zero(mass.rows());
  for (Index i = 0; i < nodes; ++i) rigid(i * dofs) = 1;
  modes.mass = rigid.dot(mass * rigid);
  modes.stiffness(0) = 0;
  modes.shapes.col(0) = rigid / std::sqrt(modes.mass);
  modes.turn = modes.shapes.transpose() * mass * turned(modes.shapes, dofs);
  return modes;
}

/// Every J-th row: the contact dofs.
Matrix at_contacts(const LongMatrix& shapes, Index nodes) {
  const Index dofs = shapes.rows() / nodes;
  Matrix rows(nodes, shapes.cols());
  for (Index i = 0; i < nodes; ++i) rows.row(i) = shapes.row(i * dofs).cast<double>();
  return rows;
}

/// F of all nodes for the load of node 1.
ComplexVector travelling(const PreciseComplexVector& first, Index wave_number, Index nodes) {
  const Index dofs = first.size();
  ComplexVector load(nodes * dofs);
  for (Index i = 0; i < nodes; ++i) {
    const double lag = two_pi * static_cast<double>(wave_number * i % nodes) / static_cast<double>(nodes);
    for (Index d = 0; d < dofs; ++d) {
      const Complex at_first(static_cast<double>(first(d).real()), static_cast<double>(first(d).imag()));
      load(i * dofs + d) = at_first * std::polar(1.0, -lag);
    }
  }
  return load;
}

void refuse_what_is_not_viscous(const SystemParameters& parameters) {
  if (parameters.structures) {
    throw std::invalid_argument("build_ring: rods or beams are needed");
  }
  if (parameters.base_damping_kind != DampingKind::viscous) {
    throw std::invalid_argument("build_ring: motion in time needs viscous damping, not " +
                                to_string(parameters.base_damping_kind));
  }
}

/// The load's harmonics on the base's modes.
std::vector<RingLoad> loads_on(const SystemParameters& parameters, const Modes& modes) {
  const Index nodes = parameters.elements;
  std::vector<RingLoad> loads;
  for (const int h : parameters.harmonics) {
    SystemParameters wave = parameters;
    wave.wave_number = h * parameters.wave_number % nodes;
    wave.force = parameters.force * parameters.excitation.share(h);
    if (wave.force == 0) continue;
    if (wave.wave_number == 0)
      throw std::invalid_argument("build_ring: a harmonic of the load that pushes all nodes alike");
    loads.push_back({h, modes.shapes.cast<double>().transpose() *
                            travelling(reduce(wave).base.load, wave.wave_number, nodes)});
    loads.back().amplitude(0) = 0;  // a travelling load has no mean
  }
  return loads;
}

/// The base's modes: all there is where the damper is held.
Ring ring_of_base(const SystemParameters& parameters, const Modes& modes) {
  const Index nodes = parameters.elements;
  Ring ring;
  ring.stiffness = modes.stiffness.cast<double>();
  ring.damping = base_damping_factor(parameters) / (two_pi)*ring.stiffness;
  ring.loads = loads_on(parameters, modes);
  ring.base = at_contacts(modes.shapes, nodes);
  ring.damper = Matrix::Zero(nodes, ring.base.cols());
  ring.turn = modes.turn.cast<double>();
  ring.wave_number = parameters.wave_number;
  ring.contact_stiffness = parameters.interface_stiffness / static_cast<double>(nodes);
  ring.slip_per_preload = parameters.stiffness_ratio() / parameters.interface_stiffness;
  ring.preload_growth = parameters.preload_growth;
  return ring;
}

/// Adds the damper's modes. The two rigid motions become the one of base against damper, the first
/// coordinate.
void join_damper(Ring& ring, const Modes& base, const Modes& damper, double damping_factor) {
  const Index nodes = ring.base.rows();
  const Index own = ring.base.cols();
  const Index elastic = damper.shapes.cols() - 1;
  const Index all = own + elastic;
  const auto ratio = static_cast<double>(std::sqrt(damper.mass / base.mass));
  const auto scale = static_cast<double>(1 / std::sqrt(damper.mass + base.mass));

  ring.stiffness.conservativeResize(all);
  ring.stiffness.tail(elastic) = damper.stiffness.tail(elastic).cast<double>();
  ring.damping.conservativeResize(all);
  ring.damping.tail(elastic) = damping_factor / (two_pi)*ring.stiffness.tail(elastic);
  for (RingLoad& load : ring.loads) {
    load.amplitude.conservativeResize(all);
    load.amplitude.tail(elastic).setZero();
  }
  ring.base.conservativeResize(nodes, all);
  ring.base.rightCols(elastic).setZero();
  ring.base.col(0).setConstant(-ratio * scale);
  ring.damper = Matrix::Zero(nodes, all);
  ring.damper.rightCols(elastic) = at_contacts(damper.shapes, nodes).rightCols(elastic);
  ring.damper.col(0).setConstant(scale / ratio);
  Matrix turn = Matrix::Zero(all, all);
  turn.topLeftCorner(own, own) = ring.turn;
  turn.bottomRightCorner(elastic, elastic) = damper.turn.bottomRightCorner(elastic, elastic).cast<double>();
  ring.turn = turn;
}

/// The same where elements hold base or damper to ground: the damper's rigid motion is by itself, the first
/// coordinate, before that of the base.
void join_free_damper(Ring& ring, const Modes& damper, double damping_factor) {
  const Index own = ring.base.cols();
  const Index nodes = ring.base.rows();
  const Index elastic = damper.shapes.cols() - 1;
  const auto joined = [&](const auto& rigid, const auto& of_base, const auto& of_damper, auto& all) {
    auto sum = all;
    sum.resize(1 + own + elastic);
    sum << rigid, of_base, of_damper;
    all = sum;
  };
  const Vector stiffness = damper.stiffness.tail(elastic).cast<double>();
  joined(0.0, ring.stiffness, stiffness, ring.stiffness);
  joined(0.0, ring.damping, Vector(damping_factor / (two_pi)*stiffness), ring.damping);
  for (RingLoad& load : ring.loads)
    joined(Complex(0), load.amplitude, ComplexVector::Zero(elastic).eval(), load.amplitude);
  const Matrix shapes = at_contacts(damper.shapes, nodes);
  const Matrix base = ring.base;
  ring.base = Matrix::Zero(nodes, 1 + own + elastic);
  ring.base.middleCols(1, own) = base;
  ring.damper = Matrix::Zero(nodes, 1 + own + elastic);
  ring.damper.col(0) = shapes.col(0);
  ring.damper.rightCols(elastic) = shapes.rightCols(elastic);
  Matrix turn = Matrix::Zero(1 + own + elastic, 1 + own + elastic);
  turn(0, 0) = 1;
  turn.block(1, 1, own, own) = ring.turn;
  turn.bottomRightCorner(elastic, elastic) = damper.turn.bottomRightCorner(elastic, elastic).cast<double>();
  ring.turn = turn;
}

/// The elements beside the contacts, and the drift that they leave.
void add_others(Ring& ring, const std::vector<Coordinate>& others, bool is_free) {
  bool holds_base = false;
  bool holds_damper = false;
  for (const Coordinate& one : others) {
    if (one.element->law() == nullptr)
      throw std::invalid_argument("build_ring: elements beside the contacts must have no memory");
    ring.others.push_back({one.base * ring.base + one.damper * ring.damper, one.element});
    holds_base = holds_base || one.base != 0;
    holds_damper = holds_damper || one.damper != 0;
  }
  if (!is_free) {
    if (!holds_base) ring.drift = 0;
  } else if (!holds_base) {
    ring.drift = holds_damper ? 1 : 0;
  } else if (!holds_damper) {
    ring.drift = 0;
  }
}

}  // namespace

double Ring::fastest_rate() const {
  const double contacts = (relative * relative.transpose()).cwiseAbs().rowwise().sum().maxCoeff();
  double others_stiffness = 0;  // of laws that do not grow with the displacement
  for (const RingElements& other : others) {
    double steepest = 0;
    for (const PiecewiseLaw::Piece& piece : other.law().pieces()) {
      if (piece.coefficients.size() == 2)
        steepest = std::max(steepest, std::abs(piece.coefficients[1].value));
    }
    others_stiffness +=
        steepest * (other.motion * other.motion.transpose()).cwiseAbs().rowwise().sum().maxCoeff();
  }
  const double half = damping.cwiseAbs().maxCoeff() / 2;
  return half +
         std::sqrt(half * half + stiffness.maxCoeff() + contact_stiffness * contacts + others_stiffness);
}

Ring build_ring(const SystemParameters& parameters) {
  refuse_what_is_not_viscous(parameters);
  const Index nodes = parameters.elements;
  const auto make = parameters.model == StructureModel::rods ? rod_element : beam_element;
  const Modes base = modes_of(
      make(parameters.mass_ratio, parameters.stiffness_ratio(), parameters.wave_number, nodes), nodes);
  Ring ring = ring_of_base(parameters, base);
  const std::vector<Coordinate> others = other_coordinates(parameters, [](const Coordinate&) { return 1.0; });
  if (!parameters.fixed_damper) {
    const Modes damper = modes_of(make(1, 1, parameters.wave_number, nodes), nodes);
    const double factor = damper_damping_factor(parameters);
    const bool is_grounded = std::any_of(
        others.begin(), others.end(), [](const Coordinate& one) { return one.base == 0 || one.damper == 0; });
    if (is_grounded) {
      join_free_damper(ring, damper, factor);
    } else {
      join_damper(ring, base, damper, factor);
    }
  }
  ring.relative = ring.damper - ring.base;
  add_others(ring, others, !parameters.fixed_damper);
  return ring;
}

}  // namespace arcslip
