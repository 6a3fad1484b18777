#include "arcslip/continuation/atlas/triangulation.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace arcslip::continuation {

Triangulation::Triangulation(const std::vector<Disc>& discs) : discs_(discs) {
  meet();
  close();
}

bool Triangulation::on_side(int a, int b) const {
  return (discs_[static_cast<std::size_t>(a)].sides & discs_[static_cast<std::size_t>(b)].sides) != 0;
}

/// Takes a triangle unless one of its edges has another on that side.
bool Triangulation::add(const Face& face) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (has(face[i], face[(i + 1) % 3])) return false;
  }
  for (std::size_t i = 0; i < 3; ++i) third_[{face[i], face[(i + 1) % 3]}] = face[(i + 2) % 3];
  faces_.push_back(face);
  return true;
}

/// The triangles that all three discs agree upon, then those that two or one see and none contradicts.
void Triangulation::meet() {
  constexpr double beyond = 1 + 1e-9;  // a corner that is not covered yet
  std::map<Face, int> agreed;
  for (std::size_t c = 0; c < discs_.size(); ++c) {
    const Polygon& polygon = discs_[c].polygon;
    for (std::size_t i = 0; i < polygon.corners().size(); ++i) {
      Face face{static_cast<int>(c), polygon.corners()[polygon.before(i)].beyond,
                polygon.corners()[i].beyond};
      if (face[1] < 0 || face[2] < 0 || polygon.corners()[i].at.norm() > beyond * discs_[c].radius) continue;
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      ++agreed[face];
    }
  }
  for (const int votes : {3, 2, 1}) {
    for (const auto& [face, count] : agreed) {
      if (count == votes) add(face);
    }
  }
}

/// The edges without a triangle on their left that follow each other, the first of them given.
std::vector<int> Triangulation::around(int from, int to) const {
  std::vector<int> loop{from};
  int a = from;
  int b = to;
  do {
    loop.push_back(b);
    int beyond = a;
    for (auto edge = third_.find({b, beyond}); edge != third_.end(); edge = third_.find({b, beyond}))
      beyond = edge->second;
    a = b;
    b = beyond;
  } while (a != from || b != to);
  loop.pop_back();
  return loop;
}

/// Fills a hole by triangles that cut off its corners, the shortest new edge first.
bool Triangulation::fill(std::vector<int> loop) {
  for (auto twice = loop.begin(); twice != loop.end(); ++twice) {  // holes that meet in a corner
    const auto first = std::find(loop.begin(), twice, *twice);
    if (first == twice) continue;
    const bool is_filled = fill({first, twice});
    loop.erase(first, twice);
    return fill(std::move(loop)) && is_filled;
  }
  constexpr std::size_t most = 16;  // corners, above which it is none of rounding's
  const auto is_torn = [&](int i) { return discs_[static_cast<std::size_t>(i)].is_torn; };
  if (loop.size() < 3 || loop.size() > most || std::any_of(loop.begin(), loop.end(), is_torn)) return false;
  while (loop.size() > 3) {
    std::size_t best = loop.size();
    double shortest = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i];
      const int c = loop[(i + 2) % loop.size()];
      if (has(c, a) || has(a, c) || a == c) continue;
      const double length =
          (discs_[static_cast<std::size_t>(a)].at - discs_[static_cast<std::size_t>(c)].at).norm();
      if (best < loop.size() && length >= shortest) continue;
      best = i;
      shortest = length;
    }
    if (best == loop.size()) return false;
    const std::size_t middle = (best + 1) % loop.size();
    if (!add({loop[best], loop[middle], loop[(best + 2) % loop.size()]})) return false;
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(middle));
  }
  return add({loop[0], loop[1], loop[2]});
}

/// Fills what is open but for the sides of the box, and notes what cannot be filled.
void Triangulation::close() {
  std::set<std::pair<int, int>> open;
  for (const auto& [edge, third] : third_) {
    if (!has(edge.second, edge.first)) open.insert({edge.second, edge.first});
  }
  std::vector<std::vector<int>> loops;
  while (!open.empty()) {
    std::vector<int> loop = around(open.begin()->first, open.begin()->second);
    const std::size_t length = loop.size();
    for (std::size_t i = 0; i < length; ++i) open.erase({loop[i], loop[(i + 1) % length]});
    // Parts between edges on the box's sides are holes of their own, with such an edge behind their end.
    const auto lies_on_side = [&](std::size_t i) {
      return on_side(loop[i % length], loop[(i + 1) % length]);
    };
    std::size_t start = 0;
    while (start < length && !lies_on_side(start)) ++start;
    if (start == length) {
      loops.push_back(loop);
      continue;
    }
    std::vector<int> part;
    for (std::size_t i = start + 1; i <= start + length; ++i) {
      if (!lies_on_side(i)) {
        if (part.empty()) part.push_back(loop[i % length]);
        part.push_back(loop[(i + 1) % length]);
      } else if (!part.empty()) {
        loops.push_back(std::move(part));
        part.clear();
      }
    }
  }
  for (const std::vector<int>& loop : loops) fill(loop);
  std::set<int> rims;
  for (const auto& [edge, third] : third_) {
    if (!has(edge.second, edge.first) && !on_side(edge.first, edge.second)) rims.insert(edge.first);
  }
  rims_.assign(rims.begin(), rims.end());
}

std::vector<int> Triangulation::components() const {
  std::vector<int> least(discs_.size());
  std::iota(least.begin(), least.end(), 0);
  const auto root = [&](int i) {
    while (least[static_cast<std::size_t>(i)] != i) i = least[static_cast<std::size_t>(i)];
    return i;
  };
  const auto join = [&](int a, int b) {
    const int first = root(a);
    const int second = root(b);
    least[static_cast<std::size_t>(std::max(first, second))] = std::min(first, second);
  };
  for (const Face& face : faces_) {
    join(face[0], face[1]);
    join(face[0], face[2]);
  }
  for (std::size_t i = 0; i < discs_.size(); ++i) least[i] = root(static_cast<int>(i));
  return least;
}

}  // namespace arcslip::continuation
