#pragma once

// Case files made wrong, the same ones for the same seed.

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace arcslip::fuzz {

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  /// A number from 0 to `count` - 1.
  std::size_t pick(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }

  template <class Type>
  const Type& one_of(const std::vector<Type>& list) {
    return list[pick(list.size())];
  }

  /// The text with one to five changes: of numbers as somebody might have chosen them, or of bytes, of
  /// values, of lines, or with something that grows.
  std::string mutated(std::string text);

  /// An argument of --set, "section.key=value".
  std::string setting();

 private:
  bool chance(double part) { return std::bernoulli_distribution(part)(random_); }
  std::string value();
  std::string text_value();
  std::string garbage();
  void change_bytes(std::string& text);
  void nudge(std::string& text);
  void change_value(std::string& text);
  void change_lines(std::string& text);
  void insert_key(std::string& text);
  void grow(std::string& text);

  std::mt19937_64 random_;
};

}  // namespace arcslip::fuzz
