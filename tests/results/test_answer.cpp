// The answer in words: sentences with the numbers that they are made from.

#include "results/answer.hpp"

#include <cmath>

#include "catch.hpp"
#include "temporary_folder.hpp"

using arcslip::BestPreload;
using arcslip::Findings;
using arcslip::run_answer;
using arcslip::testing::TemporaryFolder;
using nlohmann::ordered_json;
using Lines = std::vector<std::string>;

namespace {

BestPreload rotor() {
  return {
      "damper.width = 0.006", "smooth", 312.55, 188.55, 855.26, false, false, 2282.006, 4.5626e-6, 0.14757};
}

Findings physical(std::vector<BestPreload> designs) { return {"N/m", "Y", std::move(designs)}; }

Findings nondimensional(const BestPreload& design) { return {"", "Y", {design}}; }

std::string first_line(const Findings& findings) { return study_answer(findings).front(); }

constexpr const char* optimum_header = "curve,mass_ratio,P_opt,eta_opt,Y_opt,ratio_opt,kind,P_low,P_high";

}  // namespace

TEST_CASE("A study of one design in SI units answers in these", "[answer]") {
  CHECK(study_answer(physical({rotor()})) ==
        Lines{"Best preload 312.6 N/m: highest peak 4.563 um at 2282 Hz, 85 % below the free base.",
              "The highest peak is within a factor 2 of that from 188.6 to 855.3 N/m."});
}

TEST_CASE("A nondimensional study answers in P, eta and the quantity that it lowers", "[answer]") {
  BestPreload best{"", "exchange", 0.84, 0.1, 2.0, true, false, 4.62891, 0.0020887, 1 / 1536.4};
  CHECK(
      study_answer(nondimensional(best)) ==
      Lines{"Best preload P = 0.84: highest peak Y = 0.002089 at eta = 4.6289, 1540 times lower than that of "
            "the free base.",
            "There two peaks are as high as each other.",
            "The highest peak is within a factor 2 of that from P = 0.1 to 2, from the low end of the range "
            "on."});
  best.kind = "jump";
  CHECK(study_answer(nondimensional(best))[1] ==
        "It lies beside a jump, behind which the response has a higher peak.");
  best.ratio = std::nan("");
  Findings of_damper{"", "U", {best}};
  CHECK(first_line(of_damper) == "Best preload P = 0.84: highest peak U = 0.002089 at eta = 4.6289.");
}

TEST_CASE("The answer says what the damper does to the free base, also where that is nothing", "[answer]") {
  const auto told = [](double ratio) {
    BestPreload best = rotor();
    best.ratio = ratio;
    return first_line(physical({best}));
  };
  CHECK_THAT(told(0.2401), ContainsSubstring(" 76 % below the free base."));
  CHECK_THAT(told(0.021), ContainsSubstring(" 98 % below the free base."));
  CHECK_THAT(told(0.00424), ContainsSubstring(" 236 times lower than that of the free base."));
  CHECK_THAT(told(1.0), ContainsSubstring(" as high as that of the free base."));
  CHECK_THAT(told(1.21), ContainsSubstring(" 21 % above the free base."));
}

TEST_CASE("Where something scatters the answer gives the preload for that", "[answer]") {
  BestPreload best = rotor();
  best.scatter = {352.118, 6.2507e-6, 6.7002e-6};
  CHECK(
      study_answer(physical({best})).back() ==
      "With scatter the best preload is 352.1 N/m: 95 % of all stay below 6.251 um; made for 312.6 N/m they "
      "would stay below 6.7 um.");
}

TEST_CASE("Of several designs the answer names the one on which the damper does most", "[answer]") {
  BestPreload wide = rotor();
  wide.design = "damper.width = 0.012";
  wide.preload = 335.1;
  wide.peak = 2.49e-6;
  wide.ratio = 0.0806;
  BestPreload failed;
  failed.kind = "failed";
  const Lines told = study_answer(physical({rotor(), wide, failed}));
  REQUIRE(told.size() == 4);
  CHECK(told[0] ==
        "Of 3 designs the damper does most with damper.width = 0.012. Best preload 335.1 N/m: highest peak "
        "2.49 um at 2282 Hz, 92 % below the free base.");
  CHECK(told[2] ==
        "Of all designs the best preloads are 312.6 to 335.1 N/m, their highest peaks 2.49 um to 4.563 um, "
        "0.0806 to 0.148 of those of the free base.");
  CHECK(told[3] == "1 of 3 designs failed.");
  CHECK(study_answer(physical({failed})) == Lines{"1 of 1 designs failed."});
}

TEST_CASE("Lengths are told in the unit that fits", "[answer]") {
  CHECK(arcslip::length_text(1.8204e-6) == "1.82 um");
  CHECK(arcslip::length_text(0.0123) == "12.3 mm");
  CHECK(arcslip::length_text(2) == "2 m");
  CHECK(arcslip::length_text(3e-11) == "0.03 nm");
}

TEST_CASE("What for_each sets is told with its unit", "[answer]") {
  CHECK(arcslip::setting_text("damper.width", "0.012") == "damper.width = 0.012 m");
  CHECK(arcslip::setting_text("preload_per_length", "300") == "preload_per_length = 300 N/m");
  CHECK(arcslip::setting_text("friction_coefficient", "0.3") == "friction_coefficient = 0.3");
  CHECK(arcslip::setting_text("mass_ratio", "5") == "mass_ratio = 5");
}

TEST_CASE("The answer of a study comes from its tables", "[answer]") {
  const TemporaryFolder folder;
  const std::string optimum = folder.write(
      "optimum.csv", std::string(optimum_header) +
                         ",preload_N_per_m,preload_low_N_per_m,preload_high_N_per_m,frequency_Hz,"
                         "Y_m\n0,5,1,4,2,0.5,smooth,0.1,3,100,10,300,400,2e-6\n"
                         "1,10,nan,nan,nan,nan,failed,nan,nan,nan,nan,nan,nan,nan\n");
  const std::string robust = folder.write(
      "robust.csv",
      "curve,mass_ratio,P_q95,Y_q95,ratio_q95,P_opt,Y_q95_opt,ratio_q95_opt,error,sampling_error,"
      "preload_N_per_m,Y_q95_m\n0,5,1.5,3,0.75,1,4,1,0,0,150,3e-6\n"
      "1,10,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan\n");
  const ordered_json input = {{"study", {{"from", 0.1}, {"to", 10}, {"objective", "Y"}}}};
  const arcslip::ResultTable optima(optimum, {"kind"}, "designs");
  const arcslip::ResultTable robusts(robust, {"P_q95"}, "designs");
  const Findings found = findings_of(input, optima, &robusts);
  REQUIRE(found.designs.size() == 2);
  CHECK(found.preload_unit == "N/m");
  const BestPreload& best = found.designs[0];
  CHECK(best.design == "mass_ratio = 5");
  CHECK(best.preload == 100);
  CHECK(best.from_end);
  CHECK_FALSE(best.to_end);
  CHECK(best.scatter->preload == 150);
  CHECK_THAT(best.scatter->peak_at_best, WithinRel(4e-6, 1e-14));  // in metres as the quantile itself
  CHECK(found.designs[1].kind == "failed");
  CHECK_FALSE(found.designs[1].scatter);
  CHECK(arcslip::study_answer(folder.path("."), input) == study_answer(found));
  const ordered_json of_damper = {{"study", {{"from", 0.1}, {"to", 10}, {"objective", "U"}}}};
  CHECK(findings_of(of_damper, optima, nullptr).designs[0].preload == 1);  // its heights have no columns in m
}

TEST_CASE("A run answers with its peaks, what else it found and what is not whole", "[answer]") {
  const auto branch = [](int number, double preload, double Y) {
    return ordered_json{{"branch", number},
                        {"values", {{"preload", preload}}},
                        {"points", 100},
                        {"stop", "reached_end"},
                        {"explanation", "the last value was reached"},
                        {"peak", {{"Y", Y}}},
                        {"special",
                         {{{"type", "start"}, {"eta", 1}, {"Y", 0.1}},
                          {{"type", "switch"}, {"eta", 3}, {"Y", 9.0}},
                          {{"type", "peak"}, {"eta", 4}, {"Y", Y}}}}};
  };
  ordered_json summary = {{"branches", {branch(0, 0.1, 2.8), branch(1, 1, 0.007)}}};
  CHECK(
      run_answer(summary) ==
      Lines{"Of 2 branches the highest peak is lowest with preload = 1: Y = 0.007 at eta = 4. It is highest "
            "with preload = 0.1: Y = 2.8 at eta = 4, 400 times as high.",
            "2 branches of 200 points in all, with 2 switches, 2 peaks."});
  summary["branches"][1]["stop"] = "min_step";
  summary["branches"][1]["explanation"] = "no smaller step is allowed";
  summary["branches"][0]["certificate"] = {{"proven", true}};
  summary["interrupted"] = true;
  const Lines told = run_answer(summary);
  REQUIRE(told.size() == 5);
  CHECK(told[2] == "Branch 1 is not whole: no smaller step is allowed.");
  CHECK(told[3] == "1 of 2 branches are proven by interval arithmetic: nothing was jumped.");
  CHECK(told[4] == "The run was interrupted.");
  summary["branches"][1]["stop"] = "reached_end";
  summary["branches"][1]["first_stop"] = "no_value";
  summary["branches"][1]["first_explanation"] = "the problem has no value there";
  CHECK(run_answer(summary)[2] == "Branch 1 is not whole before its start: the problem has no value there.");
  summary["branches"] = {branch(0, 0.1, 2.8)};
  summary["branches"][0]["special"][2]["Y_m"] = 1.5e-5;
  summary["branches"][0]["special"][2]["frequency_Hz"] = 2413;
  CHECK(run_answer(summary).front() == "Highest peak 15 um at 2413 Hz.");
  summary["branches"] = {branch(0, 0.1, 2.8), branch(1, 1, 2.801)};
  CHECK(run_answer(summary).front() == "On 2 branches the highest peak is alike: Y = 2.801 at eta = 4.");
  summary["case"]["branch"] = {{"parameter", "P"}};
  summary["branches"] = {branch(0, 0.1, 2.8)};
  summary["branches"][0]["special"][2]["P"] = 1.25;
  CHECK(run_answer(summary).front() == "Highest peak Y = 2.8 at eta = 4, P = 1.25.");
  summary["case"]["branch"]["response"] = "limit_cycle";  // whose amplitude is not that of a response
  CHECK(run_answer(summary).front() == "1 branch of 100 points in all, with 1 switch, 1 peak.");
  CHECK_THROWS_AS(run_answer({{"branches", {{{"branch", 0}}}}}), ordered_json::exception);
}

TEST_CASE("What was solved anew is told by its largest differences", "[answer]") {
  const TemporaryFolder folder;
  const auto told = [&](const std::string& rows) {
    const std::string path = folder.write("verify.csv", "type,difference_harmonics,difference_time\n" + rows);
    return verification_answer(arcslip::ResultTable(path, {"type"}, "points"));
  };
  CHECK(
      told("peak,0.01,nan\ntrough,-0.02,-0.003\ninterrupted,nan,nan\n") ==
      "2 points were solved anew: with more harmonics Y differs by at most 0.02, in time at 1 of them by at "
      "most 0.003, relative.");
  CHECK(told("interrupted,nan,nan\n").empty());
}
