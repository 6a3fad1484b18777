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
  transform_.resize(count(), count());
  for (Index m = 0; m < count(); ++m) {
    for (Index i = 0; i < count(); ++i)
      transform_(m, i) = turns_[static_cast<std::size_t>(m * i % count())] / static_cast<double>(count());
  }
  for (const ContactModes& wave : given_.waves) {
    is_loaded_.push_back(wave.is_solved() || std::any_of(wave.modes().begin(), wave.modes().end(),
                                                         [](const auto& mode) { return mode.load != 0.0; }));
  }
  for (const RingChange& change : given_.changes)
    rows_.insert(rows_.end(), change.of.begin(), change.of.end());
}

/// The blocks of all lags between sectors, by a transformation over the waves of all entries at once.
RingPart::Tuned RingPart::tuned(double eta, double load) const {
  const Index n = count();
  const Index entries = ports_ * ports_;
  ComplexMatrix waves(2 * entries, n);  // a column for each wave: its compliance, then the derivative
  ComplexMatrix free = ComplexMatrix::Zero(2 * ports_, n);
  const auto keep = [&](Index m, const auto& compliance, const auto& by_eta) {
    Eigen::Map<ContactMatrix>(waves.col(m).data(), ports_, ports_) = compliance;
    Eigen::Map<ContactMatrix>(waves.col(m).data() + entries, ports_, ports_) = by_eta;
  };
  ContactReceptance one;
  for (Index m = 0; m < n; ++m) {
    const auto at = static_cast<std::size_t>(m);
    const bool is_twin = is_modal_ && 2 * m > n;
    if (is_twin && !is_loaded_[at]) continue;
    one.set_zero(ports_);
    given_.waves[at].add(eta, one);
    if (is_loaded_[at]) free.col(m) << one.free, one.free_eta;
    if (is_twin) continue;
    keep(m, one.compliance, one.compliance_eta);
    if (is_modal_ && m > 0 && 2 * m < n)
      keep(n - m, one.compliance.transpose(), one.compliance_eta.transpose());
  }
  Tuned sum;
  sum.entries.noalias() = waves * transform_;
  sum.free.noalias() = (load * std::sqrt(static_cast<double>(n))) * (free.topRows(ports_) * transform_);
  sum.free_eta.noalias() =
      (load * std::sqrt(static_cast<double>(n))) * (free.bottomRows(ports_) * transform_);
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

ComplexMatrix RingPart::times_rows(const Tuned& tuned, bool by_eta, const Places& places) const {
  ComplexMatrix product = ComplexMatrix::Zero(std::ssize(places), std::ssize(rows_));
  for (Index k = 0; k < product.cols(); ++k) {
    for (const RingChange::Term& term : rows_[static_cast<std::size_t>(k)]) {
      for (Index i = 0; i < product.rows(); ++i) {
        const auto& [sector, port] = places[static_cast<std::size_t>(i)];
        product(i, k) +=
            term.weight * entry(tuned, by_eta, place(sector, port), place(term.sector, term.port));
      }
    }
  }
  return product;
}

ComplexMatrix RingPart::between_rows(const Tuned& tuned, bool by_eta) const {
  const Index size = std::ssize(rows_);
  ComplexMatrix product = ComplexMatrix::Zero(size, size);
  for (Index k = 0; k < size; ++k) {
    for (Index i = 0; i < size; ++i) {
      for (const RingChange::Term& to : rows_[static_cast<std::size_t>(i)]) {
        for (const RingChange::Term& from : rows_[static_cast<std::size_t>(k)])
          product(i, k) += to.weight * from.weight *
                           entry(tuned, by_eta, place(to.sector, to.port), place(from.sector, from.port));
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
  const ComplexMatrix c = between_rows(tuned, false);
  const ComplexMatrix c_eta = between_rows(tuned, true);
  const Index size = c.rows();
  const ComplexMatrix factor =
      (ComplexMatrix::Identity(size, size) + d.value * c).partialPivLu().inverse();  // (1 + D C)^-1
  Stiffness all;
  all.value = factor * d.value;
  all.by_eta.noalias() = -all.value * c_eta * all.value;
  if (!d.by_eta.isZero(0))
    all.by_eta += factor * d.by_eta * (ComplexMatrix::Identity(size, size) - c * all.value);
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
      const Index to = place(j / c, j % c);
      response.compliance(first + i, j) = entry(all, false, place(sector, of), to);
      response.compliance_eta(first + i, j) = entry(all, true, place(sector, of), to);
    }
  }
  if (rows_.empty()) return response;
  const Stiffness g = turned(all, eta);
  const ComplexMatrix left = times_rows(all, false, rows);
  const ComplexMatrix left_eta = times_rows(all, true, rows);
  const ComplexMatrix right = port >= 0 ? times_rows(all, false, contacts) : left;
  const ComplexMatrix right_eta = port >= 0 ? times_rows(all, true, contacts) : left_eta;
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
    const ComplexVector x = of_rows(all.free) + times_rows(all, false, contacts).transpose() * forces;
    const ComplexVector taken = turned(all, eta).value * x;  // what the changes meet the motion with
    const ComplexVector moved = x - between_rows(all, false) * taken;
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
