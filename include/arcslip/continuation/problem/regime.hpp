#pragma once

// Which piece of a problem that is smooth in pieces: the states of its switches.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// A small state for each switch, 0 where nothing else was said. A value that is copied without allocation;
/// the first 32 switches need no memory beside it. Problems without switches have the one regime `{}`.
class Regime {
 public:
  static constexpr int states = 16;  ///< of a switch, at most

  Regime() = default;  ///< every switch in state 0

  /// Of a problem with one switch. Throws std::invalid_argument unless 0 <= state < states.
  Regime(int state) : Regime(Regime().with(0, state)) {}  // NOLINT(google-explicit-constructor)

  /// The state of a switch.
  int operator[](Index which) const {
    const std::uint64_t* word = find(which);
    return word == nullptr ? 0 : static_cast<int>(*word >> shift(which) & (states - 1));
  }

  /// The same but for one switch. Throws std::invalid_argument unless 0 <= state < states and which >= 0.
  Regime with(Index which, int state) const;

  /// Switches up to the last that is not in state 0.
  Index size() const;

  /// Whether every switch is in the same state.
  bool operator==(const Regime& other) const;

  /// As numbers whose digits are the states, the first switch being the last digit.
  bool operator<(const Regime& other) const;

 private:
  static constexpr Index bits = 4;
  static constexpr Index each_word = 64 / bits;
  static constexpr Index inline_words = 2;

  static Index shift(Index which) { return which % each_word * bits; }
  const std::uint64_t* find(Index which) const {
    const auto word = static_cast<std::size_t>(which / each_word);
    if (word < inline_words) return &first_[word];
    return more_ && word - inline_words < more_->size() ? &(*more_)[word - inline_words] : nullptr;
  }

  std::array<std::uint64_t, inline_words> first_{};
  std::shared_ptr<const std::vector<std::uint64_t>> more_;  // without zeros at its end; null if empty
};

/// The states as digits to the base of `Regime::states`, the first switch first: "0", "1", "011".
std::string digits(const Regime& regime);

/// The inverse; throws std::invalid_argument where these are no digits.
Regime regime_of_digits(const std::string& text);

/// Bit i of the number as the state of switch i.
Regime regime_of_bits(unsigned bits);

}  // namespace arcslip::continuation
