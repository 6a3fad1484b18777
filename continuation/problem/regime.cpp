#include "arcslip/continuation/problem/regime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace arcslip::continuation {
namespace {
constexpr std::string_view figures = "0123456789abcdef";
static_assert(figures.size() == Regime::states);
}  // namespace

Regime Regime::with(Index which, int state) const {
  if (which < 0 || state < 0 || state >= states)
    throw std::invalid_argument(fmt::format("Regime: state {} of switch {}; expected 0 to {} of 0 or more",
                                            state, which, states - 1));
  Regime result = *this;
  const auto word = static_cast<std::size_t>(which / each_word);
  const auto set = [&](std::uint64_t& target) {
    target &= ~(std::uint64_t{states - 1} << shift(which));
    target |= static_cast<std::uint64_t>(state) << shift(which);
  };
  if (word < inline_words) {
    set(result.first_[word]);
    return result;
  }
  std::vector<std::uint64_t> more = more_ ? *more_ : std::vector<std::uint64_t>{};
  more.resize(std::max(more.size(), word - inline_words + 1));
  set(more[word - inline_words]);
  while (!more.empty() && more.back() == 0) more.pop_back();
  result.more_ = more.empty() ? nullptr : std::make_shared<const std::vector<std::uint64_t>>(std::move(more));
  return result;
}

Index Regime::size() const {
  Index last = (inline_words + (more_ ? std::ssize(*more_) : 0)) * each_word;
  while (last > 0 && (*this)[last - 1] == 0) --last;
  return last;
}

bool Regime::operator==(const Regime& other) const {
  return first_ == other.first_ && (more_ == other.more_ || (more_ && other.more_ && *more_ == *other.more_));
}

bool Regime::operator<(const Regime& other) const {
  const std::size_t words = more_ ? more_->size() : 0;
  const std::size_t others = other.more_ ? other.more_->size() : 0;
  if (words != others) return words < others;
  const auto less = [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  };
  if (words > 0 && *more_ != *other.more_) return less(*more_, *other.more_);
  return less(first_, other.first_);
}

std::string digits(const Regime& regime) {
  std::string text;
  for (Index i = 0; i < std::max<Index>(1, regime.size()); ++i)
    text += figures[static_cast<std::size_t>(regime[i])];
  return text;
}

Regime regime_of_digits(const std::string& text) {
  Regime regime;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t state = figures.find(text[i]);
    if (state == std::string_view::npos)
      throw std::invalid_argument(fmt::format("Regime: expected digits 0 to f, got '{}'", text));
    if (state > 0) regime = regime.with(static_cast<Index>(i), static_cast<int>(state));
  }
  return regime;
}

Regime regime_of_bits(unsigned bits) {
  Regime regime;
  for (Index i = 0; bits >> i != 0; ++i) regime = regime.with(i, static_cast<int>(bits >> i & 1U));
  return regime;
}

}  // namespace arcslip::continuation
