#include "arcslip/assembly/coordinates.hpp"

#include <algorithm>
#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/structures.hpp"
#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/elements/held_element.hpp"
#include "arcslip/elements/idle.hpp"
#include "arcslip/elements/jenkins.hpp"
#include "arcslip/elements/memoryless.hpp"

namespace arcslip {

namespace {

/// The numbers of an element at a node, with derivatives by one of the settings where that has a value of its
/// own.
ElementKind::Values values_of(const PlacedElement& placed, double nodes, double rate, double usual_stiffness,
                              Index varied = -1, double value = 0) {
  ElementKind::Values values{{}, usual_stiffness, rate, placed.closes()};
  for (Index i = 0; i < std::ssize(placed.settings); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double share = placed.kind->settings[k].scales_force ? 1 / nodes : 1;
    values.settings.push_back(i == varied ? Jet(share * value, share, 0) : Jet(placed.settings[k] * share));
  }
  return values;
}

}  // namespace

namespace {

using UsualStiffness = std::function<double(const Coordinate&)>;

/// A cubic spring from each contact dof of the base to ground.
void add_cubic_springs(const SystemParameters& parameters, const UsualStiffness& usual_stiffness,
                       std::vector<Coordinate>& all) {
  const Index dofs = std::max(Index{1}, static_cast<Index>(std::ssize(parameters.contacts)));
  const WholeRing* whole = structures_of(parameters).whole();
  const Index each = whole != nullptr ? dofs / whole->sectors() : dofs;
  SystemParameters unit = parameters;
  unit.cubic_stiffness = 1;
  const double share = cubic_coefficient(unit);
  for (Index i = 0; i < dofs; ++i) {
    Coordinate& one = all.emplace_back(Coordinate{1, 0, i, nullptr});
    one.sector = i / each;
    const double usual = usual_stiffness(one);
    one.element = cubic_spring(cubic_coefficient(parameters), usual);
    one.follows_base = true;
    if (parameters.varied == "cubic_stiffness")
      one.varied = [=](double value) { return cubic_spring({share * value, share, 0}, usual); };
  }
}

/// The k-th element of a system in one sector, whose contact dofs begin with `first`.
void add_placed(const SystemParameters& parameters, std::size_t k, Index sector, Index first,
                const UsualStiffness& usual_stiffness, std::vector<Coordinate>& all) {
  const double nodes = structures_of(parameters).nodes(parameters);
  const double rate = structures_of(parameters).circular_frequency();
  const PlacedElement& placed = parameters.others[k];
  using Place = PlacedElement::Place;
  const double base = placed.place == Place::base ? 1 : placed.place == Place::contact ? -1 : 0;
  const double damper = placed.place == Place::base ? 0 : 1;
  const double side = placed.closes_backwards ? -1 : 1;  // of the coordinate that closes
  const double own = placed.kind->closes == ElementKind::Closing::cannot ? side : 1;
  Coordinate one{own * base, own * damper, first + placed.dof, nullptr};
  const Coordinate second{base, damper, first + placed.second, nullptr};
  const Coordinate closing{side * base, side * damper, first + placed.normal, nullptr};
  const double usual = usual_stiffness(placed.closes() ? closing : one);
  one.name = element_name(parameters, k);
  if (sector > 0) one.name += "_sector_" + std::to_string(sector + 1);
  one.sector = sector;
  one.element = placed.kind->make(values_of(placed, nodes, rate, usual));
  for (Index i = 0; i < std::ssize(placed.settings); ++i) {
    if (setting_name(parameters, k, static_cast<std::size_t>(i)) != parameters.varied) continue;
    one.varied = [=](double value) {
      return placed.kind->make(values_of(placed, nodes, rate, usual, i, value));
    };
  }
  const auto element = one.element;
  all.push_back(std::move(one));
  const auto add = [&](Coordinate further, Index part) {
    further.element = element;
    further.part = part;
    further.sector = sector;
    all.push_back(std::move(further));
  };
  if (placed.kind->slides == 2) add(second, 1);
  if (placed.closes()) add(closing, placed.kind->slides);
}

}  // namespace

std::vector<Coordinate> other_coordinates(const SystemParameters& parameters,
                                          const UsualStiffness& usual_stiffness) {
  std::vector<Coordinate> all;
  if (parameters.has_cubic_springs()) add_cubic_springs(parameters, usual_stiffness, all);
  const WholeRing* whole = structures_of(parameters).whole();
  const Index sectors = whole != nullptr ? whole->sectors() : 1;
  const Index dofs = std::ssize(parameters.contacts) / sectors;
  for (std::size_t k = 0; k < parameters.others.size(); ++k) {
    for (Index sector = 0; sector < sectors; ++sector)
      add_placed(parameters, k, sector, sector * dofs, usual_stiffness, all);
  }
  std::stable_partition(all.begin(), all.end(),
                        [](const Coordinate& one) { return one.element->has_border(); });
  return all;
}

Coordinates::Coordinates(const HarmonicSystem& system)
    : contacts_(std::ssize(system.contacts)), spares_base_(system.one_way) {
  for (Index i = 0; i < contacts_; ++i) {
    const SectorContact& contact = system.contacts[static_cast<std::size_t>(i)];
    Coordinate& one = all_.emplace_back(Coordinate{-1, 1, i, nullptr, spares_base_});
    if (contact.stiffness > 0) {
      one.element = std::make_shared<Jenkins>(contact.stiffness, contact.slip_per_preload);
    } else {
      one.element = std::make_shared<Idle>(usual_stiffness(system, one));
    }
  }
  for (Coordinate one : system.others) {
    one.spares_base = spares_base_ && one.damper != 0;
    all_.push_back(std::move(one));
  }
  switches_ = 0;
  for (Index i = 0; i < size(); ++i) {
    if ((*this)[i].part == 0) first_.push_back(i);
    element_of_.push_back(elements() - 1);
    if ((*this)[i].part > 0 || !element(elements() - 1).has_border()) continue;
    if (++switches_ < elements())
      throw std::invalid_argument("Coordinates: elements with a border must come first");
  }
  for (const auto& [e, force] : system.held) {
    const auto held = std::make_shared<HeldElement>((*this)[first(e)].element, force);
    for (Index i = 0; i < size(); ++i) {
      if (element_of(i) == e) all_[static_cast<std::size_t>(i)].element = held;
    }
  }
}

bool Coordinates::let_alone(Index e) {
  const std::shared_ptr<const Element> alone = element(e).alone();
  if (alone == nullptr) return false;
  for (Coordinate& one : all_) {
    if (element_of(&one - all_.data()) != e) continue;
    one.element = alone;
    if (one.varied) one.varied = [varied = one.varied](double value) { return varied(value)->alone(); };
  }
  return true;
}

void Coordinates::receptance(const ContactModes& base, const ContactModes& damper, double frequency,
                             Each& each, ContactReceptance& joint) const {
  if (!has_others() && !spares_base_) {
    joint.set_zero(contacts_);
    base.add(frequency, joint);
    return damper.add(frequency, joint);
  }
  each.base.set_zero(contacts_);
  base.add(frequency, each.base);
  each.damper.set_zero(contacts_);
  damper.add(frequency, each.damper);
  join(each.base, each.damper, joint);
}

void Coordinates::join(const ContactReceptance& of_base, const ContactReceptance& of_damper,
                       ContactReceptance& joint) const {
  joint.set_zero(size());
  add(of_base.compliance, true, joint.compliance);
  add(of_damper.compliance, false, joint.compliance);
  add(of_base.compliance_eta, true, joint.compliance_eta);
  add(of_damper.compliance_eta, false, joint.compliance_eta);
  for (Index i = 0; i < size(); ++i) {
    joint.free(i) = -(*this)[i].base * of_base.free((*this)[i].dof);
    joint.free_eta(i) = -(*this)[i].base * of_base.free_eta((*this)[i].dof);
  }
}

void Coordinates::add(const ContactMatrix& compliance, bool is_base, ContactMatrix& sum) const {
  for (Index j = 0; j < size(); ++j) {
    for (Index i = 0; i < size(); ++i)
      sum(i, j) +=
          (*this)[i].move(is_base) * (*this)[j].push(is_base) * compliance((*this)[i].dof, (*this)[j].dof);
  }
}

void Coordinates::forces_on(bool is_base, const std::vector<ElementForce>& forces, Index order,
                            ContactVector& sum) const {
  sum.setZero(contacts_);
  for (Index i = 0; i < size(); ++i) {
    const HarmonicVector& force = forces[static_cast<std::size_t>(element_of(i))].harmonics;
    const Index orders = force.size() / element(element_of(i)).coordinates();
    sum((*this)[i].dof) -= (*this)[i].push(is_base) * force((*this)[i].part * orders + order);
  }
}

}  // namespace arcslip
