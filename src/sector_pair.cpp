#include "arcslip/sector_pair.hpp"

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

/// The outputs of a part, whose contact feels `sign` times the base's force.
void add_outputs(const SectorPart& part, const SectorModes& found, const Loss& loss, const char* letter,
                 Complex sign, double force, std::vector<ContactOutput>& outputs) {
  for (Index i = 0; i < found.output_by_load.rows(); ++i) {
    std::vector<Mode> by_load = found.modes;
    std::vector<Mode> by_contact = found.modes;
    for (std::size_t k = 0; k < found.modes.size(); ++k) {
      by_load[k].load_residue = force * found.output_by_load(i, static_cast<Index>(k));
      by_contact[k].load_residue = sign * found.output_by_contact(i, static_cast<Index>(k));
    }
    const Index dof = part.sector.outputs[static_cast<std::size_t>(i)] + 1;
    outputs.push_back({std::string(letter) + "_" + std::to_string(dof),
                       {std::move(by_load), loss},
                       {std::move(by_contact), loss}});
  }
}

}  // namespace

FrictionSystem build_sector_system(const SystemParameters& parameters) {
  const SectorPair& sectors = *parameters.sectors;
  const SectorUse use = sector_use(parameters);
  const double k = parameters.interface_stiffness / static_cast<double>(parameters.elements);
  const SectorPart& base = sectors.base();
  const Loss base_loss = base.fixed + parameters.base_damping * base.loss_per_zeta();
  const SectorModes& base_modes = sectors.base_modes(use, parameters.base_damping);
  std::vector<Mode> loaded = base_modes.modes;
  for (Mode& mode : loaded) mode.load_residue *= parameters.force;
  FrictionSystem system{.base = ModalModel(std::move(loaded), base_loss),
                        .damper = {},
                        .contact_stiffness = k,
                        .slip_per_preload = parameters.limit_per_preload / k,
                        .base_loss_per_zeta = base.loss_per_zeta(),
                        .preload_growth = parameters.preload_growth,
                        .base_loss_fixed = base.fixed};
  add_outputs(base, base_modes, base_loss, "Y", 1, parameters.force, system.outputs);
  if (sectors.damper() == nullptr) return system;
  const SectorPart& damper = *sectors.damper();
  const Loss loss = damper.fixed + parameters.damper_damping * damper.loss_per_zeta();
  const SectorModes& modes = sectors.damper_modes(use, parameters.damper_damping);
  system.damper = ModalModel(modes.modes, loss);
  add_outputs(damper, modes, loss, "U", -1, 0, system.outputs);
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
