#pragma once

// What a piece of work has traced, so that the same work, done again after it was interrupted, gets it back.

#include <functional>
#include <iosfwd>
#include <mutex>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"

namespace arcslip::continuation {

/// A branch, or one way along a curve of special points, which has borders of its conditions at its end.
struct JournalEntry {
  Branch branch;                ///< as far as it has come
  std::vector<double> borders;  ///< of the conditions, at its end; empty of a branch
};

/// The branches in the order that they were begun in, which has to be the same whenever the work is done.
/// From the first that was interrupted, or had no more time, none has gone on.
class Journal {
 public:
  /// Of work with a single branch that one is kept only where it is unfinished: once it is whole the work is
  /// done.
  void begin(bool has_several);

  /// The next branch: as it is known, gone on with if it is unfinished, else begun. One that was left before
  /// it had a point is as if it had not been begun.
  JournalEntry next(const std::function<JournalEntry()>& begin,
                    const std::function<JournalEntry(JournalEntry begun)>& go_on);

  /// As text, numbers in hexadecimal. May be written by another thread than that which does the work.
  void write(std::ostream& out) const;

  /// In place of what there is. Throws std::runtime_error where the text is none.
  void read(std::istream& in);

 private:
  mutable std::mutex mutex_;
  bool keeps_whole_ = true;
  std::vector<JournalEntry> entries_;
  std::size_t next_ = 0;
};

}  // namespace arcslip::continuation
