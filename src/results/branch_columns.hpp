#pragma once

// What a point of a branch is described by: the columns of tables and summaries.

#include <optional>
#include <string>
#include <vector>

#include "arcslip/cases/runs.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/results/results.hpp"

namespace arcslip {

/// Parameters and observables by name. Of a curve of special points the active parameter is an observable; it
/// stands among the parameters, in the base's order. What was traced must outlive it.
class Columns {
 public:
  explicit Columns(const TracedBranch& traced, BranchTable::Detail detail = BranchTable::Detail::full);

  const std::vector<std::string>& names() const { return names_; }

  /// In the order of the names; valid until the next call.
  const std::vector<double>& values(const continuation::BranchPoint& point);

  /// The place of a name, or -1.
  Index find(const std::string& name) const;

  /// Those that tables and summaries show of a special point.
  std::vector<Index> shown() const;

 private:
  void observe(const continuation::BranchPoint& point);
  bool is_told(const continuation::BranchPoint& point) const;
  bool is_constant(const std::string& name) const;

  const continuation::Problem& problem_;
  bool is_drawn_;
  const CaseBranch& request_;
  const std::vector<continuation::BranchPoint>& points_;
  const Matrix* told_ = nullptr;
  std::vector<std::string> names_;
  Index parameters_ = 0;
  Index moved_ = -1;
  std::vector<Index> undefined_;  // of contacts of stiffness 0, which have no slip threshold
  Vector observed_;
  std::vector<double> values_;
};

/// The columns in SI units that a system given in them has besides, and the speed that follows an engine
/// order; none of any other.
class PhysicalColumns {
 public:
  explicit PhysicalColumns(const TracedBranch& traced);

  const std::vector<std::string>& names() const { return names_; }

  /// In the order of the names, from the values of Columns.
  std::vector<double> values(const std::vector<double>& row) const;

  /// Those that the table shows of a special point.
  const std::vector<std::size_t>& shown() const { return shown_; }

 private:
  enum class Unit { frequency, preload, length, energy, force, speed };

  std::optional<PhysicalScale> scale_;
  double per_eta_ = 0;                                 ///< of the speed
  Index threshold_ = -1;                               ///< the column S, or -1
  std::vector<std::pair<std::size_t, Unit>> sources_;  ///< columns that those in SI units are made from
  std::vector<std::string> names_;
  std::vector<std::size_t> shown_;
};

}  // namespace arcslip
