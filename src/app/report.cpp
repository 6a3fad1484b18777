#include "app/report.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "app/report_data.hpp"
#include "app/share.hpp"
#include "results/output.hpp"

namespace arcslip {
namespace {

/// A file of plots/.
std::string part_of_page(const std::string& name) {
  const std::filesystem::path path = share_folder() / "plots" / name;
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.empty())
    throw OutputError(
        fmt::format("{}: a part of the report is missing; install arcslip anew", path.string()));
  return text;
}

std::string plotly() {
  const std::filesystem::path path = share_folder() / "report/plotly-basic.min.js";
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.empty()) throw PlotlyNotFound{path.string()};
  return text;
}

/// A script without what would end it in HTML; within strings, where alone it may stand, it means the same.
std::string harmless(std::string script) {
  constexpr std::string_view end = "</script";
  for (std::size_t at = 0; (at = script.find(end, at)) != std::string::npos; at += end.size())
    script.insert(at + 1, 1, '\\');
  return script;
}

}  // namespace

std::string report_page(const std::string& folder) {
  constexpr std::string_view opening = "/*{";
  constexpr std::string_view closing = "}*/";
  // First what may be wrong with the folder, then what may be wrong with the installation.
  const std::string data = report_data(folder);
  const std::string page = part_of_page("report.html");
  std::string whole;
  std::size_t from = 0;
  for (std::size_t at = 0; (at = page.find(opening, from)) != std::string::npos;) {
    const std::size_t begin = at + opening.size();
    const std::size_t end = page.find(closing, begin);
    if (end == std::string::npos) break;
    const std::string name = page.substr(begin, end - begin);
    whole.append(page, from, at - from);
    whole += name == "data" ? data : name == "plotly" ? harmless(plotly()) : part_of_page(name);
    from = end + closing.size();
  }
  return whole.append(page, from);
}

}  // namespace arcslip
