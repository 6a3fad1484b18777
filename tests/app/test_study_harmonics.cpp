// What a study says of its harmonics at its end.

#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "program.hpp"

using namespace arcslip::testing;

TEST_CASE("study warns where one harmonic misleads, and says how far more of them move the peak", "[study]") {
  const TemporaryFolder folder;
  const std::string text = R"([system]
model = "rods"
wave_number = 1
elements = 30
mass_ratio = 5.0
frequency_ratio = 4.0
interface_stiffness = 1000.0
force = 1.0
harmonics = 1
[study]
parameter = "P"
from = 0.5
to = 2.0
eta = [0.5, 6.0]
sweep = false
)";
  const auto outcome_of = [&](const std::string& harmonics) {
    return arcslip_program("study " + folder.write("case.toml", text) + " -o " + folder.path("r") +
                           " --set system.harmonics=" + harmonics);
  };
  const auto checked = [&] {
    return nlohmann::json::parse(read(folder.path("r/summary.json"))).at("more_harmonics").at(0);
  };
  const Outcome one = outcome_of("1");
  CHECK(one.status == 0);
  CHECK_THAT(one.out, ContainsSubstring("8.2 times as high: 1.0376, at eta = 4.02445"));
  CHECK_THAT(one.err, ContainsSubstring("warning: the harmonics of [system] mislead"));
  CHECK(checked()["harmonics"] == 9);
  CHECK_THAT(checked()["moved_by"].get<double>(), WithinRel(7.2, 0.01));

  const Outcome nine = outcome_of("9");
  CHECK(nine.status == 0);
  CHECK(nine.err.empty());
  CHECK(checked()["harmonics"] == 19);
  CHECK(std::abs(checked()["moved_by"].get<double>()) < 1e-2);
  const auto optimum = read_csv(folder.path("r/optimum.csv"));
  CHECK_THAT(std::stod(optimum[1][1]), WithinRel(0.8932582, 1e-6));
  CHECK(optimum[1][5] == "exchange");
}
