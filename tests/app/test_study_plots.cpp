// The pictures of a preload study, from tables written here: that each table gives its pictures, whole.

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "plotting.hpp"

using namespace arcslip::testing;

namespace {

const std::set<std::string> study_results = {"optimum.csv", "summary.json", "sweep.csv"};
const std::set<std::string> without_sweep = {"optimum.csv", "summary.json"};

constexpr const char* sweep_header =
    "curve,peak_branch,P,eta_peak,Y_max,Y_nd_max,ratio,R_over_S,dissipated,is_global,type,site,by_P,by_mu,"
    "by_F,by_mass_ratio,by_frequency_ratio\n";

/// One peak that falls and one that rises over P = 0.1 to 10; they are as high at P = 1.
std::string sweep_of(int curves) {
  std::string text = sweep_header;
  for (int curve = 0; curve < curves; ++curve) {
    for (const int branch : {0, 1}) {
      for (int i = -10; i <= 10; ++i) {
        const double preload = std::pow(10, 0.1 * i);
        const double ratio = 0.05 * (curve + 1) * (branch == 0 ? 1 / preload : preload);
        const bool is_global = branch == 0 ? i <= 0 : i >= 0;
        const char* type = i == -10      ? "start"
                           : i == 10     ? "end"
                           : i != 0      ? "regular"
                           : branch == 0 ? "optimum"
                                         : "exchange";
        text += fmt::format("{},{},{:.17g},{},{:.17g},2,{:.17g},5,16,{:d},{},slip,0,0,0,0,0\n", curve, branch,
                            preload, 4 - 0.3 * branch, 2 * ratio, ratio, is_global, type);
      }
    }
  }
  return text;
}

/// A row for each set of values of the keys; the one numbered `failed` has no optimum.
std::string optimum_of(const std::string& keys, const std::vector<std::string>& values,
                       std::size_t failed = 1000) {
  std::string text =
      "curve," + keys + (keys.empty() ? "" : ",") + "P_opt,eta_opt,Y_opt,ratio_opt,kind,P_low,P_high\n";
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string start = fmt::format("{},{}{}", i, values[i], keys.empty() ? "" : ",");
    const double ratio = 0.01 * static_cast<double>(i + 1);
    text += start + (i == failed ? "nan,nan,nan,nan,failed,nan,nan\n"
                                 : fmt::format("{},4,{},{},{},0.5,2\n", 1 + 0.1 * static_cast<double>(i),
                                               2 * ratio, ratio, i % 2 == 0 ? "smooth" : "exchange"));
  }
  return text;
}

struct Study {
  TemporaryFolder folder;

  Study(const std::string& optimum, const std::string& sweep) {
    folder.write("optimum.csv", optimum);
    if (!sweep.empty()) folder.write("sweep.csv", sweep);
    folder.write("summary.json", fmt::format(R"({{"case": {{"study": {{"sweep": {}}}}}}})", !sweep.empty()));
  }

  Outcome plot() const { return plotted(folder.path(".")); }
  std::string picture(const std::string& name) const { return read(folder.path(name + ".svg")); }
};

void require_drawn(const Study& study, const std::vector<std::string>& drawn,
                   const std::set<std::string>& tables) {
  const Outcome outcome = study.plot();
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  require_pictures(study.folder.path("."), 5'000, drawn, tables);
}

}  // namespace

TEST_CASE("plot draws a study over the preload and the optimum over its key", "[plots]") {
  if (!has_matplotlib()) return;
  const Study study(optimum_of("mass_ratio", {"5", "20", "100"}), sweep_of(3));
  require_drawn(study, {"ratio", "peaks", "optimum"}, study_results);
  const std::string ratio = study.picture("ratio");
  CHECK_THAT(ratio, ContainsSubstring("highest peak") && ContainsSubstring("preload  $P$") &&
                        ContainsSubstring("<!-- optimum -->"));
  CHECK_THAT(ratio, !ContainsSubstring("other peaks"));
  CHECK_THAT(study.picture("peaks"),
             ContainsSubstring("<!-- other peaks -->") && ContainsSubstring("<!-- exchange -->"));
  CHECK_THAT(study.picture("optimum"), ContainsSubstring("mass ratio") &&
                                           ContainsSubstring("<!-- smooth -->") &&
                                           ContainsSubstring("best preload"));
}

TEST_CASE("plot draws designs listed one by one over the first of their keys", "[plots]") {
  if (!has_matplotlib()) return;
  const Study study(optimum_of("frequency_ratio,slenderness", {"1,8.3", "1.5,12.5", "2,16.7"}), sweep_of(3));
  require_drawn(study, {"ratio", "peaks", "optimum"}, study_results);
  CHECK_THAT(study.picture("ratio"), ContainsSubstring("16.7"));
}

TEST_CASE("plot draws a single design without a key of curves", "[plots]") {
  if (!has_matplotlib()) return;
  const Study study(optimum_of("", {""}), sweep_of(1));
  require_drawn(study, {"ratio", "peaks"}, study_results);
  CHECK_THAT(study.picture("ratio"), !ContainsSubstring("mass"));
}

TEST_CASE("plot draws each value with each as maps, whatever their order, with gaps for what failed",
          "[plots]") {
  if (!has_matplotlib()) return;
  std::vector<std::string> values;
  for (const char* mass_ratio : {"20", "5", "10", "40"}) {
    for (const char* frequency_ratio : {"1", "2", "3"})
      values.push_back(fmt::format("{},{}", mass_ratio, frequency_ratio));
  }
  const Study study(optimum_of("mass_ratio,frequency_ratio", values, 7), "");
  require_drawn(study, {"optimum_preload", "attenuation"}, without_sweep);
  CHECK_THAT(study.picture("attenuation"),
             ContainsSubstring("mass ratio") && ContainsSubstring("frequency ratio"));
}

TEST_CASE("plot draws a study, and the branches beside it", "[plots]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "case.toml",
      "[system]\nmodel = 'beams'\nwave_number = 1\nelements = 30\nmass_ratio = 5\nfrequency_ratio = 4\n"
      "slenderness = 33.3\nforce = 1\npreload = 1\n"
      "[branch]\nparameter = 'eta'\nfrom = 3\nto = 5\n"
      "[study]\nparameter = 'P'\nfrom = 0.5\nto = 5\neta = [3, 5]\nfor_each = { mass_ratio = [5, 20] }\n");
  const std::string into = " --quiet -o '" + folder.path("r") + "'";
  const auto drawn = [&](const std::string& command, const std::string& only) {
    const Outcome outcome = arcslip_program(command + " '" + path + "'" + into);
    CHECK(outcome.err.empty());
    CHECK(outcome.status == 0);
    return plotted(folder.path("r"), only).out;
  };
  CHECK_THAT(drawn("study", "--only ratio --only optimum"),
             ContainsSubstring("ratio.svg") && ContainsSubstring("optimum.svg"));
  CHECK_THAT(drawn("run", "--only phase_difference --only ratio"),
             ContainsSubstring("phase_difference.svg") && ContainsSubstring("ratio.svg"));
}
