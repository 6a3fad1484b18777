#include "arcslip/cases/study_case.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "paper_sectors.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("Ten elements a sector, each with its contact, vibrate as the paper's rods and beams",
          "[numbers]") {
  const bool beams = GENERATE(false, true);
  const TemporaryFolder folder;
  const std::string branch =
      "[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 120.0\nfor_each = { preload = [1.0, 10.0] }\n"
      "[continuation]\nstop_at = [3.45, 3.5, 3.7, 3.8, 3.9, 60.0]\n";
  std::string text = paper_system(folder, beams, 10);
  const std::string contacts =
      beams ? "contact = [1, 3, 5, 7, 9, 11, 13, 15, 17, 19]" : "contact = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]";
  for (std::size_t at = text.find("contact = [1]"); at != std::string::npos; at = text.find("contact = [1]"))
    text.replace(at, 13, contacts);
  const auto rows = branches_csv(read_case(folder.write("sector.toml", text + branch)));
  const auto expected = branches_csv(read_case(folder.write(
      "case.toml", fmt::format("[system]\nmodel = \"{}\"\nwave_number = 1\nelements = 30\nmass_ratio = 5.0\n"
                               "frequency_ratio = 4.0\ninterface_stiffness = {:.17g}\nforce = 1.0\n",
                               beams ? "beams" : "rods", interface_stiffness(beams)) +
                       branch)));
  const auto of_type = [](const std::vector<std::vector<std::string>>& table, const std::string& type) {
    std::vector<std::vector<std::string>> kept;
    std::copy_if(table.begin(), table.end(), std::back_inserter(kept),
                 [&](const auto& row) { return row[2] == type; });
    return kept;
  };
  const auto column = [&](const std::string& name, const std::vector<std::string>& row) {
    const auto found = std::find(rows.front().begin(), rows.front().end(), name);
    return std::stod(row[static_cast<std::size_t>(found - rows.front().begin())]);
  };
  for (const std::string type : {"user", "peak", "trough"}) {
    const auto found = of_type(rows, type);
    const auto right = of_type(expected, type);
    REQUIRE(found.size() == right.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      CAPTURE(type, i);
      CHECK(found[i][3] == right[i][3]);
      CHECK_THAT(column("eta", found[i]), WithinRel(std::stod(right[i][4]), 1e-10));
      for (std::size_t k = 6; k < 15 && type == "user"; ++k) {  // R to dissipated
        CAPTURE(rows.front()[k]);
        CHECK_THAT(std::stod(found[i][k]), WithinRel(std::stod(right[i][k]), 1e-10));
      }
      for (const char* name : {"R", "Y", "U"}) {  // the same at all contacts of the wave
        for (const char* other : {"_contact_2", "_contact_10"})
          CHECK_THAT(column(name + std::string(other), found[i]), WithinRel(column(name, found[i]), 1e-9));
      }
    }
  }
}

TEST_CASE("Several contacts are taken by a study and by every response") {
  const TemporaryFolder folder;
  std::string text = paper_system(folder, false, 3);
  for (std::size_t at = text.find("contact = [1]"); at != std::string::npos; at = text.find("contact = [1]"))
    text.replace(at, 13, "contact = [1, 2]");
  const std::string study = "[study]\nparameter = \"P\"\nfrom = 0.1\nto = 10.0\neta = [0.5, 6.0]\n";
  CHECK(read_study(folder.write("study.toml", text + study)).design(0).system.contacts.size() == 2);
  for (const char* response : {"forced", "one_way", "limit_cycle", "nonlinear_mode"}) {
    const std::string asked = fmt::format("response = \"{}\"\n", response);
    const bool is_free = response[0] == 'l' || response[0] == 'n';
    const std::string branch = !is_free ? over_all_eta
                               : response[0] == 'l'
                                   ? "[branch]\nparameter = \"zeta_B\"\nfrom = -1e-3\nto = -1e-2\n"
                                   : "[branch]\nparameter = \"R\"\nfrom = 1e-3\nto = 1\neta = 4\n";
    const std::string window = is_free ? "[system]\nreduction_window = [0.1, 20.0]\n" : "[system]\n";
    CHECK(read_case(folder.write("response.toml", replaced(text, "[system]\n", window) + branch + asked))
              .branches.size() == 1);
  }
  std::string listed = text;
  const std::size_t at = listed.find("contact_stiffness = ") + 20;
  listed.replace(at, listed.find('\n', at) - at, "[1.0, 2.0, 3.0]");
  CHECK_THROWS_WITH(read_case(folder.write("list.toml", listed + over_all_eta)),
                    ContainsSubstring("expected a number, or 2 of them as there are contacts, got 3"));
}
