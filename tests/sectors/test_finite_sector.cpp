#include <functional>
#include <limits>

#include "arcslip/sectors/sector_reduction.hpp"
#include "catch.hpp"
#include "sector_examples.hpp"

using namespace arcslip;
using arcslip::testing::bladed_disk;
using arcslip::testing::sparse;

namespace {

/// What the checks say of the bladed disk with a mistake made in it.
std::string refusal(const std::function<void(FiniteSector&)>& spoil) {
  FiniteSector sector = bladed_disk();
  spoil(sector);
  try {
    const FiniteSector good = checked(sector);
    SectorReduction reduction(good);
    check_mass(good, reduction);
  } catch (const SectorError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A sector without mistakes is taken, and what is not listed is its interior") {
  const FiniteSector sector = checked(bladed_disk());
  CHECK(sector.interior == std::vector<Index>{1, 2});
  CHECK(refusal([](FiniteSector&) {}).empty());
  CHECK(refusal([](FiniteSector& s) { s.interior = {2, 1}; }).empty());
}

TEST_CASE("Each inconsistency of a sector is named, with its dof") {
  struct Example {
    std::function<void(FiniteSector&)> spoil;
    const char* message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Example example = GENERATE_COPY(values<Example>({
      {[](FiniteSector& s) { s.mass = SparseMatrix(); },
       "the mass matrix is empty, expected at least one dof"},
      {[](FiniteSector& s) { s.stiffness = sparse(Matrix::Identity(3, 3)); },
       "the stiffness matrix has 3 rows and 3 columns, expected 4 of each as the mass matrix has rows"},
      {[](FiniteSector& s) { s.damping = sparse(Matrix::Ones(4, 5)); },
       "the damping matrix has 4 rows and 5 columns, expected 4 of each as the mass matrix has rows"},
      {[](FiniteSector& s) { s.load.resize(5); }, "the load has 5 entries, expected 4, one for each dof"},
      {[=](FiniteSector& s) { s.load(1) = nan; }, "the load of dof 2 is not finite"},
      {[](FiniteSector& s) {
         s.left = {0, 1};
       },
       "the left boundary has 2 dofs and the right one 1, expected pairs"},
      {[](FiniteSector& s) {
         s.contacts = {1, 2};
         s.against = {2, 1};
       },
       "dofs 3 and 2 are listed twice in the contact dofs"},
      {[](FiniteSector& s) { s.contacts = s.against = {1}; },
       "the contact of dof 2 is against this dof itself, expected another one"},
      {[](FiniteSector& s) {
         s.contacts = {1};
         s.against = {3};
       },
       "contact dof 4 is on the right boundary, expected its pair on the left one"},
      {[](FiniteSector& s) { s.left = {4}; }, "expected dofs from 1 to 4 in the left boundary, got 5"},
      {[](FiniteSector& s) { s.right = {-1}; }, "expected dofs from 1 to 4 in the right boundary, got 0"},
      {[](FiniteSector& s) { s.right = {0}; }, "dof 1 is in the left boundary and in the right boundary"},
      {[](FiniteSector& s) {
         s.interior = {1, 2, 1};
       },
       "dof 2 is listed twice in the interior"},
      {[](FiniteSector& s) {
         s.interior = {1, 2, 3};
       },
       "dof 4 is in the right boundary and in the interior"},
      {[](FiniteSector& s) { s.interior = {1}; }, "dof 3 is neither on a boundary nor in the interior"},
      {[](FiniteSector& s) {
         s.contacts = {0, 0};
       },
       "dof 1 is listed twice in the contact dofs"},
      {[](FiniteSector& s) { s.contacts = {3}; },
       "contact dof 4 is on the right boundary, expected its pair on the left one"},
      {[](FiniteSector& s) { s.outputs = {7}; }, "expected dofs from 1 to 4 in the output dofs, got 8"},
      {[](FiniteSector& s) { s.stiffness.coeffRef(1, 2) = -1e6; },
       "the stiffness matrix is not symmetric: -2000000 at row 3, column 2, but -1000000 at row 2, column 3"},
      {[](FiniteSector& s) { s.mass.insert(0, 1) = 1e-3; },
       "the mass matrix is not symmetric: 0 at row 2, column 1, but 0.001 at row 1, column 2"},
      {[=](FiniteSector& s) { s.stiffness.coeffRef(2, 1) = nan; },
       "the stiffness matrix is not finite at row 3, column 2"},
      {[](FiniteSector& s) { s.stiffness.prune([](Index i, Index j, double) { return i != 2 || j != 2; }); },
       "the stiffness matrix has no entry on the diagonal of dof 3"},
      {[](FiniteSector& s) { s.mass.prune([](Index i, Index, double) { return i != 0; }); },
       "the mass matrix has no entry on the diagonal of dof 1 nor of its pair 4"},
      {[](FiniteSector& s) { s.mass.coeffRef(2, 2) = 0; },
       "the mass matrix is not positive definite, as seen at dof 3"},
      {[](FiniteSector& s) { s.mass.coeffRef(1, 1) = -0.35; },
       "the mass matrix is not positive definite, as seen at dof 2"},
      {[](FiniteSector& s) { s.mass.coeffRef(0, 0) = -1.2; },
       "the mass matrix is not positive definite, as seen at dof 1"},
  }));
  CHECK(refusal(example.spoil) == example.message);
}

TEST_CASE(
    "A mass that is singular but for rounding is refused, and one that is only ill conditioned is not") {
  const auto couple = [](double ratio) {
    return [ratio](FiniteSector& s) {
      const double mass = ratio * std::sqrt(0.35 * 0.25);
      s.mass.insert(1, 2) = mass;
      s.mass.insert(2, 1) = mass;
    };
  };
  CHECK_THAT(refusal(couple(1)), ContainsSubstring("not positive definite, as seen at dof"));
  CHECK(refusal(couple(1 - 1e-10)).empty());
}

TEST_CASE("Asymmetry of rounding is averaged out") {
  FiniteSector sector = bladed_disk();
  sector.stiffness.coeffRef(1, 2) *= 1 + 4e-9;
  const FiniteSector good = checked(sector);
  CHECK((SparseMatrix(good.stiffness.transpose()) - good.stiffness).norm() == 0);
  CHECK_THAT(good.stiffness.coeff(1, 2), WithinRel(-2e6 * (1 + 2e-9), 1e-15));
  CHECK_THROWS_AS(checked(sector, 1e-9), SectorError);
}
