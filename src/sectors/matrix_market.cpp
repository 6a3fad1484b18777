#include "arcslip/sectors/matrix_market.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace arcslip {
namespace {

constexpr std::int64_t shortest_entry = 6;  // "1 1 0" and the end of its line
constexpr std::int64_t shortest_value = 2;  // "0" and its end, of an array
constexpr std::int64_t largest_index = std::numeric_limits<SparseMatrix::StorageIndex>::max();
constexpr std::string_view blanks = " \t\r\v\f";

/// Whether a word may be a number, from its characters.
bool is_like_a_number(std::string_view word) {
  return word.find_first_not_of("0123456789+-.,;:eEdD") == word.npos || word == "nan" || word == "inf";
}

/// A piece of a text as an error quotes it: on one line, and not too long.
std::string quoted(std::string_view piece) {
  constexpr std::size_t longest = 40;
  std::string text(piece.substr(0, longest));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return fmt::format("'{}{}'", text, piece.size() > longest ? "..." : "");
}

/// The lines of a text, without those that are blank or comments.
class Lines {
 public:
  Lines(std::string_view text, const std::string& file, std::string_view comment)
      : rest_(text), file_(file), comment_(comment) {}

  /// The next line as it stands. False at the end.
  bool advance() {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
  }

  /// The next line with a word in it, up to a comment. False at the end.
  bool advance_to_words() {
    while (advance()) {
      line_ = line_.substr(0, line_.find_first_of(comment_));
      if (line_.find_first_not_of(blanks) != line_.npos) return true;
    }
    return false;
  }

  /// The next word of the line, which is taken from it; empty at its end.
  std::string_view word() {
    line_.remove_prefix(std::min(line_.find_first_not_of(blanks), line_.size()));
    const std::string_view word = line_.substr(0, line_.find_first_of(blanks));
    line_.remove_prefix(word.size());
    return word;
  }

  /// From now on the text is known to be in its format.
  void trust() { trusted_ = true; }

  /// What an error says of a word: a file that is none of ours, whose name somebody else gave, may hold what
  /// is not for the reader of the message.
  std::string given(std::string_view word) const {
    if (word.empty()) return "the end of the line";
    return trusted_ || is_like_a_number(word) ? quoted(word) : "a word that is no number";
  }

  std::string_view line() const { return line_; }
  std::int64_t bytes_left() const { return static_cast<std::int64_t>(rest_.size()); }

  [[noreturn]] void fail(const std::string& expected, const std::string& given) const {
    throw MatrixTextError(fmt::format("{}:{}: expected {}, got {}", file_, std::max<std::int64_t>(number_, 1),
                                      expected, given));
  }

 private:
  std::string_view rest_;
  std::string_view line_;
  const std::string& file_;
  std::string_view comment_;
  std::int64_t number_ = 0;
  bool trusted_ = false;
};

/// from_chars takes no sign +.
std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

template <class Describe>
std::int64_t integer(Lines& lines, std::int64_t low, std::int64_t high, const Describe& expected) {
  const std::string_view word = lines.word();
  const std::string_view digits = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || value < low || value > high) {
    lines.fail(expected(), lines.given(word));
  }
  return value;
}

/// Fortran's exponent letter d is taken too.
std::optional<double> finite_number(std::string_view word) {
  std::string_view digits = without_plus(word);
  std::array<char, 64> copy{};
  const std::size_t letter = digits.find_first_of("dD");
  if (letter != digits.npos && digits.size() <= copy.size()) {
    std::copy(digits.begin(), digits.end(), copy.begin());
    copy[letter] = 'e';
    digits = {copy.data(), digits.size()};
  }
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) return {};
  return value;
}

void end_of_line(Lines& lines, std::string_view after) {
  const std::string_view word = lines.word();
  if (!word.empty()) lines.fail(fmt::format("the end of the line after {}", after), lines.given(word));
}

/// What the first line says.
struct Banner {
  bool is_array = false;      ///< all entries by columns, without indices
  bool is_complex = false;    ///< each with an imaginary part
  double mirror = 0;          ///< A_ji over A_ij, of which the lower triangle is given; 0: all are given
  bool is_hermitian = false;  ///< as it is called
  bool is_turned = false;     ///< what is read is A of a Hermitian jA, the imaginary parts

  bool has_diagonal() const { return mirror >= 0; }
};

Banner read_banner(Lines& lines) {
  const auto require = [&](std::string_view name, const std::vector<std::string_view>& choices) {
    const std::string_view word = lines.word();
    std::string lower(word.substr(0, 20));
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    const auto found = std::find(choices.begin(), choices.end(), lower);
    if (found == choices.end() || lower.size() != word.size()) {
      lines.fail(fmt::format("{} {}", name, fmt::join(choices, " or ")), lines.given(word));
    }
    return *found;
  };
  if (!lines.advance()) lines.fail("a line that begins with %%MatrixMarket", "an empty file");
  require("a Matrix Market file, which begins with", {"%%matrixmarket"});
  lines.trust();
  require("the object", {"matrix"});
  Banner banner;
  banner.is_array = require("the format", {"coordinate", "array"}) == "array";
  banner.is_complex = require("values that are", {"real", "integer", "complex"}) == "complex";
  const std::string_view symmetry =
      require("a matrix that is", {"general", "symmetric", "skew-symmetric", "hermitian"});
  banner.mirror = symmetry == "general" ? 0 : symmetry == "skew-symmetric" ? -1 : 1;
  banner.is_hermitian = symmetry == "hermitian";
  end_of_line(lines, "the banner");
  return banner;
}

struct Sizes {
  std::int64_t rows;
  std::int64_t entries;
};

Sizes read_sizes(Lines& lines, const Banner& banner) {
  if (!lines.advance_to_words())
    lines.fail(
        banner.is_array ? "the numbers of rows and columns" : "the numbers of rows, columns and entries",
        "the end of the file");
  const auto size = [&](const char* name, std::int64_t low) {
    return integer(lines, low, largest_index,
                   [&] { return fmt::format("a number of {} from {} to {}", name, low, largest_index); });
  };
  const std::int64_t rows = size("rows", 1);
  const std::int64_t columns = size("columns", 1);
  const std::int64_t given =
      banner.mirror == 0 ? rows * rows : rows * (rows + (banner.mirror > 0 ? 1 : -1)) / 2;
  const std::int64_t entries = banner.is_array ? given : size("entries", 0);
  end_of_line(lines, "the sizes");
  if (rows != columns) lines.fail("a square matrix", fmt::format("{} rows and {} columns", rows, columns));
  const std::int64_t possible =
      (lines.bytes_left() + 1) / (banner.is_array ? shortest_value : shortest_entry);
  if (entries > possible) {
    lines.fail(fmt::format("at most the {} entries that the rest of the file has room for", possible),
               std::to_string(entries));
  }
  if (banner.mirror != 0 && entries > largest_index / 2) {
    lines.fail(fmt::format("at most {} entries of a symmetric matrix", largest_index / 2),
               std::to_string(entries));
  }
  if (rows > entries + most_empty_rows) {
    lines.fail(fmt::format("at most {} rows for {} entries", entries + most_empty_rows, entries),
               std::to_string(rows));
  }
  return {rows, entries};
}

using Triplet = Eigen::Triplet<double, SparseMatrix::StorageIndex>;

/// The next value of a line. Of a complex one the imaginary part must be zero, or of jG the real one: a
/// structure moves in time by real matrices, and waves and losses make them complex later.
double read_value(Lines& lines, const Banner& banner) {
  const auto number = [&] {
    const std::string_view word = lines.word();
    const std::optional<double> value = finite_number(word);
    if (!value) lines.fail("a finite number", lines.given(word));
    return *value;
  };
  const double value = number();
  if (!banner.is_complex) return value;
  const double imaginary = number();
  if (banner.is_turned) {
    if (value != 0)
      lines.fail("a real part that is 0, as a Hermitian matrix jG has", fmt::format("{:g}", value));
    return imaginary;
  }
  if (imaginary != 0)
    lines.fail(
        "an imaginary part that is 0, as M, C and K are real (structural damping is damping_kind, a wave "
        "is wave_number)",
        fmt::format("{:g}", imaginary));
  return value;
}

void read_entry(Lines& lines, std::int64_t rows, const Banner& banner, std::vector<Triplet>& entries) {
  const auto index = [&](const char* name) {
    const std::int64_t value =
        integer(lines, 1, rows, [&] { return fmt::format("a {} from 1 to {}", name, rows); });
    return static_cast<SparseMatrix::StorageIndex>(value - 1);
  };
  const auto row = index("row");
  const auto column = index("column");
  const double value = read_value(lines, banner);
  end_of_line(lines, "the value");
  const bool is_above = banner.has_diagonal() ? column > row : column >= row;
  if (banner.mirror != 0 && is_above) {
    lines.fail(banner.has_diagonal() ? "the lower triangle of a symmetric matrix"
                                     : "what is below the diagonal of a skew-symmetric matrix",
               fmt::format("row {}, column {}", row + 1, column + 1));
  }
  entries.emplace_back(row, column, value);
}

/// One column after the other, of a symmetric matrix from the diagonal down. Zeros beside the diagonal are
/// left out.
void read_array(Lines& lines, const Sizes& sizes, const Banner& banner, std::vector<Triplet>& entries) {
  std::int64_t count = 0;
  bool has_line = lines.advance_to_words();
  for (std::int64_t column = 0; column < sizes.rows; ++column) {
    const std::int64_t first = banner.mirror == 0 ? 0 : banner.has_diagonal() ? column : column + 1;
    for (std::int64_t row = first; row < sizes.rows; ++row, ++count) {
      if (!has_line) lines.fail(fmt::format("{} entries", sizes.entries), fmt::format("{}", count));
      const double value = read_value(lines, banner);
      using Storage = SparseMatrix::StorageIndex;
      if (value != 0 || row == column)
        entries.emplace_back(static_cast<Storage>(row), static_cast<Storage>(column), value);
      if (lines.line().find_first_not_of(blanks) == std::string_view::npos)
        has_line = lines.advance_to_words();
    }
  }
  if (has_line)
    lines.fail(fmt::format("no more than the {} entries of the sizes", sizes.entries), quoted(lines.line()));
}

void read_coordinates(Lines& lines, const Sizes& sizes, const Banner& banner, std::vector<Triplet>& entries) {
  entries.reserve(static_cast<std::size_t>(sizes.entries));
  while (lines.advance_to_words()) {
    if (std::ssize(entries) == sizes.entries) {
      lines.fail(fmt::format("no more than the {} entries of the sizes", sizes.entries),
                 quoted(lines.line()));
    }
    read_entry(lines, sizes.rows, banner, entries);
  }
  if (std::ssize(entries) < sizes.entries) {
    lines.fail(fmt::format("{} entries", sizes.entries), fmt::format("{}", entries.size()));
  }
}

}  // namespace

void check_banner(std::string_view beginning, const std::string& file) {
  Lines lines(beginning, file, "%");
  read_banner(lines);
}

namespace {

SparseMatrix read_matrix(std::string_view text, const std::string& file, bool may_be_turned) {
  Lines lines(text, file, "%");
  Banner banner = read_banner(lines);
  banner.is_turned = may_be_turned && banner.is_complex && banner.is_hermitian;
  const Sizes sizes = read_sizes(lines, banner);
  std::vector<Triplet> entries;
  (banner.is_array ? read_array : read_coordinates)(lines, sizes, banner, entries);
  SparseMatrix matrix(sizes.rows, sizes.rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  entries = std::vector<Triplet>();
  if (banner.is_turned && !Vector(std::as_const(matrix).diagonal()).isZero(0))
    lines.fail("no imaginary parts on the diagonal of a Hermitian matrix", "others");
  if (banner.mirror < 0 || banner.is_turned) {
    matrix = SparseMatrix(matrix - SparseMatrix(matrix.transpose()));
  } else if (banner.mirror > 0) {
    matrix = SparseMatrix(matrix.selfadjointView<Eigen::Lower>());
  }
  for (Index k = 0; k < matrix.nonZeros(); ++k) {
    if (!std::isfinite(matrix.valuePtr()[k]))
      lines.fail("entries given twice to have a finite sum", "infinity");
  }
  return matrix;
}

}  // namespace

SparseMatrix read_matrix_market(std::string_view text, const std::string& file) {
  return read_matrix(text, file, false);
}

SparseMatrix read_gyroscopic(std::string_view text, const std::string& file) {
  return read_matrix(text, file, true);
}

std::vector<Index> read_dofs(std::string_view text, const std::string& file, Index size) {
  Lines lines(text, file, "%#");
  std::vector<Index> dofs;
  while (lines.advance_to_words()) {
    while (lines.line().find_first_not_of(blanks) != std::string_view::npos) {
      dofs.push_back(integer(lines, 1, size, [&] { return fmt::format("a dof from 1 to {}", size); }) - 1);
    }
  }
  return dofs;
}

namespace {

double number(const Lines& lines, std::string_view word) {
  const std::optional<double> value = finite_number(word);
  if (!value) lines.fail("a finite number", lines.given(word));
  return *value;
}

}  // namespace

ComplexVector read_load(std::string_view text, const std::string& file, Index size) {
  Lines lines(text, file, "%#");
  ComplexVector load = ComplexVector::Zero(size);
  while (lines.advance_to_words()) {
    const std::int64_t dof = integer(lines, 1, size, [&] { return fmt::format("a dof from 1 to {}", size); });
    const double real = number(lines, lines.word());
    const std::string_view more = lines.word();
    load(dof - 1) += Complex(real, more.empty() ? 0 : number(lines, more));
    end_of_line(lines, "the force");
  }
  return load;
}

std::vector<DofPlace> read_places(std::string_view text, const std::string& file, Index size) {
  Lines lines(text, file, "%#");
  std::vector<DofPlace> places(static_cast<std::size_t>(size));
  std::vector<char> known(places.size());
  while (lines.advance_to_words()) {
    const auto dof = static_cast<std::size_t>(
        integer(lines, 1, size, [&] { return fmt::format("a dof from 1 to {}", size); }) - 1);
    DofPlace& place = places[dof];
    for (double* value : {&place.at[0], &place.at[1], &place.at[2], &place.direction[0], &place.direction[1],
                          &place.direction[2]})
      *value = number(lines, lines.word());
    const double length = std::hypot(place.direction[0], place.direction[1], place.direction[2]);
    if (!(length > 0)) lines.fail("a direction that is not 0 0 0", "0 0 0");
    for (double& part : place.direction) part /= length;
    end_of_line(lines, "the direction");
    known[dof] = 1;
  }
  const auto missing = std::find(known.begin(), known.end(), char{0});
  if (missing != known.end())
    throw MatrixTextError(fmt::format("{}: expected a line for each of {} dofs, dof {} has none", file, size,
                                      missing - known.begin() + 1));
  return places;
}

}  // namespace arcslip
