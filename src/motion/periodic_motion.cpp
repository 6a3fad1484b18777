#include "arcslip/motion/periodic_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "motion/lattice.hpp"

namespace arcslip {

PeriodicMotion::PeriodicMotion(ComplexVector coefficients) : coefficients_(std::move(coefficients)) {
  if (coefficients_.size() == 0) throw std::invalid_argument("PeriodicMotion: no harmonics");
  coefficients_(0) = coefficients_(0).real();
}

PeriodicMotion::PeriodicMotion(std::span<const int> orders, const ComplexVector& coefficients, int highest)
    : coefficients_(ComplexVector::Zero(highest + 1)) {
  if (std::ssize(orders) != coefficients.size())
    throw std::invalid_argument("PeriodicMotion: one coefficient for each order");
  for (std::size_t a = 0; a < orders.size(); ++a) {
    if (orders[a] < 0 || orders[a] > highest)
      throw std::invalid_argument("PeriodicMotion: orders must be 0 or more and not above the highest");
    coefficients_(orders[a]) = coefficients(static_cast<Index>(a));
  }
  coefficients_(0) = coefficients_(0).real();
}

PeriodicMotion PeriodicMotion::drifting(double drift) const {
  PeriodicMotion motion = *this;
  motion.drift_ = drift;
  return motion;
}

PeriodicMotion::Local PeriodicMotion::at(double theta) const {
  const Complex turn = std::polar(1.0, theta);
  double cosine = 1;  // of h theta, by real products, which unlike complex ones look for no infinities
  double sine = 0;
  Local sum{coefficients_(0).real(), 0};
  for (Index h = 1; h < coefficients_.size(); ++h) {
    const double before = cosine;
    cosine = before * turn.real() - sine * turn.imag();
    sine = before * turn.imag() + sine * turn.real();
    const Complex own = coefficients_(h);
    sum.value += own.real() * cosine - own.imag() * sine;
    sum.first -= static_cast<double>(h) * (own.real() * sine + own.imag() * cosine);
  }
  if (drift_ != 0) {
    sum.value += drift_ * theta;
    sum.first += drift_;
  }
  return sum;
}

PeriodicMotion PeriodicMotion::derivative() const {
  ComplexVector rates = coefficients_;
  for (Index h = 0; h < rates.size(); ++h) rates(h) *= Complex(0, static_cast<double>(h));
  rates(0) = drift_;
  return PeriodicMotion(std::move(rates));
}

std::vector<double> PeriodicMotion::zeros() const {
  double second = 0;  // bounds of derivatives wherever
  double fourth = 0;
  Lattice<lattice_size> lattice;
  lattice.value.fill(coefficients_(0).real());
  for (Index h = 1; h < coefficients_.size(); ++h) {
    if (coefficients_(h) == 0.0) continue;
    const auto square = static_cast<double>(h * h);
    second += square * std::abs(coefficients_(h));
    fourth += square * square * std::abs(coefficients_(h));
    lattice.add(static_cast<int>(h), coefficients_(h).real(), coefficients_(h).imag());
  }
  std::vector<double> found;
  if (!(fourth > 0)) return found;
  const auto both = [&](double theta) {
    const Local here = at(theta);
    return std::pair(here.value, here.first);
  };
  for (std::size_t i = 0; i < lattice_size; i += 2) {
    const double bound = std::min(second, lattice.bound_round(i + 1, fourth));
    if (lattice.keeps_from_zero(i + 1, bound)) continue;
    const AngleCell cell{static_cast<double>(i) * lattice_width, static_cast<double>(i + 2) * lattice_width,
                         lattice.value[i], lattice.value[(i + 2) % lattice_size]};
    isolate_zeros(both, bound, cell, [&](double theta) { found.push_back(theta); });
  }
  return found;
}

}  // namespace arcslip
