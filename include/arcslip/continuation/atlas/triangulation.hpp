#pragma once

// The triangles of discs that cover a surface.

#include <array>
#include <map>
#include <vector>

#include "arcslip/continuation/atlas/covering.hpp"

namespace arcslip::continuation {

/// Where three polygons meet at a corner their discs make a triangle, if all three say so. What is left
/// open, as where four discs lie on one circle and rounding tells which two of them touch, is filled by the
/// shortest edges.
class Triangulation {
 public:
  using Face = std::array<int, 3>;

  explicit Triangulation(const std::vector<Disc>& discs);

  const std::vector<Face>& faces() const { return faces_; }

  /// The discs on edges with a triangle on one side only, but for edges on a side of the box: where the
  /// surface is not covered.
  const std::vector<int>& rims() const { return rims_; }

  /// For each disc the least number of one that it hangs together with.
  std::vector<int> components() const;

  /// Whether an edge has a triangle on its left.
  bool has(int from, int to) const { return third_.count({from, to}) > 0; }

 private:
  void meet();
  bool add(const Face& face);
  void close();
  bool fill(std::vector<int> loop);
  std::vector<int> around(int from, int to) const;
  bool on_side(int a, int b) const;

  const std::vector<Disc>& discs_;
  std::vector<Face> faces_;
  std::map<std::pair<int, int>, int> third_;  // corner of the triangle on an edge's left
  std::vector<int> rims_;
};

}  // namespace arcslip::continuation
