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
void Hermite::add(double x, std::array<const Vector*, 3> derivatives, std::size_t count) {
  std::size_t terms = counts_[places_];
  for (std::size_t order = 0; order < count; ++order, ++terms) {
    // In place, from the highest order down: each needs what was its lower neighbour.
    last_[terms] = *derivatives[0];
    for (std::size_t j = 1; j <= terms; ++j) {
      const std::size_t place = terms - j;
      if (j <= order) {
        last_[place] = *derivatives[j];
      } else {
        last_[place] = (last_[place + 1] - last_[place]) / (x - nodes_[place]);
      }
    }
    nodes_[terms] = x;
    terms_[terms] = last_[0];
  }
  counts_[++places_] = terms;
}

void Hermite::at(double s, std::size_t places, Vector& out) const {
  const double x = variable(s);
  std::size_t k = counts_[places] - 1;
  out = terms_[k];
  while (k-- > 0) out = terms_[k] + (x - nodes_[k]) * out;
}

void Hermite::added(double s, std::size_t places, Vector& out) const {
  const double x = variable(s);
  const std::size_t before = counts_[places - 1];
  std::size_t k = counts_[places] - 1;
  out = terms_[k].cwiseAbs();
  while (k-- > before) out = terms_[k].cwiseAbs() + std::abs(x - nodes_[k]) * out;
  for (std::size_t i = 0; i < before; ++i) out *= std::abs(x - nodes_[i]);
}

}  // namespace arcslip::continuation
