#include "arcslip/time/ring_disturbances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace arcslip {
namespace {

constexpr Index most_cells = 16;   // side by side
constexpr Index own_balance = -1;  // in place of a cell
constexpr Index even_balance = -2;

/// Product of 1 - e^{sigma step}/at, at = 1 or -1, but for positive factors: it changes its sign with a real
/// multiplier at that place. Each is of the size 1 but near there, and 1 where nu is nothing, as
/// multipliers that small are left out.
double passage(const std::vector<Complex>& exponents, double at, double step) {
  constexpr double far = 30;
  Complex product = 1;
  for (const Complex& sigma : exponents) {
    const Complex exponent = sigma * step;
    const Complex nu = std::exp(Complex(std::min(exponent.real(), far), exponent.imag()));
    const Complex distance = 1.0 - nu / at;
    product *= 2.0 * distance / (std::abs(distance) + 1);
  }
  return product.real();
}

HarmonicSystem even_system(const HarmonicSystem& system, const RingWaves& waves) {
  HarmonicSystem even;
  even.contacts = system.contacts;
  even.others = system.others;
  for (int h = 0; h <= highest_order(system.orders) + 1; h += 2) {
    RingWaves::Structures under = waves.structures(h * waves.wave_number());
    even.orders.push_back(h);
    even.base.push_back(std::move(under.base));
    even.damper.push_back(std::move(under.damper));
  }
  return even;
}

}  // namespace

/// Makes the cells.
struct RingDisturbances::Builder {
  const RingWaves& waves;
  Vector springs;
  std::span<const Coordinate> others;
  int highest;       // H
  bool is_odd;       // whether the response is
  bool is_balanced;  // whether its own harmonics and the even ones between are told apart from cells
  std::vector<Cell>& cells;
  Index common = std::gcd(waves.wave_number(), waves.nodes());
  Index classes = is_odd ? std::gcd(2 * waves.wave_number(), waves.nodes()) : common;
  Index size = waves.nodes() / classes;  // M
  bool odd_size = waves.nodes() / common % 2 == 1;

  using Tests = std::vector<Cell::Test>;

  /// Whether all waves are taken exactly.
  bool is_small() const { return is_exact(waves.nodes() / common, highest); }

  /// By the waves of orders `from` to `to` in steps of 2: of a response that is not odd they count halves.
  void cell(TurnedFlow::Kind kind, Index wave, Index nodes, Index from, Index to, bool own, Tests tests) {
    std::vector<TurnedFlow::Wave> all;
    for (Index f = from; f <= to; f += 2) {
      const Index turned = f * waves.wave_number();
      const Index moved = waves.within(wave + (is_odd ? turned : turned / 2));
      all.push_back({moved, static_cast<int>(f), waves.at(moved, others)});
    }
    cells.push_back({TurnedFlow(kind, nodes, all, springs, is_odd ? pi : two_pi), wave, own,
                     !is_odd && from % 2 != 0, std::move(tests)});
  }

  /// The waves with f from `from` to `to` in cells side by side.
  void row(Index wave, Index from, Index to) {
    if (to < from) return;
    const Index count = (to - from) / 2 + 1;
    const Index all = (count + highest + 1) / (highest + 2);
    const Index chosen = std::min(all, most_cells);
    for (Index k = 0; k < chosen; ++k) {
      const Index i = chosen < all ? k * (all - 1) / (chosen - 1) : k;
      const Index first = i * count / all;
      const Index next = (i + 1) * count / all;
      cell(TurnedFlow::Kind::general, wave, next - first, from + 2 * first, from + 2 * (next - 1), false, {});
    }
  }

  /// Waves of l = N/2 and beside it, with `beside` more f on each side; returns how many were taken there.
  Index middle(Index beside) {
    const Index most = is_odd ? (highest + 1) / 2 : highest + 1;
    const Index taken = std::min(most, beside);
    cell(TurnedFlow::Kind::self_conjugate, waves.nodes() / 2, 2 * taken + 1, 0, 2 * taken, false, {{1}});
    return taken;
  }

  /// A class that is its own conjugate, of l = 0 or N/2 and f from `from`, 0 or 1.
  void self_conjugate(Index wave, Index from, bool own) {
    if (is_small()) {
      const Tests tests = own ? Tests{{-1}} : Tests{{1}, {-1}};
      cell(TurnedFlow::Kind::self_conjugate, wave, size, from, size, own, tests);
      return;
    }
    Index first = from;
    Index last = size;
    if ((last - from) % 2 != 0) --last;
    if (wave > 0) {  // N/2, the only one that is its own conjugate
      first = 2 + 2 * middle((last - first) / 2);
    } else {
      first = own ? highest + 2 : highest + 3;
      if (odd_size) {
        last = size - highest - 3;  // the even ones stand at its end
      } else if (last == size) {
        last -= 2 + 2 * middle((last - first) / 2);
      }
    }
    row(wave, first, last);
  }

  /// In place of a balance: the response's own harmonics, and the even ones between.
  void near_own() {
    const Index H = highest;
    cell(TurnedFlow::Kind::self_conjugate, 0, H + 1, 1, H, true, {});
    cell(TurnedFlow::Kind::self_conjugate, 0, H + 2, 0, H + 1, false, {{1}});
  }

  void build() {
    if (!is_odd) return build_whole();
    if (!is_small() && !is_balanced) near_own();
    self_conjugate(0, odd_size ? 1 : 0, odd_size);
    for (Index wave = 1; 2 * wave < classes; ++wave) {
      if (is_small()) {
        cell(TurnedFlow::Kind::general, wave, size, 0, 2 * (size - 1), false, {});
      } else {
        row(wave, 0, 2 * (size - 1));
      }
    }
    if (classes % 2 != 0) return;
    if (odd_size) {
      self_conjugate(waves.nodes() / 2, 0, false);
    } else {
      self_conjugate(0, 1, true);
    }
  }

  /// Of a response that repeats itself after a whole period alone.
  void build_whole() {
    if (is_small()) return build_small();
    const Index own = highest + 1;  // f either way
    cell(TurnedFlow::Kind::self_conjugate, 0, 2 * own + 1, 0, 2 * own, true, {{-1, true}});
    const Index rest = (size - 1) / 2 - own;
    const Index beside = odd_size ? 0 : 1 + middle(rest);
    row(0, 2 * (own + 1), 2 * (size / 2 - beside));
    for (Index wave = 1; 2 * wave < classes; ++wave) row(wave, 0, 2 * (size - 1));
    if (classes % 2 != 0) return;
    if (odd_size) {
      const Index taken = middle((size - 1) / 2);
      row(waves.nodes() / 2, 2 * (taken + 1), size - 1);
    } else {
      row(0, 1, size - 1);  // with their conjugates
    }
  }
  void build_small() {
    cell(TurnedFlow::Kind::self_conjugate, 0, size, 0, size, true, {{-1, odd_size}});
    for (Index wave = 1; 2 * wave < classes; ++wave)
      cell(TurnedFlow::Kind::general, wave, size, 0, 2 * (size - 1), false, {});
    if (classes % 2 != 0) return;
    if (odd_size) {
      cell(TurnedFlow::Kind::self_conjugate, waves.nodes() / 2, size, 0, size, false, {{1}, {-1, true}});
    } else {
      cell(TurnedFlow::Kind::self_conjugate, 0, size, 1, size, false, {{1, true}, {-1, true}});
    }
  }
};

RingDisturbances::RingDisturbances(const HarmonicSystem& system, const RingWaves& waves)
    : waves_(waves), is_odd_(all_odd(system.orders)) {
  const int highest = highest_order(system.orders);
  const bool has_laws = std::any_of(system.others.begin(), system.others.end(), [](const Coordinate& one) {
    return one.element && one.element->is_told_by_law();
  });
  Builder builder{waves_, contact_springs(system.contacts), system.others, highest, is_odd_, !has_laws,
                  cells_};
  builder.build();
  if (!builder.is_small() && is_odd_ && !has_laws) {
    balanced_.emplace(
        Balanced{DisturbanceFlow(system, highest), DisturbanceFlow(even_system(system, waves), highest)});
  }
  if (balanced_) doubles_.push_back(false);
  for (const Cell& cell : cells_) {
    for (const Cell::Test& test : cell.tests) doubles_.push_back(test.doubles);
  }
}

std::set<Index> RingDisturbances::waves(Index wave_number, Index nodes, std::span<const int> orders) {
  const int highest = highest_order(orders);
  std::set<Index> found;
  const RingWaves asked(wave_number, nodes, [&](Index wave) {
    found.insert(wave);
    return RingWaves::Structures{ContactModes(1, {}, {}), ContactModes(1, {}, {})};
  });
  std::vector<Cell> cells;
  Builder builder{asked, Vector::Ones(1), {}, highest, all_odd(orders), true, cells};
  builder.build();
  if (!builder.is_small()) {
    for (int h = 0; h <= highest + 1; ++h) asked.structures(h * wave_number);
  }
  return found;
}

/// What a cell of real motions has found, as all nodes see it.
RingDisturbances::Disturbance RingDisturbances::seen(Index which, const Complex& sigma, double eta) const {
  const Cell& cell = cells_[static_cast<std::size_t>(which)];
  const bool turns = sigma.imag() == cell.flow.edge(eta);  // nu is negative
  const bool is_real = turns || sigma.imag() == 0;
  if (is_odd_) {  // real, perhaps in the frame of other f
    const Index moved = turns ? cell.flow.nodes() * waves_.wave_number() : 0;
    const Complex exponent = turns ? sigma.real() : sigma;
    return {exponent, cell.wave - moved, cell.is_own && sigma.imag() == 0, which, sigma};
  }
  const Index moved = turns ? cell.flow.nodes() / 2 * waves_.wave_number() : 0;
  if (is_real) {
    const bool is_negative = cell.is_halved || (turns && cell.flow.nodes() % 2 == 1);
    return {sigma.real(), cell.wave - moved, cell.is_own && !turns, which, sigma, is_negative};
  }
  const Complex half(0, cell.is_halved ? std::copysign(0.5 * eta, sigma.imag()) : 0);
  return {sigma + half, cell.wave, false, which, sigma};
}

void RingDisturbances::add(Index which, double eta, std::span<const StickPattern> elements,
                           Disturbances& found) const {
  const Cell& cell = cells_[static_cast<std::size_t>(which)];
  const std::vector<Complex> exponents = cell.flow.exponents(eta, elements, cell.is_own);
  const double edge = cell.flow.edge(eta);
  for (const Complex& sigma : exponents) {
    if (cell.flow.kind() == TurnedFlow::Kind::general) {
      // Modulo 2 j eta M: far from the real axis, where it is none of two that meet there.
      const bool is_near = std::abs(sigma.imag()) < 0.5 * edge;
      const Complex away = is_near ? sigma + Complex(0, 2 * edge) : sigma;
      found.all.push_back({away, cell.wave, false, which, sigma});
      found.all.push_back({std::conj(away), -cell.wave, false, which, sigma});
    } else {
      found.all.push_back(seen(which, sigma, eta));
    }
  }
  for (const Cell::Test& test : cell.tests)
    found.symmetries.push_back(passage(exponents, test.at, pi / edge));
}

void RingDisturbances::add_balanced(double eta, std::span<const StickPattern> elements,
                                    Disturbances& found) const {
  const ComplexVector own = balanced_->own.exponents(eta, elements);
  for (const Complex& sigma : own) found.all.push_back({sigma, 0, sigma.imag() == 0, own_balance, sigma});
  const ComplexVector even = balanced_->even.exponents(eta, elements);
  Complex product = 1;
  for (const Complex& sigma : even) {
    found.all.push_back({sigma, 0, false, even_balance, sigma});
    product *= -sigma / (std::abs(sigma) + eta);
  }
  found.symmetries.push_back(product.real());
}

RingDisturbances::Disturbances RingDisturbances::at(double eta, std::span<const StickPattern> elements,
                                                    bool active) const {
  Disturbances found;
  // What swings may excite others.
  const bool varies =
      has_law(elements) || std::any_of(elements.begin(), elements.end(),
                                       [](const StickPattern& one) { return !one.stiffness.is_constant(); });
  if (balanced_) add_balanced(eta, elements, found);
  for (Index i = 0; i < std::ssize(cells_); ++i) {
    const Cell& cell = cells_[static_cast<std::size_t>(i)];
    if (!active || cell.is_own || varies || !cell.flow.is_passive()) {
      add(i, eta, elements, found);
    } else {
      found.symmetries.insert(found.symmetries.end(), cell.tests.size(), 1);
    }
  }
  return found;
}

Complex RingDisturbances::turned(const Disturbance& one, double eta) const {
  const double node = 2 * pi / static_cast<double>(waves_.nodes());
  const Index n = waves_.wave_number();
  const auto turns = static_cast<double>(n == 0 ? waves_.nodes() : std::abs(n));
  const auto wave = static_cast<double>(n < 0 ? -one.wave : one.wave);
  return std::exp(one.exponent * (node * turns / eta) - Complex(0, node * wave));
}

Index RingDisturbances::wave_of(const Disturbance& one, double eta,
                                std::span<const StickPattern> elements) const {
  const auto wave = [&](const auto& flow, const auto&... ring) {
    return flow.wave_of(one.in_cell, eta, elements, ring...);
  };
  if (one.cell == own_balance) return wave(balanced_->own, waves_);
  if (one.cell == even_balance) return wave(balanced_->even, waves_);
  const Cell& cell = cells_[static_cast<std::size_t>(one.cell)];
  const double strip = 2 * cell.flow.edge(eta);
  const double shift = std::remainder(one.exponent.imag() - one.in_cell.imag(), strip);
  const bool is_conjugate = cell.flow.kind() == TurnedFlow::Kind::general && std::abs(shift) > 1e-9 * strip;
  const Index found = wave(cell.flow, waves_.nodes());
  return is_conjugate ? waves_.within(-found) : found;
}

}  // namespace arcslip
