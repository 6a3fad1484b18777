#pragma once

// Sector of equal elements in a row, of which each shares the dofs of its end nodes with its neighbours:
// that of a ring, and of the rods and beams of `elements.hpp`.

#include "arcslip/sectors/finite_sector.hpp"
#include "arcslip/structure/chain_elements.hpp"

namespace arcslip {

/// `count` elements whose dofs are ordered left node, interior, right node, with `node_dofs` to a node. Dofs
/// count in this order along the sector. Contacts and outputs are dof `contact` of each node but the last,
/// which is the next sector's; no load. What rotation adds may be given as well.
FiniteSector chain_sector(const Matrix& mass, const Matrix& stiffness, Index node_dofs, Index count,
                          Index contact, const Matrix& gyroscopic = {}, const Matrix& stiffness_speed2 = {});

/// `count` elements of `elements` in the whole ring, with its travelling load of unit force per length.
FiniteSector chain_sector(const ChainElement& element, Index wave_number, Index elements, Index count);

}  // namespace arcslip
