#include "arcslip/interval/zeros_in_box.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

constexpr std::size_t most_undecided = 1000;

bool holds(const Box& outer, const Box& inner) {
  return std::equal(inner.begin(), inner.end(), outer.begin(),
                    [](const Interval& a, const Interval& b) { return subset(a, b); });
}
bool holds_inside(const Box& outer, const Box& inner) {
  return std::equal(inner.begin(), inner.end(), outer.begin(),
                    [](const Interval& a, const Interval& b) { return proper_subset(a, b); });
}
bool meet(const Box& a, const Box& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const Interval& x, const Interval& y) { return overlap(x, y); });
}
Box inflated(Box box, double share) {
  for (Interval& side : box) {
    const double more = share * width(side) + 1e-15 * norm(side) + 1e-300;
    side = {side.lower() - more, side.upper() + more};
  }
  return box;
}

class Search {
 public:
  Search(const EnclosedMap& map, const Box& box, const BoxOptions& options)
      : map_(map), whole_(box), options_(options), n_(std::ssize(box)), inverse_(n_, n_) {}

  ZerosInBox run() {
    std::vector<Box> waiting{whole_};
    while (!waiting.empty()) {
      if (found_.boxes >= options_.max_boxes || found_.undecided.size() >= most_undecided ||
          (options_.go_on && !options_.go_on())) {
        found_.finished = false;
        break;
      }
      ++found_.boxes;
      Box box = std::move(waiting.back());
      waiting.pop_back();
      if (decide(box)) continue;
      const std::size_t k = longest(box);
      if (!(width(box[k]) > options_.narrowest * width(whole_[k]))) {
        found_.undecided.push_back(std::move(box));
        continue;
      }
      Box half = box;
      const double middle = median(box[k]);
      half[k] = {middle, box[k].upper()};
      box[k] = {box[k].lower(), middle};
      waiting.push_back(std::move(half));
      waiting.push_back(std::move(box));
    }
    join_undecided();
    std::erase_if(found_.zeros, [&](const Box& zero) { return !meet(zero, whole_); });
    return std::move(found_);
  }

 private:
  /// Whether nothing is left to do with this box, which may become smaller.
  bool decide(Box& box) {
    while (true) {
      if (is_known(box)) return true;
      const double before = size(box);
      Box image;
      if (!contracted(box, image)) return false;
      if (image.empty()) return true;
      if (holds_inside(box, image)) return keep(box);
      for (std::size_t k = 0; k < box.size(); ++k) {
        if (!overlap(box[k], image[k])) return true;
        box[k] = intersect(box[k], image[k]);
      }
      if (contracts_ && settles(box)) return true;
      if (size(box) > 0.7 * before) return false;
    }
  }

  /// A zero on the border of a box is found in a larger one.
  bool settles(const Box& box) {
    for (const double share : {0.1, 1.0}) {
      Box larger = inflated(box, share);
      Box image;
      if (!contracted(larger, image) || image.empty()) return false;
      if (holds_inside(larger, image)) return keep(larger);
    }
    return false;
  }

  /// K over a box; no box where it holds no zero for sure. False where there is no K.
  bool contracted(const Box& box, Box& image) {
    image.clear();
    contracts_ = false;
    try {
      map_(box, values_, jacobian_);
      if (std::any_of(values_.begin(), values_.end(), [](const Interval& one) { return !zero_in(one); }))
        return true;
      Box middle;
      for (const Interval& side : box) middle.emplace_back(median(side));
      map_(middle, at_middle_, slopes_);
      if (!invert()) return false;
      return apply(box, middle, image);
    } catch (const NoValue&) {
      return true;
    } catch (const NoEnclosure&) {
      return false;
    }
  }

  bool invert() {
    Matrix middle(n_, n_);
    for (Index i = 0; i < n_; ++i) {
      for (Index k = 0; k < n_; ++k) middle(i, k) = median(jacobian_[static_cast<std::size_t>(i * n_ + k)]);
    }
    const std::optional<Matrix> inverse = middle.allFinite() ? inverse_of(middle) : std::nullopt;
    if (!inverse || !inverse->allFinite()) return false;
    inverse_ = *inverse;
    return true;
  }

  bool apply(const Box& box, const Box& middle, Box& image) {
    const auto n = static_cast<std::size_t>(n_);
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      Interval sum = middle[i];
      double row = 0;
      for (std::size_t j = 0; j < n; ++j) sum -= inverse(i, j) * at_middle_[j];
      for (std::size_t k = 0; k < n; ++k) {
        Interval rest(i == k ? 1 : 0);
        for (std::size_t j = 0; j < n; ++j) rest -= inverse(i, j) * jacobian_[j * n + k];
        sum += rest * (box[k] - middle[k]);
        row += norm(rest) * width(box[k]);
      }
      if (!std::isfinite(sum.lower()) || !std::isfinite(sum.upper())) return false;
      largest = std::max(largest, row / std::max(width(box[i]), 1e-300));
      image.push_back(sum);
    }
    contracts_ = largest < 1;
    return true;
  }
  Interval inverse(std::size_t i, std::size_t j) const {
    return inverse_(static_cast<Index>(i), static_cast<Index>(j));
  }

  bool is_known(const Box& box) const {
    return std::any_of(alone_.begin(), alone_.end(), [&](const Box& one) { return holds(one, box); });
  }

  /// A box with exactly one zero, which it is made narrow about.
  bool keep(const Box& box) {
    Box zero = box;
    Box image;
    for (int i = 0; i < 100 && contracted(zero, image) && !image.empty(); ++i) {
      const double before = size(zero);
      for (std::size_t k = 0; k < zero.size(); ++k) zero[k] = intersect(zero[k], image[k]);
      if (size(zero) > 0.99 * before) break;
    }
    const bool is_new =
        std::none_of(alone_.begin(), alone_.end(), [&](const Box& one) { return holds(one, zero); });
    alone_.push_back(box);
    if (is_new) found_.zeros.push_back(std::move(zero));
    return true;
  }

  /// Sum of the sides, each of the whole one.
  double size(const Box& box) const {
    double sum = 0;
    for (std::size_t k = 0; k < box.size(); ++k) sum += width(box[k]) / width(whole_[k]);
    return sum;
  }
  std::size_t longest(const Box& box) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < box.size(); ++k) {
      if (width(box[k]) * width(whole_[best]) > width(box[best]) * width(whole_[k])) best = k;
    }
    return best;
  }

  /// Boxes that touch each other become one.
  void join_undecided() {
    std::vector<Box>& all = found_.undecided;
    std::erase_if(all, [&](const Box& box) { return is_known(box); });
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        if (!meet(inflated(all[i], 1), all[k])) continue;
        for (std::size_t j = 0; j < all[i].size(); ++j) all[i][j] = hull(all[i][j], all[k][j]);
        all.erase(all.begin() + static_cast<std::ptrdiff_t>(k));
        k = i;
      }
    }
  }

  const EnclosedMap& map_;
  const Box whole_;
  const BoxOptions& options_;
  Index n_;
  ZerosInBox found_;
  std::vector<Box> alone_;  // each holds exactly one zero
  bool contracts_ = false;  // whether the last K shrinks: its box holds no two zeros
  Matrix inverse_;
  std::vector<Interval> values_, jacobian_, at_middle_, slopes_;
};

}  // namespace

ZerosInBox zeros_in_box(const EnclosedMap& map, const Box& box, const BoxOptions& options) {
  return Search(map, box, options).run();
}

}  // namespace arcslip
