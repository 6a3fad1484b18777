#include "arcslip/time/ring_tangent.hpp"

#include <algorithm>
#include <cmath>

#include "time/dense_leap.hpp"
#include "time/law_series.hpp"

namespace arcslip {
namespace {

constexpr Index columns_at_once = 16;  // which the processor's caches hold

}  // namespace

void RingTangent::follow(const RingSegment& segment, const RingState& state) {
  if (phase_.empty()) {
    phase_ = state.phase;
    changed_.assign(motion_.families().size(), false);
  }
  if (segment.length == 0) return;
  const bool is_linear = motion_.varying().are_linear();
  if (goes_on_ && is_linear) {  // no phase has changed since
    stretches_.back().length += segment.length;
    return;
  }
  goes_on_ = is_linear;
  Stretch stretch{segment.length,
                  series_order(motion_.fastest_rate() * segment.length),
                  motion_.varying(),
                  waves_.of(motion_.varying().rows),
                  {},
                  {},
                  {}};
  if (!is_linear) stretch.order += segment.position.cols();
  note_memory(stretch);
  note_slopes(segment, stretch);
  for (std::size_t i = 0; i < stretch.forces.circles.size(); ++i) {
    const RingMotion::Family& family = motion_.family(stretch.forces.circles[i].element);
    stretch.slips.push_back(
        SlipTangent::Step::of(motion_.slips()[i], *family.law->circle(), segment.length / segment.scale));
  }
  stretches_.push_back(std::move(stretch));
}

void RingTangent::note_memory(Stretch& stretch) const {
  const VaryingForces& forces = stretch.forces;
  std::vector<Index> place(static_cast<std::size_t>(motion_.ring().motion.rows()), -1);
  for (std::size_t i = 0; i < forces.rows.size(); ++i)
    place[static_cast<std::size_t>(forces.rows[i])] = static_cast<Index>(i);
  std::vector<Index> curved(forces.rows.size(), -1);
  for (std::size_t i = 0; i < forces.curved.size(); ++i)
    curved[static_cast<std::size_t>(forces.curved[i].first)] = static_cast<Index>(i);
  for (Index e = 0; e < motion_.elements(); ++e) {
    const RingBranch& branch = motion_.branch(e);
    const Index here = place[static_cast<std::size_t>(motion_.family(e).sliding + motion_.node(e))];
    if (here < 0) continue;
    for (std::size_t j = 0; j < branch.by_memory.size(); ++j)
      stretch.memory.push_back(
          {here, motion_.memory_place(e, static_cast<Index>(j)), branch.by_memory[j], -1});
    if (branch.origin_memory >= 0)
      stretch.memory.push_back({here, motion_.memory_place(e, branch.origin_memory), -forces.linear(here),
                                curved[static_cast<std::size_t>(here)]});
    if (branch.across == 0) continue;
    const Index across = place[static_cast<std::size_t>(motion_.family(e).across + motion_.node(e))];
    stretch.memory.push_back(
        {across, motion_.memory_place(e, branch.origin_memory + 1), -forces.linear(across), -1});
  }
}

/// Terms of the slopes in the stretch's own length.
void RingTangent::note_slopes(const RingSegment& segment, Stretch& stretch) const {
  const auto& curved = stretch.forces.curved;
  stretch.slopes.resize(std::ssize(curved), stretch.order + 1);
  if (curved.empty()) return;
  std::vector<std::vector<double>> powers;
  for (const auto& [place, of_place] : curved) powers.push_back(of_place);
  LawSeries law(powers, stretch.order + 1);
  Vector x(std::ssize(curved));
  double power = 1;
  for (Index m = 0; m <= stretch.order; ++m, power *= segment.length / segment.scale) {
    for (Index i = 0; i < x.size(); ++i) {
      const Index place = curved[static_cast<std::size_t>(i)].first;
      const Index row = stretch.forces.rows[static_cast<std::size_t>(place)];
      x(i) = m < segment.motion.cols() ? power * segment.motion(row, m) : 0;
      if (m == 0) x(i) -= stretch.forces.origin(place);
    }
    law.take(x);
    stretch.slopes.col(m) = law.slope();
  }
}

void RingTangent::change(Index which, const RingMemoryChanges& memory, const RingState& /*state*/) {
  changed_[static_cast<std::size_t>(which / motion_.ring().nodes())] = true;
  goes_on_ = false;
  for (const RingMemoryChange& one : memory) changes_.push_back({stretches_.size(), which, one});
}

/// What becomes of a number of the memory that displacements move.
Eigen::RowVectorXd RingTangent::memory_row(Index element, const RingMemoryChange& change,
                                           const Matrix& position) const {
  const RingMotion::Family& family = motion_.family(element);
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(position.cols());
  const auto add = [&](Index first, double part) {
    if (part != 0) sum += part * (motion_.ring().motion.row(first + motion_.node(element)) * position);
  };
  add(family.sliding, change.by_sliding);
  add(family.across, change.by_across);
  add(family.closing, change.by_closing);
  return sum;
}

/// Adds what forces that are not linear make of the next term of x, behind those of `motions`.
void RingTangent::take_curved(const Stretch& stretch, const Matrix& x, std::vector<Matrix>& motions,
                              Matrix& local) {
  const auto& curved = stretch.forces.curved;
  const Index m = std::ssize(motions);
  Matrix& moved = motions.emplace_back(std::ssize(curved), x.cols());
  for (Index i = 0; i < moved.rows(); ++i) moved.row(i) = x.row(curved[static_cast<std::size_t>(i)].first);
  for (Index i = 0; i < moved.rows(); ++i) {
    auto row = local.row(curved[static_cast<std::size_t>(i)].first);
    for (Index j = 0; j <= m; ++j)
      row += stretch.slopes(i, m - j) * motions[static_cast<std::size_t>(j)].row(i);
  }
}

namespace {

/// What the linear parts of the forces do to displacements x.
void set_linear_forces(const VaryingForces& forces, const Matrix& x, Matrix& local) {
  local = forces.linear.asDiagonal() * x;
  for (std::size_t i = 0; i < forces.other.size(); ++i) {
    if (forces.other[i] >= 0)
      local.row(static_cast<Index>(i)) += forces.cross(static_cast<Index>(i)) * x.row(forces.other[i]);
  }
}

/// Position and velocity after `steps` of length h of p'' + damping p' + stiffness p = f (D rows each), by
/// those at first and by a constant f, D columns each.
Matrix flow_of(const Matrix& stiffness, const Matrix& damping, double h, int steps, Index order) {
  const Index count = stiffness.rows();
  Matrix state = Matrix::Zero(2 * count, 3 * count);
  state.leftCols(2 * count).setIdentity();
  Matrix push = Matrix::Zero(count, 3 * count);
  push.rightCols(count).setIdentity();
  for (int step = 0; step < steps; ++step) {
    Matrix now = state.topRows(count);
    Matrix next = h * state.bottomRows(count);
    Matrix rate = next;
    state.topRows(count) += next;
    for (Index m = 0; m + 2 <= order; ++m) {
      const auto up = static_cast<double>(m + 1);
      Matrix force = -stiffness * now - (up / h) * (damping * next);
      if (m == 0) force += push;
      now = next;
      next = force * (h * h / (up * (up + 1)));
      state.topRows(count) += next;
      rate += (up + 1) * next;
    }
    state.bottomRows(count) = rate / h;
  }
  return state;
}

}  // namespace

void RingTangent::take(const Stretch& stretch, Columns& columns) const {
  const Ring& ring = motion_.ring();
  const VaryingForces& forces = stretch.forces;
  const double h = stretch.length;
  std::vector<Matrix> motions;  // of those that are not linear, term by term
  std::vector<SlipTangent> slips = slips_of(stretch, columns);
  Matrix now = columns.position;
  Matrix next = h * columns.velocity;
  Matrix rate = next;  // h times the velocity
  Matrix x(std::ssize(forces.rows), now.cols());
  Matrix local;
  Matrix force = Matrix::Zero(now.rows(), now.cols());
  columns.position += next;
  const double* stiff = ring.stiffness.data();
  const double* damped = ring.damping.data();
  const bool is_coupled = motion_.dragged().rows() > 0 || ring.coupling.size() > 0 || ring.turns();
  for (Index m = 0; m + 2 <= stretch.order; ++m) {
    const auto up = static_cast<double>(m + 1);
    if (forces.rows.empty() && is_coupled) force.setZero();
    if (!forces.rows.empty()) {
      waves_.displace(stretch.rows, now, x);
      set_linear_forces(forces, x, local);
      if (m == 0) {
        for (const Remembered& one : stretch.memory) {
          local.row(one.place) += one.coefficient * columns.memory.row(one.number);
          if (one.curved >= 0) x.row(one.place) -= columns.memory.row(one.number);
        }
      }
      if (!forces.curved.empty()) take_curved(stretch, x, motions, local);
      take_slips(stretch, x, slips, local);
      waves_.push(stretch.rows, local, force);
    }
    if (motion_.dragged().rows() > 0)
      force.noalias() += (up / h) * motion_.dragged().transpose() * (motion_.dragged() * next);
    if (ring.coupling.size() > 0) force -= ring.coupled(now);
    if (ring.turns()) {
      force.noalias() += motion_.turned_stiffness() * now;
      force.noalias() += (up / h) * (motion_.turned_damping() * next);
    }
    // now becomes the term after `next`: in one pass through memory.
    const double step = -h * h / (up * (up + 1));
    for (Index c = 0; c < now.cols(); ++c) {
      double* term = &now(0, c);
      const double* before = &next(0, c);
      const double* pushed = &force(0, c);
      double* position = &columns.position(0, c);
      double* velocity = &rate(0, c);
      for (Index i = 0; i < now.rows(); ++i) {
        term[i] = stiff[i] * step * term[i] + damped[i] * (step * up / h) * before[i] + step * pushed[i];
        position[i] += term[i];
        velocity[i] += (up + 1) * term[i];
      }
    }
    now.swap(next);
  }
  columns.velocity = rate / h;
  finish_slips(stretch, slips, columns);
}

/// In one go where that costs less, else by series over parts that these are summed to rounding in.
void RingTangent::take_whole(const Stretch& stretch, Columns& columns) const {
  constexpr double longest = 8;  // over the fastest rate
  const double rate = motion_.fastest_rate();
  if (DenseLeap::pays(motion_, stretch.forces, rate * stretch.length, columns.position.cols())) {
    Matrix constant = Matrix::Zero(std::ssize(stretch.forces.rows), columns.position.cols());
    for (const Remembered& one : stretch.memory)
      constant.row(one.place) += one.coefficient * columns.memory.row(one.number);
    return DenseLeap(motion_, stretch.forces, stretch.length)
        .take(constant, columns.position, columns.velocity);
  }
  const bool is_linear = stretch.forces.are_linear();
  const double parts = is_linear ? std::ceil(stretch.length * rate / longest - 1e-9) : 1;
  Stretch one = stretch;
  one.length /= parts;
  if (is_linear) one.order = series_order(rate * one.length);
  for (Index first = 0; first < columns.position.cols(); first += columns_at_once) {
    const Index count = std::min(columns_at_once, columns.position.cols() - first);
    Columns some{columns.position.middleCols(first, count), columns.velocity.middleCols(first, count),
                 columns.memory.middleCols(first, count)};
    for (int part = 0; part < static_cast<int>(parts); ++part) take(one, some);
    columns.position.middleCols(first, count) = some.position;
    columns.velocity.middleCols(first, count) = some.velocity;
    if (!stretch.slips.empty()) columns.memory.middleCols(first, count) = some.memory;
  }
}

void RingTangent::take_all(Columns& columns) const {
  auto change = changes_.begin();
  for (std::size_t k = 0; k <= stretches_.size(); ++k) {
    for (; change != changes_.end() && change->after == k; ++change) {
      columns.memory.row(motion_.memory_place(change->element, change->memory.number)) =
          memory_row(change->element, change->memory, columns.position);
    }
    if (k < stretches_.size()) take_whole(stretches_[k], columns);
  }
}

/// Whether all elements of a kind are and stay in one phase, with linear forces: then waves do not mix.
bool RingTangent::is_uniform() const {
  if (std::find(changed_.begin(), changed_.end(), true) != changed_.end()) return false;
  const auto nodes = static_cast<std::size_t>(motion_.ring().nodes());
  for (std::size_t e = 0; e < phase_.size(); ++e) {
    if (phase_[e] != phase_[e / nodes * nodes]) return false;
  }
  return std::all_of(stretches_.begin(), stretches_.end(), [](const Stretch& one) {
    return one.forces.are_linear() &&
           std::all_of(one.memory.begin(), one.memory.end(), [&](const auto& number) {
             return number.coefficient == -one.forces.linear(number.place);
           });
  });
}

/// The derivative where waves do not mix.
Matrix RingTangent::wave_by_wave() const {
  const Ring& ring = motion_.ring();
  const Index all = ring.coordinates();
  const Index size = 2 * all + motion_.memories();
  Matrix derivative = Matrix::Zero(size, size);
  derivative.bottomRightCorner(motion_.memories(), motion_.memories()).setIdentity();
  const Stretch& one = stretches_.front();
  double length = 0;
  for (const Stretch& stretch : stretches_) length += stretch.length;
  const auto steps = static_cast<int>(std::ceil(motion_.fastest_rate() * length / 4));
  const double h = length / steps;
  const Index order = series_order(motion_.fastest_rate() * h);
  for (Index wave = 0; 2 * wave <= ring.nodes(); ++wave) {
    std::vector<Index> which;
    for (Index c = 0; c < all; ++c) {
      if (ring.wave[static_cast<std::size_t>(c)] == wave) which.push_back(c);
    }
    const Index count = std::ssize(which);
    if (count == 0) continue;
    const Matrix rows = one.forces.motion(Eigen::all, which);
    Matrix gains;
    set_linear_forces(one.forces, rows, gains);
    Matrix stiffness = rows.transpose() * gains;
    stiffness.diagonal() += ring.stiffness(which);
    for (Index c = 0; c < count && ring.coupling.size() > 0; ++c) {
      const auto beside =
          std::find(which.begin(), which.end(), ring.beside[static_cast<std::size_t>(which[c])]);
      stiffness(c, beside - which.begin()) -= ring.coupling(which[c]);
    }
    const Matrix dragged = motion_.dragged()(Eigen::all, which);
    Matrix damping = dragged.transpose() * dragged;
    damping.diagonal() += ring.damping(which);
    if (ring.turns()) {
      stiffness += motion_.turned_stiffness()(which, which);
      damping += motion_.turned_damping()(which, which);
    }
    const Matrix state = flow_of(stiffness, damping, h, steps, order);
    Matrix of_memory = Matrix::Zero(count, motion_.memories());
    for (const Remembered& number : one.memory)
      of_memory.col(number.number) -= number.coefficient * rows.row(number.place).transpose();
    const Matrix by_memory = state.rightCols(count) * of_memory;
    for (Index i = 0; i < count; ++i) {
      for (Index k = 0; k < count; ++k) {
        derivative(which[i], which[k]) = state(i, k);
        derivative(which[i], all + which[k]) = state(i, count + k);
        derivative(all + which[i], which[k]) = state(count + i, k);
        derivative(all + which[i], all + which[k]) = state(count + i, count + k);
      }
      derivative.row(which[i]).tail(motion_.memories()) = by_memory.row(i);
      derivative.row(all + which[i]).tail(motion_.memories()) = by_memory.row(count + i);
    }
  }
  return derivative;
}

/// Rows of memory that the phases at the end do not need; it follows the displacements.
void RingTangent::add_idle(const RingState& state, Matrix& all) const {
  const Index coordinates = motion_.ring().coordinates();
  for (Index e = 0; e < motion_.elements(); ++e) {
    const RingMotion::Family& family = motion_.family(e);
    const int phase = state.phase[static_cast<std::size_t>(e)];
    for (Index j = 0; j < family.law->memories(); ++j) {
      if (family.law->needs(phase, j)) continue;
      std::vector<double> memory = motion_.memory_of(e, state);
      const RingMemoryChange change =
          family.law->idle(phase, motion_.place_of(e, state.position, state.velocity), j, memory);
      all.row(2 * coordinates + motion_.memory_place(e, j)) = memory_row(e, change, all.topRows(coordinates));
    }
  }
}

Matrix RingTangent::at(const RingState& state) const {
  const Index coordinates = motion_.ring().coordinates();
  const Index size = 2 * coordinates + motion_.memories();
  Matrix all(size, size);
  if (is_uniform()) {
    all = wave_by_wave();
  } else {
    const Matrix unit = Matrix::Identity(size, size);
    Columns columns{unit.topRows(coordinates), unit.middleRows(coordinates, coordinates),
                    unit.bottomRows(motion_.memories())};
    take_all(columns);
    all << columns.position, columns.velocity, columns.memory;
  }
  add_idle(state, all);
  for (Index e = 0; e < motion_.elements(); ++e) {
    for (Index j = 0; j < motion_.family(e).law->memories(); ++j) {
      if (!motion_.family(e).law->needs(phase_[static_cast<std::size_t>(e)], j))
        all.col(2 * coordinates + motion_.memory_place(e, j)).setZero();
    }
  }
  return all;
}

std::vector<bool> RingTangent::moved() const {
  std::vector<bool> moved = changed_;
  for (Index e = 0; e < motion_.elements(); ++e) {
    const RingLaw& law = *motion_.family(e).law;
    const int phase = phase_[static_cast<std::size_t>(e)];
    for (Index j = 0; j < law.memories(); ++j) {
      if (!law.needs(phase, j) || law.flows(phase))
        moved[static_cast<std::size_t>(e / motion_.ring().nodes())] = true;
    }
  }
  return moved;
}

}  // namespace arcslip
