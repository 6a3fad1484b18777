#pragma once

// The results of a study on the disk, DIR/study.sqlite: finished designs in transactions of as many as come
// within a moment, so that a study that was killed at any moment goes on where it was then. Tables: `study`
// (the input), `runs` (when it was worked on), `designs` (one row each: what for_each sets, the optimum, the
// free peak, why it failed), `sweep` (the peaks at each preload) and those of study_extras.hpp.

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/cases/study_case.hpp"
#include "arcslip/results/results.hpp"
#include "results/database.hpp"
#include "results/study_checksum.hpp"
#include "results/study_extras.hpp"

namespace arcslip {

/// What a table on the screen shows of a design.
struct StoredDesign {
  std::size_t curve = 0;      ///< which of the designs
  std::size_t item = 0;       ///< which of the study's items, that and a pattern of it
  std::string kind;           ///< of the optimum, or "failed"
  std::string failure;        ///< why, or empty
  double preload = 0;         ///< P_opt
  double eta = 0;             ///< eta_opt
  double Y = 0;               ///< Y_opt
  double ratio = 0;           ///< Y_opt/Y_nd_max
  double free_eta = 0;        ///< of the highest amplitude without damper
  double robust_preload = 0;  ///< P_q95; nan of a study without scatter
  double robust_ratio = 0;    ///< Y_q95/Y_nd_max
  std::string harmonics;      ///< that were added as the best preload asked for, "1 3 5"; else empty
};

class StudyStore {
 public:
  /// Goes on with the study in the folder, if there is one and `resume` is true; otherwise begins a new one
  /// in its place. Throws InputError where the study there is another one or damaged, OutputError.
  StudyStore(const std::string& folder, const StudyCase& study, bool resume);
  /// Ends the transaction.
  ~StudyStore();
  StudyStore(const StudyStore&) = delete;
  StudyStore& operator=(const StudyStore&) = delete;
  StudyStore(StudyStore&&) = delete;
  StudyStore& operator=(StudyStore&&) = delete;

  /// Which designs are stored.
  std::vector<bool> finished() const;

  /// Stores a design whole, `uncertain` if the study asks for it, in a transaction that goes on.
  void add(std::size_t curve, const nlohmann::ordered_json& values, const problems::PreloadStudy& result,
           const problems::UncertainPeaks* uncertain = nullptr);

  /// Ends the transaction, if it began a moment ago: to be called while there is nothing to store, too.
  void keep();

  bool has_robust() const { return extras_.has_robust(); }
  bool has_quantiles() const { return extras_.has_quantiles(); }

  /// Of a study of patterns, for the file of the same name and those of their quantiles.
  void write_patterns(const Sink& sink) const;
  /// The stored peaks of one of the items.
  std::vector<problems::PeakBranch> branches(std::size_t item) const;

  /// All designs, of patterns the equal rings alone, or every item that failed.
  enum class Which { all, failed };
  /// In the order of the items, until the visitor returns false.
  void visit(Which which, const std::function<bool(const StoredDesign&)>& visitor) const;

  /// optimum.csv, sweep.csv, robust.csv, quantiles.csv, in the order of the designs and of their peaks.
  void write_optimum(const Sink& sink) const;
  void write_sweep(const Sink& sink) const;
  void write_robust(const Sink& sink) const;
  void write_quantiles(const Sink& sink) const;

  /// Ends the transaction and leaves the database as one file that is read without others beside it.
  void tidy();

 private:
  using Clock = std::chrono::steady_clock;

  void begin(const StudyCase& study);
  void check_same(const StudyCase& study) const;
  void open();
  void insert(std::size_t curve, const nlohmann::ordered_json& values, const problems::PreloadStudy& result,
              const problems::UncertainPeaks* uncertain);
  void abandon_design();
  void end_batch();
  void add_sweep(std::size_t curve, const problems::PreloadStudy& result);

  std::string folder_;
  std::string path_;
  std::vector<std::string> keys_;
  std::size_t count_;
  std::size_t each_;  // rings of a design
  bool sweep_;
  StudyExtras extras_;
  std::int64_t run_ = 0;
  std::optional<Database> database_;
  std::optional<Statement> insert_design_;
  std::optional<Statement> insert_peak_;
  std::optional<DesignChecksums> checksums_;
  std::optional<Clock::time_point> batch_begun_;
};

}  // namespace arcslip
