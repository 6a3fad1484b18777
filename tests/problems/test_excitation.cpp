#include <cmath>
#include <numbers>

#include "arcslip/cases/study_case.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

TracedBranch traced_load(const std::string& text) {
  const TemporaryFolder folder;
  const Case input = read_case(folder.write("case.toml", text));
  auto all = trace(input.branches.front());
  INFO(all.front().branch.explanation);
  CHECK(all.front().branch.complete());
  REQUIRE(all.front().branch.points.size() > 20);
  return std::move(all.front());
}

std::string rods_under(const std::string& excitation, int harmonics, double preload) {
  return fmt::format(
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 12\nmass_ratio = 5.0\nfrequency_ratio = 4.0\n"
      "interface_stiffness = 1000.0\ndamping = {{ base = 0.01, damper = 0.01 }}\nforce = 1.0\n"
      "preload = {}\nharmonics = {}\n{}[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 6.0\n",
      preload, harmonics, excitation);
}

std::string arcs(double width) { return fmt::format("[excitation]\nkind = \"arcs\"\nwidth = {}\n", width); }

}  // namespace

TEST_CASE("The harmonics of arcs are those of their Fourier series", "[excitation]") {
  const ExcitationKind& kind = *find_excitation_kind("arcs");
  const double width = GENERATE(1e-6, 0.1, 1.0 / 3, 0.5);
  // The even half period about the arc's middle: 1 up to w/2 of the wavelength, -1 beyond (1 - w)/2.
  const auto coefficient = [&](int h) {
    const double edge = std::numbers::pi * width;
    return (std::sin(h * edge) - (std::sin(h * std::numbers::pi) - std::sin(h * (std::numbers::pi - edge)))) /
           h;
  };
  for (const int h : {1, 3, 5, 7, 31})
    CHECK(std::abs(kind.share({&kind, {width}}, h) - coefficient(h) / coefficient(1)) < 1e-9);
  CHECK(find_excitation_kind("travelling")->share({}, 1) == 1.0);
  CHECK(find_excitation_kind("travelling")->share({}, 3) == 0.0);
}

TEST_CASE("What sticks moves in each harmonic of the load as a linear system", "[excitation]") {
  const auto branch = traced_load(
      "[system]\nmodel = \"spring_mass\"\nbase = { mass = [2.0], stiffness = [3.0] }\ncontact_stiffness = "
      "1.5\n"
      "preload = 1e4\nforce = 1.2\ndamping = { base = 0.02 }\nharmonics = 5\n" +
      arcs(0.2) + "[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 4.0\n");
  for (const auto& point : branch.branch.points) {
    const double eta = value(branch, point, "eta");
    for (const int h : {1, 3, 5}) {
      const double share = std::sin(0.2 * h * std::numbers::pi) / (h * std::sin(0.2 * std::numbers::pi));
      const double w = h * eta;
      const Complex stiffness(4.5 - 2 * w * w, 2 * 0.02 * std::sqrt(6.0) * w);
      INFO("eta = " << eta << ", h = " << h);
      CHECK_THAT(value(branch, point, h == 1 ? "Y" : fmt::format("Y_h{}", h)),
                 WithinAbs(std::abs(1.2 * share / stiffness), 1e-9 * value(branch, point, "Y_peak")));
    }
  }
}

TEST_CASE("Under arcs the balance of harmonics is the ring in time, and power comes to nothing",
          "[excitation][numbers]") {
  const double width = GENERATE(0.15, 0.3, 0.5);
  const double preload = GENERATE(0.1, 0.5, 5.0);
  const auto branch = traced_load(rods_under(arcs(width), 15, preload));
  const std::vector<problems::Verification> found =
      problems::verify(branch.request->problem.system, branch.base.harmonics, branch.branch, {});
  int timed = 0;
  for (const problems::Verification& one : found) {
    INFO("width " << width << ", P = " << preload << ", point " << one.point);
    CHECK(one.power_error < 1e-10);
    CHECK_THAT(one.Y_harmonics, WithinRel(one.Y, 1e-3));
    if (std::isnan(one.Y_time)) continue;
    ++timed;
    CHECK_THAT(one.Y_time, WithinRel(one.Y_harmonics, 5e-4));  // up to the 43rd
  }
  CHECK(timed >= 3);
}

TEST_CASE("What is left of the difference goes with the harmonics that are left out",
          "[excitation][numbers]") {
  const auto branch = traced_load(rods_under(arcs(0.5), 81, 0.1));
  problems::VerifyOptions options;
  options.samples = 0;
  int timed = 0;
  for (const problems::Verification& one :
       problems::verify(branch.request->problem.system, branch.base.harmonics, branch.branch, options)) {
    if (std::isnan(one.Y_time)) continue;
    ++timed;
    CHECK_THAT(one.Y_time, WithinRel(one.Y_harmonics, 5e-6));
  }
  CHECK(timed >= 3);
}

TEST_CASE("Free vibrations know no load", "[excitation]") {
  const auto mode = [](const std::string& excitation) {
    std::string text = rods_under(excitation, 3, 1);
    text = replaced(
        text, "[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 6.0\n",
        "[branch]\nresponse = \"nonlinear_mode\"\nparameter = \"R\"\neta = 4.0\nfrom = 1e-3\nto = 1.0\n");
    return traced_load(text);
  };
  const TracedBranch sine = mode("");
  const TracedBranch pads = mode(arcs(0.3));
  REQUIRE(sine.branch.points.size() == pads.branch.points.size());
  for (std::size_t i = 0; i < sine.branch.points.size(); ++i)
    CHECK(sine.branch.points[i].unknowns == pads.branch.points[i].unknowns);
}

TEST_CASE("A study takes the load as it is", "[excitation]") {
  const TemporaryFolder folder;
  const std::string text = replaced(replaced(rods_under(arcs(0.3), 3, 1), "preload = 1\n", ""),
                                    "[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 6.0\n", "") +
                           "[study]\nparameter = \"P\"\nfrom = 0.05\nto = 20.0\neta = [0.5, 6.0]\n"
                           "for_each = { width = [0.1, 0.4] }\n";
  const StudyCase study = read_study(folder.write("case.toml", text));
  REQUIRE(study.count == 2);
  CHECK(study.design(0).system.excitation.settings == std::vector<double>{0.1});
  CHECK(study.design(1).system.excitation.settings == std::vector<double>{0.4});
  CHECK(study.resolved["excitation"]["kind"] == "arcs");
}

TEST_CASE("A load that is none is refused", "[excitation]") {
  const TemporaryFolder folder;
  const Mistake mistakes[] = {
      {"width = 0.3", "width = 0.6", ":14", "excitation.width", "<= 0.5", "0.6"},
      {"width = 0.3", "width = 0", ":14", "excitation.width", "> 0", "got 0"},
      {"width = 0.3", "widht = 0.3", ":14", "excitation.widht", "did you mean 'width'", ""},
      {"\"arcs\"", "\"saw\"", ":13", "excitation.kind",
       "\"arcs\" or \"jet\" or \"orders\" or \"table\" or \"travelling\"", "got \"saw\""},
      {"kind = \"arcs\"", "", ":14", "excitation.width", "unknown key", ""}};
  for (const Mistake& mistake : mistakes) {
    const std::string path =
        folder.write("case.toml", replaced(rods_under(arcs(0.3), 3, 1), mistake.from, mistake.to));
    check_message(error_of([&] { read_case(path); }), mistake);
  }
}
