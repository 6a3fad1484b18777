// Outputs of masses on springs and of rods and beams, whose dofs are few: against dynamic stiffnesses solved
// densely, with the force of the contact that the motion at the contact tells.

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "arcslip/assembly/reduced_pair.hpp"
#include "arcslip/assembly/structures.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::HarmonicResponse;

namespace {

const std::string masses_text =
    "[system]\nmodel = \"spring_mass\"\nbase = { mass = [2.0, 1.0, 0.5], stiffness = [3.0, 2.0, 1.5], "
    "contact "
    "= 2, output = [1], weights = { spring = { dof = [2, 3], value = [-1.0, 1.0] } } }\n"
    "damper = { mass = [0.3, 0.2], stiffness = [0.0, 0.7], weights = \"w.csv\" }\n"
    "contact_stiffness = 1.5\npreload = 0.5\ndamping_kind = \"viscous\"\ndamping = { base = 0.02, damper = "
    "0.03 }\nharmonics = 1\n\n[branch]\nparameter = \"eta\"\nfrom = 0.2\nto = 2.0\n";

std::string rings_text(const std::string& model, const std::string& weights, const std::string& more = "") {
  return fmt::format(
      "[system]\nmodel = \"{}\"\nwave_number = 2\nelements = 12\nmass_ratio = 3.0\nfrequency_ratio = 1.5\n"
      "interface_stiffness = 400.0\nforce = 1.0\npreload = 0.5\ndamping = {{ base = 0.01, damper = 0.02 }}\n"
      "base = {{ weights = {} }}\ndamper = {{ output = [1], weights = {} }}\n{}\n"
      "[branch]\nparameter = \"eta\"\nfrom = 1.0\nto = 9.0\n",
      model, weights, weights, more);
}

TracedBranch traced_few(const std::string& path) {
  return std::move(trace(read_case(path).branches[0]).front());
}

/// What a structure does under its load and the force at its first dof that makes it move so there, seen
/// through a row.
Complex seen_output(const ComplexMatrix& Z, const ComplexVector& load, Index contact, Complex motion,
                    const ComplexVector& row) {
  const auto factors = Z.partialPivLu();
  const ComplexVector free = factors.solve(load);
  const ComplexVector pushed = factors.solve(ComplexVector(ComplexVector::Unit(Z.rows(), contact)));
  const ComplexVector moved = free + pushed * ((motion - free(contact)) / pushed(contact));
  return (row.transpose() * moved).value();
}

Matrix chain_stiffness(const std::vector<double>& k) {
  const auto n = static_cast<Index>(k.size());
  Matrix K = Matrix::Zero(n, n);
  for (Index i = 0; i < n; ++i) {
    const double spring = k[static_cast<std::size_t>(i)];
    K(i, i) += spring;
    if (i == 0) continue;
    K(i - 1, i - 1) += spring;
    K(i, i - 1) = K(i - 1, i) = -spring;
  }
  return K;
}

template <class Precise>
ComplexMatrix rounded_matrix(const Precise& matrix) {
  ComplexMatrix all(matrix.rows(), matrix.cols());
  for (Index i = 0; i < all.rows(); ++i) {
    for (Index j = 0; j < all.cols(); ++j)
      all(i, j) = {static_cast<double>(matrix(i, j).real()), static_cast<double>(matrix(i, j).imag())};
  }
  return all;
}

}  // namespace

TEST_CASE("Outputs of masses are sums of their displacements") {
  const TemporaryFolder folder;
  folder.write("w.csv", "hang, -1.0, 1.0\n0.5, 0.25 # the second\n");
  const TracedBranch traced = traced_few(folder.write("case.toml", masses_text));
  const Vector base_mass = Eigen::Vector3d(2, 1, 0.5);
  const Matrix base_stiffness = chain_stiffness({3, 2, 1.5});
  const Vector damper_mass = Eigen::Vector2d(0.3, 0.2);
  const Matrix damper_stiffness = chain_stiffness({0, 0.7});
  for (std::size_t k = 0; k < traced.branch.points.size(); k += 5) {
    const BranchPoint& point = traced.branch.points[k];
    const auto told = [&](const char* name) { return value(traced, point, name); };
    const double w = told("eta");
    const auto Z = [&](const Vector& m, const Matrix& K, double zeta) {
      return ComplexMatrix(K * Complex(1, 2 * zeta * w) - w * w * Matrix(m.asDiagonal()));
    };
    const Complex y = std::polar(told("Y"), -told("beta"));
    const Complex u = std::polar(told("U"), -told("alpha"));
    const auto of_base = [&](const ComplexVector& row) {
      return std::abs(seen_output(Z(base_mass, base_stiffness, 0.02), ComplexVector::Unit(3, 2), 1, y, row));
    };
    const auto of_damper = [&](const ComplexVector& row) {
      return std::abs(seen_output(Z(damper_mass, damper_stiffness, 0.03), ComplexVector::Zero(2), 1, u, row));
    };
    CHECK_THAT(told("Y_1"), WithinRel(of_base(Eigen::Vector3cd(1, 0, 0)), 1e-8));
    CHECK_THAT(told("Y_spring"), WithinRel(of_base(Eigen::Vector3cd(0, -1, 1)), 1e-8));
    CHECK_THAT(told("U_hang"), WithinRel(of_damper(Eigen::Vector2cd(-1, 1)), 1e-8));
    CHECK_THAT(told("U_w2"), WithinRel(of_damper(Eigen::Vector2cd(0.5, 0.25)), 1e-8));
  }
  check_derivatives_along(traced, 0, 5);
}

TEST_CASE("Outputs of rods and beams are sums of the dofs of an element") {
  for (const std::string model : {"rods", "beams"}) {
    CAPTURE(model);
    const TemporaryFolder folder;
    const Index dofs = model == "rods" ? 2 : 4;
    const std::string weights = model == "rods" ? "{ strain = { dof = [1, 2], value = [-12.0, 12.0] } }"
                                                : "{ moment = { dof = [1, 2, 3, 4], value = [-6.0, -4.0, "
                                                  "6.0, -2.0] }, turn = { dof = [2], value = [1.0] } }";
    const TracedBranch traced = traced_few(folder.write("case.toml", rings_text(model, weights)));
    const SystemParameters& system = traced.request->problem.system;
    const ReducedPair pair = reduce(system);
    const PairLosses losses = structures_of(system).losses(system);
    const double a = two_pi * 2 / 12;
    const auto row = [&](std::vector<double> w) {
      ComplexVector sum(dofs / 2);
      for (Index i = 0; i < dofs / 2; ++i)
        sum(i) =
            w[static_cast<std::size_t>(i)] + w[static_cast<std::size_t>(dofs / 2 + i)] * std::polar(1.0, -a);
      return sum;
    };
    for (std::size_t k = 0; k < traced.branch.points.size(); k += 9) {
      const BranchPoint& point = traced.branch.points[k];
      const auto told = [&](const std::string& name) { return value(traced, point, name); };
      const auto of = [&](const ReducedStructure& part, const Loss& loss, Complex motion,
                          const ComplexVector& seen_through) {
        const MatrixFactors<double> by(told("eta"), loss);
        const ComplexMatrix Z = by.k * rounded_matrix(part.stiffness) + by.m * rounded_matrix(part.mass);
        return std::abs(seen_output(Z, rounded_matrix(part.load), 0, motion, seen_through));
      };
      const Complex y = std::polar(told("Y"), -told("beta"));
      const Complex u = std::polar(told("U"), -told("alpha"));
      const std::string name = model == "rods" ? "strain" : "moment";
      const ComplexVector sums =
          row(model == "rods" ? std::vector{-12.0, 12.0} : std::vector{-6., -4., 6., -2.});
      CHECK_THAT(told("Y_" + name), WithinRel(of(pair.base, losses.base(system), y, sums), 1e-7));
      CHECK_THAT(told("U_" + name), WithinRel(of(pair.damper, losses.damper(system), u, sums), 1e-7));
      CHECK_THAT(told("U_1"), WithinRel(told("U"), 1e-10));
      if (model == "rods")
        CHECK_THAT(told("Y_strain"), WithinRel(24 * std::sin(a / 2) * told("Y"), 1e-9));
      else
        CHECK_THAT(told("Y_turn"), WithinRel(of(pair.base, losses.base(system), y, row({0, 1, 0, 0})), 1e-7));
    }
  }
}

TEST_CASE("Outputs of rods follow every harmonic, their greatest value in time and parameters") {
  const TemporaryFolder folder;
  const std::string weights = "{ strain = { dof = [1, 2], value = [-1.0, 1.0] } }";
  std::string text = rings_text("rods", weights, "harmonics = 3\n");
  const TracedBranch traced =
      traced_few(folder.write("case.toml", text + "extrema_of = [\"Y_strain_peak\"]\n"));
  const double a = two_pi * 2 / 12;
  for (std::size_t k = 3; k < traced.branch.points.size(); k += 12) {
    const BranchPoint& point = traced.branch.points[k];
    const auto told = [&](const char* name) { return value(traced, point, name); };
    CHECK_THAT(told("Y_strain_h3"),
               WithinRel(2 * std::sin(1.5 * a) * told("Y_h3"), 1e-9) || WithinAbs(0, 1e-12));
  }
  check_derivatives_along(traced, 3, 12);
  CHECK(count(traced, PointType::peak) > 0);
  // over a ratio that changes the structure the outputs are those of the system built there
  text = replaced(text, "parameter = \"eta\"\nfrom = 1.0\nto = 9.0",
                  "parameter = \"gamma\"\nfrom = 1.5\nto = 1.8\neta = 2.5");
  const TracedBranch along = traced_few(folder.write("gamma.toml", text));
  const BranchPoint& last = along.branch.points.back();
  const std::string there = replaced(rings_text("rods", weights, "harmonics = 3\n"), "frequency_ratio = 1.5",
                                     "frequency_ratio = 1.8");
  const TracedBranch built =
      traced_few(folder.write("built.toml", there + "[continuation]\nstop_at = [2.5]\n"));
  CHECK_THAT(value(along, last, "Y_strain"),
             WithinRel(value(built, points(built, PointType::user).front(), "Y_strain"), 1e-8));
}

TEST_CASE("A ring that is held has outputs that stand still") {
  const TemporaryFolder folder;
  const std::string weights = "{ strain = { dof = [1, 2], value = [-1.0, 1.0] } }";
  const TracedBranch traced =
      traced_few(folder.write("case.toml", rings_text("rods", weights, "fixed_damper = true\n")));
  for (const BranchPoint& point : traced.branch.points) CHECK(value(traced, point, "U_strain") == 0);
}
