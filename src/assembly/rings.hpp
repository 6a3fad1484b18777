#pragma once

#include "arcslip/assembly/structures.hpp"

namespace arcslip {

/// Rods and beams of the paper, of one node's contact.
class Rings : public Structures {
 public:
  ContactSystem wave(const SystemParameters& system) const override;
  ContactModes seen(const SystemParameters& system, bool is_base) const override;
  FrictionSystem one_contact(const SystemParameters& system) const override;
  bool is_one_contact(const SystemParameters& /*system*/) const override { return true; }
  PairLosses losses(const SystemParameters& system) const override;
  double nodes(const SystemParameters& system) const override { return static_cast<double>(system.elements); }
  std::vector<SystemParameter> parameters(const SystemParameters& system) const override;
};

}  // namespace arcslip
