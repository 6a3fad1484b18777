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
  found(kept, kept.checked, {wave.wave_number, wave.sectors}, [&] {
    SectorReduction reduction(kept.part.sector);
    reduction.set_forward(wave.forward());
    check_mass(kept.part.sector, reduction);
    return true;
  });
}

void SectorPair::check(const SectorWave& wave) const {
  check(base_, wave);
  if (damper_) check(*damper_, wave);
}

std::shared_ptr<const SectorPair> reduced(const SectorPair& pair) {
  const auto diagonal = [](SectorPart part) {
    FiniteSector& sector = part.sector;
    if (sector.damping.size() != 0)
      part.fixed = part.fixed + proportional_loss(sector.damping, sector.mass, sector.stiffness);
    sector.damping = SparseMatrix();
    return part;
  };
  std::optional<SectorPart> damper;
  if (pair.damper() != nullptr) damper = diagonal(*pair.damper());
  return std::make_shared<const SectorPair>(diagonal(pair.base()), std::move(damper), pair.tolerance());
}

bool needs_contact_system(const SystemParameters& parameters) {
  return parameters.sectors &&
         (parameters.contacts.size() > 1 || parameters.sectors->path() == SectorPath::full);
}

SectorUse sector_use(const SystemParameters& parameters) {
  return {{parameters.wave_number, parameters.elements}, parameters.eta_low, parameters.eta_high};
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

  ModalModel contact() const { return modal_model(modes, force, loss); }

  /// The contacts and, if one is asked for, an output after them.
  ContactModes contacts(std::optional<Index> output = {}) const {
    const Index count = std::ssize(part.sector.contacts);
    std::vector<ContactMode> list;
    for (std::size_t k = 0; k < modes.frequencies.size(); ++k) {
      const auto column = static_cast<Index>(k);
      ContactMode mode{modes.frequencies[k], modes.shapes.col(column).head(count),
                       force * modes.loads(column)};
      if (output) {
        mode.shape.conservativeResize(count + 1);
        mode.shape(count) = modes.shapes(count + *output, column);
      }
      list.push_back(std::move(mode));
    }
    const ContactModes modal(count + (output ? 1 : 0), std::move(list), loss);
    if (solves == nullptr) return modal;
    if (output) {
      return modal.solved_by([solves = solves, output = *output, force = force](double eta) {
        return solves->with_output(output, eta, force);
      });
    }
    return modal.solved_by([solves = solves, force = force](double eta) { return solves->at(eta, force); },
                           [solves = solves, force = force](double eta, const ContactVector& forces) {
                             return solves->work(eta, force, forces);
                           });
  }

  ContactModes driven() const {
    const ContactModes modal = contacts().with_driven_motion();
    if (solves == nullptr) return modal;
    return modal.solved_by(
        [solves = solves, force = force](double eta) { return solves->with_driven_motion(eta, force); });
  }

  void add_outputs(std::vector<ContactOutput>& outputs) const {
    for (Index i = 0; i < std::ssize(part.sector.outputs); ++i) {
      const Index dof = part.sector.outputs[static_cast<std::size_t>(i)] + 1;
      outputs.push_back({fmt::format("{}_{}", letter, dof), contacts(i), is_base});
    }
  }
};

Part base_part(const SystemParameters& parameters) {
  const SectorPart& part = parameters.sectors->base();
  const double zeta = parameters.base_damping;
  const SectorUse use = sector_use(parameters);
  const bool full = parameters.sectors->path() == SectorPath::full;
  return {part,
          parameters.sectors->base_modes(use, zeta),
          full ? parameters.sectors->base_solves(use.wave, zeta) : nullptr,
          part.loss(zeta),
          parameters.force,
          true,
          "Y"};
}

std::optional<Part> damper_part(const SystemParameters& parameters) {
  const SectorPart* part = parameters.sectors->damper();
  if (part == nullptr) return std::nullopt;
  const double zeta = parameters.damper_damping;
  const SectorUse use = sector_use(parameters);
  const bool full = parameters.sectors->path() == SectorPath::full;
  return Part{*part,
              parameters.sectors->damper_modes(use, zeta),
              full ? parameters.sectors->damper_solves(use.wave, zeta) : nullptr,
              part->loss(zeta),
              0,
              false,
              "U"};
}

}  // namespace

FrictionSystem build_sector_system(const SystemParameters& parameters) {
  if (parameters.contacts.size() != 1)
    throw SectorError("several contacts of a sector are no system with one contact");
  if (parameters.sectors->path() == SectorPath::full)
    throw SectorError("sparse solves of a sector are no modes, which a system with one contact is made of");
  const SectorContact& contact = parameters.contacts.front();
  const Part base = base_part(parameters);
  FrictionSystem system{.base = base.contact(),
                        .damper = {},
                        .contact_stiffness = contact.stiffness,
                        .slip_per_preload = contact.slip_per_preload,
                        .base_loss_per_zeta = base.part.loss_per_zeta(),
                        .preload_growth = parameters.preload_growth,
                        .base_loss_fixed = base.part.fixed};
  base.add_outputs(system.outputs);
  if (const std::optional<Part> damper = damper_part(parameters)) {
    system.damper = damper->contact();
    damper->add_outputs(system.outputs);
  }
  return system;
}

ContactSystem build_contact_system(const SystemParameters& parameters) {
  const Part base = base_part(parameters);
  const std::optional<Part> damper = damper_part(parameters);
  const ContactModes held(std::ssize(parameters.contacts), {}, {});
  ContactSystem system{base.contacts(), damper ? damper->contacts() : held, parameters.contacts};
  base.add_outputs(system.outputs);
  if (damper) damper->add_outputs(system.outputs);
  if (parameters.tells_lag) system.outputs.push_back(driven_motion(base.driven()));
  return system;
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
