#include "arcslip/disturbance_flow.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "arcslip/spectrum.hpp"

namespace arcslip {
namespace {

constexpr double pi = std::numbers::pi;

// On an arc as long as half a period e^{jh theta} needs some h pi/2 points, and 16 more give it to rounding.
Index points_for(int highest) { return 16 + 2 * highest; }

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

/// The lowest frequency but 0 of all harmonics.
double slowest_rate(const HarmonicSystem& system) {
  double slowest = std::numeric_limits<double>::infinity();
  for (const auto* structures : {&system.base, &system.damper}) {
    for (const ContactModes& structure : *structures) {
      for (const ContactMode& mode : structure.modes()) {
        if (mode.frequency > 0) slowest = std::min(slowest, mode.frequency);
      }
    }
  }
  return slowest;
}

/// The modes that count: what moves the contacts by less than rounding at a very high rate, as the second
/// modes of short elements, would only drown the rates of the others.
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

}  // namespace

/// The flow of (p, v, x), v = (sigma + jh eta) p/scale, real and imaginary parts apart.
struct DisturbanceFlow::Flow {
  ComplexMatrix relative;  ///< rho_h of contact i in row i * orders + a, by state
  ComplexMatrix force;     ///< k f_h likewise
  Matrix matrix;
};

DisturbanceFlow::DisturbanceFlow(const HarmonicSystem& system, std::vector<int> orders)
    : orders_(system.orders), response_orders_(std::move(orders)) {
  check(system);
  springs_.resize(std::ssize(system.contacts));
  for (Index i = 0; i < springs_.size(); ++i)
    springs_(i) = system.contacts[static_cast<std::size_t>(i)].stiffness;
  const double slowest = slowest_rate(system);
  for (Index a = 0; a < std::ssize(orders_); ++a) {
    std::vector<Oscillator> rigid;
    for (const auto* structures : {&system.base, &system.damper}) {
      for (const Oscillator& mode : oscillators(a, (*structures)[static_cast<std::size_t>(a)], slowest))
        (mode.frequency > 0 ? modes_ : rigid).push_back(mode);
    }
    for (const Oscillator& mode : joined(rigid)) modes_.push_back(mode);
  }
  for (Oscillator& mode : modes_) {
    mode.place = modal_states_;
    modal_states_ += 2 * parts(mode.order);
  }
  const Index n = points_for(std::max(orders_.back(), response_orders_.back()));
  places_ = chebyshev_points(n);
  weights_ = chebyshev_weights(n);
  derivative_ = chebyshev_derivative(places_);
}

/// The modes of one structure in one harmonic.
std::vector<DisturbanceFlow::Oscillator> DisturbanceFlow::oscillators(Index order,
                                                                      const ContactModes& structure,
                                                                      double slowest) const {
  const Loss& loss = structure.loss();
  if (loss.structural != 0 || structure.is_solved())
    throw std::invalid_argument("DisturbanceFlow: stability needs modes with viscous or modal damping");
  std::vector<Oscillator> all;
  for (const ContactMode& mode : noticeable(structure, slowest)) {
    all.push_back({order, mode.frequency, loss.part_eta(mode.frequency), mode.shape});
    Index largest = 0;
    const double size = mode.shape.cwiseAbs().maxCoeff(&largest);
    // What is the same at all nodes is real but for its phase.
    if (parts(order) == 1 && size > 0) all.back().shape *= std::conj(mode.shape(largest)) / size;
  }
  return all;
}

/// Rigid motions of the same damping act on the contacts by sum s s^H alone. Combinations that move no
/// contact, as base and damper together, would add a defective exponent and are left out.
std::vector<DisturbanceFlow::Oscillator> DisturbanceFlow::joined(const std::vector<Oscillator>& rigid) {
  const auto other = [&](const Oscillator& mode) { return mode.damping != rigid.front().damping; };
  if (rigid.size() < 2 || std::any_of(rigid.begin(), rigid.end(), other)) return rigid;
  ComplexMatrix shapes(std::ssize(rigid), rigid.front().shape.size());
  for (Index k = 0; k < shapes.rows(); ++k)
    shapes.row(k) = rigid[static_cast<std::size_t>(k)].shape.adjoint();
  const Eigen::ColPivHouseholderQR<ComplexMatrix> parts(shapes);
  const ComplexMatrix upper = parts.matrixR().topRows(parts.rank()).triangularView<Eigen::Upper>();
  std::vector<Oscillator> all;
  for (Index k = 0; k < parts.rank(); ++k) {
    all.push_back(rigid.front());
    all.back().shape = parts.colsPermutation() * upper.row(k).adjoint();
  }
  return all;
}

/// Friction of a contact that slips, by the disturbances of its motion and of its slider.
void DisturbanceFlow::add_sliders(double eta, Index contact, const HysteresisLoop& loop, Index first,
                                  Flow& flow) const {
  const Index orders = std::ssize(orders_);
  const Index inner = places_.size() - 1;
  Index slider = first;
  for (const HysteresisLoop::Arc& arc : loop.stick()) {
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

void DisturbanceFlow::add_modes(double eta, Flow& flow) const {
  const Index orders = std::ssize(orders_);
  Matrix& matrix = flow.matrix;
  for (const Oscillator& mode : modes_) {
    const double turning = orders_[static_cast<std::size_t>(mode.order)] * eta;
    const double scale = std::max(mode.frequency, eta);
    const Index both = parts(mode.order);
    const Index p = mode.place;
    const Index v = p + both;
    for (Index part = 0; part < both; ++part) {
      matrix(p + part, v + part) += scale;
      matrix(v + part, p + part) -= mode.frequency * mode.frequency / scale;
      matrix(v + part, v + part) -= mode.damping;
    }
    for (const Index row : {p, v}) {  // -jh eta
      if (both == 1) continue;
      matrix(row, row + 1) += turning;
      matrix(row + 1, row) -= turning;
    }
    for (Index i = 0; i < springs_.size(); ++i) {
      const auto push = std::conj(mode.shape(i)) / scale * flow.force.row(i * orders + mode.order);
      matrix.row(v) -= push.real();
      if (both == 2) matrix.row(v + 1) -= push.imag();
    }
  }
}

/// Where all contacts slip, base and damper are free to move as rigid bodies with all sliders.
Index DisturbanceFlow::drifts(std::span<const Contact> contacts) const {
  if (orders_.front() != 0 ||
      !std::all_of(contacts.begin(), contacts.end(), [](const Contact& one) { return one.slips; }))
    return 0;
  return std::count_if(modes_.begin(), modes_.end(),
                       [](const Oscillator& mode) { return mode.order == 0 && mode.frequency == 0; });
}

/// rho_h of each contact, by `size` states.
ComplexMatrix DisturbanceFlow::relative_motion(Index size) const {
  const Index orders = std::ssize(orders_);
  ComplexMatrix relative = ComplexMatrix::Zero(springs_.size() * orders, size);
  for (const Oscillator& mode : modes_) {
    for (Index i = 0; i < springs_.size(); ++i) {
      const Index row = i * orders + mode.order;
      relative(row, mode.place) = mode.shape(i);
      if (parts(mode.order) == 2) relative(row, mode.place + 1) = Complex(0, 1) * mode.shape(i);
    }
  }
  return relative;
}

ComplexVector DisturbanceFlow::exponents(double eta, std::span<const Contact> contacts) const {
  const Index orders = std::ssize(orders_);
  const Index inner = places_.size() - 1;
  Index size = modal_states_;
  std::vector<OddMotion> motions;
  std::vector<HysteresisLoop> loops;
  motions.reserve(contacts.size());
  loops.reserve(contacts.size());
  for (const Contact& contact : contacts) {
    if (!contact.slips) continue;
    motions.emplace_back(response_orders_, contact.motion);
    loops.emplace_back(motions.back(), contact.slip_threshold);
    size += inner * std::ssize(loops.back().stick());
  }
  Flow flow{relative_motion(size), ComplexMatrix::Zero(springs_.size() * orders, size),
            Matrix::Zero(size, size)};
  Index slider = modal_states_;
  std::size_t slipping = 0;
  for (Index i = 0; i < springs_.size(); ++i) {
    if (!contacts[static_cast<std::size_t>(i)].slips) {
      flow.force.middleRows(i * orders, orders) = springs_(i) * flow.relative.middleRows(i * orders, orders);
      continue;
    }
    const HysteresisLoop& loop = loops[slipping++];
    add_sliders(eta, i, loop, slider, flow);
    slider += inner * std::ssize(loop.stick());
  }
  add_modes(eta, flow);
  ComplexVector found = spectrum(flow.matrix);
  found.conservativeResize(size - drifts(contacts));
  const double rounding = 64 * std::numeric_limits<double>::epsilon() * flow.matrix.norm();
  for (Complex& sigma : found) {
    if (std::abs(sigma.real()) < rounding) sigma.real(0);
  }
  return found;
}

}  // namespace arcslip
