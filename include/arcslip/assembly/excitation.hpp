#pragma once

// The load's course in time and round the ring. It travels with the wave, so that what it is at one node over
// a period is what all nodes feel one after the other; its harmonic h acts at the frequency h eta on h n
// waves. Each kind that [excitation] of a case file may name is one file in src/assembly/excitations:
// NAME.cpp defines `ExcitationKind NAME_excitation()`, and the build finds it.

#include <functional>
#include <string>
#include <vector>

#include "arcslip/setting.hpp"

namespace arcslip {

/// A course that a load may have.
struct ExcitationKind {
  std::string name;               ///< what case files call it
  std::string meaning;            ///< one line
  std::vector<Setting> settings;  ///< its numbers
  /// Amplitude of harmonic h over that of the first, which the force is; negative in antiphase.
  std::function<double(const std::vector<double>& settings, int h)> share;
};

/// All of them, in alphabetical order.
const std::vector<ExcitationKind>& excitation_kinds();

/// The one of this name, or null.
const ExcitationKind* find_excitation_kind(const std::string& name);

/// That of a system.
struct Excitation {
  const ExcitationKind* kind = nullptr;  ///< null: a sine, the first harmonic alone
  std::vector<double> settings;          ///< of the kind

  /// Amplitude of harmonic h over that of the first.
  double share(int h) const { return kind != nullptr ? kind->share(settings, h) : h == 1 ? 1 : 0; }
};

}  // namespace arcslip
