#pragma once

// Base and damper of which nothing is known but how they answer to harmonic forces, as of measured
// receptances or of another program.

#include <functional>
#include <optional>
#include <vector>

#include "arcslip/assembly/structures.hpp"

namespace arcslip {

/// One of the two; used from several threads.
struct GivenPart {
  /// Under a travelling wave at eta > 0, the free response that to a load of factor 1.
  std::function<ContactReceptance(Index wave, double eta)> response;
  /// Undamped, to show where it resonates; shapes may be zero. Null: not known.
  std::function<std::vector<ContactMode>(Index wave)> modes = {};
};

/// By their responses.
class GivenStructures final : public Structures {
 public:
  /// All responses are of so many contacts. Without damper these are to ground.
  GivenStructures(Index contacts, GivenPart base, std::optional<GivenPart> damper)
      : contacts_(contacts), base_(std::move(base)), damper_(std::move(damper)) {}

  /// What it was made of.
  Index contacts() const { return contacts_; }
  bool has_damper() const { return damper_.has_value(); }

  ContactSystem wave(const SystemParameters& system) const override;
  bool is_one_contact(const SystemParameters& /*system*/) const override { return false; }
  PairLosses losses(const SystemParameters& /*system*/) const override { return {}; }
  bool has_equations() const override { return false; }

 private:
  ContactModes part(const GivenPart& part, Index wave, double force) const;

  Index contacts_;
  GivenPart base_;
  std::optional<GivenPart> damper_;
};

}  // namespace arcslip
