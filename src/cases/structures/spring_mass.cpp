// Masses on springs in a row, the textbook's oscillators: base and damper each of up to a few of them, with
// one contact. The first spring of the base goes to ground; the damper hangs by its own first spring, of
// stiffness 0 if it hangs by the contact alone.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "arcslip/dense.hpp"
#include "cases/output_weights.hpp"
#include "cases/structure_kind.hpp"
#include "cases/system_section.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_masses = 100;

/// Masses m_1, m_2, ... with springs k_1 from ground to m_1, k_2 from m_1 to m_2, ...
struct SpringMassChain : OutputSettings {
  std::vector<double> mass = {1};
  std::vector<double> stiffness = {1};
  std::vector<double> load = {};  ///< of each mass; if empty the last one has 1
  Index contact = 0;              ///< the mass that rubs, from 1; 0: the last one

  /// Natural frequencies sqrt(k/m) with shapes of unit modal mass, in radians per unit of time; an output, if
  /// one is wanted, as a contact after the first one.
  ContactModes modes(double force, const Loss& loss, const Vector* output = nullptr) const {
    const Index count = std::ssize(mass);
    Matrix k = Matrix::Zero(count, count);
    for (Index i = 0; i < count; ++i) {
      const double spring = stiffness[static_cast<std::size_t>(i)];
      k(i, i) += spring;
      if (i == 0) continue;
      k(i - 1, i - 1) += spring;
      k(i, i - 1) = k(i - 1, i) = -spring;
    }
    const Vector scale = Vector::Map(mass.data(), count).cwiseSqrt().cwiseInverse();
    const Pencil<Matrix> found = pencil(Matrix(scale.asDiagonal() * k * scale.asDiagonal())).value();
    Vector forces = Vector::Unit(count, count - 1);
    if (!load.empty()) forces = Vector::Map(load.data(), count);
    const Index rubs = contact > 0 ? contact - 1 : count - 1;
    std::vector<ContactMode> all;
    for (Index i = 0; i < count; ++i) {
      const Vector shape = scale.cwiseProduct(found.vectors.col(i));
      const bool is_rigid = i == 0 && stiffness.front() == 0;
      ContactVector seen = ContactVector::Constant(output != nullptr ? 2 : 1, shape(rubs));
      if (output != nullptr) seen(1) = output->dot(shape);
      all.push_back({is_rigid ? 0 : std::sqrt(found.values(i)), seen, force * shape.dot(forces)});
    }
    return {output != nullptr ? 2 : 1, std::move(all), loss};
  }
};

/// Its eta is an angular frequency: 1 of a mass 1 on a spring 1.
class SpringMass : public Structures {
 public:
  SpringMass(SpringMassChain base, std::optional<SpringMassChain> damper, DampingKind kind)
      : base_(std::move(base)), damper_(std::move(damper)), kind_(kind) {}

  ContactSystem wave(const SystemParameters& system) const override {
    const PairLosses losses = this->losses(system);
    const ContactModes damper = damper_ ? damper_->modes(0, losses.damper(system)) : ContactModes(1, {}, {});
    ContactSystem wave{base_.modes(system.force, losses.base(system)), damper, system.contacts};
    for (const auto& [name, on_base, weights] : system.wanted) {
      wave.outputs.push_back(
          on_base ? ContactOutput{"Y_" + name, base_.modes(system.force, losses.base(system), &weights), true}
                  : ContactOutput{"U_" + name, damper_->modes(0, losses.damper(system), &weights), false});
    }
    if (system.tells_lag) wave.outputs.push_back(driven_motion(wave.base.with_driven_motion()));
    return wave;
  }

  PairLosses losses(const SystemParameters& /*system*/) const override {
    const Loss loss = kind_ == DampingKind::modal        ? Loss{.modal = 2}
                      : kind_ == DampingKind::structural ? Loss{.structural = 2}
                                                         : Loss{.viscous = 2};
    return {.base_per_zeta = loss, .damper_per_zeta = loss};
  }

  double circular_frequency() const override { return 1; }

 private:
  SpringMassChain base_;
  std::optional<SpringMassChain> damper_;
  DampingKind kind_;
};

struct SpringMassSettings : FrictionSettings {
  SpringMassSettings() {
    has_damping_kind = false;
    hertz = 1 / two_pi;  // of radians a second
  }

  SpringMassChain base = {};
  SpringMassChain damper = {};
  bool has_damper = false;
  DampingKind kind = DampingKind::modal;
  double contact_stiffness = 1;
  double limit_per_preload = 1;
};

using ChainKey = Key<SpringMassChain>;
using SpringMassKey = Key<SpringMassSettings>;

void check_masses(SpringMassChain& chain, const TomlSection& section) {
  if (chain.mass.empty() || chain.mass.size() > most_masses)
    section.fail("mass", fmt::format("expected from 1 to {} masses, got {}", most_masses, chain.mass.size()));
  chain.dofs = std::ssize(chain.mass);
}

/// One for each mass, in the list of this name.
auto one_each(const char* name, const std::vector<double> SpringMassChain::*member) {
  return then([=](const SpringMassChain& chain, const TomlSection& section) {
    const std::size_t count = (chain.*member).size();
    if (count != chain.mass.size())
      section.fail(name,
                   fmt::format("expected {} numbers, one for each mass, got {}", chain.mass.size(), count));
  });
}

std::vector<ChainKey> chain_keys(bool is_base) {
  using C = SpringMassChain;
  const auto check_springs = [=](const C& chain, const TomlSection& section) {
    if (chain.stiffness.size() != chain.mass.size())
      section.fail("stiffness", fmt::format("expected {} numbers, one for each mass, got {}",
                                            chain.mass.size(), chain.stiffness.size()));
    for (std::size_t i = 0; i < chain.stiffness.size(); ++i) {
      if (chain.stiffness[i] == 0 && (i > 0 || is_base))
        section.fail("stiffness", "expected springs that are not 0, but for the damper's first one");
    }
  };
  std::vector<ChainKey> keys{
      ChainKey("mass", &C::mass, positive(), "m_1, m_2, ..., in a row", required, then(check_masses)),
      ChainKey("stiffness", &C::stiffness, at_least(0),
               "k_1 from ground to the first mass, k_2 from there to the second, ...; of a damper that hangs "
               "by its contact k_1 = 0",
               required, then(check_springs)),
      ChainKey("contact", &C::contact,
               {" >= 1 and <= the number of masses",
                [](const C& chain) {
                  const auto count = static_cast<double>(chain.mass.size());
                  return within(1, count, fmt::format(" >= 1 and <= {}", count));
                }},
               "the mass that rubs", otherwise("the last one"), unresolved)};
  for (const Key<OutputSettings>& key : output_keys()) keys.push_back(key);
  if (is_base)
    keys.push_back(ChainKey("load", &C::load, any_number(), "the force on each mass, times `force`",
                            otherwise("1 on the last one"), unresolved, one_each("load", &C::load)));
  return keys;
}

const KeyTable<SpringMassSettings>& spring_mass_keys() {
  using S = SpringMassSettings;
  static const KeyTable<SpringMassChain> base(chain_keys(true));
  static const KeyTable<SpringMassChain> damper(chain_keys(false));
  constexpr const char* table = "a table { mass, stiffness, ... }";
  static const KeyTable<S> keys{
      {SpringMassKey::special("model", "\"spring_mass\"", "masses on springs, without symmetry", {},
                              otherwise("required"), unlisted),
       SpringMassKey::table("base", &S::base, base, table, table, "masses on springs from ground", required,
                            unlisted),
       SpringMassKey::table("damper", &S::damper, damper, table, table,
                            "others, which rub on the base; without them it rubs on ground",
                            otherwise("none: the contact is to ground"), unlisted,
                            then([](S& settings, const TomlSection&) { settings.has_damper = true; })),
       SpringMassKey::choice("damping_kind", &S::kind,
                             {{"modal", DampingKind::modal},
                              {"viscous", DampingKind::viscous},
                              {"structural", DampingKind::structural}},
                             "of the zeta in `damping`: zeta for every mode; C = 2 zeta K; K (1 + 2j zeta)",
                             ""),
       SpringMassKey("contact_stiffness", &S::contact_stiffness, positive(), "k of the contact", required,
                     parameter("K_FD"))},
      keys_of<S>(shared_keys()),
      {SpringMassKey("limit_per_preload", &S::limit_per_preload, positive(),
                     "L: the contact slips where its force is L P, S = L P/k"),
       SpringMassKey("force", &S::force, positive(), "factor of the load", parameter("F")),
       preload_growth_key(), units_key()}};
  return keys;
}

void read_spring_mass(const StructureKind::Source& source, ProblemRequest& problem) {
  SpringMassSettings settings;
  settings.use = &source.use;
  settings.wave_number = 0;
  settings.elements = 1;
  spring_mass_keys().read(settings, source.section);
  settings.fixed_damper = !settings.has_damper;
  settings.interface_stiffness = settings.contact_stiffness;
  settings.contacts = {{settings.contact_stiffness, settings.limit_per_preload / settings.contact_stiffness}};
  std::optional<SpringMassChain> damper;
  if (settings.has_damper) damper = settings.damper;
  want(settings.base.outputs, true, settings);
  want(settings.damper.outputs, false, settings);
  settings.structures = std::make_shared<const SpringMass>(settings.base, damper, settings.kind);
  take(std::move(settings), problem);
}

ordered_json spring_mass_resolved(const ProblemRequest& problem, const ordered_json& /*given*/) {
  SpringMassSettings settings;
  static_cast<SystemParameters&>(settings) = problem.system;
  settings.harmonics_tolerance = problem.harmonics_tolerance;
  ordered_json values = spring_mass_keys().values(settings);
  for (const char* given : {"base", "damper", "contact_stiffness"}) values.erase(given);
  return values;
}

std::string spring_mass_in_words(const ProblemRequest& problem) {
  const SystemParameters& system = problem.system;
  const ContactSystem wave = system.structures->wave(system);
  const auto frequencies = [](const ContactModes& structure) {
    std::vector<std::string> all;
    for (const ContactMode& mode : structure.modes()) all.push_back(fmt::format("{:.6g}", mode.frequency));
    return fmt::format("{}", fmt::join(all, ", "));
  };
  std::string text = fmt::format("masses on springs, natural frequencies {} (base)", frequencies(wave.base));
  if (!system.fixed_damper) text += fmt::format(", {} (damper)", frequencies(wave.damper));
  return text + fmt::format(", {}, zeta = {:g} (base)", contacts_in_words(system), system.base_damping);
}

}  // namespace

StructureKind spring_mass_structure() {
  return {.name = "spring_mass",
          .title = "masses on springs",
          .models = {"spring_mass"},
          .keys = [] { return spring_mass_keys().words(); },
          .read = read_spring_mass,
          .resolved = spring_mass_resolved,
          .describe = spring_mass_in_words,
          .frequency_unit = "rad/s"};
}

}  // namespace arcslip
