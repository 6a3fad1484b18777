#pragma once

// What a study stores of each design beside its optimum and its peaks. Tables: `units`, of designs given in
// SI units what one of each nondimensional quantity is; `harmonics`, of designs with harmonics = "auto" those
// that were taken; `robust` and `quantiles`, of designs that scatter the
// preload at which the 95 % quantile of the highest peak is lowest, and quantiles at many preloads.

#include <optional>
#include <string>

#include "arcslip/cases/study_case.hpp"
#include "results/database.hpp"

namespace arcslip {

/// A column of a file that is computed from the tables.
struct ExtraColumn {
  std::string name;
  std::string value;  ///< in SQL: of the design d, its units u, its peak s
};

/// Of columns of quantiles, which are named by per cents: q5.
std::vector<std::string> quantile_names(const problems::Uncertainty& uncertainty, const char* prefix = "");

class StudyExtras {
 public:
  explicit StudyExtras(const StudyCase& study);

  /// SQL that makes the tables.
  std::string tables() const;
  void open(const Database& database);
  void close();
  /// Stores what belongs to a design.
  void add(std::size_t curve, const problems::PreloadStudy& result,
           const problems::UncertainPeaks* uncertain);

  bool has_harmonics() const { return has_harmonics_; }
  bool has_robust() const { return study_.uncertain && study_.patterns == 0; }
  bool has_quantiles() const { return has_robust() && study_.sweep; }

  /// Columns in SI units, none of a study without them, and what joins `units` to designs d.
  std::vector<ExtraColumn> optimum_columns() const;
  std::vector<ExtraColumn> sweep_columns() const;
  std::string join_units() const;

  /// Columns of robust.csv and quantiles.csv but for the keys of for_each.
  std::vector<ExtraColumn> robust_columns() const;
  std::vector<ExtraColumn> quantile_columns() const;

 private:
  bool is_physical() const { return !study_.preload_unit.empty(); }
  /// "preload_low_N_per_m"
  std::string preload_name(const char* which = "") const {
    return std::string("preload_") + which + study_.preload_unit;
  }

  StudyCase study_;
  bool has_harmonics_;
  std::optional<Statement> insert_harmonics_;
  std::optional<Statement> insert_units_;
  std::optional<Statement> insert_robust_;
  std::optional<Statement> insert_quantiles_;
};

}  // namespace arcslip
