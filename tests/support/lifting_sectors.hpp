#pragma once

// Rings of sectors of three masses each, on a damper of as many, which rub as they press each other, and lift
// off.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "small_structures.hpp"
#include "temporary_folder.hpp"

namespace arcslip::testing {

/// Three masses with springs to their neighbours and to ground, the last spring to the next sector.
struct Row {
  std::vector<double> mass;
  std::vector<double> springs;
  std::vector<double> ground;
};

inline void write_row(const TemporaryFolder& folder, const std::string& name, const Row& row) {
  Matrix mass = Matrix::Zero(4, 4);
  Matrix stiffness = Matrix::Zero(4, 4);
  for (Index i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    mass(i, i) = row.mass[k];
    stiffness(i, i) += row.ground[k];
    stiffness.block(i, i, 2, 2) += row.springs[k] * (Matrix(2, 2) << 1, -1, -1, 1).finished();
  }
  folder.write(name + "_m.mtx", matrix_text(mass));
  folder.write(name + "_k.mtx", matrix_text(stiffness));
}

/// The system whose matrices are these, with `system` and `friction` as further keys of both tables.
inline std::string lifting_sectors(const TemporaryFolder& folder, const Row& base, const Row& damper,
                                   const std::string& system, const std::string& friction) {
  write_row(folder, "base", base);
  write_row(folder, "damper", damper);
  const auto part = [](const std::string& name) {
    return fmt::format(
        "[system.{0}]\nmass = \"{0}_m.mtx\"\nstiffness = \"{0}_k.mtx\"\nleft = [1]\nright = [4]\n"
        "contact = [1, 2]\ndamping_kind = \"viscous\"\nreference_frequency = 0.3\n",
        name);
  };
  return "[system]\nmodel = \"sector\"\nsectors = 12\nforce = 1.0\nreduction_window = [0.05, 3.0]\n" +
         system + "[[element]]\nkind = \"friction\"\nat = \"contact\"\nnormal = 2\n" + friction +
         part("base") + "load = { dof = [2], value = [1.0] }\n" + part("damper");
}

}  // namespace arcslip::testing
