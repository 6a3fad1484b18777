#pragma once

// Masses in the plane that rub, lift off and meet stops, alone or round a ring, and their case files.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "arcslip/types.hpp"
#include "temporary_folder.hpp"

namespace arcslip::testing {

/// Masses that slide along one direction and close along another one, with springs to their neighbours.
struct Masses {
  Index nodes = 1;
  Index wave_number = 0;
  Matrix stiffness = (Matrix(2, 2) << 1, 0.2, 0.2, 1.5).finished();
  double coupling = 0;
  double damping = 0.05;  // times K
  Eigen::Vector2cd load{1, std::polar(0.6, 0.5)};
  double tangential = 0.6, normal = 0.8, friction = 0.5, press = 1;
  double stop = 0, gap = 0.5;       // along the closing direction
  double contact = 0, limit = 0.3;  // of Jenkins along the sliding one
};

inline std::string plane_matrix_text(const Matrix& a) {
  std::string text = fmt::format("%%MatrixMarket matrix array real general\n{} {}\n", a.rows(), a.cols());
  for (Index i = 0; i < a.size(); ++i) text += fmt::format("{:.17g}\n", a.data()[i]);
  return text;
}

inline std::string text_of(const Masses& s, const TemporaryFolder& folder, int highest, double eta) {
  const bool ring = s.nodes > 1;
  Matrix mass = Matrix::Zero(ring ? 4 : 2, ring ? 4 : 2);
  Matrix stiffness = mass;
  mass.topLeftCorner(2, 2).setIdentity();
  stiffness.topLeftCorner(2, 2) = s.stiffness;
  if (ring) {
    const Matrix spring = s.coupling * Matrix::Identity(2, 2);
    stiffness.topLeftCorner(2, 2) += spring;
    stiffness.bottomRightCorner(2, 2) += spring;
    stiffness.topRightCorner(2, 2) -= spring;
    stiffness.bottomLeftCorner(2, 2) -= spring;
  }
  folder.write("m.mtx", plane_matrix_text(mass));
  folder.write("k.mtx", plane_matrix_text(stiffness));
  folder.write("c.mtx", plane_matrix_text(s.damping * stiffness));
  std::string text = fmt::format(
      "[system]\nmodel = \"sector\"\ncontact_stiffness = [{}, 0.0]\nlimit_per_preload = [{}, 1.0]\n"
      "preload = 1.0\nharmonics = {}\n",
      s.contact, s.limit, highest);
  if (ring) text += fmt::format("sectors = {}\nwave_number = {}\n", s.nodes, s.wave_number);
  text += "[system.base]\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\ndamping = \"c.mtx\"\ncontact = [1, 2]\n";
  if (ring) text += "left = [1, 2]\nright = [3, 4]\n";
  text += fmt::format(
      "load = {{ dof = [1, 2], value = [{:.17g}, {:.17g}], imaginary = [{:.17g}, {:.17g}] }}\n"
      "[[element]]\nkind = \"friction\"\nat = \"base\"\ncontact = 1\nnormal = 2\ntangential_stiffness = "
      "{}\nnormal_stiffness = {}\nmu = {}\nnormal_force = {}\n",
      s.load(0).real(), s.load(1).real(), s.load(0).imag(), s.load(1).imag(), s.tangential, s.normal,
      s.friction, s.press);
  if (s.stop > 0)
    text += fmt::format(
        "[[element]]\nkind = \"unilateral\"\nat = \"base\"\ncontact = 2\nstiffness = {}\ngap = {}\n", s.stop,
        s.gap);
  return text + fmt::format("[branch]\nparameter = \"eta\"\nfrom = {:.17g}\nto = {:.17g}\nstability = true\n",
                            eta, 1.001 * eta);
}

/// Those of a larger modulus.
inline ComplexVector larger_than(const std::vector<Complex>& all, double modulus) {
  std::vector<Complex> kept;
  for (const Complex& mu : all) {
    if (std::abs(mu) > modulus) kept.push_back(mu);
  }
  return ComplexVector::Map(kept.data(), std::ssize(kept));
}

}  // namespace arcslip::testing
