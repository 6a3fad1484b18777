#pragma once

// The load's course in time and round the ring. It travels with the wave, so that what it is at one node over
// a period is what all nodes feel one after the other; its harmonic h acts at the frequency h eta on h n
// waves. Each kind that [excitation] of a case file may name is one file in src/assembly/excitations:
// NAME.cpp defines `ExcitationKind NAME_excitation()`, and the build finds it.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/setting.hpp"
#include "arcslip/types.hpp"

namespace arcslip {

struct Excitation;

/// A list of numbers that a kind of load takes from a case file, empty if it is not given.
struct ListSetting {
  Setting each;                ///< its name and meaning, and what each number may be
  std::string otherwise = {};  ///< what it stands for where it is not given; "" where it must be
  bool may_be_file = false;    ///< whether a file may hold the numbers
};

/// A key with what is wrong about it.
struct WrongSetting {
  std::string key;   ///< which
  std::string what;  ///< as "expected as many as orders, 3, got 2"
};

/// A course that a load may have.
struct ExcitationKind {
  std::string name;                     ///< what case files call it
  std::string meaning;                  ///< one line
  std::vector<Setting> settings;        ///< its numbers
  std::vector<ListSetting> lists = {};  ///< and its lists of them
  /// p_h/F: the load at node 1 is p_0 + Re sum p_h e^{j h theta}, theta = 2 pi eta t and p_0 real.
  std::function<Complex(const Excitation&, int h)> share = {};
  /// Whether the load half a period later is its opposite; null: it is.
  std::function<bool(const Excitation&)> is_odd = {};
  /// What does not fit together; null: nothing may.
  std::function<std::optional<WrongSetting>(const Excitation&)> complaint = {};
  /// The harmonics that a balance must not leave out; null: it may leave out any.
  std::function<std::vector<int>(const Excitation&)> needed = {};
};

/// All of them, in alphabetical order.
const std::vector<ExcitationKind>& excitation_kinds();

/// The one of this name, or null.
const ExcitationKind* find_excitation_kind(const std::string& name);

/// That of a system.
struct Excitation {
  const ExcitationKind* kind = nullptr;         ///< null: a sine, the first harmonic alone
  std::vector<double> settings = {};            ///< of the kind
  std::vector<std::vector<double>> lists = {};  ///< the same

  /// p_h/F.
  Complex share(int h) const { return kind != nullptr ? kind->share(*this, h) : h == 1 ? 1 : 0; }

  /// Whether it has odd harmonics alone.
  bool is_odd() const { return kind == nullptr || !kind->is_odd || kind->is_odd(*this); }

  /// What p_h is turned by against a real load: 1 of one that is real.
  Complex turn(int h) const {
    const Complex whole = share(h);
    return whole.imag() == 0 ? 1 : whole / std::abs(whole);
  }
};

}  // namespace arcslip
