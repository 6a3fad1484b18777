#include "arcslip/sectors/annular_plate.hpp"

#include <cmath>
#include <stdexcept>

#include "arcslip/dense.hpp"
#include "structure/shape_functions.hpp"

namespace arcslip {
namespace {

constexpr int node_dofs = 4;  // w, w_r, w_theta, w_r,theta
using ElementMatrix = Eigen::Matrix<double, 16, 16>;
using Shapes = Eigen::Matrix<double, 16, 1>;

/// Products of a polynomial of r and one of theta, in the order of `element_nodes`.
Shapes product(const Eigen::Vector4d& radial, const Eigen::Vector4d& angular) {
  Shapes shapes;
  for (int b = 0; b < 2; ++b) {
    for (int a = 0; a < 2; ++a) {
      for (int q = 0; q < 2; ++q) {
        for (int p = 0; p < 2; ++p) {
          shapes(node_dofs * (2 * b + a) + 2 * q + p) = radial(2 * a + p) * angular(2 * b + q);
        }
      }
    }
  }
  return shapes;
}

/// The stresses in the plane of a plate that turns at one radian.
class SpinStress {
 public:
  explicit SpinStress(const AnnularPlate& plate) : nu_(plate.poisson_ratio), load_(plate.density / 8) {
    Eigen::Matrix2d conditions;
    Eigen::Vector2d loads;
    const auto set = [&](int row, EdgeSupport edge, double r) {
      const double r2 = r * r;
      if (edge == EdgeSupport::clamped) {  // E u/r = s_t - nu s_r
        conditions.row(row) << 1 - nu_, (1 + nu_) / r2;
        loads(row) = (1 - nu_ * nu_) * load_ * r2;
      } else {
        conditions.row(row) << 1, -1 / r2;
        loads(row) = (3 + nu_) * load_ * r2;
      }
    };
    set(0, plate.inner_edge, plate.inner_radius);
    set(1, plate.outer_edge, plate.outer_radius);
    constants_ = solution_of(conditions, loads);
  }

  double radial(double r) const {
    return constants_(0) - constants_(1) / (r * r) - (3 + nu_) * load_ * r * r;
  }
  double hoop(double r) const {
    return constants_(0) + constants_(1) / (r * r) - (1 + 3 * nu_) * load_ * r * r;
  }

 private:
  double nu_;
  double load_;
  Eigen::Vector2d constants_;
};

struct ElementMatrices {
  ElementMatrix mass = ElementMatrix::Zero();
  ElementMatrix stiffness = ElementMatrix::Zero();
  ElementMatrix stiffness_speed2 = ElementMatrix::Zero();
};

/// Element from radius `inner` over `length`, through `angle`.
ElementMatrices element(const AnnularPlate& plate, double inner, double length, double angle) {
  const double nu = plate.poisson_ratio;
  const double bending = plate.youngs_modulus * std::pow(plate.thickness, 3) / (12 * (1 - nu * nu));
  const SpinStress stress(plate);
  ElementMatrices matrices;
  // The rule is exact but for 1/r^3, which adds less than the elements' own error.
  for (const auto& [s, radial_weight] : gauss_points()) {
    for (const auto& [t, angular_weight] : gauss_points()) {
      const Hermite along(s, length);
      const Hermite around(t, angle);
      const double r = inner + s * length;
      const double area = radial_weight * angular_weight * length * angle * r;
      const Shapes w = product(along.value, around.value);
      const Shapes k_r = product(along.second, around.value);
      const Shapes k_t =
          product(along.first, around.value) / r + product(along.value, around.second) / (r * r);
      const Shapes k_rt =
          product(along.first, around.first) / r - product(along.value, around.first) / (r * r);
      const Shapes sum = k_r + k_t;
      matrices.mass += plate.density * plate.thickness * area * w * w.transpose();
      matrices.stiffness +=
          bending * area *
          (sum * sum.transpose() -
           (1 - nu) * (k_r * k_t.transpose() + k_t * k_r.transpose() - 2 * k_rt * k_rt.transpose()));
      const Shapes w_r = product(along.first, around.value);
      const Shapes w_t = product(along.value, around.first) / r;
      matrices.stiffness_speed2 +=
          plate.thickness * area *
          (stress.radial(r) * w_r * w_r.transpose() + stress.hoop(r) * w_t * w_t.transpose());
    }
  }
  return matrices;
}

void check(const AnnularPlate& plate) {
  const bool shape = plate.inner_radius > 0 && plate.outer_radius > plate.inner_radius && plate.thickness > 0;
  const bool material =
      plate.youngs_modulus > 0 && plate.density > 0 && plate.poisson_ratio > -1 && plate.poisson_ratio < 0.5;
  const bool mesh = plate.sectors >= 1 && plate.radial_elements >= 1 && plate.angular_elements >= 1;
  if (!shape || !material || !mesh) {
    throw std::invalid_argument("annular_plate_sector: a quantity of the plate is out of its range");
  }
}

/// Number of each dof of the mesh among those that are not held; -1 for those that are.
struct Numbering {
  std::vector<int> number;
  int count = 0;

  explicit Numbering(const AnnularPlate& plate) {
    for (Index line = 0; line <= plate.angular_elements; ++line) {
      for (Index circle = 0; circle <= plate.radial_elements; ++circle) {
        for (int dof = 0; dof < node_dofs; ++dof) {
          const bool slope = dof % 2 == 1;
          const auto holds = [&](EdgeSupport edge) {
            return edge == EdgeSupport::clamped || (edge == EdgeSupport::supported && !slope);
          };
          const bool held = (circle == 0 && holds(plate.inner_edge)) ||
                            (circle == plate.radial_elements && holds(plate.outer_edge));
          number.push_back(held ? -1 : count++);
        }
      }
    }
  }
};

/// Entries of the matrices of a sector.
struct PlateEntries {
  using Triplets = std::vector<Eigen::Triplet<double>>;
  Triplets mass;
  Triplets stiffness;
  Triplets stiffness_speed2;

  static SparseMatrix matrix(const Triplets& entries, int size) {
    SparseMatrix made(size, size);
    made.setFromTriplets(entries.begin(), entries.end());
    return made;
  }
};

PlateEntries assemble(const AnnularPlate& plate, const Numbering& numbering) {
  PlateEntries entries;
  const double length =
      (plate.outer_radius - plate.inner_radius) / static_cast<double>(plate.radial_elements);
  const double angle = two_pi / static_cast<double>(plate.sectors * plate.angular_elements);
  const Index circles = plate.radial_elements + 1;
  for (Index i = 0; i < plate.radial_elements; ++i) {
    const ElementMatrices matrices =
        element(plate, plate.inner_radius + static_cast<double>(i) * length, length, angle);
    for (Index line = 0; line < plate.angular_elements; ++line) {
      const auto dof = [&](int local) {
        const int node = local / node_dofs;
        const Index at = (line + node / 2) * circles + i + node % 2;
        return numbering.number[static_cast<std::size_t>(at * node_dofs + local % node_dofs)];
      };
      for (int a = 0; a < 16; ++a) {
        for (int b = 0; b < 16; ++b) {
          if (dof(a) < 0 || dof(b) < 0) continue;
          entries.mass.emplace_back(dof(a), dof(b), matrices.mass(a, b));
          entries.stiffness.emplace_back(dof(a), dof(b), matrices.stiffness(a, b));
          entries.stiffness_speed2.emplace_back(dof(a), dof(b), matrices.stiffness_speed2(a, b));
        }
      }
    }
  }
  return entries;
}

}  // namespace

FiniteSector annular_plate_sector(const AnnularPlate& plate) {
  check(plate);
  const Numbering numbering(plate);
  const PlateEntries entries = assemble(plate, numbering);
  FiniteSector sector;
  sector.mass = PlateEntries::matrix(entries.mass, numbering.count);
  sector.stiffness = PlateEntries::matrix(entries.stiffness, numbering.count);
  if (plate.turns) sector.stiffness_speed2 = PlateEntries::matrix(entries.stiffness_speed2, numbering.count);
  sector.load = ComplexVector::Zero(numbering.count);
  const int line_dofs = numbering.count / static_cast<int>(plate.angular_elements + 1);
  for (int k = 0; k < line_dofs; ++k) {
    sector.left.push_back(k);
    sector.right.push_back(numbering.count - line_dofs + k);
  }
  const int rim = numbering.number[static_cast<std::size_t>(plate.radial_elements * node_dofs)];
  for (Index line = 0; rim >= 0 && line < plate.angular_elements; ++line) {
    sector.contacts.push_back(line * line_dofs + rim);
  }
  sector.outputs = sector.contacts;
  return checked(sector);
}

}  // namespace arcslip
