#include "arcslip/cases/case_file.hpp"

#include "arcslip/cases/study_case.hpp"
#include "case_texts.hpp"
#include "catch.hpp"
#include "places.hpp"

using namespace arcslip;
using namespace arcslip::testing::case_texts;
using arcslip::testing::Mistake;
using arcslip::testing::replaced;
using arcslip::testing::TemporaryFolder;

TEST_CASE("A case file is read with its defaults") {
  const Case input = read_text(good);
  CHECK(input.title == "A case");
  REQUIRE(input.branches.size() == 1);
  const SystemParameters& system = input.branches[0].problem.system;
  CHECK(system.model == StructureModel::beams);
  CHECK(system.wave_number == 2);
  CHECK(system.interface_stiffness == shear_interface_stiffness(33.3, 0.3));
  CHECK(system.base_damping == 1e-4);
  CHECK(system.damper_damping == 1e-4);
  CHECK(input.branches[0].options.tolerance == 1e-10);
  CHECK(input.branches[0].options.max_step == 0.1);
  CHECK(input.branches[0].options.min_step == 1e-10);
  CHECK(input.branches[0].options.max_points == 100000);
  CHECK(input.resolved["system"]["damping"]["base"] == 1e-4);
  CHECK(input.resolved["system"]["poisson_ratio"] == 0.3);
  CHECK(input.resolved["continuation"]["max_points"] == 100000);
}

TEST_CASE("for_each gives one branch for each value, and lists of several keys are walked together") {
  const Case one = read_text(good + "for_each = { preload = [0.1, 1, 10.0] }\n");
  REQUIRE(one.branches.size() == 3);
  CHECK(one.branches[1].problem.system.preload == 1);
  CHECK(describe(one.branches[0].values) == "preload = 0.1");

  const Case two = read_text(good + "for_each = { frequency_ratio = [1, 2], slenderness = [8.3, 16.7] }\n");
  REQUIRE(two.branches.size() == 2);
  CHECK(two.branches[1].problem.system.frequency_ratio == 2);
  CHECK(two.branches[1].problem.system.interface_stiffness == shear_interface_stiffness(16.7, 0.3));

  const Case damped = read_text(good + "for_each = { damping = [{ base = 1e-3 }, { damper = 0.01 }] }\n");
  CHECK(damped.branches[0].problem.system.base_damping == 1e-3);
  CHECK(damped.branches[1].problem.system.base_damping == 1e-4);
  CHECK(damped.branches[1].problem.system.damper_damping == 0.01);

  const std::string over_preload =
      replaced(replaced(good, "parameter = \"eta\"", "parameter = \"P\""), "preload = 1.0\n", "");
  const Case sweep = read_text(over_preload + "for_each = { eta = [3.5, 4.0] }\n");
  CHECK(sweep.branches[1].problem.eta == 4.0);
}

TEST_CASE("for_each takes ranges, and sets of values one by one") {
  const Case ranged = read_text(
      good +
      "for_each = { preload = { from = 0.1, to = 10, count = 3, scale = \"log\" }, wave_number = { from = "
      "1, to = 3, count = 3 } }\n");
  REQUIRE(ranged.branches.size() == 3);
  CHECK_THAT(ranged.branches[1].problem.system.preload, WithinRel(1, 1e-15));
  CHECK(ranged.branches[2].problem.system.preload == 10);
  CHECK(ranged.branches[1].problem.system.wave_number == 2);

  const Case sets =
      read_text(good + "for_each = [{ preload = 3, force = 2.0 }, { force = 1.0, preload = 4 }]\n");
  REQUIRE(sets.branches.size() == 2);
  CHECK(sets.branches[1].problem.system.preload == 4);
  CHECK(describe(sets.branches[1].values) == "preload = 4, force = 1.0");
}

TEST_CASE("Settings on the command line replace and add values, and bare words need no quotes") {
  const Case input = read_text(good, {"system.preload=7", "continuation.stop_at=[3.9, 4.1]", "title=other",
                                      "system.damping.base=0.01"});
  CHECK(input.branches[0].problem.system.preload == 7);
  CHECK(input.branches[0].options.stop_at == std::vector<double>{3.9, 4.1});
  CHECK(input.title == "other");
  CHECK(input.branches[0].problem.system.base_damping == 0.01);
  CHECK(error_of(good, {"system.preload"}) == "--set system.preload: expected section.key=value");
  CHECK_THAT(error_of(good, {"system.preload=-2"}),
             ContainsSubstring("--set: system.preload: expected") && ContainsSubstring("got -2"));
  CHECK_THAT(error_of(good, {"title.deep=1"}), ContainsSubstring("'title' is not a table"));
  CHECK_THAT(error_of(good, {"system.preload=1 2"}), ContainsSubstring("not a TOML value"));
}

TEST_CASE("Wrong input is refused in one line with place, key, what was expected and what was given") {
  const Mistake mistakes[] = {
      {"preload = 1.0", "preloud = 1.0", ":10:", "system.preloud", "unknown key; did you mean 'preload'?",
       ""},
      {"mass_ratio = 5.0\n", "", ":2:", "system.mass_ratio", "missing; expected a finite number > 0", ""},
      {"mass_ratio = 5.0", "mass_ratio = -5.0", ":6:14", "system.mass_ratio", "a finite number > 0",
       "got -5"},
      {"mass_ratio = 5.0", "mass_ratio = \"5\"", ":6:14", "system.mass_ratio", "a finite number > 0",
       "got \"5\""},
      {"mass_ratio = 5.0", "mass_ratio = nan", ":6:14", "system.mass_ratio", "a finite number > 0",
       "got nan"},
      {"mass_ratio = 5.0", "mass_ratio = inf", ":6:14", "system.mass_ratio", "a finite number > 0",
       "got inf"},
      {"elements = 30", "elements = 4", ":5:12", "system.elements", "> 2 wave_number = 4", "got 4"},
      {"elements = 30", "elements = 30.5", ":5:12", "system.elements", "an integer", "got 30.5"},
      {"elements = 30", "elements = 30.0", ":5:12", "system.elements", "an integer", "got 30.0"},
      {"wave_number = 2", "wave_number = 0", ":4:15", "system.wave_number", "an integer >= 1", "got 0"},
      {"model = \"beams\"", "model = \"plates\"", ":3:9", "system.model",
       R"("rods" or "beams" or "sector" or "spring_mass")", "got \"plates\""},
      {"model = \"beams\"", "model = \"rods\"", ":8:15", "system.slenderness", "only for beams", ""},
      {"force = 1.0", "force = 1.0\ninterface_stiffness = 10", ":10:23", "system.interface_stiffness",
       "not both", ""},
      {"force = 1.0", "force = 1.0\npoisson_ratio = 0.7", ":10:17", "system.poisson_ratio", "<= 0.5",
       "got 0.7"},
      {"force = 1.0", "force = 1.0\ndamping = 0.1", ":10:11", "system.damping", "a table", "got 0.1"},
      {"force = 1.0", "force = 1.0\ndamping = { base = -1 }", ":10:20", "system.damping.base", "> -1 and < 1",
       "-1"},
      {"force = 1.0", "force = 1.0\ndamping = { damper = -0.1 }", ":10:22", "system.damping.damper",
       ">= 0 and < 1", "-0.1"},
      {"force = 1.0", "force = 1.0\ndamping = { bass = 0.1 }", ":10:20", "system.damping.bass", "unknown key",
       ""},
      {"preload = 1.0\n", "", ":2:", "system.preload", "missing", ""},
      {"to = 120.0", "to = 0.5", ":15:6", "branch.to", "differs from branch.from", "got 0.5"},
      {"from = 0.5", "from = 0", ":14:8", "branch.from", "> 0", "got 0"},
      {"parameter = \"eta\"", "parameter = \"omega\"", ":13:13", "branch.parameter", R"("eta" or "P")",
       "\"omega\""},
      {"parameter = \"eta\"", "parameter = \"P\"", ":12:", "branch.eta", "missing", ""},
      {"to = 120.0", "to = 120.0\neta = 3", ":16:7", "branch.eta", "only where parameter = \"P\"", ""},
      {"to = 120.0", "to = 120.0\nfor_each = {}", ":16:", "branch.for_each", "at least one key",
       "got a table"},
      {"to = 120.0", "to = 120.0\nfor_each = { preload = [] }", ":16:", "branch.for_each.preload",
       "at least one value", "got an empty array"},
      {"to = 120.0", "to = 120.0\nfor_each = { preload = [1, -1] }", ":16:", "branch.for_each.preload[1]",
       "> 0", "got -1"},
      {"to = 120.0", "to = 120.0\nfor_each = { preload = [1], force = [1, 2] }",
       ":16:", "branch.for_each.force", "as many as preload", "got 2"},
      {"to = 120.0", "to = 120.0\n[continuation]\nmax_step = 0", ":17:12", "continuation.max_step", "> 0",
       "got 0"},
      {"to = 120.0", "to = 120.0\n[continuation]\nstop_at = [3, 200]", ":17:", "continuation.stop_at[1]",
       ">= 0.5 and <= 120", "got 200"},
      {"to = 120.0", "to = 120.0\n[continuation]\nmax_points = 1", ":17:14", "continuation.max_points",
       ">= 2", "got 1"},
      {"to = 120.0", "to = 120.0\n[contination]\n", ":16:", "contination", "did you mean 'continuation'?",
       ""},
      {"[branch]", "[brunch]", "", "brunch", "did you mean 'branch'?", ""},
      {"title = \"A case\"", "title = 3", ":1:9", "title", "a string", "got 3"},
      {"title = \"A case\"", "title = ", ":1:", "not valid TOML", "", ""},
      {"title = \"A case\"", "title = }", ":1:", "not valid TOML", "", ""},
      {"title = \"A case\"", "[[[title", ":1:", "not valid TOML", "", ""},
  };
  for (const Mistake& mistake : mistakes) check_refused(good, mistake);
}

TEST_CASE("Values that for_each takes the place of are checked as well") {
  const std::string over_preload = replaced(good, "\"eta\"\nfrom", "\"P\"\neta = 3.8\nfrom");
  const std::pair<std::string, Mistake> cases[] = {
      {good + "for_each = { preload = [0.1, 1] }\n",
       {"preload = 1.0", "preload = -1", ":10:11", "system.preload", "> 0", "got -1"}},
      {good + "for_each = [{ preload = 1, force = 2 }]\n",
       {"force = 1.0", "force = \"1\"", ":9:9", "system.force", "> 0", "got \"1\""}},
      {good + "for_each = { wave_number = [3, 4] }\n",
       {"wave_number = 2", "wave_number = 0.5", ":4:15", "system.wave_number", "an integer >= 1", "got 0.5"}},
      {good + "for_each = { damping = [{ base = 0.1 }] }\n",
       {"force = 1.0", "force = 1.0\ndamping = { damper = -0.1 }", ":10:22", "system.damping.damper",
        ">= 0 and < 1", "-0.1"}},
      {good + "for_each = { wave_number = [20], elements = [50] }\n",
       {"elements = 30", "elements = 3", ":5:12", "system.elements", "> 2 wave_number = 4", "got 3"}},
      {over_preload + "for_each = { eta = [3.5, 4.0] }\n",
       {"eta = 3.8", "eta = -3.8", ":", "branch.eta", "> 0", "got -3.8"}},
  };
  for (const auto& [text, mistake] : cases) {
    CAPTURE(mistake.to);
    read_text(text);
    check_refused(text, mistake);
  }
  // What the file lacks is the first set's.
  const Case input = read_text(replaced(good, "wave_number = 2\n", "") +
                               "for_each = { wave_number = [14, 20], elements = [40, 50] }\n");
  CHECK(input.branches[1].problem.system.elements == 50);
}

TEST_CASE("Wrong input for what goes beyond a forced response is refused as well") {
  const Mistake mistakes[] = {
      {"parameter = \"eta\"", "curve = \"fold\"\nparameters = [\"eta\", \"P\"]", ":12:", "branch.window",
       "missing; expected two different numbers, the range of eta", ""},
      {"parameter = \"eta\"", "curve = \"fold\"\nwindow = [1, 2]", ":12:", "branch.parameters",
       R"(missing; expected two different names among "eta", "P")", ""},
      {"parameter = \"eta\"", "curve = \"folds\"", ":13:9", "branch.curve", R"("fold" or "branch_point")",
       "got \"folds\""},
      {"parameter = \"eta\"", "curve = \"level\"\nparameters = [\"eta\", \"P\"]\nwindow = [1, 2]\nlevel = 1",
       ":12:", "branch.level_of", "missing; expected a string", ""},
      {"parameter = \"eta\"",
       "curve = \"level\"\nlevel_of = \"Y\"\nparameters = [\"eta\", \"P\"]\nwindow = [1, 2]",
       ":12:", "branch.level", "missing; expected a finite number", ""},
      {"parameter = \"eta\"",
       "curve = \"level\"\nlevel_of = \"Z\"\nlevel = 1\nparameters = [\"eta\", \"P\"]\nwindow = [1, 2]",
       ":14:12", "branch.level_of",
       R"("beta" or "alpha" or "psi" or "dissipated" or "T_max" or "slip" or "lag")", "got \"Z\""},
      {"parameter = \"eta\"", "curve = \"phase_resonance\"\nparameters = [\"P\", \"eta\"]\nwindow = [1, 2]",
       ":14:14", "branch.parameters", "\"eta\" and another one", ""},
      {"parameter = \"eta\"", "curve = \"phase_resonance\"\nresponse = \"limit_cycle\"", ":13:9",
       "branch.curve", "only of forced and one-way responses", ""},
      {"to = 120.0", "to = 120.0\nlevel_of = \"Y\"", ":16:12", "branch.level_of",
       "only beside curve = \"level\"", ""},
      {"parameter = \"eta\"", "parameters = [\"eta\", \"P\"]", ":13:14", "branch.parameters",
       "only beside curve", ""},
      {"to = 120.0", "to = 120.0\nwindow = [1, 2]", ":16:10", "branch.window", "only beside curve", ""},
      {"to = 120.0", "to = 120.0\nstart = 0.4", ":16:9", "branch.start", ">= 0.5 and <= 120", "got 0.4"},
      {"to = 120.0", "to = 120.0\nswitching = 1", ":16:13", "branch.switching", "true or false", "got 1"},
      {"to = 120.0", "to = 120.0\nresponse = \"free\"", ":16:12", "branch.response",
       R"("forced" or "limit_cycle" or "nonlinear_mode" or "one_way")", "got \"free\""},
      {"to = 120.0", "to = 120.0\nresponse = \"limit_cycle\"", ":13:13", "branch.parameter",
       R"("zeta_B" or "P")", "got \"eta\""},
      {"to = 120.0", "to = 120.0\nextrema_of = \"Y\"", ":16:14", "branch.extrema_of",
       "an array of observables", "got \"Y\""},
      {"to = 120.0", "to = 120.0\nextrema_of = [\"y\"]", ":16:15", "branch.extrema_of[0]",
       R"(names among "R", "S", "R_over_S", "Y")", "got \"y\""},
      {"force = 1.0", "force = 1.0\ndamping = { kind = \"hysteretic\" }", ":10:20", "system.damping.kind",
       R"("viscous" or "structural")", "got \"hysteretic\""},
      {"force = 1.0", "force = 1.0\ndamping = { base = 1 }", ":10:20", "system.damping.base", "> -1 and < 1",
       "got 1"},
      {"force = 1.0", "force = 1.0\nfixed_damper = 1", ":10:16", "system.fixed_damper", "true or false",
       "got 1"},
      {"force = 1.0", "force = 1.0\ncubic_stifness = 1", ":10:", "system.cubic_stifness",
       "did you mean 'cubic_stiffness'?", ""},
      {"force = 1.0", "force = 1.0\ncubic_stiffness = inf", ":10:19", "system.cubic_stiffness",
       "a finite number", "got inf"},
      {"force = 1.0", "force = 1.0\npreload_growth = \"much\"", ":10:18", "system.preload_growth",
       "a finite number", "got \"much\""},
      {"to = 120.0", "to = 120.0\n[continuation]\nstop_after = \"folds\"", ":17:14",
       "continuation.stop_after", "unknown type 'folds'; expected the type of a special point", ""},
      {"to = 120.0", "to = 120.0\n[continuation]\nstop_after = \"regular\"", ":17:14",
       "continuation.stop_after", "unknown type 'regular'", ""},
      {"to = 120.0", "to = 120.0\n[continuation]\nstop_after = { fold = 0 }",
       ":17:", "continuation.stop_after.fold", "an integer >= 1", "got 0"},
      {"to = 120.0", "to = 120.0\n[continuation]\nstop_after = { foold = 1 }",
       ":17:", "continuation.stop_after.foold", "unknown type 'foold'", ""},
      {"to = 120.0", "to = 120.0\n[continuation]\nmax_seconds = 0", ":17:15", "continuation.max_seconds",
       "> 0", "got 0"},
  };
  for (const Mistake& mistake : mistakes) check_refused(good, mistake);
}

TEST_CASE("Wrong input for models of the library and for curves is refused") {
  const Mistake of_models[] = {
      {"\"cusp\"", "\"cups\"", ":2:9", "system.model",
       R"("bratu" or "bratu_2d" or "brusselator_1d" or "cusp")", "got \"cups\""},
      {"lambda = 1", "mu = 1", ":3:6", "system.mu", "has its values from [branch]", ""},
      {"lambda = 1", "lamda = 1", ":3:", "system.lamda", "did you mean 'lambda'?", ""},
      {"lambda = 1", "lambda = \"1\"", ":3:10", "system.lambda", "a finite number", "got \"1\""},
      {"lambda = 1", "preload = 1", ":3:", "system.preload", "unknown key", ""},
      {"\"mu\"", "\"eta\"", ":5:13", "branch.parameter", R"("mu" or "lambda")", "got \"eta\""},
      {"to = 2", "to = 2\nresponse = \"forced\"", ":8:12", "branch.response",
       "only for systems with friction", ""},
      {"to = 2", "to = 2\neta = 1", ":8:7", "branch.eta", "only for systems with friction", ""},
      {"to = 2", "to = 2\nextrema_of = [\"Y\"]", ":8:15", "branch.extrema_of[0]", "names among", "got \"Y\""},
      {"to = 2", "to = 2\nfor_each = { mu = [1] }", ":8:", "branch.for_each.mu[0]",
       "has its values from [branch]", ""},
      {"to = 2", "to = 2\nfor_each = { lambda = [1, true] }", ":8:", "branch.for_each.lambda[1]",
       "a finite number", "got true"},
      {"\"mu\"", "\"mu\"\nwindow = [1, 2]", ":6:10", "branch.window", "only beside curve", ""},
  };
  const std::string cusp =
      "[system]\nmodel = \"cusp\"\nlambda = 1\n[branch]\nparameter = \"mu\"\nfrom = -2\nto = 2\n";
  for (const Mistake& mistake : of_models) check_refused(cusp, mistake);

  const std::string expected = R"(two different names among "mu", "lambda")";
  const Mistake of_curves[] = {
      {"\"lambda\"]", "\"mu\"]", ":6:14", "branch.parameters", expected, ""},
      {", \"lambda\"]", "]", ":6:14", "branch.parameters", expected, ""},
      {"\"lambda\"]", "\"nu\"]", ":6:21", "branch.parameters[1]", expected, "got \"nu\""},
      {"[-5, 5]", "[5, 5]", ":7:10", "branch.window", "two different numbers, the range of mu", ""},
      {"[-5, 5]", "[\"a\", 5]", ":7:11", "branch.window[0]", "a finite number", "got \"a\""},
      {"from = -1", "from = 2", ":8:8", "branch.from",
       "looked for at lambda = 1, which is not between 2 and 3", ""},
      {"from = -1", "from = -1\nstart = 1", ":9:9", "branch.start", "not beside curve", ""},
      {"curve = \"fold\"", "curve = \"branch_point\"\nswitching = true", ":6:13", "branch.switching",
       "beside curve only of \"fold\", \"hopf\" or special cycles", ""},
      {"from = -1", "from = -1\nparameter = \"mu\"", ":9:13", "branch.parameter", "not beside curve", ""},
      {"\"fold\"", "\"peak\"", ":4:", "branch.extrema_of", "missing; expected the one observable", ""},
      {"\"fold\"", "\"fold\"\nextrema_of = [\"x\"]", ":6:14", "branch.extrema_of",
       "only beside curves of peaks or troughs", ""},
  };
  const std::string curve =
      "[system]\nmodel = \"cusp\"\nlambda = 1\n[branch]\ncurve = \"fold\"\nparameters = [\"mu\", "
      "\"lambda\"]\nwindow = [-5, 5]\nfrom = -1\nto = 3\n";
  for (const Mistake& mistake : of_curves) check_refused(curve, mistake);
}

TEST_CASE("Sizes of models have their ranges") {
  const auto model = [](const std::string& name, const std::string& setting, const std::string& parameter) {
    return "[system]\nmodel = \"" + name + "\"\n" + setting + "\n[branch]\nparameter = \"" + parameter +
           "\"\nfrom = 0.5\nto = 2\n";
  };
  CHECK_THAT(
      error_of(model("bratu", "intervals = 1", "lambda")),
      ContainsSubstring("case.toml:3:13: system.intervals: expected an integer >= 2 and <= 1e+06, got 1"));
  CHECK_THAT(error_of(model("bratu", "intervals = 2.5", "lambda")), ContainsSubstring("got 2.5"));
  CHECK_THAT(error_of(model("duffing", "harmonics = 1000", "W")),
             ContainsSubstring("system.harmonics: expected an integer >= 1 and <= 999, got 1000"));
  CHECK_THAT(error_of(model("ab", "p3 = -1", "p1")),
             ContainsSubstring("system.p3: expected a finite number >= 0, got -1"));
}

TEST_CASE("A limit cycle takes no frequency, and the damping that it continues") {
  const std::string cycle = replaced(replaced(good, "parameter = \"eta\"", "parameter = \"P\""),
                                     "preload = 1.0\n", "damping = { base = -1e-3 }\n") +
                            "response = \"limit_cycle\"\n";
  const Case input = read_text(cycle);
  CHECK(input.branches[0].problem.response->name == "limit_cycle");
  CHECK(input.branches[0].options.extrema_of.empty());
  CHECK_THAT(error_of(cycle + "eta = 4\n"),
             ContainsSubstring(":17:7: branch.eta: a limit cycle has an eta of its own"));
}

TEST_CASE("Every response takes cubic springs") {
  const std::string sprung = replaced(good, "force = 1.0", "force = 1.0\ncubic_stiffness = 10");
  CHECK(read_text(sprung).branches[0].problem.response->name == "forced");
  const CaseBranch driven = read_text(sprung + "response = \"one_way\"\n").branches[0];
  CHECK(driven.problem.response->name == "one_way");
  CHECK(driven.problem.system.one_way);
  CHECK(driven.problem.system.cubic_stiffness == 10);
}

TEST_CASE("What goes beyond a forced response is read from a case file") {
  const Case curve = read_text(
      replaced(good, "parameter = \"eta\"\nfrom = 0.5\nto = 120.0",
               "curve = \"peak\"\nparameters = [\"eta\", \"P\"]\nwindow = [120, 0.5]\nfrom = 0.1\nto = 10"));
  REQUIRE(curve.branches[0].curve);
  const CurveRequest& request = *curve.branches[0].curve;
  CHECK(request.type == continuation::PointType::peak);
  CHECK(request.active == "eta");
  CHECK(request.window.low == 0.5);
  CHECK(request.window.high == 120);
  CHECK(request.from == 120);  // the search begins there
  CHECK(request.to == 0.5);
  CHECK(request.seed == 1);
  CHECK(curve.branches[0].options.parameter == "P");

  const Case system = read_text(replaced(good, "force = 1.0",
                                         "force = 1.0\ndamping = { base = -0.01, kind = \"structural\" }\n"
                                         "cubic_stiffness = -3\npreload_growth = 0.1\nfixed_damper = true"));
  const SystemParameters& parameters = system.branches[0].problem.system;
  CHECK(parameters.base_damping == -0.01);
  CHECK(parameters.base_damping_kind == DampingKind::structural);
  CHECK(parameters.cubic_stiffness == -3);
  CHECK(parameters.preload_growth == 0.1);
  CHECK(parameters.fixed_damper);
  CHECK(system.resolved["system"]["damping"]["damper"] == 1e-4);

  const Case ended = read_text(good +
                               "start = 3\n[continuation]\nstop_after = { fold = 2, peak = 5 }\n"
                               "max_seconds = 60\n");
  CHECK(ended.branches[0].start == 3.0);
  CHECK(ended.branches[0].options.max_seconds == 60);
  REQUIRE(ended.branches[0].options.stop_after.size() == 2);
  CHECK(ended.branches[0].options.stop_after[1].type == continuation::PointType::peak);
  CHECK(ended.branches[0].options.stop_after[1].count == 5);

  const Case model = read_text(
      "[system]\nmodel = \"bratu\"\n[branch]\nparameter = \"lambda\"\nfrom = 0\nto = 4\nswitching = true\n"
      "for_each = { intervals = [10, 20] }\n");
  REQUIRE(model.branches.size() == 2);
  CHECK(model.branches[0].switching);
  CHECK(model.branches[1].problem.model->name == "bratu");
  CHECK(model.branches[1].problem.settings == problems::LibraryModel::Values{0, 20});
  CHECK(model.resolved["system"]["lambda"] == 0);
}

TEST_CASE("All solutions are looked for at a value that is given") {
  CHECK_THAT(error_of(good + "all_solutions = true\n"),
             ContainsSubstring("branch.start: missing; expected the value of the parameter"));
  CHECK(read_text(good + "start = 3\nall_solutions = true\n").branches[0].all_solutions);
}

TEST_CASE("A case without a section, and a file that cannot be read, are refused") {
  CHECK_THAT(error_of("title = \"nothing\"\n"), ContainsSubstring("expected a section [branch]"));
  CHECK_THAT(error_of(good.substr(good.find("[branch]"))), ContainsSubstring("expected a section [system]"));
  CHECK_THROWS_WITH(read_case("/nowhere/case.toml"),
                    ContainsSubstring("/nowhere/case.toml: cannot be read: No such file"));
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_case(folder.path("")), ContainsSubstring("cannot be read: Is a directory"));
}

TEST_CASE("Every case file that comes with the program is valid") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(testing::source_folder() + "/problems")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string text = arcslip::testing::read(entry.path());
    CHECK(text.front() == '#');  // opens with what it shows
    const bool has_branch = text.find("\n[branch]") != std::string::npos;
    const bool has_study = text.find("\n[study]") != std::string::npos;
    CHECK((has_branch || has_study));
    if (has_branch) CHECK_NOTHROW(read_case(entry.path()));
    if (has_study) CHECK_NOTHROW(read_study(entry.path()));
    ++count;
  }
  CHECK(count >= 3);
}
