// Cycles of case files: against closed forms, other methods, other programs and published numbers.

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// Another degree on a finer mesh than `degree = 5`, `intervals = 20` and `tolerance = 1e-6`.
const Settings finer = {"cycles.degree=7", "cycles.intervals=80", "cycles.tolerance=1e-10"};

/// AUTO's demonstrations have constants of single precision.
const Settings enzyme_of_auto = {"model.parameters.alpha=0.20000000298023224",
                                 "model.parameters.kappa=0.10000000149011612"};
const Settings oscillator_of_auto = {
    "model.parameters.gamma=-0.60000002384185791", "model.parameters.r=0.60000002384185791",
    "model.parameters.a3=0.32857799530029297", "model.parameters.b3=0.93357801437377930"};

const std::string mathieu = R"case(
[model]
kind = "forced"
period = "pi"
[model.parameters]
a = 0
q = 1
d = 0
[model.equations]
x = "v"
v = "-d*v - (a + q*cos(2*t))*x"
[branch]
parameter = "a"
from = -1
to = 5
)case";

}  // namespace

TEST_CASE("Special points of cycles are those that a finer mesh of another degree has", "[cycles][numbers]") {
  struct Sought {
    std::string file, parameter;
    PointType type;
    std::vector<double> published;
    double digits;
  };
  // of duffing.toml by harmonic balance; AUTO-07p; published of Roessler's flow
  const std::vector<Sought> all = {
      {"tank_cycles", "p1", PointType::fold, {0.161696}, 1e-6},
      {"roessler_cascade", "c", PointType::period_doubling, {2.832445, 3.837358}, 1e-6},
      {"forced_duffing", "W", PointType::fold, {1.1157002516, 1.2696019548}, 1e-9},
      {"oscillator_tori", "nu", PointType::neimark_sacker, {-0.59165022, -0.59165022}, 1e-7}};
  for (const Sought& sought : all) {
    INFO(sought.file);
    const Run run(sought.file);
    const Run fine(sought.file, finer);
    const auto found = all_values_at(cycles_of(run.traced), sought.type, sought.parameter);
    check_values(found, sought.published, sought.digits);
    check_values(found, all_values_at(cycles_of(fine.traced), sought.type, sought.parameter), 1e-8);
  }
}

TEST_CASE("An oscillator's cycles lose their symmetry and shed tori where AUTO-07p has it", "[cycles]") {
  const Run run("oscillator_tori", oscillator_of_auto);
  const auto all = cycles_of(run.traced);
  REQUIRE(all.size() >= 2);
  check_values(values_at(all[0], PointType::fold, "nu"), {-0.58433479733}, 1e-9);
  check_values(values_at(all[0], PointType::branch_point, "nu"), {-0.587029027}, 1e-7);
  check_values(values_at(all[1], PointType::period_doubling, "nu"), {-0.614955256, -0.614955256}, 1e-7);
  check_values(values_at(all[1], PointType::neimark_sacker, "nu"), {-0.59165021575, -0.59165021575}, 1e-8);
  for (const std::string unknown : {"x", "y", "z"}) {  // the two are images of each other
    const auto largest = values_at(all[1], PointType::neimark_sacker, unknown + "_max");
    const auto smallest = values_at(all[1], PointType::neimark_sacker, unknown + "_min");
    REQUIRE(largest.size() == 2);
    CHECK_THAT(largest[0], WithinAbs(-smallest[1], 1e-6));
    CHECK_THAT(largest[1], WithinAbs(-smallest[0], 1e-6));
  }
}

TEST_CASE("Cycles of a sparse case leave its Hopf point with its period, stable", "[cycles][numbers]") {
  const Run run("line_cycles");
  REQUIRE(run.traced.size() == 2);
  const auto& points = run.traced[1].branch.points;
  CHECK(points.back().parameters(0) == 0.6);
  CHECK_THAT(values_at(run.traced[1], PointType::start, "T").at(0),
             WithinRel(two_pi / std::sqrt(4.5775), 1e-6));
  CHECK(std::all_of(points.begin(), points.end(), [](const auto& point) { return point.unstable == 0; }));
}

TEST_CASE("What a motion settles on is its own stable cycle, not one that it comes by", "[cycles]") {
  struct Settled {
    std::string from, time;
    double period;
  };
  for (const Settled& one : {Settled{"2.84", "2000", 11.5390507}, Settled{"3.9", "400", 23.157204}}) {
    const auto traced = Run("roessler_cascade", {"branch.from=" + one.from, "branch.to=4",
                                                 "cycles.settle=" + one.time, "branch.switching=false"})
                            .traced;
    REQUIRE(traced.size() == 1);
    const BranchPoint& start = traced[0].branch.points.front();
    CHECK(start.unstable == 0);
    CHECK_THAT(value(traced[0], start, "T"), WithinRel(one.period, 1e-6));
  }
  const auto bursts = traced_of(R"case(
[model]
parameters = { I = 3.5 }
start = { x = -1, y = -4, z = 3.3 }
[model.equations]
x = "y - x^3 + 3*x^2 - z + I"
y = "1 - 5*x^2 - y"
z = "0.01*(4*(x + 1.6) - z)"
[cycles]
settle = 3000
[branch]
parameter = "I"
from = 3.5
to = 3.6
)case");
  REQUIRE(bursts.size() == 1);
  const BranchPoint& start = bursts[0].branch.points.front();
  CHECK(start.unstable == 0);
  CHECK_THAT(value(bursts[0], start, "T"), WithinRel(59.3317421, 1e-6));  // of two spikes
  CHECK(bursts[0].branch.stop == Stop::left_regime);                      // in two rounds of one
}

TEST_CASE("Lorenz' cycles at large rho double their periods where AUTO-07p has it", "[cycles][numbers]") {
  const Run run("lorenz_doublings");
  CHECK_THAT(values_at(run.traced.front(), PointType::branch_point, "rho").at(0), WithinAbs(312.97, 5e-3));
  check_values(all_values_at(run.traced, PointType::period_doubling, "rho"),
               {215.96593063, 215.96593063, 218.21012776, 218.21012776, 229.40670856, 229.40670856}, 1e-9);
}

TEST_CASE("Folds of cycles over two parameters pass those of AUTO-07p", "[cycles]") {
  const Run run("enzyme_cycle_folds", enzyme_of_auto);
  REQUIRE(run.traced.size() == 2);
  check_values(all_values_at(run.traced, PointType::start, "rho"), {2.7596872229, 5.0078403972}, 1e-9);
  // AUTO's s0 are 109 and 111 to 2e-7; those of s0 = 111 are the folds of a closed branch
  const auto ends = all_values_at(run.traced, PointType::end, "rho");
  check_values(ends, {2.582642451, 2.9862945702, 4.7221259912, 5.2433220475}, 2e-7);
  const auto isola = traced_of(R"case(
[model.parameters]
rho = 4
[model.definitions]
rate = "rho*s*a/(1 + s + 0.10000000149011612*s^2)"
[model.equations]
s = "111 - s - rate"
a = "0.20000000298023224*(500 - a) - rate"
[model.start]
s = 30
a = 90
[cycles]
settle = 400
[branch]
parameter = "rho"
from = 2
to = 6
start = 4
)case");
  REQUIRE(isola.size() == 1);
  CHECK(isola[0].branch.stop == Stop::closed_loop);
  check_values(all_values_at(isola, PointType::fold, "rho"), {ends[1], ends[2]}, 1e-8);
}

TEST_CASE("An isola of the enzyme's cycles vanishes at one place on two meshes", "[cycles]") {
  // From one fold of s0 = 110, between which its cycles turn back, over where they meet to the other one.
  const Run usual("enzyme_cycle_folds", {"branch.to=140"});
  const Run fine("enzyme_cycle_folds",
                 {"branch.to=140", "cycles.degree=6", "cycles.intervals=40", "cycles.tolerance=1e-9"});
  std::vector<double> places;
  for (const Run* run : {&usual, &fine}) {
    REQUIRE(run->traced.size() == 1);
    const TracedBranch& traced = run->traced[0];
    CHECK(count(traced, PointType::fold) == 0);
    CHECK(count(traced, PointType::simple_bifurcation) == 0);
    for (const BranchPoint& point : points(traced, PointType::isola_centre)) {
      places.push_back(value(traced, point, "s0"));
      places.push_back(value(traced, point, "rho"));
    }
  }
  REQUIRE(places.size() == 4);
  CHECK_THAT(places[2], WithinRel(places[0], 1e-9));
  CHECK_THAT(places[3], WithinRel(places[1], 1e-8));
  for (const BranchPoint& point : usual.traced[0].branch.points)  // folds lie below it, as the isola does
    CHECK(value(usual.traced[0], point, "s0") <= places[0]);
}

TEST_CASE("Cycles end on orbits between equilibria, at a parameter that is told", "[cycles]") {
  const Run lorenz("lorenz_cycles");
  const auto homoclinic = cycles_of(lorenz.traced);
  REQUIRE(homoclinic.size() == 1);
  CHECK(homoclinic[0].branch.stop == Stop::infinite_period);
  CHECK_THAT(homoclinic[0].branch.points.back().parameters(0), WithinAbs(13.926557407, 2e-8));
  const Run predator("predator_cycles");
  const auto saddles = cycles_of(predator.traced);
  REQUIRE(saddles.size() == 1);
  CHECK(saddles[0].branch.stop == Stop::infinite_period);
  // between the saddles (1, 0) and (0, 0); AUTO-07p's cycle of T = 36 lies at 0.707941
  CHECK_THAT(saddles[0].branch.points.back().parameters(0), WithinAbs(0.70807, 5e-5));
}

TEST_CASE("Duffing's oscillator in time is that of fifteen harmonics", "[cycles]") {
  const Run time("forced_duffing");
  const Run harmonics("duffing", {"system.harmonics=15"});
  const TracedBranch& found = time.traced.front();
  const auto folds = values_at(harmonics.traced.front(), PointType::fold, "W");
  check_values(values_at(found, PointType::fold, "W"), folds, 1e-9);
  for (const BranchPoint& point : found.branch.points) {
    const double w = point.parameters(0);
    CHECK_THAT(value(found, point, "T"), WithinRel(2 * pi / w, 1e-13));
  }
}

TEST_CASE("Multipliers of forced linear systems are known exactly", "[cycles]") {
  const auto all = traced_of(R"case(
[model]
kind = "forced"
period = "2*pi/w"
[model.parameters]
w = 0.7
z = 0.1
[model.equations]
x = "v"
v = "cos(w*t) - 2*z*v - x"
r = "(sin(w*t) - 0.3)*r + x"
[branch]
parameter = "w"
from = 0.7
to = 1.5
)case",
                             finer);
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::reached_end);
  for (const BranchPoint& point : all[0].branch.points) {
    const double period = 2 * pi / point.parameters(0);
    const ComplexVector found =
        cycles(all[0])->log_multipliers(point.unknowns, point.parameters, point.regime);
    REQUIRE(found.size() == 3);
    const double turn = std::remainder(std::sqrt(1 - 0.01) * period, 2 * pi);
    for (const Complex& wanted :
         {Complex(-0.1 * period, turn), Complex(-0.1 * period, -turn), Complex(-0.3 * period, 0)}) {
      INFO(point.parameters(0) << ": " << wanted);
      CHECK((found.array() - wanted).abs().minCoeff() < 1e-10);
    }
    CHECK(point.unstable == 0);
  }
}

TEST_CASE("A period that is no number above 0 at the start is told with its value", "[cycles]") {
  const auto told = [](const std::string& model, const std::string& from, const std::string& period) {
    const auto all = traced_of("[model]\n" + model + "\nperiod = " + period + R"case(
[model.parameters]
w = 0
[model.equations]
x = "cos(w*t) - x"
[branch]
parameter = "w"
to = 2
from = )case" + from);
    REQUIRE(all.size() == 1);
    return all[0].branch.explanation;
  };
  const auto said = [](const std::string& value) {
    return ContainsSubstring("period: " + value + " at the parameters of the start; expected a number > 0");
  };
  const std::string forced = "kind = \"forced\"";
  for (const std::string& model :
       {forced, std::string("kind = \"piecewise\"\npieces.only.until = \"x - 1\"")}) {
    CHECK_THAT(told(model, "-2", "\"10/w\""), said("-5"));
    CHECK_THAT(told(model, "1", "0"), said("0"));
    CHECK_THAT(told(model, "0", "\"10/w\""), said("inf") || said("nan"));
    CHECK_THAT(told(model, "-2", "\"sqrt(w)\""), said("nan"));
  }
  CHECK_THAT(told(forced, "1", "\"2*pi/w\""), ContainsSubstring("the last value was reached"));
}

TEST_CASE("Tongues of Mathieu's equation begin and end at its characteristic values", "[cycles]") {
  // x'' + (a + q cos 2t) x = 0 at q = 1: a_0, a_2 and b_2, with multipliers 1, b_1 and a_1, with -1, of
  // scipy.special.mathieu_a(m, 0.5) and mathieu_b(m, 0.5)
  const auto all = traced_of(mathieu);
  REQUIRE(all.size() == 1);
  check_values(values_at(all[0], PointType::branch_point, "a"),
               {-0.1217655449411, 3.979189215751, 4.10090059556}, 1e-8);
  check_values(values_at(all[0], PointType::period_doubling, "a"), {0.4706543549338, 1.466766842516}, 1e-8);
}

TEST_CASE("Van der Pol's period is known to mu = 10000", "[cycles][numbers]") {
  const auto all = traced_of(R"case(
[model.parameters]
mu = 1
[model.equations]
x = "y"
y = "mu*(1 - x^2)*y - x"
[model.start]
x = 2
[cycles]
settle = 40
[branch]
parameter = "mu"
from = 1
to = 1e4
[continuation]
stop_at = [10, 100, 1000]
)case");
  REQUIRE(all.size() == 1);
  const auto period = [&](const BranchPoint& point) { return value(all[0], point, "T"); };
  const auto& branch = all[0].branch.points;
  // by Taylor series of order 32 in 33 digits
  CHECK_THAT(period(branch.front()), WithinRel(6.6632868593231301, 1e-9));
  const std::vector<double> exact = {19.0783695669390140704, 162.837071092370012132, 1614.40112580833398307};
  const auto there = points(all[0], PointType::user);
  REQUIRE(there.size() == exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) CHECK_THAT(period(there[i]), WithinRel(exact[i], 1e-8));
  // T = (3 - 2 ln 2) mu + 3 alpha mu^(-1/3) + O(ln(mu)/mu), -alpha the first zero of Airy's function
  CHECK(all[0].branch.stop == Stop::reached_end);
  const double mu = 1e4;
  CHECK_THAT(period(branch.back()),
             WithinAbs((3 - 2 * std::log(2.0)) * mu + 3 * 2.338107410459767 / std::cbrt(mu), 1e-3));
}

TEST_CASE("Mistakes in what is asked of cycles are told with their place", "[cycles]") {
  const std::string text = mathieu + "[cycles]\ndegree = 5\n";
  const std::vector<Mistake> mistakes = {
      {"degree = 5", "degree = 8", ":17:10: ", "cycles.degree: ", "integer >= 2 and <= 7", "got 8"},
      {"degree = 5", "intervals = 3", ":17:13: ", "cycles.intervals: ", "integer >= 4", "got 3"},
      {"degree = 5", "tolerance = 0", ":17:13: ", "cycles.tolerance: ", "number > 0", "got 0"},
      {"degree = 5", "settle = -1", ":17:10: ", "cycles.settle: ", "number > 0", "got -1"},
      {"degree = 5", "order = 5", ":17:9: ", "cycles", "order", ""},
      {"period = \"pi\"", "", ":2:1: ", "model.period: ", "expected a formula", "missing"},
      {"kind = \"forced\"", "kind = \"flow\"", ":4:10: ", "model.period: ", "only of kind = \"forced\"", ""}};
  for (const Mistake& mistake : mistakes) case_texts::check_refused(text, mistake);
}

TEST_CASE("A torus that begins where the branch of its cycles does is told", "[cycles]") {
  const std::string pair = R"case(
p = "mu*p - 0.3*q - p*(p^2 + q^2)"
q = "mu*q + 0.3*p - q*(p^2 + q^2)"
[branch]
parameter = "mu"
from = 0
)case";
  const std::string forced =
      "[model]\nkind = \"forced\"\nperiod = \"2*pi\"\nparameters = { mu = 0 }\n"
      "[model.equations]\nx = \"-x + cos(t)\"\n";
  const std::string flow =
      "[cycles]\nsettle = 50\n[model]\nparameters = { mu = 0 }\nstart = { x = 1 }\n"
      "[model.equations]\nx = \"x*(1 - x^2 - y^2) - y\"\n"
      "y = \"y*(1 - x^2 - y^2) + x\"\n";
  for (const std::string& system : {forced, flow}) {
    for (const std::string end : {"1", "-1"}) {
      CAPTURE(system, end);
      const auto all = traced_of(system + pair + "to = " + end);
      check_values(all_values_at(all, PointType::neimark_sacker, "mu"), {0}, 1e-9);
    }
  }
}

// x = d + cos(2 t) + c cos(t) is greatest at 0 or pi: 1 + d + c, which falls, up to the corner at `corner`,
// then 1 + d - c, which rises as far as `way`, and falls again.
TEST_CASE(
    "A cycle whose greatest value is another one behind a corner has the extremum there and that beside it") {
  const auto [intervals, max_step] = GENERATE(std::pair(16, 0.05), std::pair(16, 0.1), std::pair(25, 0.2));
  const bool least = GENERATE(false, true);
  for (const double corner : {0.3137, 0.4137, 0.52}) {
    for (const double way : {0.003, 0.02}) {
      const auto all = traced_of(fmt::format(R"case([model]
kind = "forced"
period = "2*pi"
parameters = {{ p = 0 }}
[model.definitions]
s = "p - {0}"
first = "-0.1*s"
second = "{1}*s/4 - s^2/8"
c = "(first - second)/2"
[model.equations]
x = "-x {4} ((first + second)/2 + cos(2*t) + c*cos(t) - 2*sin(2*t) - c*sin(t))"
[branch]
parameter = "p"
from = 0
to = 1
extrema_of = ["{5}"]
[continuation]
max_step = {2}
[cycles]
tolerance = 1e-7
intervals = {3}
)case",
                                             corner, way, max_step, intervals, least ? "-" : "+",
                                             least ? "x_min" : "x_max"));
      CAPTURE(corner, way, max_step, intervals, least);
      const auto [at_corner, beside] = least ? std::pair(PointType::peak, PointType::trough)
                                             : std::pair(PointType::trough, PointType::peak);
      check_values(all_values_at(all, at_corner, "p"), {corner}, 1e-6);
      check_values(all_values_at(all, beside, "p"), {corner + way}, 1e-4);
    }
  }
}
