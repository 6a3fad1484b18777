#pragma once

// Sectors written as the files of a case with model = "sector".

#include <fmt/format.h>

#include <string>

#include "arcslip/sectors/matrix_market.hpp"
#include "sector_examples.hpp"
#include "temporary_folder.hpp"

namespace arcslip::testing {

inline std::string dof_list(const std::vector<Index>& dofs) {
  std::string text;
  for (const Index dof : dofs) text += fmt::format("{} ", dof + 1);
  return text;
}

/// Writes the matrices and lists of a sector and gives its table in [system].
inline std::string write_sector(const TemporaryFolder& folder, const std::string& name,
                                const FiniteSector& sector, const std::string& damping) {
  folder.write(name + "_mass.mtx", write_matrix_market(sector.mass, MatrixSymmetry::symmetric));
  folder.write(name + "_stiffness.mtx", write_matrix_market(sector.stiffness, MatrixSymmetry::general));
  folder.write(name + "_left.txt", "# left\n" + dof_list(sector.left));
  folder.write(name + "_right.txt", dof_list(sector.right));
  std::string text = fmt::format(
      "[system.{0}]\nmass = \"{0}_mass.mtx\"\nstiffness = \"{0}_stiffness.mtx\"\nleft = \"{0}_left.txt\"\n"
      "right = \"{0}_right.txt\"\ncontact = [{1}]\n{2}\n",
      name, sector.contacts.front() + 1, damping);
  if (sector.load.isZero(0)) return text;
  std::string loads;
  for (Index dof = 0; dof < sector.load.size(); ++dof)
    loads += fmt::format("{} {:.17g} {:.17g}\n", dof + 1, sector.load(dof).real(), sector.load(dof).imag());
  folder.write(name + "_load.txt", loads);
  return text + fmt::format("load = \"{}_load.txt\"\n", name);
}

}  // namespace arcslip::testing
