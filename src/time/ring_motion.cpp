#include "arcslip/time/ring_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "time/law_series.hpp"

namespace arcslip {
namespace {

// Of a step, in units of the fastest rate. The terms of the fastest mode reach 8^8/8! = 416 times its
// amplitude, which loses three digits of that amplitude, and no digit of the displacements.
constexpr double reach = 8;
constexpr double steps_per_period = 64;  // at least, so that quadrature resolves high harmonics
constexpr double negligible = 1e-18;

/// A bound on the largest eigenvalue of X X^T.
double bound_of(const Matrix& rows) {
  return (rows * rows.transpose()).cwiseAbs().rowwise().sum().maxCoeff();
}

}  // namespace

Matrix VaryingForces::gain() const {
  Matrix gain = linear.asDiagonal();
  for (Index i = 0; i < gain.rows(); ++i) {
    if (const Index beside = other[static_cast<std::size_t>(i)]; beside >= 0) gain(i, beside) += cross(i);
  }
  return gain;
}

Vector RingSegment::value(const Matrix& series, double ratio) {
  Vector sum = series.col(series.cols() - 1);
  for (Index m = series.cols() - 2; m >= 0; --m) sum = sum * ratio + series.col(m);
  return sum;
}

Vector RingSegment::rate(const Matrix& series, double ratio) const {
  const Index order = series.cols() - 1;
  Vector sum = static_cast<double>(order) * series.col(order);
  for (Index m = order - 1; m >= 1; --m) sum = sum * ratio + static_cast<double>(m) * series.col(m);
  return sum / scale;
}

Index series_order(double reach_of_step) {
  double term = 1;
  Index order = 3;
  for (Index m = 1; term > 1e-19 || m <= order; ++m) {
    term *= reach_of_step / static_cast<double>(m);
    if (term > 1e-19) order = std::max(order, m + 1);
  }
  return order;
}

RingMotion::RingMotion(const Ring& ring, double eta, double preload)
    : ring_(ring),
      frequency_(two_pi * eta / ring.periods),
      period_(ring.periods / eta),
      load_(preload + ring.preload_growth * eta * eta),
      fastest_load_(frequency_),
      sizes_(ring.motion.cwiseAbs()) {
  if (!(eta > 0)) throw std::invalid_argument("RingMotion: eta must be positive");
  if (!(load_ > 0)) throw std::invalid_argument("RingMotion: the contact must be loaded");
  const Index nodes = ring_.nodes();
  double springs = 0;
  dragged_.resize(0, ring_.coordinates());
  for (const RingElements& one : ring_.elements) {
    std::shared_ptr<const RingLaw> law = ring_law(*one.element, load_);
    double bound = bound_of(ring_.motion.middleRows(one.sliding, nodes));
    for (const Index more : {one.across, one.closing}) {
      if (more >= 0) bound += bound_of(ring_.motion.middleRows(more, nodes));
    }
    springs += std::abs(one.factor) * law->steepest() * bound;
    if (const double viscous = one.factor * law->viscous(); viscous != 0) {
      dragged_.conservativeResize(dragged_.rows() + nodes, Eigen::NoChange);
      dragged_.bottomRows(nodes) = std::sqrt(viscous) * ring_.motion.middleRows(one.sliding, nodes);
    }
    families_.push_back({law, one.sliding, one.across, one.closing, memories_, one.factor});
    memories_ += law->memories() * nodes;
  }
  double drag = dragged_.rows() > 0 ? bound_of(dragged_) : 0;
  if (ring_.turns()) {
    const double speed = two_pi * ring_.rotation.at(eta);
    turned_damping_ = speed * ring_.gyroscopic;
    turned_stiffness_ = speed * speed * ring_.stiffness_speed2;
    drag += turned_damping_.cwiseAbs().rowwise().sum().maxCoeff();
    springs += turned_stiffness_.cwiseAbs().rowwise().sum().maxCoeff();
  }
  const double half = (ring_.damping.cwiseAbs().maxCoeff() + drag) / 2;
  const double coupled = ring_.coupling.size() > 0 ? ring_.coupling.cwiseAbs().maxCoeff() : 0;
  rate_ = half + std::sqrt(half * half + ring_.stiffness.maxCoeff() + coupled + springs);
  longest_step_ = std::min(reach / rate_, period_ / steps_per_period);
  for (const RingLoad& one : ring_.loads) fastest_load_ = std::max(fastest_load_, one.order * frequency_);
  branches_.resize(static_cast<std::size_t>(elements()));
  events_.resize(static_cast<std::size_t>(elements()));
}

std::vector<double> RingMotion::memory_of(Index which, const RingState& state) const {
  std::vector<double> memory(static_cast<std::size_t>(family(which).law->memories()));
  for (std::size_t j = 0; j < memory.size(); ++j)
    memory[j] = state.memory(memory_place(which, static_cast<Index>(j)));
  return memory;
}

RingPlace RingMotion::place_of(Index which, const Vector& position, const Vector& velocity) const {
  const auto at = [&](Index first, double& value, double& rate) {
    if (first < 0) return;
    const auto row = ring_.motion.row(first + node(which));
    value = row.dot(position);
    rate = row.dot(velocity);
  };
  RingPlace place{};
  at(family(which).sliding, place.x, place.x_rate);
  at(family(which).across, place.y, place.y_rate);
  at(family(which).closing, place.g, place.g_rate);
  return place;
}

void RingMotion::refresh(Index which, const RingState& state) {
  const auto e = static_cast<std::size_t>(which);
  const std::vector<double> memory = memory_of(which, state);
  const double factor = family(which).factor;
  RingBranch& branch = branches_[e];
  branch = family(which).law->branch(state.phase[e], memory);
  for (auto* terms : {&branch.powers, &branch.by_memory}) {
    for (double& term : *terms) term *= factor;
  }
  for (double* term : {&branch.offset, &branch.across, &branch.by_closing, &branch.closing_stiffness,
                       &branch.closing_offset})
    *term *= factor;
  family(which).law->events(state.phase[e], memory, events_[e]);
}

void RingMotion::refresh_all(const RingState& state) {
  for (Index e = 0; e < elements(); ++e) refresh(e, state);
  gather();
}

Index RingMotion::add_row(Index row) {
  Index& place = places_[static_cast<std::size_t>(row)];
  if (place >= 0) return place;
  place = std::ssize(varying_.rows);
  varying_.rows.push_back(row);
  return place;
}

/// The forces that vary, and the others.
void RingMotion::gather() {
  places_.assign(static_cast<std::size_t>(ring_.motion.rows()), -1);
  offset_.setZero(ring_.motion.rows());
  varying_.rows.clear();
  varying_.curved.clear();
  varying_.circles.clear();
  for (Index e = 0; e < elements(); ++e) {
    const RingBranch& one = branch(e);
    const Index sliding = family(e).sliding + node(e);
    const Index across = family(e).across + node(e);
    const Index closing = family(e).closing + node(e);
    const bool closes = family(e).closing >= 0;
    offset_(sliding) += one.offset;
    if (!one.powers.empty() || one.by_closing != 0) add_row(sliding);
    if (one.across != 0) add_row(across);
    if (one.slips_round)
      varying_.circles.push_back({e, add_row(sliding), add_row(across), closes ? add_row(closing) : -1});
    if (!closes) continue;
    offset_(closing) += one.closing_offset;
    if (one.by_closing != 0 || one.closing_stiffness != 0) add_row(closing);
  }
  const Index count = std::ssize(varying_.rows);
  varying_.motion = ring_.motion(varying_.rows, Eigen::all);
  varying_.linear.setZero(count);
  varying_.origin.setZero(count);
  varying_.other.assign(static_cast<std::size_t>(count), -1);
  varying_.cross.setZero(count);
  for (Index e = 0; e < elements(); ++e) {
    const RingBranch& one = branch(e);
    const Index place = places_[static_cast<std::size_t>(family(e).sliding + node(e))];
    if (place >= 0) {
      varying_.origin(place) = one.origin;
      if (one.powers.size() == 1) varying_.linear(place) = one.powers[0];
      if (one.powers.size() > 1) varying_.curved.emplace_back(place, one.powers);
    }
    if (one.across != 0) {
      const Index across = places_[static_cast<std::size_t>(family(e).across + node(e))];
      varying_.linear(across) = one.across;
      varying_.origin(across) = one.across_origin;
    }
    if (family(e).closing < 0) continue;
    const Index closing = places_[static_cast<std::size_t>(family(e).closing + node(e))];
    if (closing < 0) continue;
    varying_.linear(closing) = one.closing_stiffness;
    if (place < 0) continue;
    varying_.other[static_cast<std::size_t>(place)] = closing;
    varying_.cross(place) = one.by_closing;
  }
}

Vector RingMotion::forces(const RingSegment& segment, double ratio, const Vector& x,
                          const Vector& rate) const {
  Vector all = offset_;
  if (!varying_.circles.empty()) {
    const Vector slip = RingSegment::value(segment.slip, ratio);
    for (std::size_t i = 0; i < varying_.circles.size(); ++i) {
      const VaryingForces::Circle& circle = varying_.circles[i];
      all(varying_.rows[static_cast<std::size_t>(circle.x)]) += slip(2 * static_cast<Index>(i));
      all(varying_.rows[static_cast<std::size_t>(circle.y)]) += slip(2 * static_cast<Index>(i) + 1);
    }
  }
  for (Index e = 0; e < elements(); ++e) {
    const RingBranch& one = branch(e);
    const Index sliding = family(e).sliding + node(e);
    all(sliding) += family(e).factor * family(e).law->viscous() * rate(sliding);
    double sum = 0;
    for (std::size_t k = one.powers.size(); k-- > 0;) sum = (sum + one.powers[k]) * (x(sliding) - one.origin);
    all(sliding) += sum;
    if (one.across != 0) {
      const Index across = family(e).across + node(e);
      all(across) += one.across * (x(across) - one.across_origin);
    }
    if (family(e).closing < 0) continue;
    const Index closing = family(e).closing + node(e);
    all(sliding) += one.by_closing * x(closing);
    all(closing) += one.closing_stiffness * x(closing);
  }
  return all;
}

/// Forces of the order m, where x has that order of the displacements that vary.
void RingMotion::vary(Index m, const Vector& x, LawSeries& laws, Vector& local) {
  local = varying_.linear.cwiseProduct(x);
  for (Index i = 0; i < x.size(); ++i) {
    const Index other = varying_.other[static_cast<std::size_t>(i)];
    if (other >= 0) local(i) += varying_.cross(i) * x(other);
  }
  if (varying_.are_linear()) return;
  Vector curved(std::ssize(varying_.curved));
  for (Index i = 0; i < curved.size(); ++i) curved(i) = x(varying_.curved[static_cast<std::size_t>(i)].first);
  laws.take(curved);
  curved = laws.force();
  for (Index i = 0; i < curved.size(); ++i)
    local(varying_.curved[static_cast<std::size_t>(i)].first) += curved(i);
  take_slips(m, x, local);
}

/// Whether the series of a step of this length is summed to rounding, as that of a linear ring always is.
bool RingMotion::expands(const RingState& state, double length) {
  const bool is_linear = varying_.are_linear();
  const Index order = series_order(rate_ * length + fastest_load_ * length) + (is_linear ? 0 : 10);
  std::vector<std::vector<double>> powers;
  for (const auto& [place, of_place] : varying_.curved) powers.push_back(of_place);
  LawSeries laws(powers, order);
  begin_slips(state, order);
  segment_.start = state.time;
  segment_.scale = length;
  segment_.length = length;
  Matrix& p = segment_.position;
  p.resize(ring_.coordinates(), order + 1);
  p.col(0) = state.position;
  p.col(1) = length * state.velocity;
  phases_.clear();  // (jwh)^m/m! e^{jwt} of each frequency w of the load
  for (const RingLoad& load : ring_.loads)
    phases_.push_back(std::polar(1.0, load.order * frequency_ * state.time));
  Vector forces(ring_.coordinates());
  Vector x(varying_.linear.size());
  Vector local(x.size());
  double largest = 0;
  Index needed = order;
  bool is_summed = is_linear;
  for (Index m = 0; m + 2 <= order; ++m) {
    const auto next = static_cast<double>(m + 1);
    forces =
        -ring_.stiffness.cwiseProduct(p.col(m)) - (next / length) * ring_.damping.cwiseProduct(p.col(m + 1));
    if (ring_.coupling.size() > 0) forces += ring_.coupled(p.col(m));
    if (ring_.turns())
      forces.noalias() -= turned_stiffness_ * p.col(m) + (next / length) * (turned_damping_ * p.col(m + 1));
    for (std::size_t h = 0; h < phases_.size(); ++h) {
      const RingLoad& load = ring_.loads[h];
      if (load.order > 0 || m == 0)
        forces += load.amplitude.real() * phases_[h].real() - load.amplitude.imag() * phases_[h].imag();
      phases_[h] *= Complex(0, load.order * frequency_ * length / next);
    }
    if (x.size() > 0) {
      x.noalias() = varying_.motion * p.col(m);
      if (m == 0) x -= varying_.origin;
      vary(m, x, laws, local);
      forces.noalias() -= varying_.motion.transpose() * local;
    }
    if (dragged_.rows() > 0)
      forces.noalias() -= (next / length) * dragged_.transpose() * (dragged_ * p.col(m + 1));
    if (m == 0) forces.noalias() -= ring_.motion.transpose() * offset_;
    p.col(m + 2) = forces * (length * length / (next * (next + 1)));
    const double size = p.middleCols(m + 1, 2).cwiseAbs().maxCoeff();
    largest = std::max(largest, size);
    if (next * size > negligible * largest || next < fastest_load_ * length || !slips_end()) continue;
    needed = m + 2;
    is_summed = true;
    break;
  }
  p.conservativeResize(Eigen::NoChange, needed + 1);
  segment_.slip.conservativeResize(Eigen::NoChange, needed + 1);
  segment_.motion.noalias() = ring_.motion * p;
  return is_summed && p.allFinite();
}

/// Gives memory that no phase needs the value that belongs to it.
void RingMotion::leave_idle(RingState& state) const {
  for (Index e = 0; e < elements(); ++e) {
    const RingLaw& law = *family(e).law;
    const int phase = state.phase[static_cast<std::size_t>(e)];
    for (Index j = 0; j < law.memories(); ++j) {
      if (law.needs(phase, j)) continue;
      std::vector<double> memory = memory_of(e, state);
      law.idle(phase, place_of(e, state.position, state.velocity), j, memory);
      state.memory(memory_place(e, j)) = memory[static_cast<std::size_t>(j)];
    }
  }
}

void RingMotion::advance(RingState& state, double duration, RingObserver* observer) {
  const double start = state.time;
  double elapsed = 0;
  double longest = longest_step_;
  Index at_once = 0;
  refresh_all(state);
  while (duration - elapsed > 1e-15 * period_) {
    const double wanted = std::min(longest, duration - elapsed);
    double length = wanted;
    while (!expands(state, length)) {
      length *= 0.5;
      if (length < 1e-14 * period_) throw std::runtime_error("the motion in time grows without bound");
    }
    longest = length < wanted ? 2 * length : std::min(longest_step_, 4 * longest);
    ++count_.steps;
    const std::vector<Crossing>& crossings = first_crossings(state);
    const double ratio = crossings.empty() ? 1 : crossings.front().ratio;
    segment_.length = ratio * segment_.scale;
    if (observer != nullptr) observer->follow(segment_, state);
    state.position = RingSegment::value(segment_.position, ratio);
    state.velocity = segment_.rate(segment_.position, ratio);
    move_sliders(ratio, state);
    elapsed += segment_.length;
    state.time = start + elapsed;
    at_once = ratio > 0 ? 0 : at_once + 1;
    if (at_once > 4 * elements()) throw std::runtime_error("RingMotion: elements change without end");
    take_events(state, observer);
  }
  leave_idle(state);
}

double RingMotion::energy(const RingState& state) const {
  const double turned = ring_.turns() ? state.position.dot(turned_stiffness_ * state.position) : 0;
  return 0.5 * (state.velocity.squaredNorm() + ring_.stiffness.dot(state.position.cwiseAbs2()) + turned);
}

}  // namespace arcslip
