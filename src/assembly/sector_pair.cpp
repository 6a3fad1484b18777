#include "arcslip/assembly/sector_pair.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "arcslip/sectors/sector_reduction.hpp"
#include "sectors/full_receptance.hpp"

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

const SectorModes& SectorPair::modes(const Kept& kept, const SectorUse& use, double zeta) const {
  // Of resonances that only show where to look: far within the peaks of any damping ratio.
  constexpr double close = 1e-6;
  constexpr Loss little{.structural = 2e-4};
  const bool full = path_ == SectorPath::full;
  const double damping = full ? 0 : zeta;
  const std::array<double, 5> key = {static_cast<double>(use.wave.wave_number),
                                     static_cast<double>(use.wave.sectors), use.eta_low, use.eta_high,
                                     damping};
  return found(kept, kept.modes, key, [&] {
    ModesRequest request{use.eta_low, use.eta_high, tolerance_, kept.part.loss(zeta)};
    if (full) {
      request.tolerance = std::max(tolerance_, close);
      request.loss = little;
      request.compared = false;
    }
    return sector_modes(kept.part.sector, use.wave, request);
  });
}

const SectorModes& SectorPair::base_modes(const SectorUse& use, double zeta) const {
  return modes(base_, use, zeta);
}

const SectorModes& SectorPair::damper_modes(const SectorUse& use, double zeta) const {
  return modes(damper_.value(), use, zeta);
}

std::shared_ptr<const FullReceptance> SectorPair::solves(const Kept& kept, const SectorWave& wave,
                                                         double zeta) const {
  const std::array<double, 3> key = {static_cast<double>(wave.wave_number), static_cast<double>(wave.sectors),
                                     zeta};
  return found(kept, kept.solves, key, [&] {
    return std::make_shared<const FullReceptance>(kept.part.sector, wave, kept.part.loss(zeta));
  });
}

std::shared_ptr<const FullReceptance> SectorPair::base_solves(const SectorWave& wave, double zeta) const {
  return solves(base_, wave, zeta);
}

std::shared_ptr<const FullReceptance> SectorPair::damper_solves(const SectorWave& wave, double zeta) const {
  return solves(damper_.value(), wave, zeta);
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
  return system.contacts.size() == 1 && path_ == SectorPath::reduced;
}

PairLosses SectorPair::losses(const SystemParameters& /*system*/) const {
  PairLosses losses{.base_per_zeta = base_.part.loss_per_zeta(), .base_fixed = base_.part.fixed};
  if (!damper_) return losses;
  losses.damper_per_zeta = damper_->part.loss_per_zeta();
  losses.damper_fixed = damper_->part.fixed;
  return losses;
}

namespace {

/// One of the two with its modes and, on the full path, its sparse solves.
struct Part {
  const SectorPart& part;
  const SectorModes& modes;
  std::shared_ptr<const FullReceptance> solves;
  Loss loss;
  double force;  ///< factor of the load
  bool is_base;
  const char* letter;

  using Terms = std::vector<SectorOutput::Term>;

  /// The contacts and, if one is asked for, an output after them.
  ContactModes contacts(const Terms& output = {}) const {
    const bool is_seen = !output.empty();
    const Index count = std::ssize(part.sector.contacts);
    std::vector<ContactMode> list;
    for (std::size_t k = 0; k < modes.frequencies.size(); ++k) {
      const auto column = static_cast<Index>(k);
      ContactMode mode{modes.frequencies[k], modes.shapes.col(column).head(count),
                       force * modes.loads(column)};
      if (is_seen) {
        mode.shape.conservativeResize(count + 1);
        mode.shape(count) = 0;
        for (const auto& [place, weight] : output)
          mode.shape(count) += weight * modes.shapes(count + place, column);
      }
      list.push_back(std::move(mode));
    }
    const ContactModes modal(count + (is_seen ? 1 : 0), std::move(list), loss);
    if (solves == nullptr) return modal;
    if (is_seen) {
      return modal.solved_by(
          [solves = solves, output](double eta, double load) { return combined(*solves, output, eta, load); },
          force);
    }
    return modal.solved_by([solves = solves](double eta, double load) { return solves->at(eta, load); },
                           force,
                           [solves = solves](double eta, double load, const ContactVector& forces) {
                             return solves->work(eta, load, forces);
                           });
  }

  static ContactReceptance combined(const FullReceptance& solves, const Terms& terms, double eta,
                                    double load) {
    ContactReceptance sum;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      ContactReceptance one = solves.with_output(terms[i].output, eta, load);
      const Index m = one.free.size() - 1;
      one.compliance.row(m) *= terms[i].weight;
      one.compliance_eta.row(m) *= terms[i].weight;
      one.free(m) *= terms[i].weight;
      one.free_eta(m) *= terms[i].weight;
      if (i == 0) {
        sum = std::move(one);
        continue;
      }
      sum.compliance.row(m) += one.compliance.row(m);
      sum.compliance_eta.row(m) += one.compliance_eta.row(m);
      sum.free(m) += one.free(m);
      sum.free_eta(m) += one.free_eta(m);
    }
    return sum;
  }

  ContactModes driven() const {
    const ContactModes modal = contacts().with_driven_motion();
    if (solves == nullptr) return modal;
    return modal.solved_by(
        [solves = solves](double eta, double load) { return solves->with_driven_motion(eta, load); }, force);
  }

  void add_outputs(std::vector<ContactOutput>& outputs) const {
    for (Index i = 0; i < std::ssize(part.sector.outputs) - part.untold; ++i) {
      const Index dof = part.sector.outputs[static_cast<std::size_t>(i)] + 1;
      outputs.push_back({fmt::format("{}_{}", letter, dof), contacts({{i, 1}}), is_base});
    }
    for (const auto& [name, terms] : part.combinations)
      outputs.push_back({fmt::format("{}_{}", letter, name), contacts(terms), is_base});
  }
};

/// The use that a system makes of its sectors.
SectorUse use_of(const SystemParameters& system) {
  return {{system.wave_number, system.elements}, system.eta_low, system.eta_high};
}

Part base_part(const SectorPair& pair, const SystemParameters& system) {
  const double zeta = system.base_damping;
  const SectorUse use = use_of(system);
  const bool full = pair.path() == SectorPath::full;
  return {pair.base(),
          pair.base_modes(use, zeta),
          full ? pair.base_solves(use.wave, zeta) : nullptr,
          pair.base().loss(zeta),
          system.force,
          true,
          "Y"};
}

std::optional<Part> damper_part(const SectorPair& pair, const SystemParameters& system) {
  if (pair.damper() == nullptr) return std::nullopt;
  const double zeta = system.damper_damping;
  const SectorUse use = use_of(system);
  const bool full = pair.path() == SectorPath::full;
  return Part{*pair.damper(),
              pair.damper_modes(use, zeta),
              full ? pair.damper_solves(use.wave, zeta) : nullptr,
              pair.damper()->loss(zeta),
              0,
              false,
              "U"};
}

PartModes told(const char* name, const Part& part, double tolerance) {
  const SectorModes& modes = part.modes;
  PartModes told{name, modes.dofs, static_cast<Index>(modes.frequencies.size()), modes.factorisations};
  if (part.solves != nullptr) {
    told.is_solved = true;
    told.factorisations = part.solves->factorisations();
    return told;
  }
  told.error = modes.error;
  told.error_eta = modes.error_eta;
  told.check_etas = modes.check_etas;
  told.tolerance = tolerance;
  return told;
}

}  // namespace

ContactSystem SectorPair::wave(const SystemParameters& system) const {
  const Part base = base_part(*this, system);
  const std::optional<Part> damper = damper_part(*this, system);
  const ContactModes held(std::ssize(system.contacts), {}, {});
  ContactSystem wave{base.contacts(), damper ? damper->contacts() : held, system.contacts};
  base.add_outputs(wave.outputs);
  if (damper) damper->add_outputs(wave.outputs);
  if (system.tells_lag) wave.outputs.push_back(driven_motion(base.driven()));
  return wave;
}

std::vector<PartModes> SectorPair::modes(const SystemParameters& system) const {
  std::vector<PartModes> parts{told("base", base_part(*this, system), tolerance_)};
  if (const std::optional<Part> damper = damper_part(*this, system))
    parts.push_back(told("damper", *damper, tolerance_));
  return parts;
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
  Eigen::Matrix2d normal;
  normal << 1, m.cwiseProduct(k).sum(), m.cwiseProduct(k).sum(), 1;
  const Eigen::Vector2d factors =
      normal.fullPivLu().solve(Eigen::Vector2d(m.cwiseProduct(c).sum(), k.cwiseProduct(c).sum()));
  const SparseMatrix rest = c - factors(0) * m - factors(1) * k;
  if (rest.norm() > rounding * c.norm()) {
    throw SectorError("the damping matrix is not a sum alpha M + beta K, which the modes of the sector need");
  }
  return {.viscous = two_pi * factors(1) / k_size, .mass = factors(0) / m_size / two_pi};
}

}  // namespace arcslip
