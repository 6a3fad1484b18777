#pragma once

// Rings whose sectors are rows of three masses, on dampers that are rows as well.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "temporary_folder.hpp"

namespace arcslip::testing {

/// The matrices of a row of three masses and springs between neighbours and to ground.
inline void write_row(const TemporaryFolder& folder, const std::string& name, const std::vector<double>& mass,
                      const std::vector<double>& springs, const std::vector<double>& ground) {
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n4 4 ";
  std::string m = head + "3\n";
  std::string k = head + "7\n";
  for (std::size_t i = 0; i < 4; ++i) {
    if (i < 3) m += fmt::format("{0} {0} {1}\n", i + 1, mass[i]);
    const double own = (i < 3 ? ground[i] + springs[i] : 0) + (i > 0 ? springs[i - 1] : 0);
    k += fmt::format("{0} {0} {1}\n", i + 1, own);
    if (i < 3) k += fmt::format("{} {} {}\n", i + 2, i + 1, -springs[i]);
  }
  folder.write(name + "_m.mtx", m);
  folder.write(name + "_k.mtx", k);
}

/// Its system with these keys and further tables, where these dofs of both rows are contacts.
inline std::string ring_of_rows(const std::string& contacts, const std::string& keys) {
  const auto part = [&](const std::string& name) {
    return fmt::format(
        "[system.{0}]\nmass = \"{0}_m.mtx\"\nstiffness = \"{0}_k.mtx\"\nleft = [1]\nright = [4]\n"
        "contact = {1}\ndamping_kind = \"viscous\"\nreference_frequency = 0.3\n",
        name, contacts);
  };
  return "[system]\nmodel = \"sector\"\nsectors = 12\nforce = 1.0\nreduction_window = [0.05, 3.0]\n" + keys +
         part("base") + "load = { dof = [2], value = [1.0] }\n" + part("damper");
}

}  // namespace arcslip::testing
