#include "elements/slider_arcs.hpp"

#include "motion/bracketed_newton.hpp"

namespace arcslip {
namespace {

constexpr double begins = -3 * pi;  // what is sampled on all lines: two periods, of which the last one counts
constexpr double samples_in_fastest = 12;

std::vector<Line> moving(const std::vector<Line>& lines, const ComplexVector& x) {
  std::vector<Line> moving;
  for (std::size_t a = 0; a < lines.size(); ++a) {
    if (x(static_cast<Index>(a)) != 0.0) moving.push_back(lines[a]);
  }
  return moving;
}

}  // namespace

SliderPaths::SliderPaths(const std::vector<Line>& lines, const ComplexVector& x, double ratio, Index places)
    : places_(places),
      ratio_(ratio),
      lines_(moving(lines, x)),
      x_(std::ssize(lines_)),
      q_(frequencies(lines_, ratio)),
      turns_(lines_) {
  std::copy_if(x.begin(), x.end(), x_.begin(), [](const Complex& one) { return one != 0.0; });
  if (q_.size() == 0) return;
  const auto samples =
      static_cast<Index>(std::ceil((pi - begins) / two_pi * q_.cwiseAbs().maxCoeff() * samples_in_fastest));
  rates_.resize(samples + 1, places);
  ComplexMatrix over_theta(samples + 1, q_.size());
  for (Index a = 0; a < q_.size(); ++a) {
    const Complex turn = std::polar(1.0, q_(a) * (pi - begins) / static_cast<double>(samples));
    Complex here = Complex(0, q_(a)) * x_(a) * std::polar(1.0, q_(a) * begins);
    for (Complex& one : over_theta.col(a)) {
      one = here;
      here *= turn;
    }
  }
  ComplexMatrix over_places(q_.size(), places);
  for (Index place = 0; place < places; ++place) {
    turns_.set(0, phase(place), e_);
    over_places.col(place) = e_;
  }
  rates_.noalias() = over_theta.real() * over_places.real();
  rates_.noalias() -= over_theta.imag() * over_places.imag();
}

SliderPaths::Local SliderPaths::at(double theta) {
  Local sum{0, 0, 0};
  turns_.set(theta, phase_ + ratio_ * theta, e_);
  for (Index a = 0; a < q_.size(); ++a) {
    const Complex turned = x_(a) * e_(a);
    sum.value += turned.real();
    sum.first -= q_(a) * turned.imag();
    sum.second -= q_(a) * q_(a) * turned.real();
  }
  return sum;
}

/// In how many periods of theta_1 what two frequencies make together comes back, as far as is looked.
int SliderPaths::beat() const {
  constexpr double most = 300;
  const double apart = std::abs(ratio_ - std::round(ratio_));
  return static_cast<int>(std::ceil(std::min(most, 1 / apart)));
}

/// The rates in an earlier period that begins there.
Vector SliderPaths::earlier_rates(double begin, Index count) {
  const double step = two_pi / static_cast<double>(count - 1);
  turns_.set(begin, phase_ + ratio_ * begin, e_);
  ComplexVector here = Complex(0, 1) * q_.cwiseProduct(x_.cwiseProduct(e_));
  ComplexVector turn(q_.size());
  for (Index a = 0; a < q_.size(); ++a) turn(a) = std::polar(1.0, q_(a) * step);
  Vector rates(count);
  for (double& rate : rates) {
    rate = here.real().sum();
    here.array() *= turn.array();
  }
  return rates;
}

/// Adds the turns of a stretch that is sampled evenly, the last one first, to those behind it; up to the last
/// one before -pi to which the slider comes in slip whatever was before, as that is farther than 2 S from the
/// one before. The direction of that slip is returned, 0 if there is none.
int SliderPaths::add_turns(double begin, double end, const Eigen::Ref<const Vector>& rates, double threshold,
                           std::vector<Turn>& turns) {
  const double step = (end - begin) / static_cast<double>(rates.size() - 1);
  for (Index i = rates.size() - 1; i > 0; --i) {
    const double low = rates(i - 1);
    const double high = rates(i);
    if ((low > 0) == (high > 0)) continue;
    const double from = begin + static_cast<double>(i - 1) * step;
    const double theta = bracketed_newton(
        [this](double there) {
          const Local local = at(there);
          return std::pair(local.first, local.second);
        },
        from - step * low / (high - low), from, from + step, high > low);
    const Turn before{theta, at(theta).value};
    const Turn& next = turns.back();
    if (next.theta <= -pi && std::abs(next.value - before.value) > 2 * threshold)
      return next.value > before.value ? 1 : -1;
    turns.push_back(before);
  }
  return 0;
}

/// Where it comes to a level, between two turns.
double SliderPaths::onset(const Turn& from, const Turn& to, double level, int direction) {
  if (direction * (from.value - level) >= 0) return from.theta;
  return bracketed_newton(
      [&](double theta) {
        const Local local = at(theta);
        return std::pair(local.value - level, local.first);
      },
      0.5 * (from.theta + to.theta), from.theta, to.theta, direction > 0);
}

/// Where nothing is known of it it is loaded from zero.
std::vector<SliderArc> SliderPaths::arcs(Index place, double threshold) {
  phase_ = phase(place);
  std::vector<Turn> turns{{pi, at(pi).value}};  // the last one first
  int direction = 0;                            // of the slip that came to the first
  double begin = begins;
  if (rates_.rows() > 0) direction = add_turns(begins, pi, rates_.col(place), threshold, turns);
  for (int period = beat(); period > 0 && direction == 0 && rates_.rows() > 0; --period) {
    begin -= two_pi;
    const Vector rates = earlier_rates(begin, rates_.rows() / 2 + 1);
    direction = add_turns(begin, begin + two_pi, rates, threshold, turns);
  }
  if (direction == 0) {
    turns.push_back({begin, at(begin).value});
    if (std::abs(turns.back().value) > threshold) direction = turns.back().value > 0 ? 1 : -1;
  }
  const Turn& first = turns.back();
  double slider = direction == 0 ? 0 : first.value - direction * threshold;
  SliderArc stick{first.theta, first.theta, true, direction, direction == 0 ? 0 : first.theta};
  std::vector<SliderArc> arcs;
  const auto add = [&](SliderArc arc) {
    arc.begin = std::max(arc.begin, -pi);
    if (arc.end > arc.begin) arcs.push_back(arc);
  };
  for (std::size_t k = turns.size() - 1; k > 0; --k) {
    const Turn& from = turns[k];
    const Turn& to = turns[k - 1];
    direction = to.value > from.value ? 1 : -1;
    if (direction * (to.value - slider) <= threshold) continue;
    stick.end = onset(from, to, slider + direction * threshold, direction);
    add(stick);
    add({stick.end, to.theta, false, direction, 0});
    slider = to.value - direction * threshold;
    stick = {to.theta, to.theta, true, direction, to.theta};
  }
  stick.end = pi;
  add(stick);
  return arcs;
}

}  // namespace arcslip
