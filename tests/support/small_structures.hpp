#pragma once

// Structures of a few masses whose dofs are contacts all, as sectors without symmetry, with their case files.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "random_systems.hpp"
#include "temporary_folder.hpp"

namespace arcslip::testing {

/// Matrices, and loads on all dofs.
struct SmallStructure {
  Matrix mass;
  Matrix stiffness;
  Matrix damping;
  ComplexVector load;
  std::vector<double> contact_stiffness;
  double preload = 1;
};

inline std::string matrix_text(const Matrix& a) {
  std::string text = fmt::format("%%MatrixMarket matrix array real general\n{} {}\n", a.rows(), a.cols());
  for (Index j = 0; j < a.cols(); ++j) {
    for (Index i = 0; i < a.rows(); ++i) text += fmt::format("{:.17g}\n", a(i, j));
  }
  return text;
}

inline void write_matrices(const SmallStructure& s, const TemporaryFolder& folder) {
  folder.write("m.mtx", matrix_text(s.mass));
  folder.write("k.mtx", matrix_text(s.stiffness));
  folder.write("c.mtx", matrix_text(s.damping));
}

/// All of a case file but elements and what is asked.
inline std::string small_system_text(const SmallStructure& s, const std::string& harmonics) {
  std::string text = fmt::format("[system]\nmodel = \"sector\"\ncontact_stiffness = [{:.17g}]\n",
                                 fmt::join(s.contact_stiffness, ", "));
  text += fmt::format("preload = {:.17g}\nharmonics = {}\n\n[system.base]\n", s.preload, harmonics);
  text += "mass = \"m.mtx\"\nstiffness = \"k.mtx\"\ndamping = \"c.mtx\"\n";
  std::vector<Index> dofs;
  std::vector<double> real, imaginary;
  for (Index i = 0; i < s.load.size(); ++i) {
    dofs.push_back(i + 1);
    real.push_back(s.load(i).real());
    imaginary.push_back(s.load(i).imag());
  }
  text +=
      fmt::format("contact = [{0}]\nload = {{ dof = [{0}], value = [{1:.17g}], imaginary = [{2:.17g}] }}\n",
                  fmt::join(dofs, ", "), fmt::join(real, ", "), fmt::join(imaginary, ", "));
  return text;
}

/// e^{jh theta} of samples and orders.
inline ComplexMatrix turns_of(const std::vector<int>& orders, Index samples) {
  ComplexMatrix turns(samples, std::ssize(orders));
  for (Index i = 0; i < samples; ++i) {
    for (Index a = 0; a < turns.cols(); ++a)
      turns(i, a) =
          std::polar(1.0, two_pi * static_cast<double>(i * orders[static_cast<std::size_t>(a)] % samples) /
                              static_cast<double>(samples));
  }
  return turns;
}

inline SmallStructure random_structure(RandomSystems& draw) {
  constexpr Index dofs = 3;
  const auto symmetric = [&](double off) {
    Matrix a(dofs, dofs);
    for (Index i = 0; i < dofs; ++i) {
      for (Index j = 0; j <= i; ++j)
        a(i, j) = a(j, i) = i == j ? draw.uniform(0.8, 2.5) : draw.uniform(-off, off);
    }
    return a;
  };
  SmallStructure s;
  s.mass = symmetric(0.1);
  s.stiffness = symmetric(0.3);
  s.damping = draw.uniform(0.005, 0.03) * s.mass + draw.uniform(0.005, 0.03) * s.stiffness;
  s.load.resize(dofs);
  for (Index i = 0; i < dofs; ++i) s.load(i) = std::polar(draw.uniform(0, 1), draw.uniform(-pi, pi));
  s.contact_stiffness.assign(dofs, 0);
  return s;
}

}  // namespace arcslip::testing
