#include "arcslip/time/turned_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "arcslip/structure/spectrum.hpp"
#include "arcslip/time/disturbed_wave.hpp"
#include "time/turned_map.hpp"

namespace arcslip {
namespace {

using Coordinate = TurnedFlow::Coordinate;
using Part = Coordinate::Part;

constexpr double forgotten = 1e-13;  // of what grows most: less is nothing, or only rounding

/// Exponents of an oscillator by itself.
std::array<Complex, 2> roots(const Oscillator& mode) {
  const Complex root = std::sqrt(0.25 * mode.damping * mode.damping - mode.stiffness());
  return {-0.5 * mode.damping + root, -0.5 * mode.damping - root};
}

std::vector<WavePlace> places(const std::vector<Coordinate>& coordinates, double eta) {
  std::vector<WavePlace> all;
  const auto size = std::ssize(coordinates);
  for (Index i = 0; i < size; ++i) {
    const Coordinate& one = coordinates[static_cast<std::size_t>(i)];
    if (one.part != Part::imaginary)
      all.push_back({one.wave, one.mode.frequency, scale_of(one, eta), i, size + i, one.part == Part::real});
  }
  return all;
}

}  // namespace

TurnedFlow::TurnedFlow(Kind kind, Index nodes, const std::vector<Wave>& waves, const Vector& springs,
                       double turn)
    : kind_(kind), nodes_(nodes), springs_(springs), turn_(turn) {
  for (const Wave& wave : waves) {
    const bool alone = kind == Kind::general || wave.order == 0 || wave.order == nodes;
    for (const Oscillator& mode : wave.modes) {
      coordinates_.push_back({alone ? Part::whole : Part::real, wave.wave, wave.order, mode});
      if (!alone) coordinates_.push_back({Part::imaginary, wave.wave, wave.order, mode});
    }
  }
}

bool TurnedFlow::is_passive() const {
  return std::all_of(coordinates_.begin(), coordinates_.end(), [](const Coordinate& one) {
    return one.mode.damping >= 0 && one.mode.influence == 0.0;
  });
}

double TurnedFlow::step(double eta) const { return turn_ / (static_cast<double>(nodes_) * eta); }

TurnedFlow::Parts TurnedFlow::parts(double eta) const {
  constexpr double most = 16;
  Parts parts;
  for (const Coordinate& one : coordinates_) {
    const bool free = roots(one.mode)[0].real() * step(eta) > most;
    (free ? parts.free : parts.held).push_back(one);
  }
  return parts;
}

std::array<Complex, 2> TurnedFlow::free_exponents(const Coordinate& coordinate, double eta) const {
  const double strip = 2 * edge(eta);
  std::array<Complex, 2> all = roots(coordinate.mode);
  for (Complex& sigma : all) {
    sigma.imag(std::remainder(sigma.imag() - pi / turn_ * coordinate.order * eta, strip));
    if (std::abs(sigma.imag()) == 0.5 * strip) sigma.imag(0.5 * strip);
    if (coordinate.part == Part::imaginary) sigma = std::conj(sigma);
  }
  return all;
}

/// Of real motions the flow is real.
template <class Use>
auto TurnedFlow::with_flow(const std::vector<Coordinate>& held, double eta,
                           std::span<const StickPattern> elements, const Use& use) const {
  std::vector<DisturbedLaw> laws;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto contact = static_cast<Index>(i);
    laws.push_back(law_of(elements[i], contact < springs_.size() ? springs_(contact) : -1));
  }
  return kind_ == Kind::general ? use(TurnedMap<Complex>(held, nodes_, turn_, eta, laws))
                                : use(TurnedMap<double>(held, nodes_, turn_, eta, laws));
}

std::vector<Complex> TurnedFlow::exponents(double eta, std::span<const StickPattern> elements,
                                           bool own) const {
  const Parts apart = parts(eta);
  std::vector<Complex> all;
  for (const Coordinate& one : apart.free) {
    for (const Complex& sigma : free_exponents(one, eta)) all.push_back(sigma);
  }
  const auto add = [&](auto&& flow) {
    const auto map = flow.turned_map();
    auto lasting = flow.drifts(std::ssize(elements) > springs_.size());
    if (own && is_free(elements)) {
      lasting.conservativeResize(Eigen::NoChange, lasting.cols() + 1);
      lasting.rightCols(1) = lasting_near(map, flow.velocity(elements));
    }
    const ComplexVector multipliers = spectrum(deflated(map, lasting));
    const double largest = multipliers.size() == 0 ? 1 : std::max(1.0, multipliers.cwiseAbs().maxCoeff());
    for (const Complex& nu : multipliers) {
      if (std::abs(nu) < forgotten * largest) continue;
      const double size = std::log(std::abs(nu));
      const double angle = nu.imag() != 0 ? std::arg(nu) / pi : nu.real() < 0 ? 1 : 0;
      all.emplace_back(std::abs(size) < flow.rounding() * largest ? 0 : size / step(eta), angle * edge(eta));
    }
  };
  if (!apart.held.empty()) with_flow(apart.held, eta, elements, add);
  std::stable_sort(all.begin(), all.end(),
                   [](const Complex& a, const Complex& b) { return a.real() > b.real(); });
  return all;
}

Index TurnedFlow::wave_of(const Complex& exponent, double eta, std::span<const StickPattern> elements,
                          Index ring) const {
  const Parts apart = parts(eta);
  for (const Coordinate& one : apart.free) {
    for (const Complex& sigma : free_exponents(one, eta)) {
      if (sigma == exponent) return std::min(one.wave, ring - one.wave);
    }
  }
  return with_flow(apart.held, eta, elements, [&](auto&& flow) {
    const ComplexVector vector =
        eigenvector(flow.turned_map().template cast<Complex>(), std::exp(exponent * step(eta)));
    return disturbed_wave(places(apart.held, eta), vector, ring);
  });
}

}  // namespace arcslip
