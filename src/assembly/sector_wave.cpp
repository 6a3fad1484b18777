// Base and damper as finite-element sectors under one travelling wave.

#include <fmt/format.h>

#include "arcslip/assembly/sector_pair.hpp"
#include "sectors/turning_modes.hpp"

namespace arcslip {
namespace {

/// One of the two with its modes and, on the full path, its sparse solves.
struct Part {
  const SectorPart& part;
  const SectorModes& modes;
  std::shared_ptr<const SectorSolves> solves;
  Loss loss;
  double force;  ///< factor of the load
  bool is_base;
  const char* letter;
  Rotation rotation;
  ModesAtSpeed turning;  ///< null at rest

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
    if (is_seen) {
      if (solves == nullptr) return modal;
      return modal.solved_at_speeds(
          [solves = solves, output, at = at_speed()](double eta, double load, double speed) {
            return combined(*solves, output, eta, load, at(speed));
          },
          force);
    }
    const ContactModes solved = solves == nullptr ? modal : solved_for(modal);
    return turning ? solved.turning(turning) : solved;
  }

  /// The outputs that are told, as combinations.
  std::vector<Terms> told_outputs() const {
    std::vector<Terms> all;
    for (Index i = 0; i < std::ssize(part.sector.outputs) - part.untold; ++i) all.push_back({{i, 1}});
    for (const auto& [name, terms] : part.combinations) all.push_back(terms);
    return all;
  }

  /// The modes as contacts and these outputs see them.
  std::shared_ptr<const SectorModes> modes_with_outputs() const {
    const Index count = std::ssize(part.sector.contacts);
    const std::vector<Terms> told = told_outputs();
    auto seen = std::make_shared<SectorModes>(modes);
    seen->shapes = ComplexMatrix::Zero(count + std::ssize(told), modes.shapes.cols());
    seen->shapes.topRows(count) = modes.shapes.topRows(count);
    for (Index i = 0; i < std::ssize(told); ++i) {
      for (const auto& [place, weight] : told[static_cast<std::size_t>(i)])
        seen->shapes.row(count + i) += weight * modes.shapes.row(count + place);
    }
    return seen;
  }

  /// Contacts and outputs, solved for in the coordinates of the modes at rest. Of a ring, which keeps what it
  /// needs of it again.
  ContactModes solved_with_outputs() const {
    constexpr std::size_t kept = 1;
    const std::shared_ptr<const SectorModes> seen = modes_with_outputs();
    std::vector<ContactMode> list;
    for (std::size_t k = 0; k < modes.frequencies.size(); ++k) {
      const auto column = static_cast<Index>(k);
      list.push_back({modes.frequencies[k], seen->shapes.col(column), force * modes.loads(column)});
    }
    const Index ports = seen->shapes.rows();
    Part all = *this;
    all.solves = std::make_shared<const ModalSolves>(seen, ports, loss, kept);
    return all.solved_for({ports, std::move(list), loss});
  }

  /// The rotation with so many revolutions more.
  std::function<Rotation(double)> at_speed() const {
    return [own = rotation](double speed) { return Rotation{own.fixed + speed, own.per_eta}; };
  }

  ContactModes solved_for(const ContactModes& modal) const {
    return modal.solved_at_speeds(
        [solves = solves, at = at_speed()](double eta, double load, double speed) {
          return solves->at(eta, load, at(speed));
        },
        force,
        [solves = solves, at = at_speed()](double eta, double load, const ContactVector& forces,
                                           double speed) {
          return solves->work(eta, load, forces, at(speed));
        });
  }

  static VariedReceptance combined(const SectorSolves& solves, const Terms& terms, double eta, double load,
                                   const Rotation& rotation) {
    VariedReceptance sum;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      VariedReceptance one = solves.with_output(terms[i].output, eta, load, rotation);
      const Index m = one.free.size() - 1;
      for (ContactMatrix* matrix : {&one.compliance, &one.compliance_eta, &one.compliance_rate})
        matrix->row(m) *= terms[i].weight;
      for (ContactVector* vector : {&one.free, &one.free_eta, &one.free_rate})
        (*vector)(m) *= terms[i].weight;
      if (i == 0) {
        sum = std::move(one);
        continue;
      }
      sum.compliance.row(m) += one.compliance.row(m);
      sum.compliance_eta.row(m) += one.compliance_eta.row(m);
      sum.compliance_rate.row(m) += one.compliance_rate.row(m);
      sum.free(m) += one.free(m);
      sum.free_eta(m) += one.free_eta(m);
      sum.free_rate(m) += one.free_rate(m);
    }
    return sum;
  }

  ContactModes driven() const {
    const ContactModes modal = contacts().with_driven_motion();
    if (solves == nullptr) return modal;
    return modal.solved_at_speeds(
        [solves = solves, at = at_speed()](double eta, double load, double speed) {
          return solves->with_driven_motion(eta, load, at(speed));
        },
        force);
  }

  void add_outputs(std::vector<ContactOutput>& outputs) const {
    const Index dofs = std::ssize(part.sector.outputs) - part.untold;
    const std::vector<Terms> told = told_outputs();
    for (Index i = 0; i < std::ssize(told); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const std::string name = i < dofs ? fmt::format("{}", part.sector.outputs[at] + 1)
                                        : part.combinations[static_cast<std::size_t>(i - dofs)].name;
      outputs.push_back({fmt::format("{}_{}", letter, name), contacts(told[at]), is_base});
    }
  }
};

/// The use that a system makes of its sectors, at the speeds that are asked for: where it is continued those
/// at the ends of its window and between them.
SectorUse use_of(const SectorPair& pair, const SystemParameters& system) {
  SectorUse use{{system.wave_number, system.elements}, system.eta_low, system.eta_high};
  if (!system.turns() || !pair.feels_rotation()) return use;
  use.rotations = {system.rotation};
  if (system.varied != "speed") return use;
  const double middle = 0.5 * (system.speed_low + system.speed_high);
  for (const double speed : {system.speed_low, middle, system.speed_high}) {
    if (speed != system.rotation.fixed) use.rotations.push_back({speed, 0});
  }
  return use;
}

Part part_of(const SectorPair& pair, const SystemParameters& system, bool is_base) {
  const double zeta = is_base ? system.base_damping : system.damper_damping;
  const SectorUse use = use_of(pair, system);
  const SectorPart& part = is_base ? pair.base() : *pair.damper();
  const double force = is_base ? system.force : 0;
  ModesAtSpeed turning;
  if (!use.rotations.empty()) {
    turning = [known = pair.turning(is_base, use, zeta), own = system.rotation](double speed) {
      return known->at({own.fixed + speed, own.per_eta});
    };
  }
  return {part,
          is_base ? pair.base_modes(use, zeta) : pair.damper_modes(use, zeta),
          is_base ? pair.base_solves(use, zeta) : pair.damper_solves(use, zeta),
          part.loss(zeta),
          force,
          is_base,
          is_base ? "Y" : "U",
          system.rotation,
          std::move(turning)};
}

Part base_part(const SectorPair& pair, const SystemParameters& system) { return part_of(pair, system, true); }

std::optional<Part> damper_part(const SectorPair& pair, const SystemParameters& system) {
  if (pair.damper() == nullptr) return std::nullopt;
  return part_of(pair, system, false);
}

PartModes told(const char* name, const Part& part, double tolerance, SectorPath path) {
  const SectorModes& modes = part.modes;
  PartModes told{name, modes.dofs, static_cast<Index>(modes.frequencies.size()), modes.factorisations};
  if (path == SectorPath::full) {
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

std::shared_ptr<const SectorModes> SectorPair::turning_modes(const SystemParameters& system,
                                                             bool is_base) const {
  const bool turns = path_ == SectorPath::reduced && system.turns() && (is_base || damper_) &&
                     (is_base ? base_ : *damper_).part.sector.feels_rotation();
  return turns ? part_of(*this, system, is_base).modes_with_outputs() : nullptr;
}

ContactModes SectorPair::seen(const SystemParameters& system, bool is_base) const {
  return turning_modes(system, is_base) != nullptr ? part_of(*this, system, is_base).solved_with_outputs()
                                                   : Structures::seen(system, is_base);
}

std::vector<PartModes> SectorPair::modes(const SystemParameters& system) const {
  std::vector<PartModes> parts{told("base", base_part(*this, system), tolerance_, path_)};
  if (const std::optional<Part> damper = damper_part(*this, system))
    parts.push_back(told("damper", *damper, tolerance_, path_));
  return parts;
}

}  // namespace arcslip
