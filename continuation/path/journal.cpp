#include "arcslip/continuation/path/journal.hpp"

#include <optional>

namespace arcslip::continuation {

void Journal::begin(bool has_several) {
  const std::scoped_lock lock(mutex_);
  keeps_whole_ = has_several;
  entries_.clear();
  next_ = 0;
}

JournalEntry Journal::next(const std::function<JournalEntry()>& begin,
                           const std::function<JournalEntry(JournalEntry begun)>& go_on) {
  std::optional<JournalEntry> known;
  {
    const std::scoped_lock lock(mutex_);
    if (next_ < entries_.size()) known = entries_[next_];
  }
  const bool done = known && !is_unfinished(known->branch.stop);
  const bool begun = known && !known->branch.points.empty() && known->branch.checkpoint;
  JournalEntry entry = done ? std::move(*known) : begun ? go_on(std::move(*known)) : begin();
  const std::scoped_lock lock(mutex_);
  if (!is_unfinished(entry.branch.stop) && !keeps_whole_) return entry;
  if (next_ == entries_.size()) {
    entries_.push_back(entry);
  } else if (!done) {
    entries_[next_] = entry;
  }
  ++next_;
  return entry;
}

}  // namespace arcslip::continuation
