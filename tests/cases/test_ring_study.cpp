// Studies of whole rings and of patterns of them.

#include <algorithm>
#include <map>

#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/continuation/problem/one_piece.hpp"
#include "arcslip/problems/ridges/highest_peak.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "cases/design_study.hpp"
#include "cases/ring_numbers.hpp"
#include "catch.hpp"
#include "program.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::OnePiece;
using problems::ResponsePeak;
using problems::ResponsePeaks;
using problems::ResponsePeakSite;

namespace {

const std::string beams_of_six = R"([system]
model = "beams"
wave_number = 1
elements = 6
mass_ratio = 5.0
frequency_ratio = 4.0
slenderness = 33.3
force = 1.0
preload = 1.0
damping = { base = 1e-2, damper = 1e-2 }
)";

const std::string sweep = R"([study]
parameter = "P"
from = 0.5
to = 5.0
eta = [3.0, 4.5]
)";

const std::string branch_over_eta = R"([branch]
parameter = "eta"
from = 3.0
to = 4.5
extrema_of = ["Y_max"]
)";

const std::string uneven =
    "[ring]\npreload = { scatter = 0.3, seed = 5 }\nstiffness = { scatter = 0.1, seed = 8, law = \"normal\" "
    "}\n";

problems::PreloadStudy first_study(const std::string& text) {
  const StudyCase study = case_texts::read_study_text(text);
  problems::PreloadStudy result = study_preload(study, study.design(0));
  INFO(result.failure);
  REQUIRE(result.optimum.has_value());
  return result;
}

std::vector<std::map<std::string, double>> rows_of(const std::string& path) {
  const auto cells = read_csv(path);
  std::vector<std::map<std::string, double>> rows;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    rows.emplace_back();
    for (std::size_t k = 0; k < cells[i].size(); ++k)
      rows.back()[cells[0][k]] = std::strtod(cells[i][k].c_str(), nullptr);
  }
  return rows;
}

/// The highest Y_max of a pattern's response at a preload, in pieces.
double highest(const std::string& text, std::size_t pattern, double preload) {
  const Case input = case_texts::read_text(
      text, {fmt::format("ring.pattern={}", pattern), fmt::format("system.preload={:.17g}", preload)});
  const std::vector<TracedBranch> traced = trace(input.branches.front());
  double most = 0;
  for (const BranchPoint& point : traced.front().branch.points)
    most = std::max(most, value(traced.front(), point, "Y_max"));
  return most;
}

/// Of a pattern over the window of `sweep`.
ResponsePeaks responses_of(std::size_t pattern, bool is_polished,
                           const std::string& text = beams_of_six + uneven) {
  const Case input = case_texts::read_text(text + branch_over_eta,
                                           {fmt::format("ring.pattern={}", pattern), "system.preload=5.0"});
  const CaseBranch& request = input.branches.front();
  const Subject subject = build(request.problem, "eta", request.options.from);
  return ResponsePeaks({std::make_shared<const OnePiece>(subject.built.problem), "eta", "P",
                        request.options.from, request.options.to, "Y_max", subject.guess, request.options,
                        is_polished});
}

}  // namespace

TEST_CASE("An equal ring under its wave has the best preload of one sector", "[ring study]") {
  const problems::Optimum sector = *first_study(beams_of_six + sweep).optimum;
  const problems::Optimum ring = *first_study(beams_of_six + "[ring]\n" + sweep).optimum;
  CHECK_THAT(ring.peak.preload, WithinRel(sector.peak.preload, 1e-6));
  CHECK_THAT(ring.peak.Y, WithinRel(sector.peak.Y, 1e-8));
  CHECK_THAT(ring.peak.eta, WithinRel(sector.peak.eta, 1e-6));
  CHECK_THAT(ring.energy, WithinRel(sector.energy, 1e-6));
  CHECK_THAT(ring.low, WithinRel(sector.low, 1e-5));
  CHECK_THAT(ring.high, WithinRel(sector.high, 1e-5));
  CHECK(ring.kind == sector.kind);
}

TEST_CASE("Peaks of an uneven ring are the same in pieces and in one", "[ring study]") {
  const int harmonics = GENERATE(1, 3);
  const Case input = case_texts::read_text(beams_of_six + uneven + branch_over_eta,
                                           {fmt::format("system.harmonics={}", harmonics)});
  const CaseBranch& request = input.branches.front();
  const Subject subject = build(request.problem, "eta", request.options.from);
  REQUIRE(subject.failure.empty());
  const auto located = trace(*subject.built.problem, subject.guess, request.options);
  const OnePiece whole(subject.built.problem);
  const auto passed = trace(whole, subject.guess, request.options);
  REQUIRE(located.complete());
  REQUIRE(passed.complete());
  CHECK(of_type(located, PointType::regime_switch).size() >= 10);
  const auto peaks = of_type(located, PointType::peak);
  const auto others = of_type(passed, PointType::peak);
  REQUIRE(!peaks.empty());
  REQUIRE(others.size() == peaks.size());
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    CHECK_THAT(others[i].parameters(0), WithinRel(peaks[i].parameters(0), 1e-7));
    CHECK((others[i].unknowns - peaks[i].unknowns).norm() < 1e-6 * peaks[i].unknowns.norm());
    CHECK(continuation::regime_at(*subject.built.problem, others[i].unknowns, others[i].parameters) ==
          peaks[i].regime);
  }
}

TEST_CASE("Peaks of an uneven ring beside rough ones are those of points on them", "[ring study]") {
  const double preload = GENERATE(0.5, 0.8, 1.2, 2.0, 3.5);
  CAPTURE(preload);
  ResponsePeaks exact = responses_of(2, false);
  ResponsePeaks polished = responses_of(2, true);
  const std::vector<ResponsePeak> there = exact.at(preload);
  const std::vector<ResponsePeak> found = polished.at(preload);
  REQUIRE(found.size() == there.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].site == there[i].site);
    CHECK_THAT(found[i].place, WithinRel(there[i].place, 1e-8));
    CHECK_THAT(found[i].log_height, WithinAbs(there[i].log_height, 1e-11));
    CHECK_THAT(found[i].slope, WithinAbs(there[i].slope, 1e-7));
  }
}

TEST_CASE("Of two peaks close to each other it is the higher one that stands", "[ring study]") {
  std::string text = replaced(beams_of_six, "elements = 6", "elements = 8");
  text = replaced(text, "base = 1e-2, damper = 1e-2", "base = 3e-3, damper = 3e-3") +
         "[ring]\npreload = { scatter = 0.3, seed = 1, correlation = 1.5 }\n"
         "stiffness = { scatter = 0.1, seed = 2 }\n";
  for (const bool is_polished : {false, true}) {
    CAPTURE(is_polished);
    ResponsePeaks responses = responses_of(34, is_polished, text);
    const std::vector<ResponsePeak> peaks = responses.at(1.09499258);  // there is one at 3.840 as well
    const ResponsePeak& highest = peaks[problems::highest_of(peaks)];
    CHECK_THAT(highest.place, WithinRel(3.82546933, 1e-7));
    CHECK_THAT(std::exp(highest.log_height), WithinRel(0.00702540289, 1e-7));
  }
}

TEST_CASE("A peak is found from beside it, an edge while it rises, and neither elsewhere", "[ring study]") {
  ResponsePeaks responses = responses_of(1, false);
  const ResponsePeak peak = responses.at(3.5).front();
  REQUIRE(peak.site == ResponsePeakSite::smooth);
  continuation::Guess guess = peak.at;
  guess.parameters(0) *= 1.0005;
  guess.unknowns *= 0.99;
  const auto again = responses.next_to(guess, peak.site);
  REQUIRE(again.has_value());
  CHECK_THAT(again->place, WithinRel(peak.place, 1e-9));
  CHECK_THAT(again->log_height, WithinAbs(peak.log_height, 1e-12));
  CHECK(!responses.next_to(guess, ResponsePeakSite::corner));
  const continuation::Branch branch = responses.response_at(3.5);
  const auto end = [](const BranchPoint& point) {
    return continuation::Guess{point.unknowns, point.parameters, point.regime, {}};
  };
  CHECK(!responses.next_to(end(branch.points.front()), ResponsePeakSite::edge));  // it rises away from both
  CHECK(!responses.next_to(end(branch.points.back()), ResponsePeakSite::edge));
  const auto trough = of_type(branch, PointType::trough);
  for (const BranchPoint& point : trough) CHECK(!responses.next_to(end(point), ResponsePeakSite::smooth));
}

TEST_CASE("A study that follows peaks finds what one that traces all responses does", "[ring study]") {
  const std::size_t pattern = GENERATE(std::size_t{1}, std::size_t{2}, std::size_t{3});
  CAPTURE(pattern);
  using problems::HighestPeak;
  constexpr double tolerance = 1e-3;
  const auto envelope = [&](ResponsePeaks& responses, HighestPeak::Looks looks, HighestPeak::Lowest& lowest,
                            double& best) {
    HighestPeak highest(responses, 0.5, 5.0, {}, looks);
    lowest = highest.lowest(0.05);
    CHECK(highest.refine(tolerance, 300) <= tolerance);
    best = highest.sample(lowest.x).highest().log_height;
    CHECK(highest.sample(lowest.x).is_whole);
    const auto& samples = highest.samples();
    const bool all_are_whole =
        std::all_of(samples.begin(), samples.end(), [](const auto& sample) { return sample.is_whole; });
    CHECK(all_are_whole == (looks == HighestPeak::Looks::whole));
    return problems::EnvelopeCurve(highest.pieces());
  };
  ResponsePeaks traced = responses_of(pattern, false);
  ResponsePeaks followed = responses_of(pattern, true);
  HighestPeak::Lowest lowest_of_traced;
  HighestPeak::Lowest lowest_of_followed;
  double best_of_traced = 0;
  double best_of_followed = 0;
  const auto all = envelope(traced, HighestPeak::Looks::whole, lowest_of_traced, best_of_traced);
  const auto some = envelope(followed, HighestPeak::Looks::followed, lowest_of_followed, best_of_followed);
  CHECK(lowest_of_followed.kind == lowest_of_traced.kind);
  CHECK_THAT(lowest_of_followed.x, WithinAbs(lowest_of_traced.x, 1e-7));
  CHECK_THAT(best_of_followed, WithinAbs(best_of_traced, 1e-10));
  for (double P = 0.5; P <= 5; P *= 1.07)
    CHECK_THAT(some.at(std::log(P)), WithinAbs(all.at(std::log(P)), 2 * tolerance));
}

TEST_CASE("Patterns are those of their numbers", "[ring study]") {
  const auto contacts = [](const std::string& pattern) {
    return case_texts::read_text(beams_of_six + uneven + pattern + branch_over_eta)
        .branches.front()
        .problem.system.contacts;
  };
  const auto same = [](const std::vector<SectorContact>& a, const std::vector<SectorContact>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), [](const SectorContact& x, const SectorContact& y) {
      return x.stiffness == y.stiffness && x.slip_per_preload == y.slip_per_preload;
    });
  };
  CHECK(same(contacts(""), contacts("pattern = 1\n")));
  CHECK(!same(contacts(""), contacts("pattern = 2\n")));
  const std::vector<SectorContact> equal = contacts("pattern = 0\n");
  CHECK(same(equal, std::vector<SectorContact>(6, equal.front())));
  CHECK(seed_of_pattern(7, 1) == 7);
  CHECK(seed_of_pattern(7, 2) != seed_of_pattern(8, 2));
  const Case listed =
      case_texts::read_text(beams_of_six + uneven + branch_over_eta + "for_each = { pattern = [0, 2] }\n");
  REQUIRE(listed.branches.size() == 2);
  CHECK(same(listed.branches[0].problem.system.contacts, equal));
  CHECK(same(listed.branches[1].problem.system.contacts, contacts("pattern = 2\n")));
}

TEST_CASE("Quantiles of patterns are those of their responses, traced one by one", "[ring study]") {
  const TemporaryFolder folder;
  const std::string text = beams_of_six + uneven;
  constexpr std::size_t patterns = 10;
  const std::string path =
      folder.write("case.toml", text + sweep + "[study.uncertain]\npatterns = 10\nquantiles = [0.1, 0.5]\n");
  const std::string results = folder.path("results");
  const Outcome outcome = arcslip_program("study " + path + " -o " + results + " --quiet --jobs 3");
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.status == 0);
  const auto robust = rows_of(results + "/robust.csv");
  REQUIRE(robust.size() == 1);
  CHECK(robust[0].at("failed") == 0);
  const double tolerance = 2e-3 + robust[0].at("error");
  CHECK(robust[0].at("error") < 5e-3);
  const double best = robust[0].at("P_q95");
  const auto at = [&](double preload) {
    std::vector<double> peaks;
    for (std::size_t i = 1; i <= patterns; ++i) peaks.push_back(highest(text + branch_over_eta, i, preload));
    std::sort(peaks.begin(), peaks.end());
    return peaks;
  };
  const std::vector<double> there = at(best);
  CHECK_THAT(robust[0].at("Y_q95"), WithinRel(there[9], tolerance));
  const double equal = highest(text + branch_over_eta, 0, best);
  CHECK_THAT(robust[0].at("amplification_q95"), WithinRel(there[9] / equal, tolerance));
  CHECK_THAT(robust[0].at("Y_q95_opt"), WithinRel(at(robust[0].at("P_opt"))[9], tolerance));
  CHECK(robust[0].at("Y_q95") <= robust[0].at("Y_q95_opt"));
  const auto quantiles = rows_of(results + "/quantiles.csv");
  for (const std::size_t i : {std::size_t{7}, quantiles.size() - 5}) {
    const std::vector<double> peaks = at(quantiles[i].at("P"));
    CHECK_THAT(quantiles[i].at("Y_q10"), WithinRel(peaks[0], tolerance));
    CHECK_THAT(quantiles[i].at("Y_q50"), WithinRel(peaks[4], tolerance));
    CHECK_THAT(quantiles[i].at("Y_equal"),
               WithinRel(highest(text + branch_over_eta, 0, quantiles[i].at("P")), tolerance));
    CHECK_THAT(quantiles[i].at("amplification_q50"),
               WithinRel(quantiles[i].at("Y_q50") / quantiles[i].at("Y_equal"), 1e-12));
  }
  CHECK(rows_of(results + "/patterns.csv").size() == patterns + 1);
  CHECK(rows_of(results + "/optimum.csv").size() == 1);

  const std::string again = folder.path("again");
  REQUIRE(arcslip_program("study " + path + " -o " + again + " --quiet --jobs 1").status == 0);
  for (const char* file : {"robust.csv", "quantiles.csv", "patterns.csv", "optimum.csv", "sweep.csv"})
    CHECK(read(results + "/" + file) == read(again + "/" + file));
}

TEST_CASE("What patterns cannot be of is refused", "[ring study][messages]") {
  const std::string patterns = "[study.uncertain]\npatterns = 10\n";
  const auto error = [](const std::string& text) {
    return error_of([&] { case_texts::read_study_text(text); });
  };
  using Catch::Matchers::ContainsSubstring;
  CHECK_THAT(error(beams_of_six + sweep + patterns),
             ContainsSubstring("study.uncertain.patterns: only of whole rings"));
  CHECK_THAT(error(beams_of_six + "[ring]\n" + sweep + patterns),
             ContainsSubstring("study.uncertain.patterns: nothing in [ring] scatters"));
  CHECK_THAT(error(beams_of_six + uneven + sweep + patterns + "mu = { lognormal = 0.1 }\n"),
             ContainsSubstring("study.uncertain.mu: not beside patterns"));
  CHECK_THAT(error(beams_of_six + uneven + sweep + "for_each = { pattern = [1, 2] }\n" + patterns),
             ContainsSubstring("pattern cannot be listed beside uncertain.patterns"));
  CHECK_THAT(error(beams_of_six + uneven + sweep + "[study.uncertain]\npatterns = 3\n"),
             ContainsSubstring("study.uncertain.patterns: expected an integer >= 10 and <= 1e6, got 3"));
  CHECK_THAT(error(beams_of_six + sweep + "for_each = { pattern = [1, 2] }\n"),
             ContainsSubstring("study.for_each.pattern: unknown key"));
}
