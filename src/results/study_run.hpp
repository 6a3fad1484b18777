#pragma once

// Designs of a study computed by threads.

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "arcslip/cases/study_case.hpp"

namespace arcslip {

struct FinishedDesign {
  std::size_t curve = 0;
  nlohmann::ordered_json values;  ///< what for_each sets on it
  problems::PreloadStudy result;
  std::optional<problems::UncertainPeaks> uncertain;  ///< where the study asks for it

  const problems::UncertainPeaks* scatter() const { return uncertain ? &*uncertain : nullptr; }
};

/// Threads that take designs in the order in which they are given and hand their results back in the order
/// in which they are done. To be used from one thread.
class StudyWorkers {
 public:
  StudyWorkers(const StudyCase& study, std::size_t jobs);
  /// Drops what was not begun, waits for what was.
  ~StudyWorkers() = default;
  StudyWorkers(const StudyWorkers&) = delete;
  StudyWorkers& operator=(const StudyWorkers&) = delete;
  StudyWorkers(StudyWorkers&&) = delete;
  StudyWorkers& operator=(StudyWorkers&&) = delete;

  void give(std::size_t curve);
  /// Drops what was given and is not begun.
  void drop();
  /// How many that were given are still to be taken back.
  std::size_t open() const { return open_; }
  /// How many should be open for all threads to be busy while results are stored.
  std::size_t wanted() const { return 16 * threads_.size(); }
  /// What is finished; waits for the first one, up to this long. Throws what a thread could not bear.
  std::vector<FinishedDesign> take(std::chrono::milliseconds patience);

 private:
  void work(const std::stop_token& stop);

  const StudyCase& study_;
  std::size_t open_ = 0;
  std::mutex mutex_;
  std::condition_variable_any given_;
  std::condition_variable_any done_;
  std::deque<std::size_t> waiting_;
  std::vector<FinishedDesign> finished_;
  std::exception_ptr error_;
  std::vector<std::jthread> threads_;
};

/// The study of one design. What it throws becomes its failure.
FinishedDesign study_design(const StudyCase& study, std::size_t curve);

/// The designs that are not finished, in their order.
class PendingDesigns {
 public:
  explicit PendingDesigns(std::vector<bool> finished);

  std::size_t left() const { return left_; }
  /// The next one; to be asked only while any are left.
  std::size_t next();

 private:
  std::vector<bool> finished_;
  std::size_t at_ = 0;
  std::size_t left_;
};

/// Computes what is pending and hands each design over on the calling thread. `go_on` is asked ten times a
/// second or more often; once it says no, only what runs is ended. Returns how many were handed over.
std::size_t compute(StudyWorkers& workers, PendingDesigns& pending,
                    const std::function<void(const FinishedDesign&)>& keep,
                    const std::function<bool()>& go_on);

}  // namespace arcslip
