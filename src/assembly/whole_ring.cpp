#include "arcslip/assembly/whole_ring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/motion/swing.hpp"
#include "assembly/ring_part.hpp"

namespace arcslip {
namespace {

/// A structure with its modes changed one by one.
template <class Change>
ContactModes with_modes(const ContactModes& modes, const Change& change) {
  std::vector<ContactMode> all = modes.modes();
  for (ContactMode& mode : all) change(mode);
  return {modes.contacts(), std::move(all), modes.loss()};
}

/// One under the opposite wave: what it moves like backwards.
ContactModes opposite(const ContactModes& modes) {
  return with_modes(modes, [](ContactMode& mode) {
    mode.shape = mode.shape.conjugate().eval();
    mode.load = std::conj(mode.load);
  });
}

/// The same under as many waves as half the sectors, if its load is half of that of each direction: shapes
/// are real there but for a phase, and what the load has of the other phase cancels.
ContactModes of_both_directions(const ContactModes& modes) {
  if (modes.is_solved()) return modes;
  return with_modes(modes, [](ContactMode& mode) {
    Index largest = 0;
    const double size = mode.shape.cwiseAbs().maxCoeff(&largest);
    const Complex phase = size > 0 ? mode.shape(largest) / size : 1;
    mode.shape = (mode.shape / phase).real().cast<Complex>().eval();
    mode.load = (mode.load * phase).real();
  });
}

/// The same under so many times its load.
ContactModes loaded(const ContactModes& modes, Complex amplitude) {
  const double size = std::abs(amplitude);
  const ContactModes own = modes.varied(Variation{.load = size, .loss = modes.loss()});
  return size > 0 ? own.turned(amplitude / size) : own;
}

void refuse(const std::string& why) { throw std::invalid_argument("WholeRing: " + why); }

}  // namespace

std::string to_string(WholeLoad::Course course) {
  using Course = WholeLoad::Course;
  return course == Course::travelling ? "travelling"
         : course == Course::standing ? "standing"
         : course == Course::point    ? "point"
                                      : "given";
}

WholeRing::WholeRing(RingMake make) : make_(std::move(make)) {
  const Index n = make_.sectors;
  if (n < 2) refuse(fmt::format("2 sectors or more, not {}", n));
  if (make_.load.course == WholeLoad::Course::given && std::ssize(make_.load.sectors) != n)
    refuse(fmt::format("an amplitude for each of the {} sectors, not {}", n, make_.load.sectors.size()));
  for (const RingChange& change : make_.changes) {
    const Index size = std::ssize(change.of);
    const bool fits = change.stiffness.rows() == size && change.stiffness.cols() == size &&
                      (change.mass.size() == 0 || (change.mass.rows() == size && change.mass.cols() == size));
    if (size < 1 || !fits) refuse("a change needs matrices of the size of its motions");
    const Index ports = change.on_base ? make_.base_ports : make_.damper_ports;
    for (const std::vector<RingChange::Term>& row : change.of) {
      for (const RingChange::Term& term : row) {
        if (term.sector < 0 || term.sector >= n || term.port < 0 || term.port >= ports)
          refuse("a change is to what no sector has");
      }
    }
  }
}

const Structures& WholeRing::sector() const {
  SystemParameters none;
  none.structures = make_.structures;
  return structures_of(none);
}

SystemParameters WholeRing::one_sector(const SystemParameters& system) const {
  SystemParameters one = system;
  one.structures = make_.structures;
  one.contacts = make_.contacts;
  return one;
}

SystemParameters WholeRing::equal(const SystemParameters& system) const {
  RingMake make = make_;
  make.changes.clear();
  make.equal_peak.reset();
  SystemParameters equal = one_sector(system);
  if (equal.contacts.empty()) equal.contacts = build_wave(equal).contacts;
  equal.contacts = RingContacts{}.of(equal.contacts, make_.sectors);
  equal.structures = std::make_shared<const WholeRing>(std::move(make));
  return equal;
}

SystemParameters WholeRing::told_over(const SystemParameters& system, double equal_peak) const {
  RingMake make = make_;
  make.equal_peak = equal_peak;
  SystemParameters told = system;
  told.structures = std::make_shared<const WholeRing>(std::move(make));
  return told;
}

/// A_m.
std::vector<Complex> WholeRing::amplitudes(Index wave_number) const {
  const Index n = make_.sectors;
  std::vector<Complex> all(static_cast<std::size_t>(n), 0.0);
  const auto wave = [&](Index m) -> Complex& { return all[static_cast<std::size_t>((m % n + n) % n)]; };
  using Course = WholeLoad::Course;
  switch (make_.load.course) {
    case Course::travelling: wave(wave_number) = 1; break;
    case Course::standing:
      wave(make_.load.wave_number) += 0.5;
      wave(-make_.load.wave_number) += 0.5;
      break;
    case Course::point:
      for (Complex& one : all) one = 1 / static_cast<double>(n);
      break;
    case Course::given:
      for (Index m = 0; m < n; ++m) {
        for (Index i = 0; i < n; ++i) {
          const double angle = two_pi * static_cast<double>(m * i % n) / static_cast<double>(n);
          wave(m) += make_.load.sectors[static_cast<std::size_t>(i)] *
                     Complex(std::cos(angle), std::sin(angle)) / static_cast<double>(n);
        }
      }
  }
  return all;
}

namespace {

/// Base or damper of all sectors under waves m = 0..N-1, each with `amplitudes` times its load and sqrt(N).
std::vector<ContactModes> waves_of(const Structures& sector, SystemParameters one, bool is_base,
                                   const std::vector<Complex>& amplitudes, bool is_travelling) {
  const Index n = std::ssize(amplitudes);
  const double size = std::sqrt(static_cast<double>(n));
  const bool turns = one.turns() && sector.feels_rotation();
  std::vector<ContactModes> all;
  for (Index m = 0; m < n; ++m) {
    const Complex amplitude = size * amplitudes[static_cast<std::size_t>(m)];
    one.wave_number = turns && 2 * m > n ? m - n : m;  // whose modes are those of n - m backwards
    const bool is_own = 2 * m <= n || (is_travelling && amplitude != 0.0) || all.front().is_solved();
    all.push_back(is_own ? sector.seen(one, is_base) : opposite(all[static_cast<std::size_t>(n - m)]));
    if (2 * m == n && !is_travelling) all.back() = of_both_directions(all.back());
  }
  for (Index m = 0; m < n; ++m) {
    ContactModes& wave = all[static_cast<std::size_t>(m)];
    wave = loaded(wave, size * amplitudes[static_cast<std::size_t>(m)]);
  }
  return all;
}

}  // namespace

std::shared_ptr<const RingPart> WholeRing::part(const SystemParameters& system, bool is_base) const {
  SystemParameters one = one_sector(system);
  one.force = 1;
  one.wanted.insert(one.wanted.end(), make_.wanted.begin(), make_.wanted.end());
  const bool is_travelling = make_.load.course == WholeLoad::Course::travelling;
  const PairLosses losses = this->losses(system);
  RingPart::Given given{std::ssize(system.contacts) / make_.sectors,
                        waves_of(sector(), one, is_base, amplitudes(system.wave_number), is_travelling),
                        {},
                        is_base ? losses.base(system) : losses.damper(system),
                        circular_frequency(),
                        arcslip::feels_rotation(system),
                        system.varied == "speed"};
  const auto* pair = dynamic_cast<const SectorPair*>(make_.structures.get());
  for (Index m = 0; given.turns && make_.in_modes && pair != nullptr && 2 * m <= make_.sectors; ++m) {
    one.wave_number = m;
    if (auto modes = pair->turning_modes(one, is_base)) given.turning.push_back(std::move(modes));
  }
  const Index ports = is_base ? make_.base_ports : make_.damper_ports;
  const Index first = given.waves.front().contacts() - ports;
  for (const RingChange& change : make_.changes) {
    if (change.on_base != is_base) continue;
    given.changes.push_back(change);
    for (auto& row : given.changes.back().of) {
      for (RingChange::Term& term : row) term.port += first;
    }
  }
  return std::make_shared<const RingPart>(std::move(given));
}

void WholeRing::check_changes(const SystemParameters& system) const {
  SystemParameters resting = system;
  resting.rotation = {};
  for (const bool is_base : {true, false}) {
    const auto is_own = [=](const RingChange& change) { return change.on_base == is_base; };
    if (std::any_of(make_.changes.begin(), make_.changes.end(), is_own))
      part(resting, is_base)->check_changes();
  }
}

ContactSystem WholeRing::wave(const SystemParameters& system) const {
  if (system.tells_lag)
    throw std::invalid_argument("the whole ring tells no lag, as its load acts on motions that differ");
  const auto base = part(system, true);
  const auto damper = part(system, false);
  if (make_.in_modes) {
    if (arcslip::feels_rotation(system))
      throw std::invalid_argument("a ring that turns is no sum of its modes at rest, which rotation couples");
    const Variation loaded{.load = system.force, .loss = base->modes().loss()};
    return {base->changed_modes().modes.varied(loaded), damper->changed_modes().modes, system.contacts};
  }
  const auto solved = [](const std::shared_ptr<const RingPart>& of, double load) {
    return of->modes().solved_at_speeds(
        [of](double eta, double factor, double speed) { return of->at(eta, factor, speed); }, load,
        [of](double eta, double factor, const ContactVector& forces, double speed) {
          return of->work(eta, factor, forces, speed);
        });
  };
  ContactSystem whole{solved(base, system.force), solved(damper, 0), system.contacts};
  const Index count = std::ssize(system.contacts);
  Index port_of_base = count / make_.sectors;
  Index port_of_damper = port_of_base;
  for (const ContactOutput& output : sector().wave(one_sector(system)).outputs) {
    if (output.name.find('#') != std::string::npos) continue;
    const Index port = output.on_base ? port_of_base++ : port_of_damper++;
    const auto of = output.on_base ? base : damper;
    const auto respond = [of, port](double eta, double factor, double speed) {
      return of->at(eta, factor, speed, port);
    };
    const ContactModes none(count + make_.sectors, {}, {});
    whole.outputs.push_back(
        {output.name, none.solved_at_speeds(respond, output.on_base ? system.force : 0), output.on_base});
  }
  return whole;
}

TurningWholeModes WholeRing::turning(const SystemParameters& system) const {
  if (!make_.in_modes) throw std::invalid_argument("a ring that turns is told by modes where it is in modes");
  const RingPart::Changed base = part(system, true)->changed_modes();
  const RingPart::Changed damper = part(system, false)->changed_modes();
  const Index first = std::ssize(base.modes.modes());
  const Index size = first + std::ssize(damper.modes.modes());
  const auto both = [&](const Matrix& of_base, const Matrix& of_damper) {
    Matrix all = Matrix::Zero(size, size);
    if (of_base.size() > 0) all.topLeftCorner(first, first) = of_base;
    if (of_damper.size() > 0) all.bottomRightCorner(size - first, size - first) = of_damper;
    return all;
  };
  return {base.modes.varied({.load = system.force, .loss = base.modes.loss()}), damper.modes,
          both(base.gyroscopic, damper.gyroscopic), both(base.stiffness_speed2, damper.stiffness_speed2)};
}

PairLosses WholeRing::losses(const SystemParameters& system) const {
  return sector().losses(one_sector(system));
}

double WholeRing::nodes(const SystemParameters& system) const { return sector().nodes(one_sector(system)); }

/// Without outputs, which no motion in time has.
std::shared_ptr<const Structures> WholeRing::in_modes() const {
  if (make_.in_modes) return nullptr;
  RingMake modal = make_;
  modal.in_modes = true;
  if (const auto structures = sector().in_modes()) modal.structures = structures;
  return std::make_shared<const WholeRing>(std::move(modal));
}

bool WholeRing::has_equations() const { return sector().has_equations(); }

double WholeRing::circular_frequency() const { return sector().circular_frequency(); }

void WholeRing::check(Index /*wave_number*/, Index nodes) const {
  for (Index m = 0; 2 * m <= nodes; ++m) sector().check(m, nodes);
}

bool WholeRing::feels_rotation() const { return sector().feels_rotation(); }

std::vector<SystemParameter> WholeRing::parameters(const SystemParameters& system) const {
  std::vector<SystemParameter> all = sector().parameters(system);
  std::erase_if(all, [](const SystemParameter& one) { return one.kind != SystemParameter::Kind::speed; });
  return all;
}

std::vector<PartModes> WholeRing::modes(const SystemParameters& system) const {
  return sector().modes(one_sector(system));
}

std::vector<double> WholeRing::landmarks(const SystemParameters& system) const {
  // Where nothing deforms but stuck contacts, as of free rods that move as a whole, the response is singular.
  constexpr double undamped = 1e-10;
  SystemParameters one = one_sector(system);
  one.wanted.clear();
  std::vector<double> all;
  const bool turns = arcslip::feels_rotation(system);
  for (Index m = 0; (turns ? m : 2 * m - 1) < make_.sectors; ++m) {
    one.wave_number = m;
    const ContactSystem wave = sector().wave(one);
    const Vector springs = contact_springs(wave.contacts);
    for (const JoinedMode& mode : joined_modes({&wave.base, &wave.damper}, springs)) {
      if (std::abs(mode.damping) > undamped) all.push_back(mode.frequency);
    }
    for (const JoinedMode& mode : joined_modes({&wave.damper}, springs)) all.push_back(mode.frequency);
    for (const ContactModes* structure : {&wave.base, &wave.damper}) {
      for (const ContactMode& mode : structure->modes()) all.push_back(mode.frequency);
    }
  }
  return all;
}

std::vector<SectorContact> RingContacts::of(const std::vector<SectorContact>& sector, Index sectors) const {
  const auto count = sector.size() * static_cast<std::size_t>(sectors);
  const auto check = [&](std::size_t size) {
    if (size != 0 && size != count) refuse(fmt::format("{} numbers of contacts, not {}", count, size));
  };
  check(limit.size());
  check(stiffness.size());
  check(missing.size());
  std::vector<SectorContact> all;
  for (std::size_t i = 0; i < count; ++i) {
    SectorContact contact = sector[i % sector.size()];
    if (!missing.empty() && missing[i]) contact = {0, never_slips};
    if (contact.stiffness > 0) {
      const double factor = stiffness.empty() ? 1 : stiffness[i];
      contact.stiffness *= factor;
      contact.slip_per_preload *= (limit.empty() ? 1 : limit[i]) / factor;
    }
    all.push_back(contact);
  }
  return all;
}

}  // namespace arcslip
