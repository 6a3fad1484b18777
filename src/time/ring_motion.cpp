#include "arcslip/time/ring_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "time/first_crossing.hpp"
#include "time/law_series.hpp"

namespace arcslip {
namespace {

// Of a step, in units of the fastest rate. The terms of the fastest mode reach 8^8/8! = 416 times its
// amplitude, which loses three digits of that amplitude, and no digit of the displacements.
constexpr double reach = 8;
constexpr double steps_per_period = 64;  // at least, so that quadrature resolves high harmonics
constexpr double negligible = 1e-18;
constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();

/// What these rows times the values may be wrong by.
Vector rounding_of(const Matrix& rows, const Vector& values) {
  return rounding * (rows.cwiseAbs() * values.cwiseAbs());
}

std::vector<bool> least_rotation(const std::vector<int>& slip) {
  std::vector<bool> pattern(slip.size());
  std::transform(slip.begin(), slip.end(), pattern.begin(), [](int sign) { return sign == 0; });
  std::vector<bool> least = pattern;
  for (std::size_t i = 1; i < slip.size(); ++i) {
    std::rotate(pattern.begin(), pattern.begin() + 1, pattern.end());
    least = std::min(least, pattern);
  }
  return least;
}

}  // namespace

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

Matrix sticking_rows(const Ring& ring, const std::vector<int>& slip) {
  Matrix rows(std::count(slip.begin(), slip.end(), 0), ring.coordinates());
  Index next = 0;
  for (Index i = 0; i < ring.nodes(); ++i) {
    if (slip[i] == 0) rows.row(next++) = ring.relative.row(i);
  }
  return rows;
}

RingMotion::RingMotion(const Ring& ring, double eta, double preload)
    : ring_(ring),
      frequency_(two_pi * eta),
      period_(1 / eta),
      threshold_((preload + ring.preload_growth * eta * eta) * ring.slip_per_preload),
      rate_(ring.fastest_rate()),
      longest_step_(std::min(reach / rate_, period_ / steps_per_period)) {
  if (!(eta > 0)) throw std::invalid_argument("RingMotion: eta must be positive");
  if (!(threshold_ > 0)) throw std::invalid_argument("RingMotion: the contact must be loaded");
}

RingState RingMotion::at_rest() const {
  const Index nodes = ring_.nodes();
  return {0, Vector::Zero(ring_.coordinates()), Vector::Zero(ring_.coordinates()), Vector::Zero(nodes),
          std::vector<int>(nodes, 0)};
}

RingState RingMotion::travelling(const std::vector<ContactHarmonic>& harmonics) const {
  RingState state = at_rest();
  const Index nodes = ring_.nodes();
  Vector force = Vector::Zero(nodes);
  Vector relative = Vector::Zero(nodes);
  const auto add = [&](int order, const ComplexVector& load) {
    const double w = order * frequency_;
    for (Index c = 0; c < ring_.coordinates(); ++c) {
      const Complex p = load(c) / Complex(ring_.stiffness(c) - w * w, w * ring_.damping(c));
      state.position(c) += p.real();
      state.velocity(c) += (Complex(0, w) * p).real();
    }
  };
  for (const RingLoad& load : ring_.loads) add(load.order, load.amplitude);
  for (const ContactHarmonic& harmonic : harmonics) {
    ComplexVector wave(nodes);
    for (Index i = 0; i < nodes; ++i) {
      const auto turns = static_cast<double>(harmonic.order * ring_.wave_number * i % nodes);
      wave(i) = std::polar(1.0, -two_pi * turns / static_cast<double>(nodes));
    }
    add(harmonic.order, -(ring_.relative.transpose() * wave) * harmonic.friction);
    if (harmonic.base != 0.0) add(harmonic.order, (ring_.base.transpose() * wave) * harmonic.base);
    if (harmonic.damper != 0.0) add(harmonic.order, (ring_.damper.transpose() * wave) * harmonic.damper);
    force += (wave * harmonic.friction).real();
    relative += (wave * harmonic.relative).real();
  }
  const Vector spring = (force / ring_.contact_stiffness).cwiseMin(threshold_).cwiseMax(-threshold_);
  state.slider = relative - spring;
  return state;
}

/// Whether the series of a step of this length is summed to rounding, as that of a linear ring always is.
bool RingMotion::expands(const RingState& state, double length) {
  double fastest = frequency_;  // of the load
  for (const RingLoad& load : ring_.loads) fastest = std::max(fastest, load.order * frequency_);
  const Index order = series_order(rate_ * length + fastest * length) + (ring_.others.empty() ? 0 : 10);
  std::vector<LawSeries> laws;
  for (std::size_t e = 0; e < ring_.others.size(); ++e)
    laws.emplace_back(ring_.others[e].law(), segment_.zones[e], order);
  const Matrix sticking = sticking_rows(ring_, state.slip);
  const double k = ring_.contact_stiffness;
  Vector offset(ring_.nodes());  // contact forces at r = 0
  for (Index i = 0; i < ring_.nodes(); ++i) {
    offset(i) = k * (state.slip[i] == 0 ? -state.slider(i) : state.slip[i] * threshold_);
  }
  segment_.start = state.time;
  segment_.scale = length;
  segment_.length = length;
  Matrix& p = segment_.position;
  p.resize(ring_.coordinates(), order + 1);
  p.col(0) = state.position;
  p.col(1) = length * state.velocity;
  std::vector<Complex> phases;  // (jwh)^m/m! e^{jwt} of each frequency w of the load
  for (const RingLoad& load : ring_.loads)
    phases.push_back(std::polar(1.0, load.order * frequency_ * state.time));
  Vector forces(ring_.coordinates());
  double largest = 0;
  Index needed = order;
  bool is_summed = laws.empty();
  for (Index m = 0; m + 2 <= order; ++m) {
    const auto next = static_cast<double>(m + 1);
    forces.setZero();
    for (std::size_t h = 0; h < phases.size(); ++h) {
      const RingLoad& load = ring_.loads[h];
      forces += load.amplitude.real() * phases[h].real() - load.amplitude.imag() * phases[h].imag();
      phases[h] *= Complex(0, load.order * frequency_ * length / next);
    }
    forces -= ring_.stiffness.cwiseProduct(p.col(m));
    forces -= (next / length) * ring_.damping.cwiseProduct(p.col(m + 1));
    if (sticking.rows() > 0) forces.noalias() -= sticking.transpose() * (k * (sticking * p.col(m)));
    if (m == 0) forces.noalias() -= ring_.relative.transpose() * offset;
    for (std::size_t e = 0; e < laws.size(); ++e) {
      const Matrix& motion = ring_.others[e].motion;
      laws[e].take(motion * p.col(m));
      forces.noalias() -= motion.transpose() * laws[e].force();
    }
    p.col(m + 2) = forces * (length * length / (next * (next + 1)));
    const double size = p.middleCols(m + 1, 2).cwiseAbs().maxCoeff();
    largest = std::max(largest, size);
    if (next * size > negligible * largest || next < fastest * length) continue;
    needed = m + 2;
    is_summed = true;
    break;
  }
  p.conservativeResize(Eigen::NoChange, needed + 1);
  segment_.relative.noalias() = ring_.relative * p;
  for (std::size_t e = 0; e < laws.size(); ++e) segment_.other[e].noalias() = ring_.others[e].motion * p;
  return is_summed;
}

/// By which law the further elements act from here on.
void RingMotion::find_zones(const RingState& state) {
  segment_.other.resize(ring_.others.size());
  segment_.zones.resize(ring_.others.size());
  for (std::size_t e = 0; e < ring_.others.size(); ++e) {
    const Matrix& motion = ring_.others[e].motion;
    segment_.zones[e] = zones_of(ring_.others[e].law(), motion * state.position, motion * state.velocity,
                                 rounding_of(motion, state.position));
  }
}

/// Where displacements leave the zones of their laws by more than the sums may be wrong by.
void RingMotion::add_law_crossings(std::vector<Crossing>& found) const {
  for (std::size_t e = 0; e < ring_.others.size(); ++e) {
    const Matrix& x = segment_.other[e];
    const Vector loose = rounding_of(ring_.others[e].motion, segment_.position.col(0));
    for (Index i = 0; i < ring_.nodes(); ++i) {
      const auto [low, high] = ring_.others[e].law().ends(segment_.zones[e][static_cast<std::size_t>(i)]);
      for (const double sign : {1.0, -1.0}) {
        const double end = sign > 0 ? high : -low;
        if (std::isinf(end)) continue;
        Vector excess = sign * x.row(i).transpose();
        excess(0) -= end + loose(i);
        if (const auto ratio = first_crossing(excess)) found.push_back({ring_.nodes(), *ratio});
      }
    }
  }
}

std::vector<RingMotion::Crossing> RingMotion::first_crossings(const RingState& state) const {
  // What the sums r and r' may be wrong by is no crossing.
  const Vector loose = rounding_of(ring_.relative, state.position);
  const Vector loose_rate = rounding_of(ring_.relative, state.velocity);
  const Matrix& r = segment_.relative;
  const Index order = r.cols() - 1;
  std::vector<Crossing> found;
  const auto look = [&](Index i, const Vector& function) {
    if (const auto ratio = first_crossing(function)) found.push_back({i, *ratio});
  };
  for (Index i = 0; i < ring_.nodes(); ++i) {
    const int slip = state.slip[i];
    if (slip != 0) {
      Vector rate = -slip * r.row(i).tail(order).transpose();
      for (Index m = 1; m < order; ++m) rate(m) *= static_cast<double>(m + 1);
      rate(0) -= segment_.scale * loose_rate(i);
      look(i, rate);
      continue;
    }
    for (const double sign : {1.0, -1.0}) {
      Vector excess = sign * r.row(i).transpose();
      excess(0) -= sign * state.slider(i) + threshold_;
      excess(0) -= loose(i) + rounding * (threshold_ + std::abs(state.slider(i)));
      look(i, excess);
    }
  }
  add_law_crossings(found);
  if (found.empty()) return found;
  const double first = std::min_element(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
                         return a.ratio < b.ratio;
                       })->ratio;
  std::erase_if(found, [&](const Crossing& crossing) { return crossing.ratio > first * (1 + 1e-13); });
  for (Crossing& crossing : found) crossing.ratio = first;
  return found;
}

void RingMotion::change(Index contact, RingState& state) const {
  const double r = ring_.relative.row(contact).dot(state.position);
  int& slip = state.slip[contact];
  if (slip == 0) {
    slip = r > state.slider(contact) ? 1 : -1;
  } else {
    state.slider(contact) = r - slip * threshold_;
    slip = 0;
  }
}

void RingMotion::note(const RingState& state) { count_.patterns.insert(least_rotation(state.slip)); }

void RingMotion::advance(RingState& state, double duration, RingObserver* observer) {
  const double start = state.time;
  double elapsed = 0;
  int at_once = 0;
  note(state);
  while (duration - elapsed > 1e-15 * period_) {
    double length = std::min(longest_step_, duration - elapsed);
    find_zones(state);
    while (!expands(state, length)) length *= 0.5;
    ++count_.steps;
    const std::vector<Crossing> crossings = first_crossings(state);
    const double ratio = crossings.empty() ? 1 : crossings.front().ratio;
    segment_.length = ratio * segment_.scale;
    if (observer) observer->follow(segment_, state);
    state.position = RingSegment::value(segment_.position, ratio);
    state.velocity = segment_.rate(segment_.position, ratio);
    elapsed += segment_.length;
    state.time = start + elapsed;
    at_once = ratio > 0 ? 0 : at_once + 1;
    if (at_once > 4 * ring_.nodes()) throw std::runtime_error("RingMotion: contacts switch without end");
    for (const Crossing& crossing : crossings) {
      if (crossing.contact == ring_.nodes()) continue;
      change(crossing.contact, state);
      ++count_.events;
      if (observer) observer->change(crossing.contact, state);
    }
    if (!crossings.empty()) note(state);
  }
  for (Index i = 0; i < ring_.nodes(); ++i) {
    if (state.slip[i] == 0) continue;
    state.slider(i) = ring_.relative.row(i).dot(state.position) - state.slip[i] * threshold_;
  }
}

double RingMotion::energy(const RingState& state) const {
  double energy = state.velocity.squaredNorm();
  energy += ring_.stiffness.dot(state.position.cwiseAbs2());
  for (Index i = 0; i < ring_.nodes(); ++i) {
    const double spring =
        state.slip[i] == 0 ? ring_.relative.row(i).dot(state.position) - state.slider(i) : threshold_;
    energy += ring_.contact_stiffness * spring * spring;
  }
  energy *= 0.5;
  for (const RingElements& other : ring_.others) {
    for (const double x : Vector(other.motion * state.position)) energy += other.law().energy(x);
  }
  return energy;
}

}  // namespace arcslip
