#include "results/study_run.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "cases/design_study.hpp"

namespace arcslip {

namespace {

/// Of the branches the stretches on which they are the highest, with a point more on both sides.
void keep_highest(problems::PreloadStudy& study) {
  std::vector<problems::PeakBranch> kept;
  for (const problems::PeakBranch& branch : study.branches) {
    bool goes_on = false;
    for (std::size_t i = 0; i < branch.size(); ++i) {
      const bool counts = branch[i].is_global || (i > 0 && branch[i - 1].is_global) ||
                          (i + 1 < branch.size() && branch[i + 1].is_global);
      if (counts && !goes_on) kept.emplace_back();
      if (counts) kept.back().push_back(branch[i]);
      goes_on = counts;
    }
  }
  study.branches = std::move(kept);
}

}  // namespace

FinishedDesign study_design(const StudyCase& study, std::size_t curve) {
  StudyDesign design = study.design(curve);
  FinishedDesign finished{curve, std::move(design.values), {}, {}};
  try {
    finished.result = study_preload(study, design);
    if (design.pattern > 0) keep_highest(finished.result);
    if (study.uncertain && study.patterns == 0 && finished.result.failure.empty())
      finished.uncertain = study_uncertainty(study, design, finished.result);
  } catch (const std::bad_alloc&) {
    throw;  // no property of the design
  } catch (const std::exception& error) {
    finished.result.failure = error.what();
  }
  return finished;
}

StudyWorkers::StudyWorkers(const StudyCase& study, std::size_t jobs) : study_(study) {
  for (std::size_t i = 0; i < jobs; ++i)
    threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
}

void StudyWorkers::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (given_.wait(lock, stop, [&] { return !waiting_.empty(); })) {
    if (stop.stop_requested()) return;
    const std::size_t curve = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    FinishedDesign finished;
    std::exception_ptr error;
    try {
      finished = study_design(study_, curve);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (error) {
      error_ = error;
    } else {
      finished_.push_back(std::move(finished));
    }
    done_.notify_one();
  }
}

void StudyWorkers::give(std::size_t curve) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(curve);
  }
  ++open_;
  given_.notify_one();
}

void StudyWorkers::drop() {
  const std::scoped_lock lock(mutex_);
  open_ -= waiting_.size();
  waiting_.clear();
}

std::vector<FinishedDesign> StudyWorkers::take(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  done_.wait_for(lock, patience, [&] { return !finished_.empty() || error_; });
  if (error_) std::rethrow_exception(error_);
  std::vector<FinishedDesign> taken = std::exchange(finished_, {});
  open_ -= taken.size();
  return taken;
}

PendingDesigns::PendingDesigns(std::vector<bool> finished)
    : finished_(std::move(finished)),
      left_(static_cast<std::size_t>(std::count(finished_.begin(), finished_.end(), false))) {}

std::size_t PendingDesigns::next() {
  while (finished_[at_]) ++at_;
  --left_;
  return at_++;
}

std::size_t compute(StudyWorkers& workers, PendingDesigns& pending,
                    const std::function<void(const FinishedDesign&)>& keep,
                    const std::function<bool()>& go_on) {
  std::size_t computed = 0;
  bool going = true;
  while (workers.open() > 0 || (going && pending.left() > 0)) {
    while (going && pending.left() > 0 && workers.open() < workers.wanted()) workers.give(pending.next());
    for (const FinishedDesign& design : workers.take(std::chrono::milliseconds(100))) {
      keep(design);
      ++computed;
    }
    if (going && !go_on()) {
      going = false;
      workers.drop();
    }
  }
  return computed;
}

}  // namespace arcslip
