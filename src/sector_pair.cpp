#include "arcslip/sector_pair.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <string>

#include "arcslip/sector_reduction.hpp"

namespace arcslip {

Loss SectorPart::loss_per_zeta() const {
  if (damping_kind == DampingKind::structural) return {.structural = 2};
  if (damping_kind == DampingKind::modal) return {.modal = 2};
  return {.viscous = 2 / reference_frequency};
}

SectorPair::SectorPair(SectorPart base, std::optional<SectorPart> damper, double tolerance)
    : base_{std::move(base), "base"}, tolerance_(tolerance) {
  if (damper) damper_ = Kept{std::move(*damper), "damper"};
}

const SectorModes& SectorPair::modes(const Kept& kept, const SectorUse& use, double zeta) const {
  std::shared_ptr<Found> found;
  {
    const std::scoped_lock lock(mutex_);
    std::shared_ptr<Found>& place =
        kept.found[{static_cast<double>(use.wave.wave_number), static_cast<double>(use.wave.sectors),
                    use.eta_low, use.eta_high, zeta}];
    if (!place) place = std::make_shared<Found>();
    found = place;
  }
  std::call_once(found->once, [&] {
    const ModesRequest request{use.eta_low, use.eta_high, tolerance_,
                               kept.part.fixed + zeta * kept.part.loss_per_zeta()};
    try {
      found->modes = sector_modes(kept.part.sector, use.wave, request);
    } catch (const SectorError& error) {
      throw SectorError(std::string(kept.name) + ": " + error.what());
    }
  });
  return found->modes;
}

const SectorModes& SectorPair::base_modes(const SectorUse& use, double zeta) const {
  return modes(base_, use, zeta);
}

const SectorModes& SectorPair::damper_modes(const SectorUse& use, double zeta) const {
  return modes(damper_.value(), use, zeta);
}

void SectorPair::check(const Kept& kept, const SectorWave& wave) const {
  std::shared_ptr<std::once_flag> once;
  {
    const std::scoped_lock lock(mutex_);
    std::shared_ptr<std::once_flag>& place = kept.checked[{wave.wave_number, wave.sectors}];
    if (!place) place = std::make_shared<std::once_flag>();
    once = place;
  }
  std::call_once(*once, [&] {
    SectorReduction reduction(kept.part.sector);
    reduction.set_forward(wave.forward());
    try {
      check_mass(kept.part.sector, reduction);
    } catch (const SectorError& error) {
      throw SectorError(std::string(kept.name) + ": " + error.what());
    }
  });
}

void SectorPair::check(const SectorWave& wave) const {
  check(base_, wave);
  if (damper_) check(*damper_, wave);
}

SectorUse sector_use(const SystemParameters& parameters) {
  return {{parameters.wave_number, parameters.elements}, parameters.eta_low, parameters.eta_high};
}

namespace {

/// One of the two with its modes.
struct Part {
  const SectorPart& part;
  const SectorModes& modes;
  Loss loss;
  double force;       ///< factor of the load
  double force_sign;  ///< of the force that its contacts feel, against the base's
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
    return {count + (output ? 1 : 0), std::move(list), loss};
  }

  void add_outputs(std::vector<ContactOutput>& outputs) const {
    for (Index i = 0; i < std::ssize(part.sector.outputs); ++i) {
      const Index dof = part.sector.outputs[static_cast<std::size_t>(i)] + 1;
      outputs.push_back({fmt::format("{}_{}", letter, dof), contacts(i), force_sign});
    }
  }
};

Part base_part(const SystemParameters& parameters) {
  const SectorPart& part = parameters.sectors->base();
  const double zeta = parameters.base_damping;
  return {part,
          parameters.sectors->base_modes(sector_use(parameters), zeta),
          part.fixed + zeta * part.loss_per_zeta(),
          parameters.force,
          1,
          "Y"};
}

std::optional<Part> damper_part(const SystemParameters& parameters) {
  const SectorPart* part = parameters.sectors->damper();
  if (part == nullptr) return std::nullopt;
  const double zeta = parameters.damper_damping;
  return Part{*part,
              parameters.sectors->damper_modes(sector_use(parameters), zeta),
              part->fixed + zeta * part->loss_per_zeta(),
              0,
              -1,
              "U"};
}

}  // namespace

FrictionSystem build_sector_system(const SystemParameters& parameters) {
  if (parameters.contacts.size() != 1)
    throw SectorError("several contacts of a sector are no system with one contact");
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
  constexpr double two_pi = 2 * std::numbers::pi;
  return {.viscous = two_pi * factors(1) / k_size, .mass = factors(0) / m_size / two_pi};
}

}  // namespace arcslip
