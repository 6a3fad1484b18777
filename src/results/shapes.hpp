#pragma once

// Shapes of modes and responses of the whole ring, for ParaView: unstructured grids of the dofs' places in
// all sectors, one .vtu file (VTK XML, text) for each shape, with its real and its imaginary part as vectors.
// A motion x(t) = Re(x e^{jwt}) is real part at t = 0 and minus the imaginary part a quarter of a period
// later.

#include <array>
#include <string>
#include <vector>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/cases/runs.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip {

/// A file and what it holds.
struct ShapeFile {
  std::string name;  ///< without folder
  std::string text;  ///< all of it
};

/// Why a system has no shapes, or nothing where it has.
std::string why_no_shapes(const SystemParameters& system);

/// The same of a branch, of which only forced responses have shapes.
std::string why_no_shapes(const CaseBranch& branch);

/// Those of a system.
class RingShapes {
 public:
  /// Throws std::invalid_argument where the system has none, SectorError where its modes cannot be found.
  explicit RingShapes(const SystemParameters& system);

  /// The modes of base, damper and the stuck whole under the system's wave, below the end of its window, each
  /// with 1 as the greatest motion of a dof.
  std::vector<ShapeFile> modes() const;

  /// The special points of a branch that has shapes, in each harmonic, as branch_0_point_12.vtu.
  std::vector<ShapeFile> responses(std::size_t number, const TracedBranch& traced) const;

 private:
  /// Base or damper.
  struct Part {
    Index dofs = 0;
    std::vector<DofPlace> places;
    std::vector<Index> point_of;                ///< of each dof, among the points of a sector
    std::vector<std::array<double, 3>> points;  ///< of the sector of phase 0
  };
  /// The motion of all dofs, of base and damper, in one order; empty of a part that it does not concern.
  struct Shape {
    std::string name;
    int order;
    std::array<ComplexVector, 2> motion;
  };

  void add_part(const SectorPart& part, std::size_t which);
  bool fits(const FiniteSector& sector, const Part& part, double sense) const;
  std::vector<ContactSystem> waves_at(const std::vector<int>& orders, const Vector& parameters) const;
  std::vector<Shape> response(const std::vector<ContactSystem>& waves,
                              const problems::HarmonicResponse& problem, const continuation::Guess& at) const;
  std::string text(const std::vector<Shape>& shapes) const;
  std::string points(const std::vector<Shape>& shapes) const;
  std::string vectors(const Shape& shape) const;

  SystemParameters system_;  ///< with all dofs as outputs
  std::array<Part, 2> parts_;
  double turn_ = 1;  ///< sense in which sector follows sector about z
};

/// Writes them into DIR/shapes. Throws OutputError.
void write_shapes(const std::string& folder, const std::vector<ShapeFile>& files);

}  // namespace arcslip
