#include "arcslip/assembly/sector_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "arcslip/dense.hpp"
#include "arcslip/sectors/sector_reduction.hpp"
#include "assembly/system_numbers.hpp"
#include "sectors/turning_modes.hpp"

namespace arcslip {

std::string to_string(SectorPath path) { return path == SectorPath::full ? "full" : "reduced"; }

Loss SectorPart::loss_per_zeta() const {
  if (damping_kind == DampingKind::structural) return {.structural = 2};
  if (damping_kind == DampingKind::modal) return {.modal = 2};
  return {.viscous = 2 / reference_frequency};
}

SectorPair::SectorPair(SectorPart base, std::optional<SectorPart> damper, double tolerance, SectorPath path)
    : base_{std::move(base), "base"}, tolerance_(tolerance), path_(path) {
  if (damper) damper_ = Kept{std::move(*damper), "damper"};
}

template <class Key, class Value, class Make>
const Value& SectorPair::found(const Kept& kept, Places<Key, Value>& places, const Key& key,
                               const Make& make) const {
  Once<Value>& place = [&]() -> Once<Value>& {
    const std::scoped_lock lock(mutex_);
    return places[key];
  }();
  std::call_once(place.flag, [&] {
    try {
      place.value = make();
    } catch (const SectorError& error) {
      throw SectorError(std::string(kept.name) + ": " + error.what());
    }
  });
  return place.value;
}

namespace {

/// What a use is told from others by.
std::vector<double> key_of(const SectorUse& use, double zeta) {
  std::vector<double> key{static_cast<double>(use.wave.wave_number), static_cast<double>(use.wave.sectors),
                          use.eta_low, use.eta_high, zeta};
  for (const Rotation& one : use.rotations) key.insert(key.end(), {one.fixed, one.per_eta});
  return key;
}

/// The same sector without what rotation adds.
FiniteSector at_rest(FiniteSector sector) {
  sector.gyroscopic = SparseMatrix();
  sector.stiffness_speed2 = SparseMatrix();
  return sector;
}

}  // namespace

std::shared_ptr<const SectorModes> SectorPair::modes(const Kept& kept, const SectorUse& use,
                                                     double zeta) const {
  // Of resonances that only show where to look: far within the peaks of any damping ratio.
  constexpr double close = 1e-6;
  constexpr Loss little{.structural = 2e-4};
  const bool full = path_ == SectorPath::full;
  return found(kept, kept.modes, key_of(use, full ? 0 : zeta), [&] {
    ModesRequest request{use.eta_low, use.eta_high, tolerance_, kept.part.loss(zeta)};
    request.rotations = use.rotations;
    if (full) {
      request.tolerance = std::max(tolerance_, close);
      request.loss = little;
      request.compared = false;
    }
    return std::make_shared<const SectorModes>(sector_modes(kept.part.sector, use.wave, request));
  });
}

const SectorModes& SectorPair::base_modes(const SectorUse& use, double zeta) const {
  return *modes(base_, use, zeta);
}

const SectorModes& SectorPair::damper_modes(const SectorUse& use, double zeta) const {
  return *modes(damper_.value(), use, zeta);
}

std::shared_ptr<const SectorSolves> SectorPair::solves(const Kept& kept, const SectorUse& use,
                                                       double zeta) const {
  const bool turns = !use.rotations.empty() && kept.part.sector.feels_rotation();
  const Loss loss = kept.part.loss(zeta);
  if (path_ == SectorPath::reduced) {
    if (!turns) return nullptr;
    const std::shared_ptr<const SectorModes> known = modes(kept, use, zeta);
    return found(kept, kept.solves, key_of(use, zeta), [&]() -> std::shared_ptr<const SectorSolves> {
      return std::make_shared<const ModalSolves>(known, std::ssize(kept.part.sector.contacts), loss);
    });
  }
  const std::vector<double> key{static_cast<double>(use.wave.wave_number),
                                static_cast<double>(use.wave.sectors), zeta, turns ? 1.0 : 0.0};
  return found(kept, kept.solves, key, [&]() -> std::shared_ptr<const SectorSolves> {
    const FiniteSector& sector = kept.part.sector;
    return std::make_shared<const FullReceptance>(turns ? sector : at_rest(sector), use.wave, loss);
  });
}

std::shared_ptr<const SectorSolves> SectorPair::base_solves(const SectorUse& use, double zeta) const {
  return solves(base_, use, zeta);
}

std::shared_ptr<const SectorSolves> SectorPair::damper_solves(const SectorUse& use, double zeta) const {
  return solves(damper_.value(), use, zeta);
}

std::shared_ptr<const KnownTurning> SectorPair::turning(bool is_base, const SectorUse& use,
                                                        double zeta) const {
  const Kept& kept = is_base ? base_ : damper_.value();
  const std::shared_ptr<const SectorModes> known = modes(kept, use, zeta);
  return found(kept, kept.turning, key_of(use, zeta), [&] {
    return std::make_shared<const KnownTurning>(known, std::ssize(kept.part.sector.contacts));
  });
}

void SectorPair::check(const Kept& kept, const SectorWave& wave) const {
  if (wave.sectors > 1 && !kept.part.sector.has_boundaries())
    throw SectorError(fmt::format(
        "the {} has no left and right boundary, as a structure without symmetry, expected with {} sectors",
        kept.name, wave.sectors));
  found(kept, kept.checked, {wave.wave_number, wave.sectors}, [&] {
    SectorReduction reduction(kept.part.sector);
    reduction.set_forward(wave.forward());
    check_mass(kept.part.sector, reduction);
    return true;
  });
}

void SectorPair::check(Index wave_number, Index nodes) const {
  const SectorWave wave{wave_number, nodes};
  check(base_, wave);
  if (damper_) check(*damper_, wave);
}

std::shared_ptr<const Structures> SectorPair::in_modes() const {
  if (path_ == SectorPath::reduced) return nullptr;
  const auto diagonal = [](SectorPart part) {
    FiniteSector& sector = part.sector;
    if (sector.damping.size() != 0)
      part.fixed = part.fixed + proportional_loss(sector.damping, sector.mass, sector.stiffness);
    sector.damping = SparseMatrix();
    return part;
  };
  std::optional<SectorPart> damper;
  if (damper_) damper = diagonal(damper_->part);
  return std::make_shared<const SectorPair>(diagonal(base_.part), std::move(damper), tolerance_);
}

bool SectorPair::is_one_contact(const SystemParameters& system) const {
  return system.contacts.size() == 1 && path_ == SectorPath::reduced && !(system.turns() && feels_rotation());
}

std::vector<SystemParameter> SectorPair::parameters(const SystemParameters& system) const {
  if (system.rotation.per_eta != 0 || !feels_rotation()) return {};
  const auto change = [own = system.rotation.fixed](SystemParameter::At& at, double value) {
    at.here.base.speed = at.here.damper.speed = value - own;
    at.rate.base.speed = at.rate.damper.speed = 1;
  };
  const auto set = [](SystemParameters& other, double value) { other.rotation.fixed = value; };
  return {system_number("speed", system.rotation.fixed, change, SystemParameter::Kind::speed, set, system)};
}

PairLosses SectorPair::losses(const SystemParameters& /*system*/) const {
  PairLosses losses{.base_per_zeta = base_.part.loss_per_zeta(), .base_fixed = base_.part.fixed};
  if (!damper_) return losses;
  losses.damper_per_zeta = damper_->part.loss_per_zeta();
  losses.damper_fixed = damper_->part.fixed;
  return losses;
}

Loss proportional_loss(const SparseMatrix& damping, const SparseMatrix& mass, const SparseMatrix& stiffness) {
  constexpr double rounding = 1e-10;
  // Least squares of entries that the diagonals scale, over M and K in units of their own.
  const Vector scale = damping.diagonal().cwiseAbs().cwiseMax(stiffness.diagonal().cwiseAbs() *
                                                              (damping.norm() / stiffness.norm()));
  const Vector factor = scale.unaryExpr([](double s) { return s > 0 ? 1 / std::sqrt(s) : 0.0; });
  const auto scaled = [&](const SparseMatrix& matrix) {
    return SparseMatrix(factor.asDiagonal() * matrix * factor.asDiagonal());
  };
  const SparseMatrix c = scaled(damping);
  SparseMatrix m = scaled(mass);
  SparseMatrix k = scaled(stiffness);
  const double m_size = m.norm();
  const double k_size = k.norm();
  m /= m_size;
  k /= k_size;
  const double alike = m.cwiseProduct(k).sum();
  const Vector products{{m.cwiseProduct(c).sum(), k.cwiseProduct(c).sum()}};
  const Vector factors = shortest(Matrix{{1, alike}, {alike, 1}}, products);
  const SparseMatrix rest = c - factors(0) * m - factors(1) * k;
  if (rest.norm() > rounding * c.norm()) {
    throw SectorError("the damping matrix is not a sum alpha M + beta K, which the modes of the sector need");
  }
  return {.viscous = two_pi * factors(1) / k_size, .mass = factors(0) / m_size / two_pi};
}

}  // namespace arcslip
