#include "arcslip/continuation/atlas/covering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {
namespace {

constexpr int torn = -10;          // beyond an edge: a place where no disc could be added
constexpr double upright = 1e-6;   // slope of a parameter in a plane that never leads to the box's side
constexpr double same = 1e-9;      // distance of two places that are one: both are solved for to rounding
constexpr double smallest = 1e-5;  // radius of a disc

Eigen::Index parameter_of(int side) { return side / 2; }
bool is_low(int side) { return side % 2 == 0; }
bool has(int sides, int side) { return (sides >> side & 1) != 0; }

/// Cosine of the largest angle between two planes; -1 where they face opposite ways.
double cosine(const Matrix& a, const Matrix& b) {
  const Eigen::Matrix2d between = a.transpose() * b;
  const double determinant = between.determinant();
  if (determinant <= 0) return -1;
  const double sum = between.squaredNorm();
  return std::sqrt(
      std::max(0.0, (sum - std::sqrt(std::max(0.0, sum * sum - 4 * determinant * determinant))) / 2));
}

}  // namespace

Covering::Covering(Surface& surface, const AtlasOptions& options)
    : surface_(surface), options_(options), unknowns_(surface.size() - 2), rows_(2, surface.size()) {}

/// How far inside the box a disc's centre is, and the direction in its plane in which that falls fastest,
/// with the rate.
double Covering::gap(const Disc& disc, int side) const {
  const double value = disc.at(unknowns_ + parameter_of(side));
  return has(disc.sides, side) ? 0 : is_low(side) ? value : 1 - value;
}
Eigen::Vector2d Covering::towards(const Disc& disc, int side) const {
  return (is_low(side) ? -1 : 1) * disc.plane.row(unknowns_ + parameter_of(side)).transpose();
}

bool Covering::lift(const Disc& disc, Vector& x, int sides) {
  Eigen::Vector2d values;
  Index held = 0;
  rows_.setZero();
  for (int side = 0; side < 4; ++side) {
    if (!has(sides, side)) continue;
    if (held == 2) return false;
    rows_(held, unknowns_ + parameter_of(side)) = 1;
    values(held++) = is_low(side) ? 0 : 1;
  }
  if (held == 1) {
    const Eigen::Vector2d out = disc.plane.transpose() * rows_.row(0).transpose();
    if (out.norm() < upright) return false;
    rows_.row(1) = (disc.plane * Eigen::Vector2d(-out(1), out(0)).normalized()).transpose();
  } else if (held == 0) {
    rows_ = disc.plane.transpose();
  }
  if (held < 2) values.tail(2 - held) = rows_.bottomRows(2 - held) * x;
  if (!surface_.settle(x, rows_, values)) return false;
  for (int side = 0; side < 4; ++side) {
    if (has(sides, side)) x(unknowns_ + parameter_of(side)) = is_low(side) ? 0 : 1;
  }
  return true;
}

/// Whether the surface hardly turns over a disc of this radius.
bool Covering::is_flat(const Disc& disc, double radius) {
  constexpr int probes = 6;
  constexpr double least = 0.1;  // of the radius, what is worth a look between the centre and the box's side
  for (int i = 0; i < probes; ++i) {
    const double angle = (i + 0.25) * two_pi / probes;
    const Eigen::Vector2d ahead(radius * std::cos(angle), radius * std::sin(angle));
    double share = 1;
    for (int side = 0; side < 4; ++side) {
      const double rate = towards(disc, side).dot(ahead);
      if (rate > 0) share = std::min(share, std::max(0.0, gap(disc, side)) / rate);
    }
    if (share < least) continue;
    lifted_ = disc.at + share * (disc.plane * ahead);
    if (!lift(disc, lifted_) || !surface_.tangent(lifted_, disc.plane, plane_)) return false;
    if (cosine(disc.plane, plane_) < std::cos(options_.max_turn)) return false;
  }
  return true;
}

bool Covering::fit_radius(Disc& disc, double radius) {
  constexpr double less = 0.6;
  while (!is_flat(disc, radius)) {
    radius *= less;
    if (radius < smallest) return false;
  }
  disc.radius = radius;
  return true;
}

/// Whether another disc's centre lies on the sheet that this one's plane touches: by two steps towards it.
bool Covering::is_one_sheet(const Disc& disc, const Disc& other) {
  constexpr double near = 0.5;  // cosine below which discs are none of neighbours
  const Vector away = other.at - disc.at;
  const Eigen::Vector2d s = disc.plane.transpose() * away;
  if ((away - disc.plane * s).norm() > s.norm() || cosine(disc.plane, other.plane) < near) return false;
  Vector x = disc.at + 0.5 * (disc.plane * s);
  if (!lift(disc, x)) return false;
  x = disc.at + 4 * (x - disc.at) - disc.plane * s;  // what is off the plane grows with the square
  return lift(disc, x) && (x - other.at).norm() < same * (1 + other.at.norm());
}

bool Covering::is_covered(const Vector& x) {
  for (const auto& [distance, i] : near(x, 0)) {
    const Disc& disc = discs_[i];
    if (distance > disc.radius) continue;
    Vector there = disc.at + disc.plane * (disc.plane.transpose() * (x - disc.at));
    if (lift(disc, there) && (there - x).norm() < same * (1 + x.norm())) return true;
  }
  return false;
}

void Covering::fail(const Vector& x) {
  if (!failure_.empty()) return;
  const Guess at = surface_.solution(x);
  const auto value = [&](std::size_t k) { return at.parameters(surface_.sides()[k].parameter); };
  failure_ = fmt::format("{} at {} = {:.10g}, {} = {:.10g}",
                         has_left_ ? "the surface leaves its regime, beyond which it has another slope,"
                                   : "Newton's method found no further chart",
                         options_.parameters[0], value(0), options_.parameters[1], value(1));
}

/// As wide as discs that are neighbours may be apart.
Covering::Cell Covering::cell(const Vector& x) const {
  const double width = 2 * options_.max_radius;
  return {std::lround(x(unknowns_) / width), std::lround(x(unknowns_ + 1) / width)};
}

/// The discs to which it is less than twice the radius, or theirs, with the distance, the nearest first.
std::vector<std::pair<double, std::size_t>> Covering::near(const Vector& x, double radius) const {
  const Cell here = cell(x);
  std::vector<std::pair<double, std::size_t>> found;
  for (long a = here[0] - 1; a <= here[0] + 1; ++a) {
    for (long b = here[1] - 1; b <= here[1] + 1; ++b) {
      const auto there = cells_.find({a, b});
      if (there == cells_.end()) continue;
      for (const std::size_t i : there->second) {
        const double distance = (discs_[i].at - x).norm();
        if (distance < 2 * std::max(radius, discs_[i].radius)) found.emplace_back(distance, i);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Makes a disc's polygon, and cuts those of its neighbours: each ends at the box and half way to the next
/// one, however large these are, so that discs become larger step by step.
void Covering::outline(std::size_t which) {
  constexpr double rounding = 1e-12;
  Disc& disc = discs_[which];
  disc.polygon = Polygon(disc.radius, Disc::open);
  for (int side = 0; side < 4; ++side) {
    const Eigen::Vector2d out = towards(disc, side);
    if (out.norm() > upright && !has(disc.missed, side))
      disc.polygon.cut(out, gap(disc, side), Disc::side(side));
  }
  const auto way = [](const Disc& from, const Disc& to) -> Eigen::Vector2d {
    return from.plane.transpose() * (to.at - from.at);
  };
  const auto reaches = [&](const Disc& one, const Eigen::Vector2d& s) {
    return one.polygon.reach(s) > (0.5 + rounding) * s.squaredNorm();
  };
  for (const auto& [distance, i] : near(disc.at, disc.radius)) {
    Disc& other = discs_[i];
    const Eigen::Vector2d there = way(disc, other);
    const Eigen::Vector2d back = way(other, disc);
    if (i == which || (!reaches(disc, there) && !reaches(other, back))) continue;
    if (!is_one_sheet(disc, other) && !is_one_sheet(other, disc)) continue;
    if (reaches(disc, there)) disc.polygon.cut(there, there.squaredNorm() / 2, static_cast<int>(i));
    if (reaches(other, back)) other.polygon.cut(back, back.squaredNorm() / 2, static_cast<int>(which));
  }
}

/// Where a disc's polygon is not covered: at the box's side, which must have discs of its own, or beyond the
/// rim.
std::optional<Covering::Opening> Covering::opening(const Disc& disc) const {
  constexpr double beyond = 1 + 1e-9;
  const Polygon& polygon = disc.polygon;
  const std::vector<Polygon::Corner>& corners = polygon.corners();
  const auto own = [&](std::size_t i) {
    for (int side = 0; side < 4; ++side) {
      if (has(disc.sides, side) && corners[i].beyond == Disc::side(side)) return 1 << side;
    }
    return 0;
  };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int side = -2 - corners[i].beyond;
    if (side < 0 || side > 3 || has(disc.sides, side)) continue;
    const Eigen::Vector2d& a = corners[i].at;
    const Eigen::Vector2d& b = corners[polygon.after(i)].at;
    const double share = std::clamp(-a.dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    Opening found{a + share * (b - a), 1 << side};
    if (const int before = own(polygon.before(i))) found = {a, before | 1 << side};
    if (const int behind = own(polygon.after(i))) found = {b, behind | 1 << side};
    if (found.at.norm() < disc.radius) return found;
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t before = polygon.before(i);
    const double distance = corners[i].at.norm();
    if (distance <= beyond * disc.radius || corners[i].beyond == torn || corners[before].beyond == torn)
      continue;
    return Opening{disc.radius / distance * corners[i].at, own(i) | own(before)};
  }
  return std::nullopt;
}

/// The centre and the plane of a disc that is to lie above a point of another one's plane, on these sides of
/// the box.
bool Covering::put(const Disc& from, const Opening& opening, Disc& disc) {
  disc.sides = opening.sides;
  disc.at = from.at + from.plane * opening.at;
  return lift(from, disc.at, disc.sides) && surface_.tangent(disc.at, from.plane, disc.plane);
}

/// Moves a disc onto the sides of the box that it lies beyond or so near that no other disc fits in between.
/// False where it lies beyond one and cannot be moved.
bool Covering::put_on_near_sides(Disc& disc) {
  constexpr double near = 0.4;  // of the radius
  for (int moved = 0; moved < 2; ++moved) {
    int nearest = -1;
    Eigen::Vector2d foot;
    for (int side = 0; side < 4; ++side) {
      if (has(disc.sides, side)) continue;
      Eigen::Vector2d out = towards(disc, side);
      for (int other = 0; other < 4; ++other) {  // along the side that it is on
        if (!has(disc.sides, other)) continue;
        const Eigen::Vector2d across = towards(disc, other).normalized();
        out -= out.dot(across) * across;
      }
      const double distance = gap(disc, side) / out.norm();
      if (!(out.norm() > upright) || distance > near * disc.radius) continue;
      if (nearest >= 0 && distance > foot.norm()) continue;
      nearest = side;
      foot = distance * out.normalized();
    }
    if (nearest < 0) break;
    Disc there = disc;
    if (put(disc, {foot, disc.sides | 1 << nearest}, there)) {
      disc = std::move(there);
    } else {
      break;
    }
  }
  for (int side = 0; side < 4; ++side) {
    if (gap(disc, side) < 0) return false;
  }
  return true;
}

/// Adds a disc with at most this radius, and cuts its polygon and those of its neighbours.
bool Covering::add(Disc disc, double radius) {
  has_left_ = !surface_.is_inside(disc.at);
  if (has_left_ || !fit_radius(disc, radius)) return false;
  const int before = disc.sides;
  if (!put_on_near_sides(disc)) return false;
  has_left_ = !surface_.is_inside(disc.at);
  if (has_left_) return false;
  if (disc.sides != before && !fit_radius(disc, disc.radius)) return false;
  const auto others = near(disc.at, 0);
  if (!others.empty() && others.front().first < same && is_one_sheet(disc, discs_[others.front().second]))
    return false;
  cells_[cell(disc.at)].push_back(discs_.size());
  discs_.push_back(std::move(disc));
  unfinished_.push_back(discs_.size() - 1);
  outline(discs_.size() - 1);
  return true;
}

/// Adds a disc where one has an opening; false if it has none.
bool Covering::extend(std::size_t which) {
  constexpr double growth = 2;
  const std::optional<Opening> found = opening(discs_[which]);
  if (!found) return false;
  Disc next;
  const double radius = std::min(options_.max_radius, growth * discs_[which].radius);
  has_left_ = false;
  const bool added = put(discs_[which], *found, next) && add(next, radius);
  Disc& disc = discs_[which];
  if (added) {
    const std::optional<Opening> still = opening(disc);
    if (!still || (still->at - found->at).norm() > same * disc.radius) return true;
  }
  if (const int met = found->sides & ~disc.sides; met != 0) {  // it may bend away from them
    disc.missed |= met;
    outline(which);
    return true;
  }
  constexpr double inside = 0.9;
  fail(disc.at + disc.plane * found->at);
  disc.is_torn = true;
  disc.polygon.cut(found->at, inside * found->at.squaredNorm(), torn);
  return true;
}

bool Covering::spread(const Vector& x, std::size_t most) {
  if (is_covered(x)) return true;
  Disc first;
  first.at = x;
  if (!surface_.tangent(x, {}, first.plane)) {
    fail(x);
    return true;
  }
  for (int side = 0; side < 4; ++side) {
    if (std::abs(gap(first, side)) > same || towards(first, side).norm() < upright) continue;
    first.at(unknowns_ + parameter_of(side)) = is_low(side) ? 0 : 1;
    first.sides |= 1 << side;
  }
  if (!add(first, options_.max_radius)) fail(x);
  while (!unfinished_.empty()) {
    if (discs_.size() >= most || (options_.go_on && !options_.go_on())) return false;
    if (!extend(unfinished_.front())) unfinished_.pop_front();
  }
  return true;
}

}  // namespace arcslip::continuation
