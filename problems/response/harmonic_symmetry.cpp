// The symmetries of whole rings under loads that have some: sector i goes to the sector s + i, or s - i, and
// all motions are later by theta/(2 pi) of the load's period, x'_{s +- i,h} = e^{-jh theta} x_{i,h}, where
// the load does so.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "arcslip/continuation/problem/one_piece.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip::problems {
namespace {

constexpr double same_motion = 1e-9;  // relative

std::string named(Index shift, bool mirrors, Index sectors, double turns) {
  std::string name;
  if (!mirrors) {
    name = fmt::format("shift by {} sector{}", shift, shift == 1 ? "" : "s");
  } else if (shift % 2 == 0) {
    name = fmt::format("mirror at sector {}", shift / 2 + 1);
  } else {
    name = fmt::format("mirror between sectors {} and {}", shift / 2 + 1, (shift / 2 + 1) % sectors + 1);
  }
  if (turns == 0) return name;
  return name + (turns == 0.5 ? ", half a period later" : fmt::format(", {:.6g} of a period later", turns));
}

}  // namespace

std::vector<continuation::Symmetry> HarmonicResponse::symmetries() const {
  const Index sectors = system_.sectors;
  if (sectors == 1) return {};
  const Index each = contacts() / sectors;
  // Where it stands on its own the load says what it is, and a response anywhere what all of it is.
  const std::vector<double>& resonances = system_.landmarks.front();
  const double at = resonances.empty() ? 1 : 1.0617 * *std::min_element(resonances.begin(), resonances.end());
  const ContactVector load = system_.base.front().at(at).free.head(contacts());
  std::vector<continuation::Symmetry> found;
  Index period = 0;             // the first shift that is one
  std::optional<Index> mirror;  // the first one
  for (Index k = 1; k < 2 * sectors; ++k) {
    const bool mirrors = k >= sectors;
    const Index shift = k % sectors;
    const auto image = [&](Index sector) {
      return ((mirrors ? shift - sector : shift + sector) % sectors + sectors) % sectors;
    };
    ContactVector moved(contacts());
    for (Index i = 0; i < contacts(); ++i) moved(image(i / each) * each + i % each) = load(i);
    const Complex product = moved.dot(load);  // sum conj(moved) load
    if (!(std::abs(product) > 0)) continue;
    const Complex later = product / std::abs(product);
    if ((later * moved - load).norm() > same_motion * load.norm()) continue;
    double turns = std::remainder(-std::arg(later) / two_pi, 1.0);
    turns = std::abs(turns) < same_motion ? 0 : turns < 0 ? turns + 1 : turns;
    if (std::abs(turns - 0.5) < same_motion) turns = 0.5;
    // Those that others make up are symmetries as these are.
    const bool is_known =
        mirrors ? mirror && period > 0 && (shift - *mirror) % period == 0 : period > 0 && shift % period == 0;
    std::optional<SparseMatrix> map = image_map(image, turns);
    if (!map || !(is_known || goes_with(*map))) continue;
    if (mirrors && !mirror) mirror = shift;
    if (!mirrors && period == 0) period = shift;
    found.push_back({named(shift, mirrors, sectors, turns), std::move(*map)});
  }
  return found;
}

/// The map of the unknowns, if all coordinates have an image.
std::optional<SparseMatrix> HarmonicResponse::image_map(const std::function<Index(Index)>& image,
                                                        double turns) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < coordinates(); ++j) {
    const Index each = contacts() / system_.sectors;
    const auto sector = [&](Index i) { return i < contacts() ? i / each : coordinates_[i].sector; };
    // Coordinates of one kind follow one another from sector to sector.
    const Index apart =
        j < contacts() ? each : coordinates_.element(coordinates_.element_of(j)).coordinates();
    const Index to = j + apart * (image(sector(j)) - sector(j));
    if (to < 0 || to >= coordinates() || sector(to) != image(sector(j))) return std::nullopt;
    for (Index a = 0; a < harmonics(); ++a) {
      const Complex turn = std::polar(1.0, -two_pi * turns * system_.orders[at(a)]);
      const Index row = 2 * (to * harmonics() + a);
      const Index column = 2 * (j * harmonics() + a);
      entries.emplace_back(row, column, turn.real());
      entries.emplace_back(row, column + 1, -turn.imag());
      entries.emplace_back(row + 1, column, turn.imag());
      entries.emplace_back(row + 1, column + 1, turn.real());
    }
  }
  SparseMatrix map(size(), size());
  map.setFromTriplets(entries.begin(), entries.end());
  return map;
}

/// Whether F(S u) = S F(u), at a motion as large as the load makes it, of which some contacts slip.
bool HarmonicResponse::goes_with(const SparseMatrix& map) const {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const std::vector<double>& resonances = system_.landmarks.front();
  Vector p = Vector::Ones(static_cast<Index>(parameter_names().size()));
  p(eta) = resonances.empty() ? 1.37 : 0.93 * resonances.back();
  if (is_varied()) p(further) = system_.varied->value;
  if (is_varied() && system_.varied->kind == SystemParameter::Kind::speed)
    p(further) += 0.01 * p(eta);  // what mirrors at rest alone is none of the branch
  const double amplitude = system_.base.front().at(p(eta)).free.head(contacts()).cwiseAbs().maxCoeff();
  for (const SectorContact& contact : system_.contacts) {
    if (contact.stiffness > 0) p(preload) = amplitude / contact.slip_per_preload;
  }
  const auto value = [&](const Vector& u) {
    Vector residual(size());
    return evaluate(u, p, continuation::regime_at(*this, u, p), {&residual}) ? std::optional(residual)
                                                                             : std::nullopt;
  };
  const Vector u = Vector::NullaryExpr(size(), [&](Index) { return amplitude * normal(random); });
  const std::optional<Vector> here = value(u);
  const std::optional<Vector> there = value(map * u);
  return here && there && (*there - map * *here).norm() <= same_motion * here->norm();
}

}  // namespace arcslip::problems
