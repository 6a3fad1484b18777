#pragma once

// All zeros of F(u) in a box, by proof: branch and prune with Krawczyk's operator
//
//   K(X) = m - C F(m) + (1 - C F'(X)) (X - m),    C near F'(m)^-1,  m in X,
//
// which holds all zeros that X holds; X holds exactly one where K(X) lies inside of it [Neumaier, Interval
// Methods for Systems of Equations, 1990, ch. 5].

#include <functional>
#include <vector>

#include "arcslip/interval/interval.hpp"
#include "arcslip/types.hpp"

namespace arcslip {

using Box = std::vector<Interval>;  ///< one interval for each unknown

/// Fills all F(u) and all dF/du, row by row, over a box. Throws NoEnclosure where F is not sure to exist.
using EnclosedMap =
    std::function<void(const Box& u, std::vector<Interval>& values, std::vector<Interval>& jacobian)>;

/// What is known of a box.
struct ZerosInBox {
  std::vector<Box> zeros;      ///< narrow ones, each of which holds exactly one zero
  std::vector<Box> undecided;  ///< outside of these and of `zeros` there is none where `finished`
  long boxes = 0;              ///< that were looked at
  bool finished = true;        ///< false where it took too long: then parts of the box were not looked at
  bool proven() const { return finished && undecided.empty(); }
};

/// What bounds the search.
struct BoxOptions {
  long max_boxes = 1000000;          ///< to look at
  double narrowest = 1e-7;           ///< of the box, by sides: what is smaller stays undecided
  std::function<bool()> go_on = {};  ///< asked before each box; false ends the search
};

/// All zeros in a box.
ZerosInBox zeros_in_box(const EnclosedMap& map, const Box& box, const BoxOptions& options = {});

}  // namespace arcslip
