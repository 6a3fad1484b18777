#include <Eigen/LU>
#include <cmath>
#include <map>
#include <numbers>
#include <thread>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/cases/study_case.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "paper_sectors.hpp"
#include "program.hpp"
#include "sectors/full_receptance.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

std::string all_replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string in_full(const std::string& text) {
  return replaced(text, "model = \"sector\"\n", "model = \"sector\"\npath = \"full\"\n");
}

using Rows = std::vector<std::vector<std::string>>;

Rows rows_of_type(const Rows& table, const std::string& type) {
  Rows kept;
  std::copy_if(table.begin(), table.end(), std::back_inserter(kept),
               [&](const auto& row) { return row[2] == type; });
  return kept;
}

/// A row's numbers by the names of their columns.
std::map<std::string, double> numbers(const Rows& table, const std::vector<std::string>& row) {
  std::map<std::string, double> values;
  for (std::size_t k = 4; k < row.size(); ++k) values[table.front()[k]] = std::stod(row[k]);
  return values;
}

/// The lumped bladed disk and a ring of two dofs a sector, with dashpots that no alpha M + beta K has.
struct DashpotPair {
  FiniteSector disk = bladed_disk();
  FiniteSector ring;

  DashpotPair() {
    Matrix damping = Matrix::Zero(4, 4);
    damping.diagonal() << 11, 20, 21, 5;
    damping(1, 2) = damping(2, 1) = -20;
    damping(0, 3) = damping(3, 0) = -5;
    disk.damping = sparse(damping);
    disk.contacts = {0, 1};
    Matrix stiffness(3, 3);
    stiffness << 4e5, -4e5, 0, -4e5, 8e5, -4e5, 0, -4e5, 4e5;
    ring.mass = sparse(Matrix(Eigen::Vector3d(0.1, 0.15, 0).asDiagonal()));
    ring.stiffness = sparse(stiffness);
    ring.damping = sparse(Matrix(Eigen::Vector3d(0, 3, 0).asDiagonal()));
    ring.left = {0};
    ring.right = {2};
    ring.contacts = {0, 1};
    ring.load = ComplexVector::Zero(3);
  }

  std::string system(const TemporaryFolder& folder, std::size_t contacts) const {
    folder.write("disk_c.mtx", write_matrix_market(disk.damping, MatrixSymmetry::symmetric));
    folder.write("ring_c.mtx", write_matrix_market(ring.damping, MatrixSymmetry::symmetric));
    const std::string text =
        "[system]\nmodel = \"sector\"\nwave_number = 3\nsectors = 24\ncontact_stiffness = 3e5\n"
        "preload = 0.4\n" +
        write_sector(folder, "base", disk, "output = [3, 4]\ndamping = \"disk_c.mtx\"") +
        write_sector(folder, "damper", ring, "output = [2]\ndamping = \"ring_c.mtx\"");
    return contacts == 1 ? text : all_replaced(text, "contact = [1]", "contact = [1, 2]");
  }
};

/// What all dofs of a sector do under forces on all, by a dense inverse.
ComplexMatrix dense_receptance(const FiniteSector& sector, Index size, double eta) {
  ComplexMatrix t = ComplexMatrix::Identity(size + 1, size);  // the last dof is the right boundary
  t(size, 0) = forward(3, 24);
  const double w = 2 * std::numbers::pi * eta;
  const ComplexMatrix z = t.adjoint() *
                          (Matrix(sector.stiffness) + Matrix(sector.damping) * Complex(0, w) -
                           Matrix(sector.mass) * Complex(w * w, 0)) *
                          t;
  return t * solution_of(z, ComplexMatrix(t.adjoint()));
}

/// First harmonic of an elastic slider's force over k r, in closed form from the area and the corners of its
/// loop.
Complex slider(double ratio) {
  if (ratio <= 1) return 1;
  const double cosine = 1 - 2 / ratio;
  const double angle = std::acos(cosine);
  const double pi = std::numbers::pi;
  return {(angle - std::sqrt(1 - cosine * cosine) * cosine) / pi, 4 * (ratio - 1) / (pi * ratio * ratio)};
}

/// The zero of `balance` by Newton's method with differences, its steps halved while they lead uphill.
template <class Balance>
ComplexVector relative_motion(const ComplexVector& free, const Balance& balance) {
  ComplexVector r = -free;
  const double difference = 1e-7 * free.norm();
  for (int i = 0; i < 100; ++i) {
    const ComplexVector rest = balance(r);
    Matrix slope(2 * r.size(), 2 * r.size());
    for (Index column = 0; column < 2 * r.size(); ++column) {
      ComplexVector moved = r;
      moved(column / 2) += column % 2 == 0 ? Complex(difference, 0) : Complex(0, difference);
      const ComplexVector by = (balance(moved) - rest) / difference;
      slope.col(column) << by.real(), by.imag();
    }
    Vector right(2 * r.size());
    right << rest.real(), rest.imag();
    const Vector step = solution_of(slope, Vector(-right));
    ComplexVector correction(r.size());
    for (Index j = 0; j < r.size(); ++j) correction(j) = {step(2 * j), step(2 * j + 1)};
    if (correction.norm() <= 1e-14 * r.norm()) return r;
    while (balance(r + correction).norm() > rest.norm() && correction.norm() > 1e-14 * r.norm())
      correction /= 2;
    r += correction;
  }
  FAIL("no balance was found");
  return r;
}

}  // namespace

TEST_CASE("Sparse solves at each eta give every column that the modes of a sector give") {
  const bool several = GENERATE(false, true);
  const TemporaryFolder folder;
  std::string text = paper_system(folder, false, 10) +
                     "[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 6.0\n"
                     "[continuation]\nstop_at = [1.1, 3.45, 3.5, 3.7, 3.9, 4.2, 5.0]\n";
  text = all_replaced(text, "contact = [1]",
                      several ? "contact = [1, 4, 6]\noutput = [3, 11]" : "contact = [1]\noutput = [3, 11]");
  const Rows modal = branches_csv(read_case(folder.write("modes.toml", text)));
  const Rows full = branches_csv(read_case(folder.write("full.toml", in_full(text))));
  REQUIRE(full.front() == modal.front());
  for (const std::string type : {"user", "switch", "peak", "trough"}) {
    const Rows found = rows_of_type(full, type);
    const Rows expected = rows_of_type(modal, type);
    REQUIRE(found.size() == expected.size());
    CHECK((type != "user" || found.size() == 7));
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(found[i][3] == expected[i][3]);
      const auto values = numbers(full, found[i]);
      for (const auto& [name, value] : numbers(modal, expected[i])) {
        // Work is not a result, and phases at a peak are those of its eta, which is flat to the root of
        // rounding.
        if (name == "arclength" || name == "iterations" || name == "residual") continue;
        if (type != "user" && name != "eta" && name != "Y") continue;
        CAPTURE(several, type, i, name);
        CHECK_THAT(values.at(name), WithinRel(value, 1e-9) || WithinAbs(value, 1e-12));
      }
    }
  }
}

TEST_CASE("Damping that is no sum of mass and stiffness acts as a dense balance of forces says") {
  const std::size_t m = GENERATE(1U, 2U);
  constexpr double k = 3e5;
  constexpr double preload = 0.4;
  const TemporaryFolder folder;
  const DashpotPair pair;
  const Rows rows = branches_csv(
      read_case(folder.write("case.toml", in_full(pair.system(folder, m)) +
                                              "[branch]\nparameter = \"eta\"\nfrom = 100\nto = 260\n"
                                              "[continuation]\nstop_at = [150, 180, 190, 200, 230]\n")));
  const Rows found = rows_of_type(rows, "user");
  REQUIRE(found.size() == 5);
  CHECK(rows_of_type(rows, "switch").size() >= 2);
  for (const auto& row : found) {
    const auto values = numbers(rows, row);
    const double eta = values.at("eta");
    const ComplexMatrix disk = dense_receptance(pair.disk, 3, eta);
    const ComplexMatrix ring = dense_receptance(pair.ring, 2, eta);
    const auto n = static_cast<Index>(m);
    const ComplexMatrix c = disk.topLeftCorner(n, n) + ring.topLeftCorner(n, n);
    const ComplexVector all_free = disk * pair.disk.load;
    const auto forces_of = [&](const ComplexVector& r) {
      return ComplexVector(r.unaryExpr([&](Complex z) { return k * slider(std::abs(z) * k / preload) * z; }));
    };
    const ComplexVector r = relative_motion(all_free.head(n), [&](const ComplexVector& z) {
      return ComplexVector(z + c * forces_of(z) + all_free.head(n));
    });
    const ComplexVector forces = forces_of(r);
    CAPTURE(m, eta, row[3]);
    const ComplexVector base = all_free + disk.leftCols(n) * forces;
    const ComplexVector damper = -ring.leftCols(n) * forces;
    // 1e-8: the correction that is left at a point, up to 1e-10, over the flatness of the slider's law.
    const auto check = [&](const std::string& name, double expected) {
      CAPTURE(name);
      CHECK_THAT(values.at(name), WithinRel(expected, 1e-8));
    };
    check("R", std::abs(r(0)));
    check("Y", std::abs(base(0)));
    check("U", std::abs(damper(0)));
    check("psi", -std::arg(r(0)));
    check("Y_3", std::abs(base(2)));
    check("Y_4", std::abs(base(0)));
    check("U_2", std::abs(damper(1)));
    if (m == 1) continue;
    check("R_contact_2", std::abs(r(1)));
    check("Y_contact_2", std::abs(base(1)));
    check("U_contact_2", std::abs(damper(1)));
  }
}

TEST_CASE("Contacts to ground rub on a damper that is held, by modes and by sparse solves") {
  const std::string contact = GENERATE("contact = [1]", "contact = [1, 2]");
  const TemporaryFolder folder;
  std::string text = DashpotPair().system(folder, 1);
  text = replaced(text.substr(0, text.find("[system.damper]")), "damping = \"disk_c.mtx\"", "");
  text = replaced(text, "contact = [1]", contact) +
         "[branch]\nparameter = \"eta\"\nfrom = 100\nto = 300\n[continuation]\nstop_at = [150, 250]\n";
  const Rows modal = branches_csv(read_case(folder.write("modes.toml", text)));
  const Rows full = branches_csv(read_case(folder.write("full.toml", in_full(text))));
  for (const std::string type : {"user", "peak"}) {
    const Rows found = rows_of_type(full, type);
    const Rows expected = rows_of_type(modal, type);
    REQUIRE(!expected.empty());
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (const char* name : {"R", "Y", "U", "Y_3"}) {
        CAPTURE(contact, type, name);
        const double right = numbers(modal, expected[i]).at(name);
        CHECK_THAT(numbers(full, found[i]).at(name), WithinRel(right, 1e-9) || WithinAbs(right, 1e-300));
      }
    }
  }
}

TEST_CASE("Power and motion are balanced by sparse solves as by modes") {
  const std::string contacts = GENERATE("contact = [1]", "contact = [1, 4, 6]");
  const TemporaryFolder folder;
  const std::string text = all_replaced(paper_system(folder, false, 10), "contact = [1]", contacts) +
                           "[branch]\nparameter = \"eta\"\nfrom = 2.5\nto = 6.0\n";
  const Case in_modes = read_case(folder.write("modes.toml", text));
  const Case full = read_case(folder.write("full.toml", in_full(text)));
  const auto traced = trace(full.branches.front());
  for (const auto& branch :
       {summarize(0, trace(in_modes.branches.front()).front()), summarize(0, traced.front())}) {
    // the residual 1e-10 over the damping ratio 1e-4
    CHECK(branch["power_error"].get<double>() < 1e-6);
    CHECK(branch["motion_error"].get<double>() < 1e-6);
    CHECK(branch["power_cancellation"].get<double>() > 1);
  }
  const problems::HarmonicResponse by_modes(build_harmonic_system(in_modes.branches.front().problem.system));
  const problems::HarmonicResponse by_solves(build_harmonic_system(full.branches.front().problem.system));
  for (const BranchPoint& point : points(traced.front(), PointType::peak)) {
    const auto found = power_balance(by_solves, point.unknowns, point.parameters, point.regime);
    const auto expected = power_balance(by_modes, point.unknowns, point.parameters, point.regime);
    CAPTURE(contacts, point.parameters(0));
    // 1e-10 of the modes over the damping
    CHECK_THAT(found.input, WithinRel(expected.input, 1e-6));
    CHECK_THAT(found.base, WithinRel(expected.base, 1e-6));
    CHECK_THAT(found.damper, WithinRel(expected.damper, 1e-6));
    CHECK_THAT(found.friction, WithinRel(expected.friction, 1e-14));
    CHECK_THAT(found.magnitude, WithinRel(expected.magnitude, 0.5));  // one of modes, the other of places
  }
}

TEST_CASE("Dashpots at single dofs take the power that the load and the contacts do not") {
  const std::size_t m = GENERATE(1U, 2U);
  const TemporaryFolder folder;
  const std::string text =
      in_full(DashpotPair().system(folder, m)) + "[branch]\nparameter = \"eta\"\nfrom = 150\nto = 230\n";
  const Case input =
      read_case(folder.write("case.toml", replaced(text, "preload", "harmonics = 5\npreload")));
  const auto traced = trace(input.branches.front());
  const problems::HarmonicResponse problem(build_harmonic_system(input.branches.front().problem.system));
  double least = 1;
  for (const BranchPoint& point : traced.front().branch.points) {
    const auto works = power_balance(problem, point.unknowns, point.parameters, point.regime);
    CAPTURE(m, point.parameters(0), works.input, works.base, works.damper, works.friction);
    CHECK(works.error() < 1e-8);  // the residual 1e-10 over the damping, about 1e-2
    CHECK(works.error() * works.cancellation() < 1e-8);
    least = std::min(least, (works.base + works.damper) / works.input);
    CHECK(motion_error(problem, point.unknowns, point.parameters, point.regime) < 1e-8);
  }
  CHECK(least > 1e-3);  // dashpots count everywhere
}

TEST_CASE("Where the load is continued the power is that of the load that acts") {
  const TemporaryFolder folder;
  const Case input = read_case(folder.write("case.toml", in_full(DashpotPair().system(folder, 2)) +
                                                             "[branch]\nparameter = \"F\"\neta = 190\n"
                                                             "from = 1\nto = 20\n"));
  const auto traced = trace(input.branches.front());
  CHECK(traced.front().branch.complete());
  const auto summary = summarize(0, traced.front());
  CHECK(summary["power_error"].get<double>() < 1e-8);
  CHECK(summary["motion_error"].get<double>() < 1e-8);
}

TEST_CASE("Points of the full path are verified with more harmonics") {
  const TemporaryFolder folder;
  const std::string text =
      in_full(DashpotPair().system(folder, 1)) + "[branch]\nparameter = \"eta\"\nfrom = 180\nto = 200\n";
  const std::string path = folder.write("case.toml", replaced(text, "preload", "harmonics = 3\npreload"));
  const Outcome run = arcslip_program("run '" + path + "' --verify -o '" + folder.path("out") + "'");
  CAPTURE(run.err);
  CHECK(run.status == 0);
  const Rows rows = read_csv(folder.path("out/verify.csv"));
  REQUIRE(rows.size() > 5);
  double largest = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    CHECK(std::stod(rows[i][6]) < 1e-8);  // power_error: the residual 1e-10 over the damping, about 1e-2
    largest = std::max(largest, std::abs(std::stod(rows[i][9])));  // of Y with 19 harmonics from that with 2
  }
  CHECK((largest > 1e-6 && largest < 1e-2));  // what friction's higher harmonics can do
}

TEST_CASE("Each eta costs one factorisation, from whatever side and thread it is asked for") {
  const DashpotPair pair;
  const FiniteSector disk = checked(pair.disk);
  const FullReceptance full(disk, {3, 24}, {});
  const auto eta_of = [](int i) { return 100.0 + i % 20; };
  SectorSolver solver(disk, forward(3, 24), {});
  const auto differs = [&](int i, double force) {
    const SectorResponse& expected = solver.at(eta_of(i));
    const ContactReceptance found = full.at(eta_of(i), force);
    const ContactReceptance output = full.with_output(1, eta_of(i), force);
    return found.compliance != expected.compliance || found.free != force * expected.free ||
           output.compliance.row(2).head(2) != expected.output_compliance.row(1) ||
           output.free(2) != force * expected.output_free(1);
  };
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 3; ++thread)
    threads.emplace_back([&] {
      for (int i = 0; i < 100; ++i) full.at(eta_of(7 * i), 1);
    });
  for (std::thread& thread : threads) thread.join();
  int wrong = 0;
  for (int i = 0; i < 40; ++i) wrong += differs(i, 1 + 0.1 * i) ? 1 : 0;
  CHECK(wrong == 0);
  CHECK(full.factorisations() == 20);
}

TEST_CASE("Where nothing damps a sector its own frequency has no finite response") {
  const FullReceptance full(checked(lumped_ring()), {0, 24}, {});
  CHECK_FALSE(full.at(0, 1).compliance.allFinite());
  CHECK_FALSE(full.at(0, 1).free.allFinite());
  CHECK(full.at(1, 1).compliance.allFinite());
}

TEST_CASE("What the full path of a sector cannot serve is refused in one line") {
  const TemporaryFolder folder;
  const std::string branch = "[branch]\nparameter = \"eta\"\nfrom = 100\nto = 260\n";
  const std::string text = in_full(DashpotPair().system(folder, 1)) + branch;
  const auto mistake = GENERATE(values<Mistake>({
      {"path = \"full\"", "path = \"reduced\"", ":", "system.damper.damping", "path = \"full\"", "alpha M"},
      {"path = \"full\"", "path = \"fast\"", ":3:8", "system.path", "\"reduced\" or \"full\"", "fast"},
      {"output = [3, 4]", "damping_kind = \"modal\"", ":", "system.base.damping_kind", "no matrix", ""},
      {"parameter = \"eta\"\nfrom = 100\nto = 260",
       "response = \"nonlinear_mode\"\nparameter = \"R\"\neta = 150\nfrom = 1\nto = 2", ":3:8", "system.path",
       "\"reduced\"", "\"full\""},
      {"from = 100", "from = 100\nstability = true", ":", "branch.stability",
       "modes, which this damping couples", ""},
      {"parameter = \"eta\"\nfrom = 100\nto = 260",
       "response = \"limit_cycle\"\nparameter = \"P\"\nfrom = 1\nto = 2", ":3:8", "system.path",
       "\"reduced\"", "\"full\""},
  }));
  CHECK_NOTHROW(read_case(folder.write("case.toml", text)));
  const std::string path = folder.write("case.toml", replaced(text, mistake.from, mistake.to));
  check_message(error_of([&] { read_case(path); }), mistake);
}

TEST_CASE("A study takes the full path, and the program says which path a case takes") {
  const TemporaryFolder folder;
  const std::string text = in_full(DashpotPair().system(folder, 1));
  const std::string study = folder.write(
      "study.toml", text + "[study]\nparameter = \"P\"\nfrom = 0.1\nto = 1.0\neta = [100, 260]\n");
  const Outcome best = arcslip_program("study '" + study + "' -o '" + folder.path("best") + "'");
  CHECK(best.status == 0);
  CHECK_THAT(best.out, ContainsSubstring("1 design"));
  const std::string path =
      folder.write("case.toml", text + "[branch]\nparameter = \"P\"\nfrom = 0.1\nto = 1.0\neta = 190\n");
  const Outcome check = arcslip_program("check --derivatives '" + path + "'");
  CHECK(check.status == 0);
  CHECK_THAT(check.out, ContainsSubstring("base: full path, 3 dofs solved for at each eta; 3 modes"));
  const Outcome run = arcslip_program("run '" + path + "' -o '" + folder.path("out") + "'");
  CHECK(run.status == 0);
  const auto summary = nlohmann::json::parse(read(folder.path("out/summary.json")));
  CHECK(summary["case"]["system"]["path"] == "full");
  CHECK(summary["branches"][0]["full_solves"]["damper"]["factorisations"] == 1);  // one eta
}
