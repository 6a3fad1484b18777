#include "arcslip/continuation/path/hermite.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {

double Hermite::variable(double s) const {
  return corner_ ? std::sqrt(std::max(0.0, corner_->into * (s - corner_->s))) : s;
}

void Hermite::add(double s, const Vector& value, const Vector& slope) {
  const double x = variable(s);
  if (!corner_) {
    add(x, {&value, &slope}, 2);
  } else if (x > 0) {
    scaled_[0] = 2 * x * corner_->into * slope;
    add(x, {&value, &scaled_[0]}, 2);
  } else {
    scaled_[0].setZero(value.size());
    scaled_[1] = corner_->into * slope;
    add(x, {&value, &scaled_[0], &scaled_[1]}, 3);
  }
}

/// Value, slope, half the second derivative at x, as far as they are given.
void Hermite::add(double x, std::array<const Vector*, 3> derivatives, Index count) {
  if (places_ == 0) {
    terms_.resize(derivatives[0]->size(), most_terms);
    last_.resize(derivatives[0]->size(), most_terms);
  }
  Index terms = counts_[places_];
  for (Index order = 0; order < count; ++order, ++terms) {
    // In place, from the highest order down: each needs what was its lower neighbour.
    last_.col(terms) = *derivatives[0];
    for (Index j = 1; j <= terms; ++j) {
      const Index place = terms - j;
      if (j <= order) {
        last_.col(place) = *derivatives[static_cast<std::size_t>(j)];
      } else {
        last_.col(place) = (last_.col(place + 1) - last_.col(place)) / (x - node(place));
      }
    }
    nodes_[static_cast<std::size_t>(terms)] = x;
    terms_.col(terms) = last_.col(0);
  }
  counts_[++places_] = terms;
}

void Hermite::at(double s, std::size_t places, Vector& out) const {
  const double x = variable(s);
  Index k = counts_[places] - 1;
  out = terms_.col(k);
  while (k-- > 0) out = terms_.col(k) + (x - node(k)) * out;
}

void Hermite::added(double s, std::size_t places, Vector& out) const {
  const double x = variable(s);
  const Index before = counts_[places - 1];
  Index k = counts_[places] - 1;
  out = terms_.col(k).cwiseAbs();
  while (k-- > before) out = terms_.col(k).cwiseAbs() + std::abs(x - node(k)) * out;
  for (Index i = 0; i < before; ++i) out *= std::abs(x - node(i));
}

}  // namespace arcslip::continuation
