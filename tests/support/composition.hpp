#pragma once

// Kinds of systems, small ones, with the case files that ask something of them.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "places.hpp"
#include "program.hpp"
#include "ring_of_rows.hpp"

namespace arcslip::testing::composition {

/// The table of a run, by the names of its columns.
struct Table {
  explicit Table(const std::string& path) : rows(testing::read_csv(path)) {
    REQUIRE(rows.size() > 1);
    names = rows.front();
    rows.erase(rows.begin());
  }

  std::string text(std::size_t row, const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    INFO(name);
    REQUIRE(found != names.end());
    return rows[row][static_cast<std::size_t>(found - names.begin())];
  }
  double operator()(std::size_t row, const std::string& name) const { return std::stod(text(row, name)); }

  std::vector<std::size_t> of_type(const std::string& type) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (text(i, "type") == type) found.push_back(i);
    }
    return found;
  }

  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> names;
};

/// A kind of system, and the eta in which it is looked at.
struct Kind {
  std::string name;
  std::string text;
  double low;
  double high;
  double eta;
  double zeta;  // of limit cycles
};

inline std::string rods(const std::string& more,
                        const std::string& damping = "{ base = 1e-2, damper = 2e-2 }") {
  return fmt::format(
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 12\nmass_ratio = 3.0\nfrequency_ratio = 1.5\n"
      "interface_stiffness = 40.0\ndamping = {}\nforce = 1.0\npreload = 0.3\n{}\n",
      damping, more);
}

inline std::string sector(const std::string& contacts, const std::string& more) {
  return ring_of_rows(contacts,
                      "wave_number = 1\ncontact_stiffness = 2.0\npreload = 0.3\n"
                      "damping = { base = 1e-2, damper = 2e-2 }\n" +
                          more + "\n");
}

/// That the base meets in its motion.
inline const std::string stops =
    "[[element]]\nkind = \"clearance\"\nat = \"base\"\nstiffness = 20.0\ngap = 0.1\n";

/// The first contact also rubs as the motion of the second one presses it, and lifts off.
inline const std::string lift_off =
    "[[element]]\nkind = \"friction\"\nat = \"contact\"\nnormal = 2\ntangential_stiffness = 1.0\n"
    "normal_stiffness = 1.5\nmu = 0.5\nnormal_per_preload = 0.5\n";

/// Sliders of many limits.
inline const std::string microslip =
    "[[element]]\nkind = \"iwan\"\nat = \"damper\"\nstiffness = 10.0\nfirst_limit = 1.0\nspread = 1.0\n";

/// A load with harmonics of its own.
inline const std::string arcs = "[excitation]\nkind = \"arcs\"\nwidth = 0.3\n";

/// Two masses on springs and a damper of one.
inline const std::string masses =
    "[system]\nmodel = \"spring_mass\"\ndamping = { base = 1e-2, damper = 2e-2 }\n"
    "base = { mass = [3.0, 2.0], stiffness = [5.0, 4.0] }\ndamper = { mass = [1.0], stiffness = [0.5] }\n"
    "damping_kind = \"viscous\"\ncontact_stiffness = 2.0\nforce = 1.0\npreload = 0.3\n";

/// Three masses in a row without symmetry, which rub between the first two and to ground.
inline const std::string no_symmetry =
    "[system]\nmodel = \"sector\"\ncontact_stiffness = 2.0\nforce = 1.0\npreload = 0.3\n"
    "damping = { base = 1e-2, damper = 2e-2 }\nreduction_window = [0.05, 3.0]\n[system.base]\nmass = "
    "\"row_m.mtx\"\nstiffness = \"row_k.mtx\"\n"
    "contact = [[2, 1], 3]\nload = { dof = [2], value = [1.0] }\ndamping_kind = \"viscous\"\n"
    "reference_frequency = 0.3\n";

inline std::vector<Kind> kinds() {
  return {{"plain", rods(""), 0.5, 5, 1.6, -5e-2},
          {"five harmonics", rods("harmonics = 9"), 0.5, 5, 1.6, -5e-2},
          {"cubic springs", rods("cubic_stiffness = 0.5"), 0.5, 5, 1.6, -5e-2},
          {"contact to ground", rods("fixed_damper = true"), 0.5, 5, 1.6, -5e-2},
          {"negative damping", rods("", "{ base = -2e-3, damper = 0.1 }"), 0.5, 5, 1.6, -5e-2},
          {"structural damping", rods("", "{ base = 1e-2, damper = 2e-2, kind = \"structural\" }"), 0.5, 5,
           1.6, -5e-2},
          {"growing preload", rods("preload_growth = 0.05"), 0.5, 5, 1.6, -5e-2},
          {"stops of `[[element]]`, five harmonics", rods("harmonics = 9\n" + stops), 0.5, 5, 1.6, -5e-2},
          {"cubic, five harmonics", rods("cubic_stiffness = 0.5\nharmonics = 9"), 0.5, 5, 1.6, -5e-2},
          {"`[excitation]`, five harmonics", rods("harmonics = 9\n" + arcs), 0.5, 5, 1.6, -5e-2},
          {"masses on springs", masses, 0.3, 4, 0.9, -5e-2},
          {"sector", sector("[1]", ""), 0.1, 0.6, 0.25, -5e-2},
          {"three contacts", sector("[1, 2, 3]", ""), 0.1, 0.6, 0.25, -5e-2},
          {"three contacts, five harmonics", sector("[1, 2, 3]", "harmonics = 9"), 0.1, 0.6, 0.25, -5e-2},
          {"lift-off", sector("[1, 2]", lift_off), 0.1, 0.6, 0.25, -5e-2},
          {"microslip", rods(microslip), 0.5, 5, 1.6, -5e-2},
          {"without symmetry", no_symmetry, 0.1, 0.6, 0.25, -5e-2},
          {"`path = \"full\"`", sector("[1, 2, 3]", "path = \"full\""), 0.1, 0.6, 0.25, -5e-2}};
}

/// The cells of a line of a table of the manual.
inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> found;
  for (std::size_t at = line.find('|'); at != std::string::npos; at = line.find('|', at + 1)) {
    const std::size_t end = line.find('|', at + 1);
    if (end == std::string::npos) break;
    const std::string cell = line.substr(at + 1, end - at - 1);
    const std::size_t first = cell.find_first_not_of(' ');
    found.push_back(first == std::string::npos ? ""
                                               : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
  }
  return found;
}

/// Lines of the manual's table, by the kind of system; under "" its head.
inline std::map<std::string, std::vector<std::string>> promised() {
  const std::string page = testing::read(testing::source_folder() + "/src/manual/pages/composition.md");
  const std::size_t start = page.find("| works with |");
  REQUIRE(start != std::string::npos);
  std::istringstream in(page.substr(start));
  std::map<std::string, std::vector<std::string>> lines;
  for (std::string line; std::getline(in, line) && line.starts_with('|');) {
    std::vector<std::string> cells = cells_of(line);
    const std::string name = lines.empty() ? "" : cells.front();
    cells.erase(cells.begin());
    lines[name] = std::move(cells);
  }
  return lines;
}

/// One kind of system with all that is asked of it.
class Cells {
 public:
  explicit Cells(const Kind& kind) : kind_(kind) {
    write_row(folder_, "base", {3, 2.5, 2}, {4, 3, 5}, {5, 4, 6});
    const std::string head = "%%MatrixMarket matrix array real symmetric\n3 3\n";
    folder_.write("row_m.mtx", head + "3\n0\n0\n2.5\n0\n2\n");
    folder_.write("row_k.mtx", head + "9\n-4\n0\n11\n-3\n9\n");
    write_row(folder_, "damper", {1, 0.8, 0.9}, {2, 1.5, 2.5}, {0.1, 0.2, 0.1});
  }

  /// What becomes of a case; its results in `out`.
  Outcome run(const std::string& command, const std::string& text, const std::string& options = "") {
    const std::string path = folder_.write("case.toml", text);
    return arcslip_program(
        fmt::format("{} '{}' -o '{}' --quiet {}", command, path, folder_.path("out"), options));
  }
  const TemporaryFolder& folder() const { return folder_; }
  Table results(const std::string& name = "branches.csv") const { return Table(folder_.path("out/" + name)); }
  nlohmann::json summary() const {
    return nlohmann::json::parse(testing::read(folder_.path("out/summary.json")));
  }

  const Kind& kind() const { return kind_; }
  std::string over_eta() const {
    return fmt::format("[branch]\nparameter = \"eta\"\nfrom = {}\nto = {}\n", kind_.low, kind_.high);
  }
  std::string response(const std::string& more = "", const std::string& system = "") const {
    return (system.empty() ? kind_.text : system) + over_eta() + more;
  }
  /// The system with another value of a key.
  std::string with(const std::string& from, const std::string& to) const {
    std::string text = kind_.text;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
  }

 private:
  Kind kind_;
  TemporaryFolder folder_;
};

}  // namespace arcslip::testing::composition
