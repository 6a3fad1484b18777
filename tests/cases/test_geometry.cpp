// Systems given in SI units: their groups, the way back from the groups, and the same case both ways.

#include <boost/math/tools/toms748_solve.hpp>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "arcslip/assembly/physical_scale.hpp"
#include "arcslip/results/results.hpp"
#include "case_runs.hpp"
#include "round_rings.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// One motion of the rotor and its ring as continua, in SI units: with kappa = 2 pi n/L,
///
///   D = E I kappa^4 (1 + j loss) - rho A w^2,   (1 + k phi/L (1/D_B + 1/D_D)) r = -f_0/D_B
///
/// and S = mu p_0 L/k_F: the limit of many elements, found without any of the groups.
struct Motion {
  Motion(const Geometry& geometry, int wave_number, double hertz, double base_loss, double damper_loss);

  double R, S, Y, U, lost;
};

Motion::Motion(const Geometry& geometry, int wave_number, double hertz, double base_loss,
               double damper_loss) {
  using Complex = std::complex<double>;
  const double L = geometry.circumference;
  const double w = 2 * pi * hertz;
  const auto dynamic_stiffness = [&](const RectangularRing& ring, double loss) {
    const double bending = ring.elastic_modulus * ring.width * std::pow(ring.height, 3) / 12;
    return bending * std::pow(2 * pi * wave_number / L, 4) * Complex(1, loss) -
           ring.density * ring.width * ring.height * w * w;
  };
  const Complex base = dynamic_stiffness(geometry.base, base_loss);
  const Complex damper = dynamic_stiffness(geometry.damper, damper_loss);
  const RectangularRing& ring = geometry.damper;
  const double shear = ring.elastic_modulus / (2 * (1 + ring.poisson_ratio));
  const double k_F = shear * ring.width * L / (ring.height / 2);
  const double friction = geometry.friction_coefficient * geometry.preload_per_length;
  S = friction * L / k_F;
  const auto force_over_r = [&](double amplitude) -> Complex {  // per length
    if (amplitude <= S) return k_F / L;
    const double x = S / amplitude;
    const double theta = std::acos(1 - 2 * x);
    return k_F / L * Complex((theta - std::sin(2 * theta) / 2) / pi, 4 / pi * x * (1 - x));
  };
  const auto closed = [&](double amplitude) {
    return 1.0 + force_over_r(amplitude) * (1.0 / base + 1.0 / damper);
  };
  const double free = geometry.force_per_length / std::abs(base);
  const auto excess = [&](double log_R) {
    return log_R + std::log(std::abs(closed(std::exp(log_R))) / free);
  };
  std::uintmax_t iterations = 200;
  const auto [low, high] = boost::math::tools::toms748_solve(
      excess, std::log(S) - 20, std::log(S) + 30, boost::math::tools::eps_tolerance<double>(50), iterations);
  R = std::exp(0.5 * (low + high));
  Y = R * std::abs(1.0 + force_over_r(R) / damper);
  U = R * std::abs(force_over_r(R) / damper);
  lost = R > S ? 4 * friction * L * (R - S) : 0;
}

/// The rows of branches.csv by column.
std::vector<std::map<std::string, std::string>> rows_of(const std::vector<TracedBranch>& traced) {
  std::string text;
  write_branches(traced, [&](std::string_view piece) { text += piece; });
  const auto cells_of = [](const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cells_of(line);
    REQUIRE(cells.size() == names.size());
    rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) rows.back()[names[i]] = cells[i];
  }
  return rows;
}

double number(const std::map<std::string, std::string>& row, const std::string& name) {
  return std::stod(row.at(name));
}

}  // namespace

TEST_CASE("The groups of two rings are those worked out by hand", "[geometry]") {
  const SystemParameters rods = groups_of(round_numbers(), StructureModel::rods);
  CHECK_THAT(rods.mass_ratio, WithinRel(16.0, rounding));               // 8000 0.1 0.04/(4000 0.05 0.01)
  CHECK_THAT(rods.frequency_ratio, WithinRel(0.5, rounding));           // sqrt(E_B rho_D/(E_D rho_B))
  CHECK_THAT(rods.interface_stiffness, WithinRel(32'000.0, rounding));  // (2/0.01)^2/1.25
  CHECK_THAT(rods.force, WithinRel(2.5e-7, rounding));                  // k_B = 1e11 0.1 0.04/2 = 2e8
  CHECK_THAT(rods.preload, WithinRel(3.75e-6, rounding));               // 0.25 3000/2e8
  const SystemParameters beams = groups_of(round_numbers(), StructureModel::beams);
  CHECK_THAT(beams.mass_ratio, WithinRel(16.0, rounding));
  CHECK_THAT(beams.frequency_ratio, WithinRel(2.0, rounding));           // (h_B/h_D) times that of rods
  CHECK_THAT(beams.interface_stiffness, WithinRel(1.536e10, rounding));  // 12 200^4/1.25
  CHECK_THAT(beams.force, WithinRel(50 / (2e4 / 3), rounding));          // k_B = 2e8 (0.04/2)^2/12
  CHECK_THAT(beams.preload, WithinRel(750 / (2e4 / 3), rounding));
}

TEST_CASE("Resonances in Hz are those of a rod and of a beam as long as the circumference", "[geometry]") {
  const Geometry geometry = round_numbers();
  const int n = GENERATE(1, 3);
  const double kappa = 2 * pi * n / geometry.circumference;
  const double wave_speed = std::sqrt(geometry.base.elastic_modulus / geometry.base.density);

  const SystemParameters rods = groups_of(geometry, StructureModel::rods);
  CHECK_THAT(PhysicalScale(geometry, rods).frequency(n * rods.frequency_ratio),
             WithinRel(kappa * wave_speed / (2 * pi), rounding));
  const SystemParameters beams = groups_of(geometry, StructureModel::beams);
  const double gyration = geometry.base.height / std::sqrt(12);
  CHECK_THAT(PhysicalScale(geometry, beams).frequency(n * n * beams.frequency_ratio),
             WithinRel(kappa * kappa * gyration * wave_speed / (2 * pi), rounding));
}

TEST_CASE("The scale leads back from the groups to what they were made of", "[geometry]") {
  const Geometry geometry = round_numbers();
  const StructureModel model = GENERATE(StructureModel::rods, StructureModel::beams);
  const SystemParameters system = groups_of(geometry, model);
  const PhysicalScale scale(geometry, system);
  CHECK_THAT(scale.preload(system.preload), WithinRel(geometry.preload_per_length, rounding));
  CHECK_THAT(scale.force_per_length(system.force), WithinRel(geometry.force_per_length, rounding));
  CHECK_THAT(scale.displacement(1e-3), WithinRel(2e-3, rounding));
  // S = P K*/K_FD is mu p_0 L/k_F, and a cycle of amplitude R = 3 S loses 4 mu p_0 L (R - S) in the ring.
  const double slip = system.preload * system.stiffness_ratio() / system.interface_stiffness;
  const double shear = geometry.damper.elastic_modulus / 2.5;
  const double friction = 0.25 * 3000 * geometry.circumference;
  const double stiffness = shear * geometry.damper.width * geometry.circumference / 0.005;
  CHECK_THAT(scale.displacement(slip), WithinRel(friction / stiffness, rounding));
  CHECK_THAT(scale.dissipated(4 * (3 - 1), slip),
             WithinRel(4 * friction * 2 * friction / stiffness, rounding));
  // The same from N contacts, N 4 k S (R - S) with k = K_FD/N.
  CHECK_THAT(scale.energy(4 * system.interface_stiffness * slip * 2 * slip),
             WithinRel(4 * friction * 2 * friction / stiffness, rounding));
}

TEST_CASE("Rotor and ring move as two continua in SI units do", "[geometry]") {
  // With 10^5 elements the discretisation's part, (n/N)^2 at most, is 1e-9.
  const Run run("rotor_ring", {"system.elements=100000"});
  const auto rows = rows_of(run.traced);
  int slipping = 0;
  int compared = 0;
  for (std::size_t i = 0; i < rows.size(); i += 5, ++compared) {
    const auto& row = rows[i];
    const CaseBranch& request = *run.traced[static_cast<std::size_t>(number(row, "branch"))].request;
    // Loss factors 2 zeta_B, structural, and 2 zeta_D eta, viscous.
    const Motion motion(*request.problem.geometry, 3, number(row, "frequency_Hz"), 2e-3,
                        1e-4 * number(row, "eta"));
    INFO(row.at("frequency_Hz") << " Hz, " << row.at("preload_N_per_m") << " N/m");
    // On a needle of relative width 2e-3 the amplitude follows a rounded frequency 1e3 times as fast.
    const double tolerance = 1e-8;
    CHECK_THAT(number(row, "R_m"), WithinRel(motion.R, tolerance));
    CHECK_THAT(number(row, "S_m"), WithinRel(motion.S, rounding));
    CHECK_THAT(number(row, "Y_m"), WithinRel(motion.Y, tolerance));
    CHECK_THAT(number(row, "U_m"), WithinRel(motion.U, tolerance));
    CHECK_THAT(number(row, "dissipated_J"), WithinRel(motion.lost, tolerance) || WithinAbs(0, 1e-18));
    const Geometry& rings = *request.problem.geometry;
    const double limit = rings.friction_coefficient * rings.preload_per_length * rings.circumference / 100000;
    CHECK_THAT(number(row, "T_max_N"), WithinRel(limit * std::min(1.0, motion.R / motion.S), tolerance));
    CHECK_THAT(number(row, "preload_N_per_m"),
               WithinRel(request.problem.geometry->preload_per_length, rounding));
    slipping += static_cast<int>(motion.lost > 0);
  }
  CHECK(slipping > 20);
  CHECK(compared - slipping > 20);
}

TEST_CASE("Rotor and ring have the same branches in nondimensional keys", "[geometry]") {
  const double L = 2 * pi * 0.13;
  const double k_B = 110e9 * 0.045 * std::pow(0.024, 3) / (12 * std::pow(L, 3));
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "case.toml", fmt::format("[system]\nmodel = \"beams\"\nwave_number = 3\nelements = 90\n"
                               "damping = {{ base = 1e-3, damper = 5e-5, kind = \"structural\" }}\n"
                               "mass_ratio = {:.17g}\nfrequency_ratio = {:.17g}\nslenderness = {:.17g}\n"
                               "poisson_ratio = 0.29\nforce = {:.17g}\n"
                               "[branch]\nparameter = \"eta\"\nfrom = 30\nto = 60\n"
                               "for_each = {{ preload = [{:.17g}, {:.17g}] }}\n",
                               7200 * 0.045 * 0.024 / (7850 * 0.006 * 0.004),
                               0.024 / 0.004 * std::sqrt(110e9 * 7850 / (210e9 * 7200)), L / 0.004, 100 / k_B,
                               0.3 * 100 / k_B, 0.3 * 300 / k_B));
  const Case plain = read_case(path);
  const Run run("rotor_ring");
  for (const std::size_t i : {0U, 1U}) {
    const TracedBranch expected = std::move(trace(plain.branches[i]).front());
    CHECK_FALSE(expected.request->problem.geometry);
    for (const PointType type : {PointType::peak, PointType::trough, PointType::regime_switch}) {
      std::vector<std::map<std::string, double>> all;
      for (const BranchPoint& point : points(expected, type))
        all.push_back({{"eta", value(expected, point, "eta")}, {"Y", value(expected, point, "Y")}});
      check(run.traced[i + 1], type, all, 1e-9);  // the last digits of the groups, magnified by resonance
    }
    CHECK(count(expected, PointType::peak) == 2);
  }
}

TEST_CASE("Rotor and ring have the amplitudes that the case says", "[geometry]") {
  const Run run("rotor_ring");
  REQUIRE(run.traced.size() == 5);
  const std::map<std::size_t, double> micrometres = {{0, 30.8}, {2, 4.58}, {4, 30.8}};  // as printed
  for (const auto& [branch, expected] : micrometres) {
    const nlohmann::json summary = summarize(run.input, run.traced, 0)["branches"][branch];
    double highest = 0;
    for (const auto& point : summary["special"]) {
      if (point["type"] == "peak") highest = std::max(highest, 1e6 * point["Y_m"].get<double>());
    }
    CHECK_THAT(highest, WithinAbs(expected, expected > 10 ? 0.05 : 0.005));
  }
  const nlohmann::json first = summarize(run.input, run.traced, 0)["branches"][0];
  CHECK_THAT(first["groups"]["mass_ratio"].get<double>(), WithinAbs(41.27, 0.005));
  CHECK_THAT(first["groups"]["frequency_ratio"].get<double>(), WithinAbs(4.534, 0.0005));
  CHECK_THAT(first["groups"]["interface_stiffness"].get<double>(), WithinAbs(1.618e10, 5e6));
  const double base = 9 * first["groups"]["frequency_ratio"].get<double>();
  CHECK_THAT(first["units"]["frequency_Hz"].get<double>() * base, WithinAbs(2295.2, 0.05));
  CHECK_THAT(first["units"]["frequency_Hz"].get<double>() * 9, WithinAbs(506.2, 0.05));
}

TEST_CASE("Curves and limit cycles have columns in SI units, systems without geometry have none",
          "[geometry]") {
  const Run ridge("rotor_ring",
                  {"branch={ curve = \"peak\", parameters = [\"eta\", \"P\"], window = [38, 42], "
                   "from = 1e-3, to = 1e-2 }",
                   "geometry.preload_per_length=200"});
  REQUIRE(!ridge.traced.empty());
  const PhysicalScale scale(*ridge.input.branches[0].problem.geometry,
                            ridge.input.branches[0].problem.system);
  for (const auto& row : rows_of(ridge.traced)) {
    CHECK_THAT(number(row, "frequency_Hz"), WithinRel(scale.frequency(number(row, "eta")), rounding));
    CHECK_THAT(number(row, "preload_N_per_m"), WithinRel(scale.preload(number(row, "P")), rounding));
    CHECK_THAT(number(row, "Y_m"), WithinRel(scale.displacement(number(row, "Y")), rounding));
  }
  const Run cycle("rotor_ring",
                  {"branch={ response = \"limit_cycle\", parameter = \"P\", from = 1e-3, to = 1e-2 }",
                   "system.damping={ base = -1e-5, damper = 1e-3, kind = \"structural\" }"});
  for (const auto& row : rows_of(cycle.traced))
    CHECK_THAT(number(row, "frequency_Hz"), WithinRel(scale.frequency(number(row, "eta")), rounding));
  const Run plain("rods", {preload_of(1)});
  CHECK_FALSE(rows_of(plain.traced)[0].contains("frequency_Hz"));
  CHECK_FALSE(summarize(plain.input, plain.traced, 0)["branches"][0].contains("groups"));
}

// ---- Input ----
