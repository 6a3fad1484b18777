#include "arcslip/continuation/atlas/fold_curves.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <map>
#include <set>

#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

constexpr double vanishes = 1e-12;  // a shadow, or a function that changes sign: rounding
constexpr double one_place = 1e-9;  // distance of places that are the same

struct NoPlace {};  // leaves the search for a zero

}  // namespace

FoldCurves::FoldCurves(const Problem& problem, Surface& surface, Covering& covering,
                       const Triangulation& triangles)
    : surface_(surface), covering_(covering), triangles_(triangles), second_(problem) {}

/// Where the shadow vanishes above the straight way between two places in a disc's plane, on sides of the box
/// that both are on, or of a crossing where the orientation turns over.
std::optional<FoldCurves::Place> FoldCurves::between(const Disc& disc, const Vector& a, const Vector& b,
                                                     int sides, bool is_crossing) {
  Place found{a, &disc, is_crossing};
  const auto try_at = [&](double share) -> std::optional<double> {
    found.at = a + share * (b - a);
    if (!covering_.lift(disc, found.at, sides) || !surface_.tangent(found.at, disc.plane, plane_))
      return std::nullopt;
    return is_crossing ? surface_.orientation(plane_) : Surface::shadow(plane_);
  };
  const auto value = [&](double share) {
    constexpr double beside = 1e-5;
    if (const auto here = try_at(share)) return *here;
    const auto before = try_at(share - beside);  // where sheets cross F_x vanishes: the middle of both sides
    const Vector at_before = found.at;
    const auto behind = try_at(share + beside);
    if (!before || !behind) throw NoPlace();
    found.at = (at_before + found.at) / 2;
    return (*before + *behind) / 2;
  };
  try {
    const double at_a = value(0);
    const double at_b = value(1);
    if (at_a * at_b > 0 && std::min(std::abs(at_a), std::abs(at_b)) > vanishes) return std::nullopt;
    value(zero_between(value, 0, 1, at_a, at_b));
  } catch (const NoPlace&) {
    return std::nullopt;
  }
  return look(found) ? std::optional(found) : std::nullopt;
}

/// Null vectors of dF/du, and what they tell of the fold.
bool FoldCurves::look(Place& place) {
  place.across.setZero();
  place.turn = 0;
  if (!surface_.tangent(place.at, place.disc->plane, plane_)) return true;  // sheets cross here
  const Index n = surface_.size() - 2;
  const Eigen::JacobiSVD<Matrix> values(surface_.derivative().leftCols(n),
                                        Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector left = values.matrixU().col(n - 1);
  place.across = surface_.derivative().rightCols<2>().transpose() * left;
  left = left.cwiseQuotient(surface_.row_lengths());
  const Guess at = surface_.solution(place.at);
  const Vector right = values.matrixV().col(n - 1).cwiseProduct(surface_.scale());
  Vector along;
  if (!second_.contract(at.unknowns, at.parameters, at.regime, left, right,
                        Vector::Zero(at.parameters.size()), along))
    return false;
  place.turn = along.head(n).dot(right);
  return true;
}

/// Between two neighbours on a curve of folds that turns there, by zeros across it within the zero along it.
std::optional<FoldCurves::Place> FoldCurves::cusp(const Place& a, const Place& b) {
  const Disc& disc = *a.disc;
  const Vector along = disc.plane * (disc.plane.transpose() * (b.at - a.at));
  const Eigen::Vector2d in_plane = disc.plane.transpose() * along;
  const Vector across = disc.plane * Eigen::Vector2d(-in_plane(1), in_plane(0));
  std::optional<Place> found;
  const auto turn = [&](double share) {
    const Vector middle = a.at + share * (b.at - a.at);
    for (double width = 0.05; width < 2; width *= 2) {
      found = between(disc, middle - width * across, middle + width * across, 0, false);
      if (found) break;
    }
    if (!found) throw NoPlace();
    return found->turn * (found->across.dot(a.across) < 0 ? -1 : 1);
  };
  try {
    const double at_b = b.turn * (b.across.dot(a.across) < 0 ? -1 : 1);
    turn(zero_between(turn, 0, 1, a.turn, at_b));
  } catch (const NoPlace&) {
    return std::nullopt;
  }
  return found;
}

/// Adds places that follow each other, with the cusps between them.
void FoldCurves::add_curve(std::vector<Place> places, std::vector<AtlasFold>& folds) {
  const auto apart = [](const Place& a, const Place& b) { return (a.at - b.at).norm(); };
  places.erase(std::unique(places.begin(), places.end(),
                           [&](const Place& a, const Place& b) { return apart(a, b) < one_place; }),
               places.end());
  double largest = 0;
  for (const Place& one : places) largest = std::max(largest, std::abs(one.turn));
  const auto add = [&](const Place& place, PointType type) {
    const Guess at = surface_.solution(place.at);
    folds.push_back({type, curves_, at.unknowns, at.parameters});
  };
  const auto is_cusp = [&](const Place& place) { return std::abs(place.turn) <= one_place * largest; };
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& here = places[i];
    add(here, here.is_crossing ? PointType::branch_point : is_cusp(here) ? PointType::cusp : PointType::fold);
    if (i + 1 == places.size()) continue;
    const Place& next = places[i + 1];
    if (is_cusp(here) || is_cusp(next) || here.is_crossing || next.is_crossing) continue;
    if (here.turn * next.turn * here.across.dot(next.across) >= 0) continue;
    const std::optional<Place> turned = cusp(here, next);
    if (turned) {
      add(*turned, PointType::cusp);
    } else {
      has_failed_ = true;
    }
  }
  ++curves_;
}

/// The places on these edges, each of which leads to those beside it, in the order of the curves.
void FoldCurves::follow(const std::map<Edge, std::vector<Edge>>& beside, bool is_crossing,
                        std::vector<AtlasFold>& folds) {
  std::set<Edge> passed;
  const auto follow = [&](Edge edge) {
    const Edge first = edge;
    std::vector<Place> places;
    for (bool goes_on = true; goes_on;) {
      passed.insert(edge);
      const Disc& a = covering_.discs()[static_cast<std::size_t>(edge.first)];
      const Disc& b = covering_.discs()[static_cast<std::size_t>(edge.second)];
      if (auto place = between(a, a.at, b.at, a.sides & b.sides, is_crossing)) {
        place->is_crossing = turns_over(edge);
        places.push_back(*place);
      } else {
        has_failed_ = true;
      }
      const std::vector<Edge>& next = beside.at(edge);
      const auto on =
          std::find_if(next.begin(), next.end(), [&](const Edge& one) { return passed.count(one) == 0; });
      goes_on = on != next.end();
      if (goes_on) edge = *on;
    }
    const std::vector<Edge>& last = beside.at(edge);
    if (beside.at(first).size() == 2 && std::count(last.begin(), last.end(), first) > 0 && !places.empty())
      places.push_back(places.front());
    add_curve(std::move(places), folds);
  };
  for (const bool from_ends : {true, false}) {
    for (const auto& [edge, next] : beside) {
      if (passed.count(edge) == 0 && (next.size() == 1) >= from_ends) follow(edge);
    }
  }
}

/// Whether the orientation differs between an edge's ends, as where another sheet crosses.
bool FoldCurves::turns_over(const Edge& edge) const {
  return orientations_[static_cast<std::size_t>(edge.first)] !=
         orientations_[static_cast<std::size_t>(edge.second)];
}

std::vector<AtlasFold> FoldCurves::find() {
  std::vector<bool> is_positive;
  for (const Disc& disc : covering_.discs()) {
    is_positive.push_back(Surface::shadow(disc.plane) > -vanishes);
    orientations_.push_back(surface_.tangent(disc.at, disc.plane, plane_) ? surface_.orientation(plane_) : 1);
  }
  std::vector<AtlasFold> folds;
  for (const bool is_crossing : {false, true}) {
    std::map<Edge, std::vector<Edge>> beside;
    for (const Triangulation::Face& face : triangles_.faces()) {
      std::vector<Edge> crossed;
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge = std::minmax(face[i], face[(i + 1) % 3]);
        const bool is_fold = is_positive[static_cast<std::size_t>(edge.first)] !=
                             is_positive[static_cast<std::size_t>(edge.second)];
        if (is_crossing ? turns_over(edge) && !is_fold : is_fold) crossed.push_back(edge);
      }
      if (crossed.size() != 2) continue;
      beside[crossed[0]].push_back(crossed[1]);
      beside[crossed[1]].push_back(crossed[0]);
    }
    follow(beside, is_crossing, folds);
  }
  return folds;
}

}  // namespace arcslip::continuation
