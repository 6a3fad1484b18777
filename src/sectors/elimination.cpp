#include "sectors/elimination.hpp"

#ifdef ARCSLIP_METIS
#include <metis.h>
#else
#include <amd.h>
#endif

#include <algorithm>
#include <mutex>
#include <new>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace arcslip {
namespace {

#ifdef ARCSLIP_METIS

/// METIS draws from the generator of the C library, which threads share: one at a time, begun anew by each.
std::mutex drawing;

constexpr const char* library = "METIS";

std::vector<int> ordered(const SymmetricPattern& pattern) {
  static_assert(sizeof(idx_t) == sizeof(int));
  std::vector<int> begin{0};
  std::vector<int> rows;
  for (int j = 0; j < pattern.size; ++j) {
    std::copy_if(pattern.rows + pattern.begin[j], pattern.rows + pattern.begin[j + 1],
                 std::back_inserter(rows), [j](int row) { return row != j; });
    begin.push_back(static_cast<int>(rows.size()));
  }
  std::vector<int> order(subscript(pattern.size)), place(subscript(pattern.size));
  idx_t size = pattern.size;
  const std::scoped_lock lock(drawing);
  if (METIS_NodeND(&size, begin.data(), rows.data(), nullptr, nullptr, order.data(), place.data()) !=
      METIS_OK)
    throw std::bad_alloc();
  return order;
}

#else

constexpr const char* library = "AMD";

std::vector<int> ordered(const SymmetricPattern& pattern) {
  std::vector<int> order(subscript(pattern.size));
  const int status = amd_order(pattern.size, pattern.begin, pattern.rows, order.data(), nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status < 0) throw std::length_error("sector: more entries than indices can count");
  return order;
}

#endif

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[subscript(order[i])] = static_cast<int>(i);
  return place;
}

/// Calls `use` with the places before that of each column in which it has entries.
template <class Use>
void for_each_above(const SymmetricPattern& pattern, const std::vector<int>& order,
                    const std::vector<int>& place, const Use& use) {
  for (int j = 0; j < pattern.size; ++j) {
    const int column = order[subscript(j)];
    for (int i = pattern.begin[column]; i < pattern.begin[column + 1]; ++i) {
      if (place[subscript(pattern.rows[i])] < j) use(j, place[subscript(pattern.rows[i])]);
    }
  }
}

/// Of each place the first one that its elimination changes; -1: none.
std::vector<int> elimination_tree(const SymmetricPattern& pattern, const std::vector<int>& order,
                                  const std::vector<int>& place) {
  std::vector<int> parents(order.size(), -1);
  std::vector<int> ancestors = parents;
  for_each_above(pattern, order, place, [&](int j, int i) {
    while (i != -1 && i != j) {
      const int next = std::exchange(ancestors[subscript(i)], j);
      if (next == -1) parents[subscript(i)] = j;
      i = next;
    }
  });
  return parents;
}

/// The places so that each subtree's are contiguous.
std::vector<int> postorder(const std::vector<int>& parents) {
  const int size = static_cast<int>(parents.size());
  std::vector<int> first_child(parents.size(), -1), next(parents.size(), -1), found, stack;
  for (int i = size - 1; i >= 0; --i) {
    if (parents[subscript(i)] == -1) continue;
    next[subscript(i)] = std::exchange(first_child[subscript(parents[subscript(i)])], i);
  }
  for (int root = 0; root < size; ++root) {
    if (parents[subscript(root)] != -1) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int top = stack.back();
      const int child = first_child[subscript(top)];
      if (child != -1) {
        first_child[subscript(top)] = next[subscript(child)];
        stack.push_back(child);
      } else {
        found.push_back(top);
        stack.pop_back();
      }
    }
  }
  return found;
}

}  // namespace

std::vector<int> least_fill_order(const SymmetricPattern& pattern) { return ordered(pattern); }

std::string least_fill_library() { return library; }

Elimination::Elimination(const SymmetricPattern& pattern) {
  find_order(pattern);
  const std::vector<int> parents = elimination_tree(pattern, order_, place_);
  find_fronts(parents, entry_counts(pattern, parents));
  find_rows(pattern);
}

void Elimination::find_order(const SymmetricPattern& pattern) {
  const std::vector<int> first = least_fill_order(pattern);
  for (const int i : postorder(elimination_tree(pattern, first, inverse(first))))
    order_.push_back(first[subscript(i)]);
  place_ = inverse(order_);
}

/// Entries of each column of the factor, with that on the diagonal.
std::vector<int> Elimination::entry_counts(const SymmetricPattern& pattern,
                                           const std::vector<int>& parents) const {
  std::vector<int> counts(order_.size(), 1), seen(order_.size(), -1);
  for_each_above(pattern, order_, place_, [&](int j, int i) {
    for (; i != j && seen[subscript(i)] != j; i = parents[subscript(i)]) {
      seen[subscript(i)] = j;
      ++counts[subscript(i)];
    }
  });
  return counts;
}

void Elimination::find_fronts(const std::vector<int>& parents, const std::vector<int>& counts) {
  constexpr double sparse = 0.1;  // part of zeros that a block of dense operations may carry along
  double entries = 0;
  for (int j = 0; j < static_cast<int>(order_.size()); ++j) {
    const double count = counts[subscript(j)];
    bool joins = j > 0 && parents[subscript(j - 1)] == j;
    if (joins) {
      const double width = fronts_.back().width + 1;
      const double all = width * count + 0.5 * width * (width - 1);
      joins = all - (entries + count) <= sparse * all;
    }
    if (!joins) {
      fronts_.push_back({j, 0, {}, -1});
      entries = 0;
    }
    ++fronts_.back().width;
    entries += count;
  }
}

void Elimination::find_rows(const SymmetricPattern& pattern) {
  std::vector<int> front_of;
  for (std::size_t f = 0; f < fronts_.size(); ++f)
    front_of.insert(front_of.end(), subscript(fronts_[f].width), static_cast<int>(f));
  std::vector<std::vector<int>> children(fronts_.size());
  std::vector<int> seen(order_.size(), -1);
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    const int end = front.first + front.width;
    const auto take = [&](int row) {
      if (row < end || seen[subscript(row)] == static_cast<int>(f)) return;
      seen[subscript(row)] = static_cast<int>(f);
      front.rows.push_back(row);
    };
    for (int j = front.first; j < end; ++j) {
      const int column = order_[subscript(j)];
      for (int i = pattern.begin[column]; i < pattern.begin[column + 1]; ++i)
        take(place_[subscript(pattern.rows[i])]);
    }
    for (const int child : children[f]) {
      for (const int row : fronts_[subscript(child)].rows) take(row);
    }
    std::sort(front.rows.begin(), front.rows.end());
    if (front.rows.empty()) continue;
    front.parent = front_of[subscript(front.rows.front())];
    children[subscript(front.parent)].push_back(static_cast<int>(f));
  }
}

}  // namespace arcslip
