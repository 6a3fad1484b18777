#include "arcslip/elements/two_phases.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "elements/slider_arcs.hpp"

namespace arcslip {
namespace {

/// Means over an arc, (1/2 pi) int e^{j(k theta_1 + l theta_2)} dtheta_1 of lines, and their derivatives by
/// s/w.
class ArcMeans {
 public:
  ArcMeans(const std::vector<Line>& lines, double ratio)
      : value(std::ssize(lines)),
        rate(value.size()),
        lines_(lines),
        ratio_(ratio),
        q_(frequencies(lines, ratio)),
        turns_(lines) {}

  /// On the line theta_2 = p + (s/w) theta_1.
  void set(const SliderArc& arc, double p) {
    turns_.set(arc.begin, p + ratio_ * arc.begin, at_begin_);
    turns_.set(arc.end, p + ratio_ * arc.end, at_end_);
    for (Index i = 0; i < q_.size(); ++i) set_one(i, arc.begin, arc.end, p);
  }

  ComplexVector value;
  ComplexVector rate;

 private:
  void set_one(Index i, double a, double b, double p) {
    constexpr double slow = 1e-4;
    const double l = lines_[static_cast<std::size_t>(i)].l;
    const double q = q_(i);
    if (std::abs(q) * (b - a) < slow) {  // four terms about the middle
      const double middle = 0.5 * (a + b);
      const double half = 0.5 * (b - a);
      const double t = q * half;
      const Complex turn = std::polar(1.0, q * middle + l * p) * half / pi;
      const double sinc = 1 - t * t / 6;
      value(i) = turn * sinc;
      rate(i) = l * turn * Complex(-q * half * half / 3, middle * sinc);
      return;
    }
    value(i) = Complex(0, -1 / (two_pi * q)) * (at_end_(i) - at_begin_(i));
    rate(i) = l * ((b * at_end_(i) - a * at_begin_(i)) / (two_pi * q) - value(i) / q);
  }

  const std::vector<Line>& lines_;
  double ratio_;
  Vector q_;
  LineTurns turns_;
  ComplexVector at_begin_;
  ComplexVector at_end_;
};

/// The real sum of lines at theta_1, and its derivative by s/w.
std::pair<double, double> value_at(double theta, const std::vector<Line>& lines,
                                   const ComplexVector& turned) {
  double rate = 0;
  for (Index b = 0; b < turned.size(); ++b)
    rate -= theta * lines[static_cast<std::size_t>(b)].l * turned(b).imag();
  return {turned.real().sum(), rate};
}

/// Means of conj(e_a) e_b and of conj(e_a e_b), less those of conj(e_a) times e_b, or its conjugate, at
/// anchors.
template <class Pairs>
void fill_derivatives(const Pairs& differences, const ComplexVector& of_differences, const Pairs& sums,
                      const ComplexVector& of_sums, const std::vector<Complex>& means,
                      const std::vector<Complex>& anchors, LineForce& out) {
  const Index n = out.force.size();
  const Index arcs = std::ssize(means) / n;
  const Eigen::Map<const ComplexMatrix> mean(means.data(), n, arcs);
  const Eigen::Map<const ComplexMatrix> anchor(anchors.data(), n, arcs);
  out.linear.noalias() = -mean * anchor.transpose();
  out.conjugate.noalias() = -mean * anchor.adjoint();
  for (Index a = 0; a < n; ++a) {
    for (Index b = 0; b < n; ++b) {
      out.linear(a, b) += differences.of(of_differences, a, b);
      out.conjugate(a, b) += std::conj(sums.of(of_sums, a, b));
    }
  }
}

}  // namespace

TwoPhases::TwoPhases(std::vector<Line> lines, Index places)
    : lines_(std::move(lines)),
      places_(places),
      differences_(lines_, -1),
      sums_(lines_, 1),
      most_k_(most(lines_, &Line::k)),
      most_l_(most(lines_, &Line::l)) {}

TwoPhases::Pairs::Pairs(const std::vector<Line>& of, int sign) : places_(std::ssize(of), std::ssize(of)) {
  std::map<std::pair<int, int>, int> known;
  for (Index a = 0; a < places_.rows(); ++a) {
    for (Index b = 0; b < places_.cols(); ++b) {
      const Line& first = of[static_cast<std::size_t>(a)];
      const Line& second = of[static_cast<std::size_t>(b)];
      Line both{second.k + sign * first.k, second.l + sign * first.l};
      const bool is_conjugate = both.k < 0 || (both.k == 0 && both.l < 0);
      if (is_conjugate) both = {-both.k, -both.l};
      const auto [at, is_new] = known.try_emplace({both.k, both.l}, static_cast<int>(lines.size()) + 1);
      if (is_new) lines.push_back(both);
      places_(a, b) = is_conjugate ? -at->second : at->second;
    }
  }
}

/// What a mean over theta_1 from one p counts in a coefficient.
double TwoPhases::share(Index a) const {
  return (lines_[static_cast<std::size_t>(a)] == Line{0, 0} ? 1.0 : 2.0) / static_cast<double>(places_);
}

void TwoPhases::rest(LineForce& out) const {
  const Index n = std::ssize(lines_);
  for (ComplexVector* one : {&out.force, &out.by_log_load, &out.by_ratio}) one->setZero(n);
  out.linear.setZero(n, n);
  out.conjugate.setZero(n, n);
}

/// With e_a = e^{j(k theta_1 + l theta_2)} the force in line a is a mean of (f/k) conj(e_a), where f/k is +-S
/// in slip, and in stick also x = Re sum x_b e_b less its value at the anchor. So means of conj(e_a) e_b and
/// of conj(e_a e_b) are wanted, which depend on differences and sums of lines alone, and of conj(e_a) times
/// e_b at the anchor.
void TwoPhases::slide(double stiffness, double threshold, const ComplexVector& x, double ratio,
                      bool derivatives, LineForce& out) const {
  const Index n = std::ssize(lines_);
  ArcMeans one(lines_, ratio);
  ArcMeans difference(differences_.lines, ratio);
  ArcMeans sum(sums_.lines, ratio);
  ComplexMatrix of_differences = ComplexMatrix::Zero(difference.value.size(), 2);  // mean and its rate
  ComplexMatrix of_sums = ComplexMatrix::Zero(sum.value.size(), 2);
  ComplexMatrix held = ComplexMatrix::Zero(n, 2);  // f/k of what is held at anchors, its rate
  ComplexMatrix set = ComplexMatrix::Zero(n, 2);   // of +-S
  std::vector<Complex> means;                      // n of each anchor
  std::vector<Complex> anchors;
  ComplexVector at_anchor(n);
  LineTurns turns(lines_);
  SliderPaths paths(lines_, x, ratio, places_);
  for (Index place = 0; place < places_; ++place) {
    const double p = paths.phase(place);
    for (const SliderArc& arc : paths.arcs(place, threshold)) {
      one.set(arc, p);
      set.col(0) += arc.direction * threshold * one.value.conjugate();
      set.col(1) += arc.direction * threshold * one.rate.conjugate();
      if (!arc.sticks) continue;
      difference.set(arc, p);
      sum.set(arc, p);
      of_differences.col(0) += difference.value;
      of_sums.col(0) += sum.value;
      of_differences.col(1) += difference.rate;
      of_sums.col(1) += sum.rate;
      if (arc.direction == 0) continue;
      turns.set(arc.anchor, p + ratio * arc.anchor, at_anchor);
      const auto [value, rate] = value_at(arc.anchor, lines_, x.cwiseProduct(at_anchor));
      held.col(0) += value * one.value.conjugate();
      held.col(1) += rate * one.value.conjugate() + value * one.rate.conjugate();
      if (!derivatives) continue;
      for (const Complex& mean : one.value) means.push_back(std::conj(mean));
      anchors.insert(anchors.end(), at_anchor.begin(), at_anchor.end());
    }
  }
  out.force = set.col(0) - held.col(0);
  out.by_ratio = set.col(1) - held.col(1);
  out.by_log_load = set.col(0);
  for (Index a = 0; a < n; ++a) {
    for (Index b = 0; b < n; ++b) {
      const auto moves = [&](Index which) {
        return 0.5 * (x(b) * differences_.of(of_differences.col(which), a, b) +
                      std::conj(x(b) * sums_.of(of_sums.col(which), a, b)));
      };
      out.force(a) += moves(0);
      out.by_ratio(a) += moves(1);
    }
  }
  Vector shares(n);
  for (Index a = 0; a < n; ++a) shares(a) = stiffness * share(a);
  for (ComplexVector* rows : {&out.force, &out.by_ratio, &out.by_log_load}) rows->array() *= shares.array();
  if (!derivatives) return;
  fill_derivatives(differences_, of_differences.col(0), sums_, of_sums.col(0), means, anchors, out);
  out.linear = 0.5 * shares.asDiagonal() * out.linear;
  out.conjugate = 0.5 * shares.asDiagonal() * out.conjugate;
}

void TwoPhases::act(const Law& law, const ComplexVector& x, bool derivatives, LineForce& out) const {
  constexpr Index times = 8;
  const Index fast = times * (most_k_ + 1);
  const Index slow = times * (most_l_ + 1);
  rest(out);
  LineTurns turns(lines_);
  ComplexVector e;
  for (Index i = 0; i < fast * slow; ++i) {
    turns.set(two_pi * static_cast<double>(i / slow) / static_cast<double>(fast),
              two_pi * static_cast<double>(i % slow) / static_cast<double>(slow), e);
    const auto [force, slope] = law((x.transpose() * e).value().real());
    const ComplexVector back = e.conjugate() / static_cast<double>(fast * slow);
    out.force += 2 * force * back;
    if (!derivatives) continue;
    out.linear.noalias() += slope * back * e.transpose();
    out.conjugate.noalias() += slope * back * e.adjoint();
  }
  for (Index a = 0; a < x.size(); ++a) {
    if (!(lines_[static_cast<std::size_t>(a)] == Line{0, 0})) continue;
    out.force(a) *= 0.5;
    out.linear.row(a) *= 0.5;
    out.conjugate.row(a) *= 0.5;
  }
}

double TwoPhases::greatest(const ComplexVector& x) const {
  constexpr Index times = 32;
  const Index fast = times * (most_k_ + 1);
  const Index slow = times * (most_l_ + 1);
  ComplexMatrix fast_turns(fast, most_k_ + 1);
  for (Index i = 0; i < fast; ++i) {
    for (int k = 0; k <= most_k_; ++k)
      fast_turns(i, k) = std::polar(1.0, two_pi * static_cast<double>(k * i) / static_cast<double>(fast));
  }
  double greatest = 0;
  LineTurns turns(lines_);
  ComplexVector e;
  ComplexVector of_k(most_k_ + 1);
  for (Index place = 0; place < slow; ++place) {
    turns.set(0, two_pi * static_cast<double>(place) / static_cast<double>(slow), e);
    of_k.setZero();
    for (Index a = 0; a < x.size(); ++a) of_k(lines_[static_cast<std::size_t>(a)].k) += x(a) * e(a);
    greatest = std::max(greatest, (fast_turns * of_k).real().cwiseAbs().maxCoeff());
  }
  return greatest;
}

}  // namespace arcslip
