// Branches that begin from a point that a run has left.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "case_texts.hpp"
#include "catch.hpp"
#include "places.hpp"
#include "program.hpp"

using namespace arcslip::testing;
using nlohmann::json;

namespace {

json summary(const TemporaryFolder& folder, const std::string& name) {
  return json::parse(read(folder.path(name + "/summary.json")));
}

/// The first special point of this type on a branch.
json first_of(const json& summary, std::size_t branch, const std::string& type) {
  for (const json& point : summary["branches"][branch]["special"]) {
    if (point["type"] == type) return point;
  }
  return {};
}

}  // namespace

TEST_CASE("A branch begins at a stored peak and passes the run's own special points", "[from_point]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", case_texts::good);
  REQUIRE(arcslip_program("run " + path + " -o " + folder.path("first")).status == 0);
  const json first = summary(folder, "first");
  const json peak = first_of(first, 0, "peak");
  const std::string from = folder.path("first") + ":0/" + peak["point"].dump();
  const Outcome again = arcslip_program("run " + path + " -o " + folder.path("again") +
                                        " --set 'branch.from_point=\"" + from + "\"'");
  INFO(again.err);
  REQUIRE(again.status == 0);
  const json second = summary(folder, "again");
  CHECK_THAT(first_of(second, 0, "start")["eta"].get<double>(), WithinRel(peak["eta"].get<double>(), 1e-12));
  const json expected = first_of(first, 0, "switch");
  const json found = first_of(second, 0, "switch");
  CHECK_THAT(found["eta"].get<double>(), WithinRel(expected["eta"].get<double>(), 1e-9));
  CHECK_THAT(found["Y"].get<double>(), WithinRel(expected["Y"].get<double>(), 1e-8));
  // The peak and, beside it, the start, which of the first run is one of its ends.
  CHECK(second["branches"][0]["special"].size() == first["branches"][0]["special"].size() + 1);
  CHECK_THAT(first_of(second, 0, "peak")["eta"].get<double>(), WithinRel(peak["eta"].get<double>(), 1e-12));
}

TEST_CASE("A point on the upper of three solutions begins a branch there, in another parameter",
          "[from_point]") {
  const TemporaryFolder folder;
  const std::string path = source_folder() + "/problems/duffing.toml";
  REQUIRE(arcslip_program("run " + path + " -o " + folder.path("first")).status == 0);
  const json first = summary(folder, "first");
  const json fold = first_of(first, 0, "fold");
  REQUIRE(fold.contains("state"));
  const Outcome again =
      arcslip_program("run " + path + " -o " + folder.path("again") + " --set 'branch.from_point=\"" +
                      folder.path("first") + ":0/" + fold["point"].dump() + "\"'");
  INFO(again.err);
  REQUIRE(again.status == 0);
  const json start = first_of(summary(folder, "again"), 0, "start");
  REQUIRE(start.contains("state"));
  for (const auto& [name, value] : fold["state"]["parameters"].items())
    CHECK_THAT(start["state"]["parameters"][name].get<double>(), WithinRel(value.get<double>(), 1e-14));
}

TEST_CASE("Points that are none are refused with those that there are", "[from_point]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", case_texts::good);
  REQUIRE(arcslip_program("run " + path + " -o " + folder.path("first")).status == 0);
  const auto error = [&](const std::string& from) {
    const Outcome outcome = arcslip_program("check " + path + " --set 'branch.from_point=\"" + from + "\"'");
    CHECK(outcome.status == 1);
    CHECK(is_one_line(outcome.err));
    return outcome.err;
  };
  CHECK_THAT(error("nowhere"), ContainsSubstring("expected \"DIR:branch/point\""));
  CHECK_THAT(error(folder.path("none") + ":0/3"), ContainsSubstring("cannot be read"));
  CHECK_THAT(error(folder.path("first") + ":7/3"), ContainsSubstring("has no branch 7"));
  CHECK_THAT(error(folder.path("first") + ":0/3"),
             ContainsSubstring("are 0, ") && ContainsSubstring("got 3"));
  CHECK_THAT(error(folder.path("first") + ":0/3/4"), ContainsSubstring("DIR:branch/point"));
  const Outcome both = arcslip_program("check " + path + " --set branch.start=1 --set 'branch.from_point=\"" +
                                       folder.path("first") + ":0/0\"'");
  CHECK_THAT(both.err, ContainsSubstring("not beside start"));
  const Outcome other =
      arcslip_program("run " + source_folder() + "/problems/enz.toml -o " + folder.path("o") +
                      " --set 'branch.from_point=\"" + folder.path("first") + ":0/0\"'");
  CHECK(other.status == 1);
  const Outcome larger = arcslip_program("run " + path + " -o " + folder.path("o") +
                                         " --set system.harmonics=3 --set 'branch.from_point=\"" +
                                         folder.path("first") + ":0/0\"'");
  CHECK(larger.status == 1);
  CHECK_THAT(larger.err, ContainsSubstring("the point has 1 in place of the problem's 4 unknowns"));
  CHECK_FALSE(std::filesystem::exists(folder.path("o")));
}
