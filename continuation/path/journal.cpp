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
  const bool done = known && known->branch.stop != Stop::interrupted;
  JournalEntry entry = done ? std::move(*known) : known ? go_on(std::move(*known)) : begin();
  const bool has_more = entry.branch.stop == Stop::interrupted;
  const std::scoped_lock lock(mutex_);
  if (has_more ? entry.branch.points.empty() || !entry.branch.checkpoint : !keeps_whole_) return entry;
  if (next_ == entries_.size()) {
    entries_.push_back(entry);
  } else if (!done) {
    entries_[next_] = entry;
  }
  if (!has_more) ++next_;
  return entry;
}

}  // namespace arcslip::continuation
