// Cost of finite-element sectors, in times of one sparse LU factorisation: of a full solve at each eta
// (goal: 1.2 of the factorisations alone), of a response traced with full solves, over the factorisations
// that it needs, of the Cholesky factorisation of the shift, and of a response by way of the modes, which
// takes one of these (goal: 5 + modes/10 LU factorisations). Annular plates with a contact at the rim and
// solid cubes that close to a ring, near their lowest frequency at n = 3. Arguments are further sizes in
// dofs, as 30000 and 100000.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "../../src/sectors/cholesky.hpp"
#include "../../src/sectors/complex_factors.hpp"
#include "../../src/sectors/full_receptance.hpp"
#include "../support/rim_plate.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/sectors/lowest_frequency.hpp"
#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/sectors/sector_solver.hpp"

namespace {

using namespace arcslip;
using Clock = std::chrono::steady_clock;

constexpr SectorWave wave{3, 24};
constexpr Loss loss{.structural = 2e-3};

/// Seconds that `work` takes, the least of several times where it is short.
template <class Work>
double seconds(const Work& work) {
  double least = 1e300;
  double all = 0;
  for (int i = 0; i < 5 && all < 3; ++i) {
    const Clock::time_point start = Clock::now();
    work();
    const double time = std::chrono::duration<double>(Clock::now() - start).count();
    least = std::min(least, time);
    all += time;
  }
  return least;
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Stiffness and mass of a cube of steel with eight nodes, three dofs each, by two points in each direction.
std::pair<Matrix, Matrix> brick(double side) {
  constexpr double lame = 1.2e11;
  constexpr double shear = 8e10;
  constexpr double density = 7850;
  const double volume = std::pow(side / 2, 3);
  const auto sign = [](Index node, Index axis) { return (node >> axis & 1) != 0 ? 1.0 : -1.0; };
  Matrix stiffness = Matrix::Zero(24, 24);
  Matrix mass = Matrix::Zero(24, 24);
  for (Index point = 0; point < 8; ++point) {
    Eigen::Matrix<double, 8, 1> shape;
    Eigen::Matrix<double, 8, 3> slope;
    for (Index node = 0; node < 8; ++node) {
      Eigen::Array3d part;
      for (Index axis = 0; axis < 3; ++axis)
        part(axis) = (1 + sign(node, axis) * sign(point, axis) / std::sqrt(3.0)) / 2;
      shape(node) = part.prod();
      for (Index axis = 0; axis < 3; ++axis)
        slope(node, axis) = shape(node) / part(axis) * sign(node, axis) / side;
    }
    for (Index i = 0; i < 8; ++i) {
      for (Index j = 0; j < 8; ++j) {
        const Eigen::Matrix3d outer = slope.row(i).transpose() * slope.row(j);
        stiffness.block<3, 3>(3 * i, 3 * j) += volume * (lame * outer + shear * outer.transpose() +
                                                         shear * outer.trace() * Eigen::Matrix3d::Identity());
        mass.block<3, 3>(3 * i, 3 * j) +=
            volume * density * shape(i) * shape(j) * Eigen::Matrix3d::Identity();
      }
    }
  }
  return {stiffness, mass};
}

/// A cube of so many elements along each edge, held below, with a contact and the load on an edge above.
FiniteSector cube(Index elements) {
  const auto [stiffness, mass] = brick(0.05 / static_cast<double>(elements));
  const Index nodes = elements + 1;
  const auto dof = [&](Index x, Index y, Index z) { return 3 * (((z - 1) * nodes + y) * nodes + x); };
  const Index size = dof(0, 0, nodes);
  std::vector<Eigen::Triplet<double>> m, k;
  for (Index cell = 0; cell < elements * elements * elements; ++cell) {
    std::array<Index, 8> at{};
    for (Index node = 0; node < 8; ++node)
      at[static_cast<std::size_t>(node)] =
          dof(cell % elements + (node & 1), cell / elements % elements + (node >> 1 & 1),
              cell / (elements * elements) + (node >> 2 & 1));
    for (Index i = 0; i < 24; ++i) {
      for (Index j = 0; j < 24; ++j) {
        const auto row = static_cast<int>(at[static_cast<std::size_t>(i / 3)] + i % 3);
        const auto column = static_cast<int>(at[static_cast<std::size_t>(j / 3)] + j % 3);
        if (row < 0 || column < 0) continue;
        m.emplace_back(row, column, mass(i, j));
        k.emplace_back(row, column, stiffness(i, j));
      }
    }
  }
  FiniteSector sector;
  sector.mass.resize(size, size);
  sector.mass.setFromTriplets(m.begin(), m.end());
  sector.stiffness.resize(size, size);
  sector.stiffness.setFromTriplets(k.begin(), k.end());
  for (Index z = 1; z < nodes; ++z) {
    for (Index y = 0; y < nodes; ++y) {
      for (Index i = 0; i < 3; ++i) {
        sector.left.push_back(dof(0, y, z) + i);
        sector.right.push_back(dof(elements, y, z) + i);
      }
    }
  }
  sector.contacts = {dof(0, 0, elements) + 1};
  sector.load = ComplexVector::Unit(size, sector.contacts.front());
  return checked(sector);
}

continuation::TraceOptions over_window(double lowest) {
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = 0.9 * lowest;
  options.to = 1.2 * lowest;
  options.extrema_of = {"Y"};
  return options;
}

/// A response by way of the modes.
SectorModes reduced_response(const FiniteSector& sector, double lowest) {
  SectorModes modes = sector_modes(sector, wave, {0.9 * lowest, 1.2 * lowest, 1e-8, loss});
  const problems::ForcedResponse problem({modal_model(modes, 1, loss), {}, 1e7, 1e-7});
  static_cast<void>(trace(problem, problem.guess(0.9 * lowest, 1), over_window(lowest)));
  return modes;
}

/// One with full solves: its seconds over those of the factorisations alone, and how many these are.
std::string full_response(const FiniteSector& sector, double lowest, double factorisation) {
  const Clock::time_point start = Clock::now();
  const FullReceptance solves(sector, wave, loss);
  const ContactModes base =
      ContactModes(1, {}, {}).solved_by([&](double eta, double load) { return solves.at(eta, load); }, 1);
  const problems::HarmonicResponse problem(one_harmonic({base, ContactModes(1, {}, {}), {{1e7, 1e-7}}}));
  static_cast<void>(trace(problem, problem.guess(0.9 * lowest, 1), over_window(lowest)));
  const double time = std::chrono::duration<double>(Clock::now() - start).count();
  const int count = solves.factorisations();
  return fmt::format("{:.2f} of {}", time / (count * factorisation), count);
}

void measure(const char* shape, const FiniteSector& sector) {
  constexpr Index traced_in_full = 2000;
  const double lowest = lowest_frequency(sector, wave.wave_number, wave.sectors);
  SectorReduction reduction(sector);
  reduction.set_forward(wave.forward());
  const double w = 2 * std::numbers::pi * lowest;
  const ComplexSparseMatrix z = reduction.stiffness() * Complex(1, 2e-3) - w * w * reduction.mass();
  ComplexFactors factors(z);
  const double factorisation = seconds([&] { factors.factor(z); });
  factors.release();
  double shift = 0;
  {
    Cholesky<Complex> fronts(z);
    shift = seconds([&] { fronts.factor(reduction.stiffness()); });
  }
  double full = 0;
  {
    SectorSolver solver(sector, wave.forward(), loss);
    double eta = lowest;
    full = seconds([&] { solver.at(eta *= 1.0005); });
  }
  const std::string traced =
      reduction.size() <= traced_in_full ? full_response(sector, lowest, factorisation) : "-";
  SectorModes modes;
  const double reduced = seconds([&] { modes = reduced_response(sector, lowest); });
  fmt::print(
      "{:>6} {:>8} {:>10.1f} {:>8.2f} {:>14} {:>10.2f} {:>7} {:>8} {:>6.1f} {:>9.1e} {:>12.1f} {:>7.0f}\n",
      shape, reduction.size(), 1e3 * factorisation, full / factorisation, traced, shift / factorisation,
      modes.frequencies.size(), modes.factorisations, 5 + 0.1 * static_cast<double>(modes.frequencies.size()),
      modes.error, reduced / factorisation, peak_megabytes());
  std::fflush(stdout);
}

void measure_both(double dofs) {
  const auto elements = static_cast<Index>(std::lround(std::sqrt(dofs / 4)));
  measure("plate", testing::rim_plate(wave.sectors, elements, elements));
  measure("cube", cube(std::lround(std::cbrt(dofs / 3))));
}

}  // namespace

int main(int count, char** arguments) {
  fmt::print("{:>6} {:>8} {:>10} {:>8} {:>14} {:>10} {:>7} {:>8} {:>6} {:>9} {:>12} {:>7}\n", "shape", "dofs",
             "factor ms", "full/f", "full path/f", "Cholesky/f", "modes", "factors", "goal", "error",
             "response/f", "MB");
  for (const double dofs : {1e3, 5.7e3}) measure_both(dofs);
  for (int i = 1; i < count; ++i) measure_both(std::stod(arguments[i]));
  return 0;
}
