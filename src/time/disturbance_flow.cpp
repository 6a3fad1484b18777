#include "arcslip/time/disturbance_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/dense.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "arcslip/time/disturbed_wave.hpp"
#include "time/own_velocity.hpp"

namespace arcslip {
namespace {

// On an arc as long as half a period e^{jh theta} needs some h pi/2 points, and 16 more give it to rounding.
Index points_for(int highest) { return 16 + 2 * highest; }

/// Those of the contacts, and 0 for further coordinates.
Vector springs_of(const HarmonicSystem& system) {
  Vector springs = Vector::Zero(std::ssize(system.contacts) + std::ssize(system.others));
  springs.head(std::ssize(system.contacts)) = contact_springs(system.contacts);
  return springs;
}

/// cos(pi i/n) from -1 to 1, i = n .. 0.
Vector chebyshev_points(Index n) {
  Vector x(n + 1);
  for (Index i = 0; i <= n; ++i) x(i) = -std::cos(pi * static_cast<double>(i) / static_cast<double>(n));
  return x;
}

/// Weights of Clenshaw and Curtis.
Vector chebyshev_weights(Index n) {
  Vector weights(n + 1);
  for (Index i = 0; i <= n; ++i) {
    double sum = 1;
    for (Index k = 1; k <= n / 2; ++k) {
      const double b = 2 * k == n ? 1 : 2;
      sum -= b * std::cos(2 * pi * static_cast<double>(k * i) / static_cast<double>(n)) /
             static_cast<double>(4 * k * k - 1);
    }
    weights(i) = (i == 0 || i == n ? 1 : 2) * sum / static_cast<double>(n);
  }
  return weights;
}

/// The diagonal makes constants exact.
Matrix chebyshev_derivative(const Vector& x) {
  const Index n = x.size() - 1;
  Matrix derivative(n + 1, n + 1);
  for (Index i = 0; i <= n; ++i) {
    for (Index k = 0; k <= n; ++k) {
      if (i == k) continue;
      const double ends = (i == 0 || i == n ? 2.0 : 1.0) / (k == 0 || k == n ? 2.0 : 1.0);
      derivative(i, k) = ((i + k) % 2 == 0 ? 1 : -1) * ends / (x(i) - x(k));
    }
    derivative(i, i) = 0;
    derivative(i, i) = -derivative.row(i).sum();
  }
  return derivative;
}

}  // namespace

/// The flow of (p, v, x), v = (sigma + jh eta) p/scale, real and imaginary parts apart.
struct DisturbanceFlow::Flow {
  ComplexMatrix relative;  ///< rho_h of contact i in row i * orders + a, by state
  ComplexMatrix force;     ///< k f_h likewise
  Matrix matrix;
};

DisturbanceFlow::DisturbanceFlow(const HarmonicSystem& system, int highest)
    : orders_(system.orders), springs_(springs_of(system)), contacts_(std::ssize(system.contacts)) {
  check(system);
  double slowest = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < orders_.size(); ++a)
    slowest = std::min(slowest, slowest_rate(system.base[a], system.damper[a]));
  for (std::size_t a = 0; a < orders_.size(); ++a) {
    for (Oscillator& mode :
         oscillators(system.base[a], system.damper[a], slowest, orders_[a] == 0, system.others)) {
      coordinates_.push_back({std::move(mode), static_cast<Index>(a), modal_states_});
      modal_states_ += 2 * parts(static_cast<Index>(a));
    }
  }
  const Index n = points_for(std::max(highest_order(orders_), highest));
  places_ = chebyshev_points(n);
  weights_ = chebyshev_weights(n);
  derivative_ = chebyshev_derivative(places_);
}

/// Friction of a contact that slips, by the disturbances of its motion and of its slider.
void DisturbanceFlow::add_sliders(double eta, Index contact, const StickPattern& pattern, Index first,
                                  Flow& flow) const {
  const Index orders = std::ssize(orders_);
  const Index inner = places_.size() - 1;
  Index slider = first;
  for (const HysteresisLoop::Arc& arc : pattern.arcs) {
    Matrix cosines(inner + 1, orders);  // of h theta
    Matrix sines(inner + 1, orders);
    for (Index i = 0; i <= inner; ++i) {
      const double theta = arc.begin + 0.5 * arc.width * (1 + places_(i));
      for (Index a = 0; a < orders; ++a) {
        const Complex wave = std::polar(1.0, orders_[static_cast<std::size_t>(a)] * theta);
        cosines(i, a) = wave.real();
        sines(i, a) = wave.imag();
      }
    }
    const auto motion = flow.relative.middleRows(contact * orders, orders);
    Matrix lag = cosines * motion.real() - sines * motion.imag();  // delta r, by state
    const double rate = 2 * eta / arc.width;
    flow.matrix.middleRows(slider, inner) = -rate * derivative_.col(0).tail(inner) * lag.row(0);
    flow.matrix.block(slider, slider, inner, inner) -= rate * derivative_.bottomRightCorner(inner, inner);
    lag.row(0).setZero();
    lag.block(1, slider, inner, inner) -= Matrix::Identity(inner, inner);
    const Matrix weighted = (springs_(contact) * arc.width / pi) * weights_.asDiagonal() * lag;
    auto force = flow.force.middleRows(contact * orders, orders);
    force.real() += cosines.transpose() * weighted;
    force.imag() -= sines.transpose() * weighted;
    slider += inner;
  }
  if (orders_.front() == 0) flow.force.row(contact * orders) *= 0.5;
}

/// The force of what does not slip.
void DisturbanceFlow::add_stiffness(Index coordinate, const VaryingStiffness& stiffness, Flow& flow) const {
  const Index orders = std::ssize(orders_);
  const auto motion = flow.relative.middleRows(coordinate * orders, orders);
  for (Index a = 0; a < orders; ++a) {
    auto force = flow.force.row(coordinate * orders + a);
    const int h = orders_[static_cast<std::size_t>(a)];
    for (Index b = 0; b < orders; ++b) {
      const int l = orders_[static_cast<std::size_t>(b)];
      force += stiffness.coefficient(h - l) * motion.row(b);
      force += stiffness.coefficient(h + l) * motion.row(b).conjugate();
    }
    if (h == 0) force *= 0.5;
  }
}

void DisturbanceFlow::add_modes(double eta, Flow& flow) const {
  const Index orders = std::ssize(orders_);
  Matrix& matrix = flow.matrix;
  for (const Coordinate& one : coordinates_) {
    const Oscillator& mode = one.mode;
    const double turning = orders_[static_cast<std::size_t>(one.order)] * eta;
    const double scale = std::max(mode.frequency, eta);
    const Index both = parts(one.order);
    const Index p = one.place;
    const Index v = p + both;
    for (Index part = 0; part < both; ++part) {
      matrix(p + part, v + part) += scale;
      matrix(v + part, p + part) -= mode.stiffness().real() / scale;
      matrix(v + part, v + part) -= mode.damping;
    }
    if (both == 2) {
      matrix(v, p + 1) += mode.stiffness().imag() / scale;
      matrix(v + 1, p) -= mode.stiffness().imag() / scale;
    }
    for (const Index row : {p, v}) {  // -jh eta
      if (both == 1) continue;
      matrix(row, row + 1) += turning;
      matrix(row + 1, row) -= turning;
    }
    for (Index i = 0; i < springs_.size(); ++i) {
      const auto push = std::conj(mode.shape(i)) / scale * flow.force.row(i * orders + one.order);
      matrix.row(v) -= push.real();
      if (both == 2) matrix.row(v + 1) -= push.imag();
    }
  }
}

/// Rigid motions that nothing resists, as in TurnedFlow: where all contacts slip, base and damper are free to
/// move with all sliders, unless other elements hold them.
Matrix DisturbanceFlow::drifts(Index size, std::span<const StickPattern> elements) const {
  Matrix found(size, 0);
  const bool all_slip = std::all_of(elements.begin(), elements.begin() + contacts_,
                                    [](const StickPattern& one) { return one.slips; });
  if (orders_.front() != 0) return found;
  std::vector<const Coordinate*> rigid;
  for (const Coordinate& one : coordinates_) {
    if (one.order == 0 && one.mode.frequency == 0) rigid.push_back(&one);
  }
  Matrix shapes(springs_.size(), std::ssize(rigid));
  for (Index k = 0; k < shapes.cols(); ++k)
    shapes.col(k) = rigid[static_cast<std::size_t>(k)]->mode.shape.real();
  std::vector<Index> holding;
  for (Index i = contacts_; i < springs_.size(); ++i) {
    if (elements[static_cast<std::size_t>(i)].stiffness.bound() > 0) holding.push_back(i);
  }
  const Matrix held = shapes(holding, Eigen::all);
  Matrix felt(contacts_ + held.rows(), shapes.cols());
  felt << shapes.topRows(contacts_), held;
  const Matrix common = springs_.size() == contacts_ ? Matrix(shapes.cols(), 0) : kernel_of(felt);
  const Matrix free = all_slip ? kernel_of(held) : common;
  const Matrix moved = shapes * free;
  const Index inner = places_.size() - 1;
  found.setZero(size, free.cols() + common.cols());
  for (Index k = 0; k < shapes.cols(); ++k) {
    const Index place = rigid[static_cast<std::size_t>(k)]->place;
    found.row(place).head(free.cols()) = free.row(k);
    found.row(place + 1).tail(common.cols()) = common.row(k);
  }
  Index slider = modal_states_;
  for (Index i = 0; i < contacts_; ++i) {
    const Index count = inner * std::ssize(elements[static_cast<std::size_t>(i)].arcs);
    found.middleRows(slider, count).leftCols(free.cols()).rowwise() = moved.row(i);
    slider += count;
  }
  return found;
}

/// That of a motion whose phase is free. Sliders keep their places in the frame that moves with it.
Matrix DisturbanceFlow::velocity(Index size, double eta, std::span<const StickPattern> elements) const {
  if (!is_free(elements) || orders_.front() == 0) return {size, 0};
  Matrix found = Matrix::Zero(size, 1);
  for (const Coordinate& one : coordinates_) {
    const int h = orders_[static_cast<std::size_t>(one.order)];
    const Complex p = own_velocity(one.mode, h, eta, elements);
    const Complex v = Complex(0, h * eta / std::max(one.mode.frequency, eta)) * p;
    found.col(0).segment<4>(one.place) << p.real(), p.imag(), v.real(), v.imag();
  }
  return found;
}

/// rho_h of each contact, by `size` states.
ComplexMatrix DisturbanceFlow::relative_motion(Index size) const {
  const Index orders = std::ssize(orders_);
  ComplexMatrix relative = ComplexMatrix::Zero(springs_.size() * orders, size);
  for (const Coordinate& one : coordinates_) {
    for (Index i = 0; i < springs_.size(); ++i) {
      const Index row = i * orders + one.order;
      relative(row, one.place) = one.mode.shape(i);
      if (parts(one.order) == 2) relative(row, one.place + 1) = Complex(0, 1) * one.mode.shape(i);
    }
  }
  return relative;
}

Matrix DisturbanceFlow::matrix(double eta, std::span<const StickPattern> elements) const {
  const Index orders = std::ssize(orders_);
  const Index inner = places_.size() - 1;
  Index size = modal_states_;
  for (const StickPattern& element : elements) size += inner * std::ssize(element.arcs);
  Flow flow{relative_motion(size), ComplexMatrix::Zero(springs_.size() * orders, size),
            Matrix::Zero(size, size)};
  Index slider = modal_states_;
  for (Index i = 0; i < springs_.size(); ++i) {
    const StickPattern& contact = elements[static_cast<std::size_t>(i)];
    if (!contact.slips) {
      if (i >= contacts_) {
        add_stiffness(i, contact.stiffness, flow);
      } else {
        flow.force.middleRows(i * orders, orders) =
            springs_(i) * flow.relative.middleRows(i * orders, orders);
      }
      continue;
    }
    add_sliders(eta, i, contact, slider, flow);
    slider += inner * std::ssize(contact.arcs);
  }
  add_modes(eta, flow);
  return flow.matrix;
}

ComplexVector DisturbanceFlow::exponents(double eta, std::span<const StickPattern> elements) const {
  const Matrix flow = matrix(eta, elements);
  const Matrix rigid = drifts(flow.rows(), elements);
  const Matrix own = velocity(flow.rows(), eta, elements);
  Matrix lasting(flow.rows(), rigid.cols() + own.cols());
  lasting << rigid, own;
  ComplexVector found = spectrum(deflated(flow, lasting));
  const double rounding = 64 * std::numeric_limits<double>::epsilon() * flow.norm();
  for (Complex& sigma : found) {
    if (std::abs(sigma.real()) < rounding) sigma.real(0);
  }
  return found;
}

Index DisturbanceFlow::wave_of(const Complex& exponent, double eta, std::span<const StickPattern> elements,
                               const RingWaves& ring) const {
  std::vector<WavePlace> all;
  for (const Coordinate& one : coordinates_) {
    const Index wave = orders_[static_cast<std::size_t>(one.order)] * ring.wave_number();
    const Index both = parts(one.order);
    all.push_back({wave, one.mode.frequency, std::max(one.mode.frequency, eta), one.place, one.place + both,
                   both == 2});
  }
  return disturbed_wave(all, eigenvector(matrix(eta, elements).cast<Complex>(), exponent), ring.nodes());
}

}  // namespace arcslip
