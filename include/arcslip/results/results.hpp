#pragma once

// Traced branches as files and tables: branches.csv, summary.json, and the rows of special points.

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// Takes pieces of a text in order.
using Sink = std::function<void(std::string_view)>;

/// One row for each point, with as many digits as give back each number: branch, point, type, regime, the
/// parameters, the observables, where points tell their stability how many eigenvalues are unstable,
/// arclength, iterations, residual; of a system given in SI units the same in these: frequency_Hz,
/// preload_N_per_m, R_m, S_m, Y_m, U_m, dissipated_J, T_max_N.
class BranchTable {
 public:
  /// What pictures need has ten digits, and nan for what a smooth response with stability says of its
  /// verdict, which takes much longer than all else.
  enum class Detail { full, drawn };

  BranchTable() = default;

  /// With the columns that `header` gives.
  explicit BranchTable(std::string_view header);

  /// The columns of a branch are added to those of the branches before it.
  void widen(const TracedBranch& traced);

  /// The names of the columns, with commas between and a newline.
  std::string header() const;

  /// The rows of a branch whose columns are known, with nan in those that it does not have.
  std::string rows(std::size_t number, const TracedBranch& traced, Detail detail = Detail::full) const;

  /// A row that was made when `before` had fewer columns, with those that were added since.
  std::string widened(std::string_view row, const BranchTable& before) const;

  /// A row of this table without the columns that `before` had not.
  std::string narrowed(std::string_view row, const BranchTable& before) const;

  /// Whether both have the same columns.
  bool operator==(const BranchTable&) const = default;

 private:
  std::vector<std::string> names_;     ///< parameters and observables
  bool stability_ = false;             ///< whether points tell it
  std::vector<std::string> physical_;  ///< of a system given in SI units
};

/// The whole table.
void write_branches(const std::vector<TracedBranch>& traced, const Sink& sink);

/// A branch as summary.json has it.
nlohmann::ordered_json summarize(std::size_t number, const TracedBranch& traced);

/// The same of one that no problem could be built for, and why.
nlohmann::ordered_json summary_of_failed(std::size_t number, const CaseBranch& request,
                                         const std::string& why);

/// summary.json as described in the manual.
nlohmann::ordered_json summarize(const Case& input, const std::vector<TracedBranch>& traced, double seconds);

/// The nondimensional groups of a system with friction, and the units of one given in SI units, with the
/// frequencies of its parts.
std::string describe_groups(const ProblemRequest& problem);
std::string describe_units(const ProblemRequest& problem);

/// The modes that stand for each finite-element sector, and how far their response is from that of the
/// matrices, or on the full path what was solved: one line for each, and the same as JSON.
std::string describe_modes(const SystemParameters& system);
nlohmann::ordered_json modes_to_json(const SystemParameters& system);

/// Rows of special points, as AUTO prints them; `number` is the branch's.
std::string special_table(std::size_t number, const TracedBranch& traced);

/// How many harmonics friction is balanced in, one line, or nothing where it is one.
std::string describe_harmonics(const TracedBranch& traced);

/// The line above such rows.
std::string special_table_header(const TracedBranch& traced);

}  // namespace arcslip
