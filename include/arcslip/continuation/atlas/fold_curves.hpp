#pragma once

// The curves on a triangulated surface along which dF/du is singular.

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "arcslip/continuation/atlas/triangulation.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Serves one thread. All is kept by reference.
class FoldCurves {
 public:
  FoldCurves(const Problem& problem, Surface& surface, Covering& covering, const Triangulation& triangles);

  /// A point on each edge at whose ends det dF/du has different signs, solved for on the surface, in their
  /// order along the curves, with the cusps between them.
  std::vector<AtlasFold> find();

  bool has_failed() const { return has_failed_; }  ///< whether a point could not be solved for

 private:
  struct Place {
    Vector at;                 ///< N
    const Disc* disc;          ///< in whose plane it was found
    bool is_crossing = false;  ///< of sheets
    Eigen::Vector2d across{};  ///< w^T dF/d(p_a, p_b) with w^T dF/du = 0: the image's normal
    double turn = 0;           ///< w^T F_uu v v with dF/du v = 0: 0 at a cusp
  };
  using Edge = std::pair<int, int>;  // of discs, the lower number first
  std::optional<Place> between(const Disc& disc, const Vector& a, const Vector& b, int sides,
                               bool is_crossing);
  bool look(Place& place);
  void add_curve(std::vector<Place> places, std::vector<AtlasFold>& folds);
  std::optional<Place> cusp(const Place& a, const Place& b);
  void follow(const std::map<Edge, std::vector<Edge>>& beside, bool is_crossing,
              std::vector<AtlasFold>& folds);
  bool turns_over(const Edge& edge) const;

  Surface& surface_;
  Covering& covering_;
  const Triangulation& triangles_;
  SecondDerivative second_;
  Matrix plane_;
  std::vector<int> orientations_;  // of the discs
  bool has_failed_ = false;
  int curves_ = 0;
};

}  // namespace arcslip::continuation
