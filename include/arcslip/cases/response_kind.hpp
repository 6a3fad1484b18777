#pragma once

// What may be asked of a system with friction, as `response` of [branch] names it. Each kind is one file in
// src/cases/responses: NAME.cpp defines `ResponseKind NAME_response()`, and the build finds it.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip {

namespace problems {
class Floquet;
class ForcedResponse;
}  // namespace problems

struct ProblemRequest;

/// A problem with what else can be had of it.
struct Built {
  /// The value of a parameter, by its name.
  using ValueOf = std::function<double(const std::string& parameter)>;
  /// A guess of a solution at these values; max_seconds and go_on of the limits may end the search for it.
  /// Throws std::invalid_argument where there is none, continuation::Unfinished where the search was ended.
  using Guess = std::function<continuation::Guess(const ValueOf&, const continuation::TraceOptions& limits)>;

  std::shared_ptr<const continuation::Problem> problem;                ///< may be shared by threads
  Guess guess;                                                         ///< of its first point
  std::vector<int> harmonics = {1};                                    ///< in which it balances
  std::shared_ptr<const problems::ForcedResponse> enclosed = nullptr;  ///< itself, if branches can be proven
  std::shared_ptr<const problems::Floquet> disturbed = nullptr;        ///< itself, if it knows its stability
  std::vector<continuation::UserEvent> events = {};                    ///< that its elements bring with them
};

/// A kind of response.
struct ResponseKind {
  /// What its frequency is: a parameter, an unknown whose first guess is given, or one that needs none.
  enum class Frequency { parameter, guessed, own };

  std::string name;                     ///< what `response` calls it
  std::string title;                    ///< of many, in messages
  std::vector<std::string> parameters;  ///< that may be continued; the first is held where P is not
  Frequency frequency;                  ///< what its frequency is
  std::string extremum;       ///< the observable whose extrema are looked for unless others are named, or ""
  bool one_way = false;       ///< whether contacts spare the base
  bool in_time = false;       ///< whether the ring in time can be held against it
  std::string not_disturbed;  ///< why no disturbances of it are followed, or ""
  std::string not_proven;     ///< why no branch of it is certified, or ""
  std::string remark;         ///< what `arcslip check` says of it after the range, or ""
  std::function<Built(const ProblemRequest&)> build;  ///< throws std::invalid_argument

  /// Whether its frequency is an unknown.
  bool has_own_frequency() const { return frequency != Frequency::parameter; }
};

/// All of them, in alphabetical order.
const std::vector<ResponseKind>& response_kinds();

/// The one of this name, or null.
const ResponseKind* find_response_kind(const std::string& name);

}  // namespace arcslip
