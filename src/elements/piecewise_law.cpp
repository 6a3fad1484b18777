#include "arcslip/elements/piecewise_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace arcslip {
namespace {

/// sum_m m (m - 1) ... (m - order + 1) c_m x^(m - order), of the coefficients or their derivatives.
double derivative(const std::vector<Jet>& coefficients, int order, double x,
                  double Jet::*part = &Jet::value) {
  double sum = 0;
  for (int m = static_cast<int>(coefficients.size()) - 1; m >= order; --m) {
    double factor = coefficients[static_cast<std::size_t>(m)].*part;
    for (int i = 0; i < order; ++i) factor *= m - i;
    sum = sum * x + factor;
  }
  return sum;
}

double integral(const std::vector<Jet>& coefficients, double x) {
  double sum = 0;
  for (std::size_t m = coefficients.size(); m-- > 0;)
    sum = sum * x + coefficients[m].value / static_cast<double>(m + 1);
  return sum * x;
}

}  // namespace

PiecewiseLaw::PiecewiseLaw(std::vector<Piece> pieces, bool is_one_sided)
    : pieces_(std::move(pieces)), is_one_sided_(is_one_sided) {
  const auto refuse = [](const char* why) {
    throw std::invalid_argument(std::string("PiecewiseLaw: ") + why);
  };
  if (pieces_.empty() || !std::isinf(pieces_.back().end.value)) refuse("the last piece must have no end");
  for (std::size_t m = 0; m < pieces_.front().coefficients.size() && !is_one_sided; m += 2) {
    if (pieces_.front().coefficients[m].value != 0) refuse("the first piece must be odd");
  }
  double before = is_one_sided ? std::numeric_limits<double>::lowest() : 0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    degree_ = std::max(degree_, static_cast<int>(pieces_[i].coefficients.size()) - 1);
    const double end = pieces_[i].end.value;
    const auto varies = [](const Jet& number) { return number.first != 0 || number.second != 0; };
    is_varied_ = is_varied_ || varies(pieces_[i].end) ||
                 std::any_of(pieces_[i].coefficients.begin(), pieces_[i].coefficients.end(), varies);
    if (!(end > before)) refuse("the ends of pieces must ascend, of an odd law from above 0");
    before = end;
    if (i + 1 == pieces_.size()) break;
    constexpr double rounding = 1e-12;
    const int zone = static_cast<int>(i);
    const double jump = value(end, zone + 1) - value(end, zone);
    double size = std::abs(value(end, zone));
    for (std::size_t m = 0; m < pieces_[i + 1].coefficients.size(); ++m)
      size = std::max(size, std::abs(pieces_[i + 1].coefficients[m].value) * std::pow(std::abs(end), m));
    if (!(std::abs(jump) <= rounding * size)) refuse("the force must be continuous");
  }
}

int PiecewiseLaw::zone_at(double x) const {
  int zone = 0;
  if (is_one_sided_) {
    while (x > piece(zone).end.value) ++zone;
    return zone;
  }
  while (std::abs(x) > piece(zone).end.value) ++zone;
  return x < 0 ? -zone : zone;
}

PiecewiseLaw::Ends PiecewiseLaw::ends(int zone) const {
  const double outer = piece(zone).end.value;
  if (zone == 0) return {is_one_sided_ ? -std::numeric_limits<double>::infinity() : -outer, outer};
  const double inner = piece(std::abs(zone) - 1).end.value;
  return zone > 0 ? Ends{inner, outer} : Ends{-outer, -inner};
}

double PiecewiseLaw::value(double x, int zone) const {
  const int side = zone < 0 ? -1 : 1;
  return side * derivative(piece(zone).coefficients, 0, side * x);
}

double PiecewiseLaw::slope(double x, int zone) const {
  return derivative(piece(zone).coefficients, 1, zone < 0 ? -x : x);
}

double PiecewiseLaw::curvature(double x, int zone) const {
  const int side = zone < 0 ? -1 : 1;
  return side * derivative(piece(zone).coefficients, 2, side * x);
}

double PiecewiseLaw::by_setting(double x, int zone) const {
  const int side = zone < 0 ? -1 : 1;
  return side * derivative(piece(zone).coefficients, 0, side * x, &Jet::first);
}

double PiecewiseLaw::slope_by_setting(double x, int zone) const {
  return derivative(piece(zone).coefficients, 1, zone < 0 ? -x : x, &Jet::first);
}

double PiecewiseLaw::second_by_setting(double x, int zone) const {
  const int side = zone < 0 ? -1 : 1;
  return side * derivative(piece(zone).coefficients, 0, side * x, &Jet::second);
}

double PiecewiseLaw::end_by_setting(int zone, int next) const {
  const int side = zone + next < 0 ? -1 : 1;
  return side * piece(std::min(std::abs(zone), std::abs(next))).end.first;
}

double PiecewiseLaw::energy(double x) const {
  double sum = 0;
  double from = 0;
  for (const Piece& piece : pieces_) {
    const double to = std::min(piece.end.value, std::abs(x));
    sum += integral(piece.coefficients, to) - integral(piece.coefficients, from);
    if (to >= std::abs(x)) break;
    from = to;
  }
  return sum;
}

}  // namespace arcslip
