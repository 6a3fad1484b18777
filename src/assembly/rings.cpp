#include "assembly/rings.hpp"

#include <cmath>

#include "arcslip/assembly/reduced_pair.hpp"
#include "arcslip/structure/sector.hpp"
#include "assembly/system_numbers.hpp"

namespace arcslip {
namespace {

using At = SystemParameter::At;

ContactModes in_contact_modes(const ModalModel& model) {
  std::vector<ContactMode> modes;
  for (const Mode& mode : model.modes()) {
    const double shape = std::sqrt(mode.residue);
    modes.push_back({mode.frequency, ContactVector::Constant(1, shape),
                     shape > 0 ? mode.load_residue / shape : Complex(0)});
  }
  return {1, std::move(modes), model.loss()};
}

/// The contact and, below it, outputs of an element's dofs, of which those of its second node are the first
/// one's with the next phase.
PreciseComplexMatrix rows_of(const SystemParameters& parameters, const std::vector<const Vector*>& weights,
                             Index dofs) {
  const PreciseReal a = propagation_constant(parameters.wave_number, parameters.elements);
  const PreciseComplex forward{cos(a), -sin(a)};
  PreciseComplexMatrix rows(std::ssize(weights) + 1, dofs);
  for (Index i = 0; i < dofs; ++i) {
    rows(0, i) = i == 0 ? 1 : 0;
    for (Index k = 1; k < rows.rows(); ++k) {
      const Vector& one = *weights[static_cast<std::size_t>(k - 1)];
      rows(k, i) = PreciseComplex(one(i)) + PreciseComplex(one(dofs + i)) * forward;
    }
  }
  return rows;
}

std::vector<ContactMode> modes_of(const ReducedStructure& structure, const PreciseComplexMatrix& rows) {
  std::vector<ContactMode> modes;
  for (SeenMode& mode : seen_modes(structure, rows))
    modes.push_back({mode.frequency, std::move(mode.shape), mode.load});
  return modes;
}

/// What is wanted of the rings.
std::vector<ContactOutput> outputs_of(const SystemParameters& parameters, const ReducedPair& pair,
                                      const Loss& base_loss, const Loss& damper_loss) {
  std::vector<ContactOutput> outputs;
  for (const WantedOutput& wanted : parameters.wanted) {
    const ReducedStructure& structure = wanted.on_base ? pair.base : pair.damper;
    std::vector<ContactMode> modes;
    if (wanted.on_base || !parameters.fixed_damper)
      modes = modes_of(structure, rows_of(parameters, {&wanted.weights}, structure.mass.rows()));
    const char letter = wanted.on_base ? 'Y' : 'U';
    outputs.push_back({std::string{letter, '_'} + wanted.name,
                       ContactModes(2, std::move(modes), wanted.on_base ? base_loss : damper_loss),
                       wanted.on_base});
  }
  return outputs;
}

/// All that goes with the base's stiffness, as K* grows by a factor with this rate.
void follow_stiffness(At& at, double factor, double rate) {
  at.here.base.stiffness = at.here.base.load = at.here.slip_per_preload = at.here.others = factor;
  at.rate.base.stiffness = at.rate.base.load = at.rate.slip_per_preload = at.rate.others = rate;
}

void change_mass_ratio(At& at, double value, const SystemParameters& system) {
  follow_stiffness(at, value / system.mass_ratio, 1 / system.mass_ratio);
  at.here.base.mass = value / system.mass_ratio;
  at.rate.base.mass = 1 / system.mass_ratio;
}

void change_frequency_ratio(At& at, double value, const SystemParameters& system) {
  const double gamma = system.frequency_ratio;
  follow_stiffness(at, value * value / (gamma * gamma), 2 * value / (gamma * gamma));
  at.here.base_viscous = gamma / value;
  at.rate.base_viscous = -gamma / (value * value);
  at.here.base.loss.viscous *= gamma / value;  // 2 zeta_B/gamma
  at.rate.base.loss.viscous = -at.here.base.loss.viscous / value;
}

/// Of an element, which is made anew at each value.
void leave(At& /*at*/, double /*value*/, const SystemParameters& /*system*/) {}

}  // namespace

ReducedPair reduce(const SystemParameters& parameters) {
  const Index n = parameters.wave_number;
  const Index elements = parameters.elements;
  const auto make = parameters.model == StructureModel::rods ? rod_element : beam_element;
  ReducedPair pair{
      reduce(make(parameters.mass_ratio, parameters.stiffness_ratio(), n, elements), n, elements),
      reduce(make(1, 1, n, elements), n, elements)};
  pair.base.load *= PreciseComplex(parameters.force * parameters.stiffness_ratio());
  pair.damper.load.setZero();
  return pair;
}

ContactSystem Rings::wave(const SystemParameters& parameters) const {
  const FrictionSystem system = one_contact(parameters);
  ContactSystem wave{in_contact_modes(system.base),
                     in_contact_modes(system.damper),
                     {{system.contact_stiffness, system.slip_per_preload}},
                     system.outputs};
  if (parameters.tells_lag) wave.outputs.push_back(driven_motion(wave.base.with_driven_motion()));
  return wave;
}

ContactModes Rings::seen(const SystemParameters& parameters, bool is_base) const {
  const ReducedPair pair = reduce(parameters);
  const ReducedStructure& structure = is_base ? pair.base : pair.damper;
  std::vector<const Vector*> weights;
  for (const WantedOutput& wanted : parameters.wanted) {
    if (wanted.on_base == is_base) weights.push_back(&wanted.weights);
  }
  const PairLosses losses = this->losses(parameters);
  const PreciseComplexMatrix rows = rows_of(parameters, weights, structure.mass.rows());
  std::vector<ContactMode> modes;
  if (is_base || !parameters.fixed_damper) modes = modes_of(structure, rows);
  return {rows.rows(), std::move(modes), is_base ? losses.base(parameters) : losses.damper(parameters)};
}

FrictionSystem Rings::one_contact(const SystemParameters& parameters) const {
  const ReducedPair pair = reduce(parameters);
  const Loss base_loss = parameters.base_damping_kind == DampingKind::structural
                             ? Loss{0, 2 * parameters.base_damping}
                             : Loss{base_damping_factor(parameters), 0};
  const Loss damper_loss{damper_damping_factor(parameters), 0};
  const ModalModel damper = parameters.fixed_damper ? ModalModel() : ModalModel(pair.damper, 0, damper_loss);
  const auto elements = static_cast<double>(parameters.elements);
  return {ModalModel(pair.base, 0, base_loss),
          damper,
          parameters.interface_stiffness / elements,
          parameters.stiffness_ratio() / parameters.interface_stiffness,
          losses(parameters).base_per_zeta,
          cubic_coefficient(parameters),
          parameters.preload_growth,
          {},
          outputs_of(parameters, pair, base_loss, damper_loss)};
}

PairLosses Rings::losses(const SystemParameters& parameters) const {
  const bool is_structural = parameters.base_damping_kind == DampingKind::structural;
  return {.base_per_zeta = is_structural ? Loss{0, 2} : Loss{2 / parameters.frequency_ratio, 0},
          .damper_per_zeta = {2, 0}};
}

std::vector<SystemParameter> Rings::parameters(const SystemParameters& system) const {
  using S = SystemParameters;
  using Kind = SystemParameter::Kind;
  std::vector<SystemParameter> all{
      system_number("M*", &S::mass_ratio, change_mass_ratio, Kind::ratio, system),
      system_number("gamma", &S::frequency_ratio, change_frequency_ratio, Kind::ratio, system),
      system_number("cubic_stiffness", &S::cubic_stiffness, leave, Kind::element, system)};
  all.back().limits = any_value("", 0, "");
  // Damping ratios of waves are told at the base's own frequencies.
  if (system.influence && !system.influence->damping.empty()) all.erase(all.begin() + 1);
  return all;
}

}  // namespace arcslip
