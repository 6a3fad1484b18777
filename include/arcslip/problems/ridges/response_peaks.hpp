#pragma once

// The peaks of an observable g over one parameter of a problem, and how high they are as a second one varies:
//
//   L(a, b) = ln g(u(a, b), a, b),   F(u, a, b) = 0
//
// At a smooth peak dL/da = 0, so that its height changes by the partial derivative dL/db alone. On a corner,
// where dL/da jumps from L_a- > 0 to L_a+ < 0 along a curve a = c(b), L is the same on both sides, hence
//
//   L_a- c' + L_b- = L_a+ c' + L_b+,   dL/db = L_b- + L_a- c',
//
// also with another coordinate along the response in place of a, where it is vertical: nothing has to be
// known of what makes the corner. Every response is traced whole, so that a peak is found whether or not a
// neighbouring b has it.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::problems {

/// What is traced, over `along` from one value to another, and whose peaks are followed over `across`.
struct PeakedResponse {
  std::shared_ptr<const continuation::Problem> problem;  ///< may be shared by threads
  std::string along;                                     ///< a parameter, a above
  std::string across;                                    ///< another one, b above
  double from = 0;                                       ///< of `along`, > 0
  double to = 0;                                         ///< > from
  std::string objective;                                 ///< an observable > 0 with a gradient
  continuation::Guess start;           ///< a solution at `from`, for some value > 0 of `across`
  continuation::TraceOptions options;  ///< tolerance and limits of steps
  bool is_polished = false;  ///< whether peaks are located beside the response, from roughly where they are
  /// Why it may end at a value of `along`, as a clause; empty where nothing is known.
  std::function<std::string(double)> reason_of_end = {};
};

/// What makes a peak.
enum class ResponsePeakSite {
  smooth,  ///< dL/da = 0
  corner,  ///< dL/da changes its sign by a jump
  edge     ///< on an end of the window, towards which L rises
};

/// A peak of L over a, at one b.
struct ResponsePeak {
  ResponsePeakSite site = ResponsePeakSite::smooth;  ///< what makes it
  continuation::Guess at;  ///< the solution there; at a corner in the regime before it
  double place = 0;        ///< a
  double log_height = 0;   ///< L
  double slope = 0;        ///< dL/d ln b of the peak
};

/// The highest of some peaks, the first of several.
std::size_t highest_of(const std::vector<ResponsePeak>& peaks);

/// To be used from one thread.
class ResponsePeaks {
 public:
  /// Throws std::invalid_argument where the objective has no gradient, or where there are no such names.
  explicit ResponsePeaks(PeakedResponse response);

  /// All peaks at a value of `across`, one at least, in the order of the response. Throws std::runtime_error,
  /// or Unfinished for want of time, where it cannot be traced from end to end.
  std::vector<ResponsePeak> at(double across);

  /// The peak next to a guess, at the guess's own `across`: where `site` is an edge the solution there, if
  /// the height still rises towards it. None where it is not met within a few steps, or is a corner.
  std::optional<ResponsePeak> next_to(const continuation::Guess& guess, ResponsePeakSite site);

  /// The whole response there; what `at` throws.
  continuation::Branch response_at(double across);

  /// How many responses were traced.
  long traced() const { return traced_; }

  /// The position of that parameter.
  Index across() const { return across_; }

  /// What was asked for.
  const PeakedResponse& response() const { return response_; }

 private:
  class Slopes;

  /// Where a response begins or ends, with the solutions that are known there, by rising values of `across`.
  struct End {
    double place;  ///< of `along`
    std::vector<continuation::Guess> known;
  };
  static continuation::Guess guess_at(const continuation::BranchPoint& point);
  std::vector<continuation::Guess>::iterator found_at(End& end, double across) const;
  const continuation::Guess* start(End& end, double across, std::string& why_not);
  continuation::Branch trace_from(End& end, double across, bool is_rough);
  continuation::Branch trace_from(End& end, double across, bool is_rough, double longest);
  continuation::Branch traced_at(double across, bool is_rough);
  void remember(End& end, const continuation::BranchPoint& point) const;
  bool knows_last(double across);
  std::optional<std::vector<ResponsePeak>> peaks_of(const continuation::Branch& branch, bool is_rough);
  void add_peak(const continuation::Branch& branch, std::size_t i, std::vector<ResponsePeak>& peaks);
  /// An end of a branch, which is a peak where the height rises towards it.
  struct Edge {
    ResponsePeak peak;
    double slope;  // of ln height
  };
  Edge edge(const continuation::Guess& at);
  std::optional<ResponsePeak> rising_edge(const continuation::Guess& at);
  std::optional<ResponsePeak> edge_next_to(const continuation::Guess& guess);
  std::optional<continuation::Guess> level_next_to(const continuation::Guess& guess, Vector& direction) const;
  bool is_inside(const continuation::Guess& at) const;
  bool rises_to(const continuation::BranchPoint& point, const ResponsePeak& peak) const;
  ResponsePeak corner(const continuation::Guess& before, const continuation::Guess& behind,
                      const Vector& direction);
  continuation::Guess beside(const continuation::Branch& branch, std::size_t i, int way) const;

  PeakedResponse response_;
  Index along_;
  Index across_;
  Index objective_;
  std::shared_ptr<Slopes> slopes_;
  End first_{};  ///< at `from`
  End last_{};   ///< at `to`
  long traced_ = 0;
};

}  // namespace arcslip::problems
