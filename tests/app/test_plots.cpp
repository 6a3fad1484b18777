// The pictures of `arcslip plot`: that they are drawn whole, and what is said where they cannot be.

#include <set>
#include <string>
#include <vector>

#include "plotting.hpp"

using namespace arcslip::testing;

namespace {

const std::vector<std::string> pictures = {"amplitude", "relative", "phases", "phase_difference",
                                           "dissipated"};

void draw_case(const std::string& problem, const std::string& folder, const std::string& options = "") {
  const Outcome outcome =
      arcslip_program("run '" + case_named(problem) + "' --quiet -o \"" + folder + "\" " + options);
  REQUIRE(outcome.err.empty());
  REQUIRE(outcome.status == 0);
}

constexpr const char* rods =
    "[system]\nmodel = 'rods'\nwave_number = 1\nelements = 30\nmass_ratio = 5\nfrequency_ratio = 4\nforce = "
    "1\n";
constexpr const char* stiffening =
    "interface_stiffness = 1000\ncubic_stiffness = 10\ndamping = { base = 5e-3, damper = 1e-4 }\n";

/// Traces a case file of this text and draws it; the pictures are required to be whole and to be these.
void draw(const TemporaryFolder& folder, const std::string& text, const std::vector<std::string>& drawn,
          const std::set<std::string>& results = run_results) {
  const std::string file = folder.write("case.toml", text);
  const Outcome run = arcslip_program("run " + file + " --quiet -o " + folder.path("r"));
  REQUIRE(run.err.empty());
  REQUIRE(run.status == 0);
  const Outcome outcome = plotted(folder.path("r"));
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  require_pictures(folder.path("r"), 8'000, drawn, results);
}

}  // namespace

TEST_CASE("plot draws every picture whole, as PNG and SVG, and names them", "[plots]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  const std::string results_folder = folder.path(R"(figure 8's "own")");
  const std::string quoted = folder.path(R"(figure 8's \"own\")");  // for the shell, between double quotes
  draw_case("figure_8", quoted);
  const Outcome outcome = arcslip_program("plot \"" + quoted + "\"");
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  require_pictures(results_folder, 40'000, pictures, run_results, true);
  std::string listed;
  for (const std::string& picture : pictures) {
    for (const char* ending : {".png", ".svg"}) {
      listed.append(results_folder).append("/").append(picture).append(ending).append("\n");
    }
  }
  CHECK(outcome.out == listed);
}

TEST_CASE("plot names axis and branches by the symbols of the paper", "[plots][outside]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  draw_case("preload_response", folder.path("r"));
  REQUIRE(plotted(folder.path("r")).status == 0);
  require_pictures(folder.path("r"), 20'000, pictures, run_results);
  const std::string svg = read(folder.path("r/amplitude.svg"));
  CHECK_THAT(svg, ContainsSubstring("preload  $P$") && ContainsSubstring("<!-- $\\eta$ = 3.68"));
}

TEST_CASE("plot names all of a few branches and some of many", "[plots][outside]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  const auto drawn = [&](int branches) {
    std::string preloads = "0.5";
    for (int i = 1; i < branches; ++i) preloads.append(",").append(std::to_string(i));
    draw_case("figure_8", folder.path("r"),
              "--set branch.to=1 --set 'branch.for_each.preload=[" + preloads + "]'");
    REQUIRE(plotted(folder.path("r"), "--only amplitude").status == 0);
    return read(folder.path("r/amplitude.svg"));
  };
  const auto named = [](const std::string& svg) {
    int count = 0;
    for (std::size_t at = 0; (at = svg.find("<!-- $P$ = ", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  CHECK(named(drawn(12)) == 12);
  CHECK(named(drawn(30)) == 6);
}

TEST_CASE("plot draws quantities that are not defined as empty panels", "[plots][outside]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  draw_case("figure_8", folder.path("r"), "--set branch.to=1.5");  // no slip: nothing is dissipated
  const Outcome outcome = plotted(folder.path("r"), "--only dissipated");
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  CHECK_THAT(read(folder.path("r/dissipated.svg")), ContainsSubstring("nothing to show"));
}

TEST_CASE("plot says in one line that matplotlib is missing, or why it failed, and leaves nothing behind",
          "[plots][outside]") {
  const TemporaryFolder folder;
  draw_case("figure_8", folder.path("r"), "--set branch.to=1.5");
  const auto fails = [&](const std::string& python, const std::string& message) {
    CAPTURE(message);
    const Outcome outcome =
        shell("ARCSLIP_PYTHON='" + python + "' '" + program + "' plot " + folder.path("r"));
    CHECK(outcome.status == 4);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, ContainsSubstring(message));
    CHECK(outcome.out.empty());
    CHECK(names_in(folder.path("r")) == run_results);
  };
  const std::string missing =
      "arcslip plot: no python3 with matplotlib was found; install it (Debian: apt-get install "
      "python3-matplotlib)\n";
  fails("/nonexistent/python3", missing);
  fails(false_python(folder, "exit 5"), missing);
  fails(false_python(folder, "echo first >&2; echo the reason >&2; exit 3"), "python3 failed: the reason");
  fails(false_python(folder, "kill -9 $$"), "signal 9");
}

TEST_CASE("plot refuses a folder without results, in one line that names the file", "[plots]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  const Outcome outcome = arcslip_program("plot " + folder.path("none"));
  CHECK(outcome.status == 1);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring(folder.path("none")));
}

TEST_CASE("plot gives the branches that one request led to no names, and those of several theirs",
          "[plots][outside]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  draw(folder, "[system]\nmodel = 'enz'\n[branch]\nparameter = 's0'\nfrom = 0\nto = 60\nswitching = true\n",
       {"branch"});
  const std::string one = read(folder.path("r/branch.svg"));
  CHECK_THAT(one, ContainsSubstring("branch") && !ContainsSubstring("$ = "));
  draw(folder,
       "[system]\nmodel = 'cusp'\n[branch]\nparameter = 'mu'\nfrom = -2\nto = 2\n"
       "for_each = { lambda = [-1, 0.5] }\n",
       {"branch"});
  CHECK_THAT(read(folder.path("r/branch.svg")), ContainsSubstring("<!-- $\\lambda$ = −1 -->"));
}

TEST_CASE("plot draws a curve of special points in the plane of its two parameters", "[plots][outside]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  draw(folder,
       "[system]\nmodel = 'cusp'\nlambda = 1\n[branch]\ncurve = 'fold'\nparameters = ['mu', 'lambda']\n"
       "window = [-2.5, 2.5]\nfrom = -1\nto = 3\n",
       {"curve"});
  const std::string svg = read(folder.path("r/curve.svg"));
  CHECK_THAT(svg, ContainsSubstring("<!-- folds -->") && ContainsSubstring("<!-- cusp -->") &&
                      ContainsSubstring("<!-- $\\mu$ -->"));
  CHECK_THAT(svg, !ContainsSubstring("requested"));  // the value from which the curve starts is no request
}

TEST_CASE("plot draws curves of special points of cycles and maps", "[plots][outside]") {
  if (!has_matplotlib()) return;
  const std::string wall =
      "[model]\nkind = 'piecewise'\nperiod = '2*pi/w'\nparameters = { w = 2.8, r = 0.8 }\n"
      "equations = { x = 'v', v = 'cos(w*t) - 0.1*v - x' }\nstart = { v = 0.5 }\n"
      "[model.pieces.free]\nuntil = 'x - 0.5'\nreset = { v = '-r*v' }\n[cycles]\nsettle = 400\n"
      "[branch]\nparameters = ['w', 'r']\nfrom = 0.8\nto = 0.7\n";
  const std::string map =
      "[model]\nkind = 'map'\nparameters = { a = 1.5, b = 0 }\n"
      "equations = { x = 'a*x*(1 - y) + b', y = 'x' }\nstart = { x = 0.4, y = 0.4 }\n"
      "[branch]\nparameters = ['a', 'b']\nfrom = 0\nto = 0.05\nwindow = [1.5, 2.5]\n";
  const auto [kind, title, text] = GENERATE_REF(table<std::string, std::string, std::string>(
      {{"cycle_fold", "folds of cycles", wall + "window = [2.8, 3.5]\n"},
       {"period_doubling", "period doublings", wall + "window = [2.8, 2]\n"},
       {"neimark_sacker", "Neimark-Sacker points", map}}));
  CAPTURE(kind);
  const TemporaryFolder folder;
  draw(folder, text + "curve = '" + kind + "'\n", {"curve"});
  CHECK_THAT(read(folder.path("r/curve.svg")), ContainsSubstring("<!-- " + title + " -->"));
}

TEST_CASE(
    "plot draws a curve of a system with friction a second time, as amplitude over its second parameter",
    "[plots]") {
  if (!has_matplotlib()) return;
  const std::string curve = GENERATE("fold", "peak", "switch");
  CAPTURE(curve);
  const TemporaryFolder folder;
  draw(folder,
       std::string(rods) + stiffening + "preload = 0.1\n[branch]\ncurve = '" + curve +
           "'\nparameters = ['eta', 'P']\nwindow = [0.5, 12]\nfrom = 0.05\nto = 10\n",
       {"curve", "amplitude"});
}

TEST_CASE("plot draws orbits of special points, and tori as nets", "[plots][outside]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  draw_case("langford_tori", folder.path("r"), "--set branch.to=0.605");
  const Outcome outcome = plotted(folder.path("r"));
  CHECK(outcome.err.empty());
  require_pictures(folder.path("r"), 8'000, {"branch", "orbits", "tori"},
                   {"branches.csv", "curves.csv", "orbits.csv", "tori.csv", "summary.json"});
  const std::string orbits = read(folder.path("r/orbits.svg"));
  CHECK_THAT(orbits,
             ContainsSubstring("<!-- Neimark\u2013Sacker") || ContainsSubstring("Sacker, $\\rho$ = 0.61"));
  CHECK_THAT(read(folder.path("r/tori.svg")), ContainsSubstring("<!-- end, $\\rho$ = 0.605 -->"));

  const TemporaryFolder between_ends;
  draw(between_ends,
       "[model]\nkind = 'boundary'\nparameters = { lambda = 0.1 }\n"
       "equations = { u = 'v', v = '-lambda*exp(u)' }\ninterval = { x = [0, 1] }\n"
       "conditions = ['u_left', 'u_right']\nstart = { u = 0, v = 0 }\n"
       "[branch]\nparameter = 'lambda'\nfrom = 0.1\nto = 4\n",
       {"branch", "orbits"}, {"branches.csv", "curves.csv", "orbits.csv", "summary.json"});
  CHECK_THAT(read(between_ends.path("r/orbits.svg")),
             ContainsSubstring("<!-- fold, $\\lambda$ = 3.51383 -->"));
}

TEST_CASE("plot draws limit cycles: their size and their frequency", "[plots][outside]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  draw(folder,
       std::string(rods) +
           "interface_stiffness = 100\nfixed_damper = true\npreload = 1\n"
           "damping = { base = -1e-3, damper = 1e-4, kind = 'structural' }\n[branch]\n"
           "response = 'limit_cycle'\nparameter = 'zeta_B'\nfrom = -1e-4\nto = -0.05\nstart = -1e-3\n",
       {"limit_cycle"});
  const std::string svg = read(folder.path("r/limit_cycle.svg"));
  CHECK_THAT(svg,
             ContainsSubstring("\\zeta") && ContainsSubstring("\\eta") && ContainsSubstring("<!-- fold -->"));
}

TEST_CASE("plot draws responses that fold, and marks the folds", "[plots][outside]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  draw(folder,
       std::string(rods) + stiffening +
           "[branch]\nparameter = 'eta'\nfrom = 0.5\nto = 12\nfor_each = { preload = [0.05, 0.1] }\n",
       pictures);
  CHECK_THAT(read(folder.path("r/amplitude.svg")), ContainsSubstring("<!-- fold -->"));
}
