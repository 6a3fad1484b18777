// What regimes and quantities of a harmonic problem are called.

#include <fmt/format.h>

#include <algorithm>

#include "arcslip/problems/response/harmonic_problem.hpp"

namespace arcslip::problems {

std::string HarmonicProblem::name_of(const std::string& quantity, Index order) const {
  return fmt::format("{}_h{}", quantity, system_.name(order));
}

std::string HarmonicProblem::suffix_of(Index element) const {
  if (element == 0) return "";
  return element < contacts() ? fmt::format("_contact_{}", element + 1)
                              : fmt::format("_{}", first(element).name);
}

/// What the contacts do, then what each further element does that is beyond its border, of several by number.
std::string HarmonicProblem::describe(const continuation::Regime& regime) const {
  std::string name = slip_name(regime, contacts());
  for (Index e = contacts(); e < switch_count(); ++e) {
    if (regime[e] == 0) continue;
    name += fmt::format(" {}", coordinates_.element(e).beyond());
    if (switch_count() > contacts() + 1) name += fmt::format(" {}", e - contacts() + 1);
  }
  return name;
}

void HarmonicProblem::add_further_contacts() {
  for (Index i = 1; i < contacts(); ++i) {
    const auto name = [&](const char* quantity) { return fmt::format("{}{}", quantity, suffix_of(i)); };
    quantities_.push_back({name("R"), Measure::amplitude, Body::contact, i});
    quantities_.push_back({name("R_over_S"), Measure::ratio, Body::contact, i});
    quantities_.push_back({name("Y"), Measure::amplitude, Body::base, i});
    quantities_.push_back({name("U"), Measure::amplitude, Body::damper, i});
    quantities_.push_back({name("dissipated"), Measure::dissipated, Body::contact, i});
    add_readings(i, suffix_of(i));
    for (Index a = 0; a < harmonics(); ++a) {
      if (system_.orders[at(a)] != 0) continue;
      quantities_.push_back({name("R_h0"), Measure::mean, Body::contact, i, a});
      quantities_.push_back({name("Y_h0"), Measure::mean, Body::base, i, a});
      quantities_.push_back({name("U_h0"), Measure::mean, Body::damper, i, a});
    }
  }
}

void HarmonicProblem::add_ring() {
  constexpr Index most_waves = 6;
  const Index each = contacts() / system_.sectors;
  const auto add = [&](const std::string& name, Body of, Index which) {
    quantities_.push_back({fmt::format("{}_max", name), Measure::largest, of, which});
    quantities_.push_back({fmt::format("{}_min", name), Measure::least, of, which});
  };
  for (Index j = 0; j < each; ++j) {
    const std::string suffix = j == 0 ? "" : fmt::format("_contact_{}", j + 1);
    add(fmt::format("R{}", suffix), Body::contact, j);
    add(fmt::format("Y{}", suffix), Body::base, j);
    add(fmt::format("U{}", suffix), Body::damper, j);
  }
  if (system_.equal_peak) quantities_.push_back({"amplification", Measure::amplification, Body::base, 0});
  const Index half = system_.sectors / 2;
  const Index n = std::abs(system_.wave_number % system_.sectors);
  const Index own = std::min(n, system_.sectors - n);
  for (Index q = 0; q <= half; ++q) {
    if (q <= most_waves || q == own)
      quantities_.push_back({fmt::format("Y_wave_{}", q), Measure::wave, Body::base, 0, 0, q});
  }
  if (own > 0 && 2 * own < system_.sectors)
    quantities_.push_back({fmt::format("Y_back_{}", own), Measure::wave, Body::base, 0, 0, -own});
  quantities_.push_back({"slipping", Measure::slipping});
  quantities_.push_back({"energy_contacts", Measure::losses});
  for (Index i = 0; i < std::ssize(system_.outputs); ++i) add(system_.outputs[at(i)].name, Body::output, i);
}

void HarmonicProblem::add_other_harmonics() {
  for (Index a = 1; a < harmonics(); ++a) {
    const auto name = [&](const char* quantity) { return name_of(quantity, a); };
    const Measure measure = system_.orders[at(a)] == 0 ? Measure::mean : Measure::amplitude;
    quantities_.push_back({name("R"), measure, Body::contact, 0, a});
    quantities_.push_back({name("Y"), measure, Body::base, 0, a});
    quantities_.push_back({name("U"), measure, Body::damper, 0, a});
  }
}

void HarmonicProblem::add_drifts() {
  for (const Drift& drift : drifts_) {
    const Index e = drift.element;
    quantities_.push_back({"drift" + suffix_of(e), Measure::drift, Body::contact, coordinates_.first(e)});
  }
}

void HarmonicProblem::add_readings(Index element, const std::string& suffix) {
  const std::vector<Reading> told = coordinates_.element(element).readings();
  for (std::size_t i = 0; i < told.size(); ++i)
    quantities_.push_back(
        {told[i].name + suffix, Measure::reading, Body::contact, element, static_cast<Index>(i)});
}

void HarmonicProblem::add_further_elements() {
  for (Index e = contacts(); e < coordinates_.elements(); ++e) {
    if (first(e).sector > 0) continue;
    const std::string suffix = suffix_of(e);
    if (coordinates_.element(e).dissipates())
      quantities_.push_back({"energy" + suffix, Measure::energy, Body::contact, e});
    add_readings(e, suffix);
  }
}

std::vector<continuation::UserEvent> HarmonicProblem::events() const {
  std::vector<continuation::UserEvent> all;
  for (Index e = 0; e < coordinates_.elements(); ++e) {
    const std::vector<ElementEvent> events = coordinates_.element(e).events(system_.orders);
    for (Index i = 0; i < std::ssize(events); ++i) {
      continuation::UserEvent event{events[at(i)].name + suffix_of(e), nullptr};
      if (const std::optional<std::size_t> which = events[at(i)].further_slips) {
        event.function = [=, this](const Vector& u, const Vector& p, const continuation::Regime& regime) {
          return slips(regime, e) ? force_of(e, u, p, regime).further_slips.functions[*which] : -1;
        };
        event.piece = [=, this](const Vector& u, const Vector& p, const continuation::Regime& regime) {
          return slips(regime, e) ? force_of(e, u, p, regime).further_slips.piece : -1;
        };
      } else {
        event.function = [=, this](const Vector& u, const Vector& p, const continuation::Regime&) {
          return with_element(e, u, p, [&](const Element& element) {
            return element.event(i, system_.orders, element_motion(u, p, e), load(e, u, p));
          });
        };
      }
      all.push_back(std::move(event));
    }
  }
  return all;
}

}  // namespace arcslip::problems
