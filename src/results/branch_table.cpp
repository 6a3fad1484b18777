#include <fmt/compile.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "arcslip/results/results.hpp"
#include "results/branch_columns.hpp"

namespace arcslip {
namespace {

using continuation::BranchPoint;
using continuation::PointType;

bool tells_stability(const TracedBranch& traced) {
  const std::vector<BranchPoint>& points = traced.branch.points;
  return !traced.curve && !points.empty() && points.front().unstable >= 0;
}

constexpr std::size_t leading = 4;      // columns: branch, point, type, regime
constexpr std::ptrdiff_t trailing = 3;  // arclength, iterations, residual
constexpr const char* no_stability = ",-1";

/// The numbers of a column, of which many are the same as in the row before.
class NumberColumn {
 public:
  /// With a comma before it; valid until the next call.
  std::string_view text(double value, BranchTable::Detail detail) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    if (size_ > 0 && bits == bits_) return {text_.data(), size_};
    bits_ = bits;
    char* end = text_.data();
    *end++ = ',';
    if (detail == BranchTable::Detail::full) {
      end = fmt::format_to(end, FMT_COMPILE("{}"), value);  // the shortest text that reads as the same number
    } else {
      end = std::to_chars(end, text_.end(), value, std::chars_format::general, 10).ptr;
    }
    size_ = static_cast<std::size_t>(end - text_.data());
    return {text_.data(), size_};
  }

 private:
  std::uint64_t bits_ = 0;  ///< of the last one
  std::array<char, 32> text_{};
  std::size_t size_ = 0;
};

std::vector<std::string> fields(std::string_view row) {
  std::vector<std::string> all(1);
  for (const char c : row) {
    if (c == ',') {
      all.emplace_back();
    } else if (c != '\n') {
      all.back() += c;
    }
  }
  return all;
}

}  // namespace

void BranchTable::widen(const TracedBranch& traced) {
  const Columns columns(traced);
  for (const std::string& name : columns.names()) {
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
  }
  stability_ = stability_ || tells_stability(traced);
  physical_ = PhysicalColumns(traced).names();
}

std::string BranchTable::header() const {
  std::string text = "branch,point,type,regime";
  for (const std::string& name : names_) text += "," + name;
  if (stability_) text += ",unstable";
  text += ",arclength,iterations,residual";
  for (const std::string& name : physical_) text += "," + name;
  return text + "\n";
}

std::string BranchTable::rows(std::size_t number, const TracedBranch& traced, Detail detail) const {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  Columns columns(traced, detail);
  const PhysicalColumns physical(traced);
  std::vector<Index> places;
  for (const std::string& name : names_) places.push_back(columns.find(name));
  std::vector<NumberColumn> numbers(names_.size() + trailing + physical.names().size());
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const BranchPoint& point = traced.branch.points[i];
    fmt::format_to(out, FMT_COMPILE("{},{},{},{}"), number, i, point.type_name(),
                   traced.base.problem->describe(point.regime));
    const std::vector<double>& values = columns.values(point);
    auto column = numbers.begin();
    const auto number_to = [&](double value) { text.append(column++->text(value, detail)); };
    for (const Index place : places)
      number_to(place < 0 ? std::nan("") : values[static_cast<std::size_t>(place)]);
    if (stability_) fmt::format_to(out, ",{}", point.unstable);
    number_to(point.arclength);
    fmt::format_to(out, ",{}", point.iterations);
    number_to(point.residual);
    for (const double value : physical.values(values)) number_to(value);
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

std::string BranchTable::widened(std::string_view row, const BranchTable& before) const {
  const auto place_after = [&](std::size_t columns) {
    std::size_t place = 0;
    for (std::size_t i = 0; i < columns; ++i)
      place = std::min(row.find(',', place + (i > 0 ? 1 : 0)), row.size());
    return place;
  };
  const std::size_t known = place_after(leading + before.names_.size());
  std::string text(row.substr(0, known));
  for (std::size_t i = before.names_.size(); i < names_.size(); ++i) text += ",nan";
  if (stability_ && !before.stability_) text += no_stability;
  return text.append(row.substr(known));
}

BranchTable::BranchTable(std::string_view header) {
  const std::vector<std::string> all = fields(header);
  const auto arclength = std::find(all.begin(), all.end(), "arclength");
  if (arclength - all.begin() < static_cast<std::ptrdiff_t>(leading) || all.end() - arclength < trailing)
    throw std::invalid_argument("BranchTable: this is not the header of a table of branches");
  stability_ = *std::prev(arclength) == "unstable";
  names_.assign(all.begin() + leading, arclength - (stability_ ? 1 : 0));
  physical_.assign(arclength + trailing, all.end());
}

std::string BranchTable::narrowed(std::string_view row, const BranchTable& before) const {
  std::string text;
  const std::vector<std::string> all = fields(row);
  const std::size_t known = leading + before.names_.size();
  const std::size_t unknown =
      names_.size() - before.names_.size() + (stability_ && !before.stability_ ? 1 : 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i < known || i >= known + unknown) text += (text.empty() ? "" : ",") + all[i];
  }
  return text;
}

void write_branches(const std::vector<TracedBranch>& traced, const Sink& sink) {
  BranchTable table;
  for (const TracedBranch& one : traced) table.widen(one);
  sink(table.header());
  for (std::size_t number = 0; number < traced.size(); ++number) sink(table.rows(number, traced[number]));
}

std::string special_table_header(const TracedBranch& traced) {
  const Columns columns(traced);
  std::string header = fmt::format("{:>6} {:>6}  {:<12}", "branch", "point", "type");
  for (const Index i : columns.shown()) {
    const std::string& name = columns.names()[static_cast<std::size_t>(i)];
    header += fmt::format(" {:>15}", name == "R_over_S" ? "R/S" : name);
  }
  const PhysicalColumns physical(traced);
  for (const std::size_t i : physical.shown()) header += fmt::format(" {:>15}", physical.names()[i]);
  return header + "\n";
}

std::string special_table(std::size_t number, const TracedBranch& traced) {
  Columns columns(traced);
  const PhysicalColumns physical(traced);
  const std::vector<Index> shown = columns.shown();
  std::string rows;
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const BranchPoint& point = traced.branch.points[i];
    if (point.type == PointType::regular) continue;
    const std::vector<double>& values = columns.values(point);
    rows += fmt::format("{:>6} {:>6}  {:<12}", number, i, point.type_name());
    for (const Index k : shown) rows += fmt::format(" {:>15.9g}", values[static_cast<std::size_t>(k)]);
    const std::vector<double> in_units = physical.values(values);
    for (const std::size_t k : physical.shown()) rows += fmt::format(" {:>15.9g}", in_units[k]);
    rows += "\n";
  }
  return rows;
}

}  // namespace arcslip
