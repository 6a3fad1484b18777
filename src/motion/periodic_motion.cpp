#include "arcslip/motion/periodic_motion.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "motion/bracketed_newton.hpp"

namespace arcslip {

PeriodicMotion::PeriodicMotion(ComplexVector coefficients) : coefficients_(std::move(coefficients)) {
  if (coefficients_.size() == 0) throw std::invalid_argument("PeriodicMotion: no harmonics");
  coefficients_(0) = coefficients_(0).real();
}

PeriodicMotion::PeriodicMotion(std::span<const int> orders, const ComplexVector& coefficients, int highest)
    : coefficients_(ComplexVector::Zero(highest + 1)) {
  if (std::ssize(orders) != coefficients.size())
    throw std::invalid_argument("PeriodicMotion: one coefficient for each order");
  int last = -1;
  for (std::size_t a = 0; a < orders.size(); ++a) {
    if (orders[a] <= last || orders[a] > highest)
      throw std::invalid_argument("PeriodicMotion: orders must ascend from 0 or more");
    last = orders[a];
    coefficients_(last) = coefficients(static_cast<Index>(a));
  }
  coefficients_(0) = coefficients_(0).real();
}

PeriodicMotion::Local PeriodicMotion::at(double theta) const {
  const Complex turn = std::polar(1.0, theta);
  Complex power = 1;
  Local sum{coefficients_(0).real(), 0, 0};
  for (Index h = 1; h < coefficients_.size(); ++h) {
    power *= turn;
    const Complex part = coefficients_(h) * power;
    const auto order = static_cast<double>(h);
    sum.value += part.real();
    sum.first -= order * part.imag();
    sum.second -= order * order * part.real();
  }
  return sum;
}

PeriodicMotion PeriodicMotion::derivative() const {
  ComplexVector rates = coefficients_;
  for (Index h = 0; h < rates.size(); ++h) rates(h) *= Complex(0, static_cast<double>(h));
  return PeriodicMotion(std::move(rates));
}

std::vector<double> PeriodicMotion::zeros() const {
  double third = 0;  // bound of |d3x/dtheta3|
  for (Index h = 1; h < coefficients_.size(); ++h)
    third += std::pow(static_cast<double>(h), 3) * std::abs(coefficients_(h));
  std::vector<double> found;
  if (!(third > 0)) return found;

  constexpr int parts = 8;
  constexpr double narrow = 1e-7;
  std::vector<std::pair<double, double>> open;  // what is not searched, the leftmost last
  for (int i = parts; i-- > 0;) open.emplace_back(i * two_pi / parts, (i + 1) * two_pi / parts);
  while (!open.empty()) {
    const auto [low, high] = open.back();
    open.pop_back();
    const double middle = 0.5 * (low + high);
    const double width = 0.5 * (high - low);
    const Local here = at(middle);
    const double bend = std::abs(here.second);
    if (std::abs(here.value) > (std::abs(here.first) + (bend / 2 + third * width / 6) * width) * width)
      continue;
    if (std::abs(here.first) > (bend + third * width / 2) * width || width < narrow) {  // one zero at most
      const double begin = value(low);
      if (begin == 0) {
        found.push_back(low);
      } else if (begin * value(high) < 0) {
        found.push_back(bracketed_newton(
            [&](double theta) {
              const Local local = at(theta);
              return std::pair(local.value, local.first);
            },
            middle, low, high, begin < 0));
      }
      continue;
    }
    open.emplace_back(middle, high);
    open.emplace_back(low, middle);
  }
  return found;
}

}  // namespace arcslip
