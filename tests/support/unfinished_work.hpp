#pragma once

// Work that is left unfinished, at whatever moment, and done again: it gives what it would have given at
// once.

#include <algorithm>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "arcslip/continuation/path/journal.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "catch.hpp"
#include "same_points.hpp"

namespace arcslip::testing {

using Branches = std::vector<continuation::Branch>;
using Tracing = std::function<Branches(const continuation::TraceOptions&)>;

inline void check_same(const Branches& again, const Branches& whole) {
  REQUIRE(again.size() == whole.size());
  for (std::size_t b = 0; b < whole.size(); ++b) {
    CHECK(again[b].stop == whole[b].stop);
    CHECK(again[b].explanation == whole[b].explanation);
    REQUIRE(again[b].points.size() == whole[b].points.size());
    for (std::size_t i = 0; i < whole[b].points.size(); ++i)
      check_same(again[b].points[i], whole[b].points[i]);
  }
}

/// `work` with a journal that is read from text and written to it.
inline Branches with_journal(const Tracing& work, continuation::TraceOptions options, std::string& kept) {
  continuation::Journal journal;
  std::stringstream text(kept);
  if (!kept.empty()) journal.read(text);
  options.journal = &journal;
  Branches found = work(options);
  std::ostringstream left;
  journal.write(left);
  kept = left.str();
  return found;
}

/// Of `work` whose options are asked `all` times whether to go on; it is interrupted when they have been
/// asked so often, then once more, and then brought to its end. In all they are asked hardly more often.
inline void check_interrupted(const Tracing& work, continuation::TraceOptions options, long samples = 97,
                              long most_lost = 200) {
  long asked = 0;
  options.go_on = [&] { return ++asked > 0; };
  const Branches whole = work(options);
  const long all = asked;
  REQUIRE(all > 50);
  for (long first = 1; first <= all; first += 1 + all / samples) {
    CAPTURE(first, all);
    std::string kept;
    Branches again;
    asked = 0;
    for (const long end : {first, first / 2 + 3, 1000000L}) {
      long left = end;
      options.go_on = [&] { return ++asked, --left > 0; };
      again = with_journal(work, options, kept);
    }
    check_same(again, whole);
    CHECK(asked <= all + most_lost);
  }
}

/// Of `work` that has ever more time, at first none to speak of.
inline void check_out_of_time(const Tracing& work, continuation::TraceOptions options) {
  const Branches whole = work(options);
  std::string kept;
  Branches again;
  bool is_left = true;
  int times = 0;
  for (options.max_seconds = 1e-5; is_left; options.max_seconds *= 2) {
    REQUIRE(++times < 40);
    again = with_journal(work, options, kept);
    is_left =
        again.empty() || std::any_of(again.begin(), again.end(), [](const continuation::Branch& branch) {
          return is_unfinished(branch.stop) || (branch.first_stop && is_unfinished(*branch.first_stop));
        });
  }
  CHECK(times > 1);
  check_same(again, whole);
}

}  // namespace arcslip::testing
