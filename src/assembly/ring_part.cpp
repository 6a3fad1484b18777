#include "assembly/ring_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace arcslip {
namespace {

using Places = std::vector<std::array<Index, 2>>;

}  // namespace

RingPart::RingPart(Given given) : given_(std::move(given)) {
  const auto is_solved = [](const ContactModes& wave) { return wave.is_solved(); };
  is_modal_ = std::none_of(given_.waves.begin(), given_.waves.end(), is_solved);
  ports_ = given_.waves.front().contacts();
  for (Index q = 0; q < count(); ++q) {
    const double angle = two_pi * static_cast<double>(q) / static_cast<double>(count());
    turns_.emplace_back(std::cos(angle), -std::sin(angle));
  }
  for (const RingChange& change : given_.changes) rows_.insert(rows_.end(), change.of.begin(), change.of.end());
}

/// One transformation over the waves for all entries; what a wave answers is asked for once.
RingPart::Tuned RingPart::tuned(double eta, double load) const {
  const Index n = count();
  const auto turn = [&](Index m, Index i) { return turns_[static_cast<std::size_t>(m * i % n)]; };
  Tuned sum;
  sum.compliance.assign(static_cast<std::size_t>(n), ContactMatrix::Zero(ports_, ports_));
  sum.compliance_eta = sum.compliance;
  sum.free.setZero(ports_, n);
  sum.free_eta.setZero(ports_, n);
  const double part = 1 / static_cast<double>(n);
  const double load_part = load / std::sqrt(static_cast<double>(n));
  ContactReceptance one;
  for (Index m = 0; m < n; ++m) {
    const ContactModes& wave = given_.waves[static_cast<std::size_t>(m)];
    const bool is_twin = is_modal_ && 2 * m > n;
    const bool is_loaded = wave.is_solved() || std::any_of(wave.modes().begin(), wave.modes().end(),
                                                           [](const auto& mode) { return mode.load != 0.0; });
    if (is_twin && !is_loaded) continue;
    one.set_zero(ports_);
    wave.add(eta, one);
    if (is_loaded) {
      for (Index i = 0; i < n; ++i) {
        sum.free.col(i) += (load_part * turn(m, i)) * one.free;
        sum.free_eta.col(i) += (load_part * turn(m, i)) * one.free_eta;
      }
    }
    if (is_twin) continue;
    const bool has_twin = is_modal_ && m > 0 && 2 * m < n;
    for (Index lag = 0; lag < n; ++lag) {
      const auto to = static_cast<std::size_t>(lag);
      sum.compliance[to] += (part * turn(m, lag)) * one.compliance;
      sum.compliance_eta[to] += (part * turn(m, lag)) * one.compliance_eta;
      if (!has_twin) continue;
      sum.compliance[to] += (part * std::conj(turn(m, lag))) * one.compliance.transpose();
      sum.compliance_eta[to] += (part * std::conj(turn(m, lag))) * one.compliance_eta.transpose();
    }
  }
  return sum;
}

RingPart::Stiffness RingPart::stiffness(double eta) const {
  const Index size = std::ssize(rows_);
  Stiffness all{ComplexMatrix::Zero(size, size), ComplexMatrix::Zero(size, size)};
  const Loss& loss = given_.loss;
  const double rate = given_.circular_frequency * given_.circular_frequency;
  Index at = 0;
  for (const RingChange& change : given_.changes) {
    const Index own = std::ssize(change.of);
    auto value = all.value.block(at, at, own, own);
    auto by_eta = all.by_eta.block(at, at, own, own);
    value += Complex(1, loss.at(eta)) * change.stiffness.cast<Complex>();
    by_eta += Complex(0, loss.viscous) * change.stiffness.cast<Complex>();
    if (change.mass.size() > 0) {
      value -= (rate * Complex(eta * eta, -loss.mass * eta)) * change.mass.cast<Complex>();
      by_eta -= (rate * Complex(2 * eta, -loss.mass)) * change.mass.cast<Complex>();
    }
    at += own;
  }
  return all;
}

ComplexMatrix RingPart::times_rows(const Blocks& blocks, const Places& places) const {
  ComplexMatrix product = ComplexMatrix::Zero(std::ssize(places), std::ssize(rows_));
  for (Index k = 0; k < product.cols(); ++k) {
    for (const RingChange::Term& term : rows_[static_cast<std::size_t>(k)]) {
      for (Index i = 0; i < product.rows(); ++i) {
        const auto& [sector, port] = places[static_cast<std::size_t>(i)];
        product(i, k) += term.weight * block(blocks, sector, term.sector)(port, term.port);
      }
    }
  }
  return product;
}

ComplexMatrix RingPart::between_rows(const Blocks& blocks) const {
  const Index size = std::ssize(rows_);
  ComplexMatrix product = ComplexMatrix::Zero(size, size);
  for (Index k = 0; k < size; ++k) {
    for (Index i = 0; i < size; ++i) {
      for (const RingChange::Term& to : rows_[static_cast<std::size_t>(i)]) {
        for (const RingChange::Term& from : rows_[static_cast<std::size_t>(k)])
          product(i, k) +=
              to.weight * from.weight * block(blocks, to.sector, from.sector)(to.port, from.port);
      }
    }
  }
  return product;
}

ComplexVector RingPart::of_rows(const ComplexMatrix& motions) const {
  ComplexVector x = ComplexVector::Zero(std::ssize(rows_));
  for (Index k = 0; k < x.size(); ++k) {
    for (const RingChange::Term& term : rows_[static_cast<std::size_t>(k)])
      x(k) += term.weight * motions(term.port, term.sector);
  }
  return x;
}

RingPart::Stiffness RingPart::turned(const Tuned& tuned, double eta) const {
  const Stiffness d = stiffness(eta);
  const ComplexMatrix c = between_rows(tuned.compliance);
  const ComplexMatrix c_eta = between_rows(tuned.compliance_eta);
  const Index size = c.rows();
  const ComplexMatrix factor =
      (ComplexMatrix::Identity(size, size) + d.value * c).partialPivLu().inverse();  // (1 + D C)^-1
  Stiffness all;
  all.value = factor * d.value;
  all.by_eta = factor * d.by_eta * (ComplexMatrix::Identity(size, size) - c * all.value) -
               all.value * c_eta * all.value;
  return all;
}

ContactReceptance RingPart::at(double eta, double load, Index port) const {
  const Index n = count();
  const Index c = given_.contacts;
  const Tuned all = tuned(eta, load);
  Places contacts;
  for (Index i = 0; i < n * c; ++i) contacts.push_back({i / c, i % c});
  Places rows = contacts;
  if (port >= 0) {
    rows.clear();
    for (Index i = 0; i < n; ++i) rows.push_back({i, port});
  }
  const Index first = port >= 0 ? n * c : 0;
  ContactReceptance response;
  response.set_zero(first + std::ssize(rows));
  for (Index i = 0; i < std::ssize(rows); ++i) {
    const auto& [sector, of] = rows[static_cast<std::size_t>(i)];
    response.free(first + i) = all.free(of, sector);
    response.free_eta(first + i) = all.free_eta(of, sector);
    for (Index j = 0; j < n * c; ++j) {
      response.compliance(first + i, j) = block(all.compliance, sector, j / c)(of, j % c);
      response.compliance_eta(first + i, j) = block(all.compliance_eta, sector, j / c)(of, j % c);
    }
  }
  if (rows_.empty()) return response;
  const Stiffness g = turned(all, eta);
  const ComplexMatrix left = times_rows(all.compliance, rows);
  const ComplexMatrix left_eta = times_rows(all.compliance_eta, rows);
  const ComplexMatrix right = port >= 0 ? times_rows(all.compliance, contacts) : left;
  const ComplexMatrix right_eta = port >= 0 ? times_rows(all.compliance_eta, contacts) : left_eta;
  const ComplexMatrix held = left * g.value;
  const ComplexMatrix held_eta = left_eta * g.value + left * g.by_eta;
  const ComplexVector x = of_rows(all.free);
  const Index size = std::ssize(rows);
  response.compliance.block(first, 0, size, n * c) -= held * right.transpose();
  response.compliance_eta.block(first, 0, size, n * c) -=
      held_eta * right.transpose() + held * right_eta.transpose();
  response.free.tail(size) -= held * x;
  response.free_eta.tail(size) -= held_eta * x + held * of_rows(all.free_eta);
  return response;
}

CycleWork RingPart::work(double eta, double load, const ContactVector& forces) const {
  const Index n = count();
  const Index c = given_.contacts;
  ComplexMatrix on_ports = ComplexMatrix::Zero(ports_, n);
  for (Index i = 0; i < n * c; ++i) on_ports(i % c, i / c) = forces(i);
  CycleWork sum;
  if (!rows_.empty()) {
    const Tuned all = tuned(eta, load);
    Places contacts;
    for (Index i = 0; i < n * c; ++i) contacts.push_back({i / c, i % c});
    const ComplexVector x = of_rows(all.free) + times_rows(all.compliance, contacts).transpose() * forces;
    const ComplexVector taken = turned(all, eta).value * x;  // what the changes meet the motion with
    const ComplexVector moved = x - between_rows(all.compliance) * taken;
    for (Index k = 0; k < x.size(); ++k) {
      for (const RingChange::Term& term : rows_[static_cast<std::size_t>(k)])
        on_ports(term.port, term.sector) -= term.weight * taken(k);
      sum.damping += pi * std::imag(taken(k) * std::conj(moved(k)));
      sum.magnitude += pi * std::abs(taken(k) * moved(k));
    }
  }
  const double part = 1 / std::sqrt(static_cast<double>(n));
  for (Index m = 0; m < n; ++m) {
    ComplexVector of_wave = ComplexVector::Zero(ports_);
    for (Index i = 0; i < n; ++i)
      of_wave += (part * std::conj(turns_[static_cast<std::size_t>(m * i % n)])) * on_ports.col(i);
    const ContactModes& wave = given_.waves[static_cast<std::size_t>(m)];
    const CycleWork own = wave.varied(Variation{.load = load, .loss = wave.loss()}).work(eta, of_wave);
    sum.load += own.load;
    sum.damping += own.damping;
    sum.magnitude += own.magnitude;
  }
  return sum;
}

ContactModes RingPart::modes() const {
  const Index n = count();
  const Index c = given_.contacts;
  const double part = 1 / std::sqrt(static_cast<double>(n));
  std::vector<ContactMode> all;
  for (Index m = 0; m < n; ++m) {
    for (const ContactMode& mode : given_.waves[static_cast<std::size_t>(m)].modes()) {
      ContactVector shape(n * c);
      for (Index i = 0; i < n * c; ++i)
        shape(i) = part * turns_[static_cast<std::size_t>(m * (i / c) % n)] * mode.shape(i % c);
      all.push_back({mode.frequency, std::move(shape), mode.load});
    }
  }
  return {n * c, std::move(all), given_.waves.front().loss()};
}

}  // namespace arcslip
