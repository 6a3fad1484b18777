#include "assembly/ring_part.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/structure/block_circulant.hpp"

namespace arcslip {
namespace {

using Places = std::vector<std::array<Index, 2>>;  // sectors with ports

Variation by_added_speed() {
  Variation rate = Variation::none();
  rate.speed = 1;
  return rate;
}

}  // namespace

RingPart::RingPart(Given given) : given_(std::move(given)) {
  const auto is_solved = [](const ContactModes& wave) { return wave.is_solved(); };
  is_modal_ = std::none_of(given_.waves.begin(), given_.waves.end(), is_solved);
  given_.turns = given_.turns && !is_modal_;
  ports_ = given_.waves.front().contacts();
  turns_ = wave_turns(count());
  transform_ = turns_ / static_cast<double>(count());
  for (const ContactModes& wave : given_.waves) {
    is_loaded_.push_back(wave.is_solved() || std::any_of(wave.modes().begin(), wave.modes().end(),
                                                         [](const auto& mode) { return mode.load != 0.0; }));
  }
  for (const RingChange& change : given_.changes)
    rows_.insert(rows_.end(), change.of.begin(), change.of.end());
  const Index size = std::ssize(rows_);
  stiffness_.setZero(size, size);
  mass_.setZero(size, size);
  Index at = 0;
  for (const RingChange& change : given_.changes) {
    const Index own = std::ssize(change.of);
    stiffness_.block(at, at, own, own) = change.stiffness;
    if (change.mass.size() > 0) mass_.block(at, at, own, own) = change.mass;
    at += own;
  }
  for (Index i = 0; i < count() * given_.contacts; ++i)
    contacts_.push_back({i / given_.contacts, i % given_.contacts});
  for (Index i = 0; i < count() * ports_; ++i) places_.push_back({i / ports_, i % ports_});
}

/// The blocks of all lags between sectors, by a transformation over the waves of all entries at once.
RingPart::Tuned RingPart::tuned(double eta, double speed) const {
  const Index n = count();
  const Index entries = ports_ * ports_;
  ComplexMatrix waves = ComplexMatrix::Zero((1 + slopes()) * entries, n);
  ComplexMatrix free = ComplexMatrix::Zero((1 + slopes()) * ports_, n);
  const auto keep = [&](Index m, Slope slope, const auto& compliance) {
    Eigen::Map<ContactMatrix>(waves.col(m).data() + slope * entries, ports_, ports_) = compliance;
  };
  VariedReceptance one;
  for (Index m = 0; m < n; ++m) {
    const auto at = static_cast<std::size_t>(m);
    const ContactModes& wave = given_.waves[at];
    const bool is_twin = is_modal_ && 2 * m > n;
    if (is_twin && !is_loaded_[at]) continue;
    if (wave.is_solved()) {
      one = wave.varied(eta, {.speed = speed}, by_added_speed());
    } else {
      one.set_zero(ports_);
      wave.add(eta, one);
    }
    if (is_loaded_[at]) free.col(m).head(2 * ports_) << one.free, one.free_eta;
    if (is_twin) continue;
    keep(m, itself, one.compliance);
    keep(m, along_eta, one.compliance_eta);
    if (is_modal_ && m > 0 && 2 * m < n) {
      keep(n - m, itself, one.compliance.transpose());
      keep(n - m, along_eta, one.compliance_eta.transpose());
    }
    if (!given_.varies_speed || !wave.is_solved()) continue;
    free.col(m).tail(ports_) = one.free_rate;
    keep(m, along_speed, one.compliance_rate);
  }
  Tuned sum;
  sum.entries.noalias() = waves * transform_;
  const double size = std::sqrt(static_cast<double>(n));
  for (Index k = 0; k <= slopes(); ++k)
    sum.free.emplace_back(size * (free.middleRows(k * ports_, ports_) * transform_));
  return sum;
}

RingPart::Stiffness RingPart::stiffness(double eta) const {
  const Loss& loss = given_.loss;
  return {Complex(1, loss.at(eta)) * stiffness_.cast<Complex>() -
              (rate() * Complex(eta * eta, -loss.mass * eta)) * mass_.cast<Complex>(),
          Complex(0, loss.viscous) * stiffness_.cast<Complex>() -
              (rate() * Complex(2 * eta, -loss.mass)) * mass_.cast<Complex>()};
}

/// D X, change by change.
ComplexMatrix RingPart::times_changes(const ComplexMatrix& blocks, const ComplexMatrix& x) const {
  const auto is_single = [](const RingChange& change) { return change.of.size() == 1; };
  if (std::all_of(given_.changes.begin(), given_.changes.end(), is_single))
    return blocks.diagonal().asDiagonal() * x;
  ComplexMatrix product(x.rows(), x.cols());
  Index at = 0;
  for (const RingChange& change : given_.changes) {
    const Index own = std::ssize(change.of);
    product.middleRows(at, own) = blocks.block(at, at, own, own).lazyProduct(x.middleRows(at, own));
    at += own;
  }
  return product;
}

ComplexMatrix RingPart::times_rows(const Tuned& tuned, Slope slope, const Places& places,
                                   bool of_forces) const {
  ComplexMatrix product = ComplexMatrix::Zero(std::ssize(places), std::ssize(rows_));
  for (Index k = 0; k < product.cols(); ++k) {
    for (const RingChange::Term& term : rows_[static_cast<std::size_t>(k)]) {
      const Index changed = place(term.sector, term.port);
      for (Index i = 0; i < product.rows(); ++i) {
        const auto& [sector, port] = places[static_cast<std::size_t>(i)];
        const Index seen = place(sector, port);
        product(i, k) += term.weight * (of_forces ? entry(tuned, slope, changed, seen)
                                                  : entry(tuned, slope, seen, changed));
      }
    }
  }
  return product;
}

ComplexMatrix RingPart::between_rows(const Tuned& tuned, Slope slope) const {
  const Index size = std::ssize(rows_);
  ComplexMatrix product = ComplexMatrix::Zero(size, size);
  for (Index k = 0; k < size; ++k) {
    for (Index i = 0; i < size; ++i) {
      for (const RingChange::Term& to : rows_[static_cast<std::size_t>(i)]) {
        for (const RingChange::Term& from : rows_[static_cast<std::size_t>(k)])
          product(i, k) += to.weight * from.weight *
                           entry(tuned, slope, place(to.sector, to.port), place(from.sector, from.port));
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

RingPart::Rows RingPart::rows(const Solved& all, const Places& places, bool of_forces) const {
  Rows found{times_rows(all.tuned, itself, places, of_forces), {}, {}, {}, {}};
  if (of_forces || !given_.turns) {  // (1 + D S)^-1 D L^T
    found.held.noalias() =
        all.factors.solve(times_changes(all.changes.value, found.left.transpose())).transpose();
  } else {  // D (1 + S^T D)^-1 L^T
    const ComplexMatrix turned = all.factors.transpose().solve(found.left.transpose());
    found.held.noalias() = times_changes(all.changes.value, turned).transpose();
  }
  const auto met = [&](const ComplexMatrix& between) -> ComplexMatrix {
    if (of_forces) return found.held * between.transpose();
    return found.held * between;
  };
  for (Index k = 0; k < slopes(); ++k) {
    found.slope.push_back(times_rows(all.tuned, static_cast<Slope>(k + 1), places, of_forces));
    found.rate.emplace_back(found.slope.back() - 0.5 * met(all.between_slope[static_cast<std::size_t>(k)]));
  }
  if (!all.changes.by_eta.isZero(0)) found.kept = found.left - met(all.between);
  return found;
}

std::shared_ptr<const RingPart::Solved> RingPart::solved(double eta, double speed) const {
  std::shared_ptr<const Solved> known = last_.load();
  if (known != nullptr && known->eta == eta && known->speed == speed) return known;
  const auto all = std::make_shared<Solved>();
  all->eta = eta;
  all->speed = speed;
  all->tuned = tuned(eta, speed);
  if (!rows_.empty()) {
    all->changes = stiffness(eta);
    all->between = between_rows(all->tuned, itself);
    for (Index k = 1; k <= slopes(); ++k)
      all->between_slope.push_back(between_rows(all->tuned, static_cast<Slope>(k)));
    ComplexMatrix turned = times_changes(all->changes.value, all->between);
    turned.diagonal().array() += 1.0;
    all->factors.compute(turned);
    all->contacts = rows(*all, contacts_, false);
    if (given_.turns) all->forces = rows(*all, contacts_, true);
  }
  last_.store(all);
  return all;
}

VariedReceptance RingPart::at(double eta, double load, double speed, Index port) const {
  const std::shared_ptr<const Solved> all = solved(eta, speed);
  Places places = contacts_;
  if (port >= 0) {
    places.clear();
    for (Index i = 0; i < count(); ++i) places.push_back({i, port});
  }
  const Index columns = std::ssize(contacts_);
  const Index first = port >= 0 ? columns : 0;
  const Index size = std::ssize(places);
  VariedReceptance response;
  response.set_zero(first + size);
  response.compliance_rate.setZero(first + size, first + size);
  response.free_rate.setZero(first + size);
  const auto fill = [&](Slope slope, ContactMatrix& compliance, ContactVector& free) {
    for (Index i = 0; i < size; ++i) {
      const auto& [sector, of] = places[static_cast<std::size_t>(i)];
      free(first + i) = load * all->tuned.free[static_cast<std::size_t>(slope)](of, sector);
      for (Index j = 0; j < columns; ++j) {
        const auto& [to, contact] = contacts_[static_cast<std::size_t>(j)];
        compliance(first + i, j) = entry(all->tuned, slope, place(sector, of), place(to, contact));
      }
    }
  };
  fill(itself, response.compliance, response.free);
  fill(along_eta, response.compliance_eta, response.free_eta);
  if (given_.varies_speed) fill(along_speed, response.compliance_rate, response.free_rate);
  if (rows_.empty()) return response;
  if (port < 0) {
    add_changes(*all, all->contacts, load, response);
  } else {
    add_changes(*all, rows(*all, places, false), load, response);
  }
  return response;
}

/// What they make of the last rows of a response.
void RingPart::add_changes(const Solved& all, const Rows& own, double load,
                           VariedReceptance& response) const {
  const Rows& forces = all.from();
  const Index columns = std::ssize(contacts_);
  const Index size = own.left.rows();
  const Index first = response.free.size() - size;
  response.compliance.block(first, 0, size, columns).noalias() -= own.held * forces.left.transpose();
  const ComplexVector x = load * of_rows(all.tuned.free[itself]);
  const ComplexVector met = all.factors.solve(all.changes.value * x);  // by the changes
  response.free.tail(size).noalias() -= own.held * x;
  for (Index k = 0; k < slopes(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    auto compliance =
        (k == 0 ? response.compliance_eta : response.compliance_rate).block(first, 0, size, columns);
    auto free = (k == 0 ? response.free_eta : response.free_rate).tail(size);
    const ComplexMatrix half = own.rate[at] * forces.held.transpose();
    compliance -= half;
    if (&own == &forces) {
      compliance -= half.transpose();
    } else {
      compliance.noalias() -= own.held * forces.rate[at].transpose();
    }
    free.noalias() -= own.slope[at] * met +
                      own.held * (load * of_rows(all.tuned.free[at + 1]) - all.between_slope[at] * met);
  }
  if (own.kept.size() == 0) return;
  response.compliance_eta.block(first, 0, size, columns).noalias() -=
      own.kept * (all.changes.by_eta * forces.kept.transpose());
  response.free_eta.tail(size).noalias() -= own.kept * (all.changes.by_eta * (x - all.between * met));
}

CycleWork RingPart::work(double eta, double load, const ContactVector& forces, double speed) const {
  const Index n = count();
  const Index c = given_.contacts;
  ComplexMatrix on_ports = ComplexMatrix::Zero(ports_, n);
  for (Index i = 0; i < n * c; ++i) on_ports(i % c, i / c) = forces(i);
  CycleWork sum;
  if (!rows_.empty()) {
    const std::shared_ptr<const Solved> all = solved(eta, speed);
    const ComplexVector x = load * of_rows(all->tuned.free[itself]) + all->from().left.transpose() * forces;
    const ComplexVector taken = all->factors.solve(all->changes.value * x);  // what the changes meet it with
    const ComplexVector moved = x - all->between * taken;
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
    for (Index i = 0; i < n; ++i) of_wave += (part * std::conj(turns_(m, i))) * on_ports.col(i);
    const ContactModes& wave = given_.waves[static_cast<std::size_t>(m)];
    const CycleWork own =
        wave.varied(Variation{.load = load, .loss = wave.loss(), .speed = speed}).work(eta, of_wave);
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
      for (Index i = 0; i < n * c; ++i) shape(i) = part * turns_(m, i / c) * mode.shape(i % c);
      all.push_back({mode.frequency, std::move(shape), mode.load});
    }
  }
  return {n * c, std::move(all), given_.waves.front().loss()};
}

}  // namespace arcslip
