#include "arcslip/elements/two_phases.hpp"

#include <algorithm>
#include <cmath>

#include "elements/harmonic_turn.hpp"
#include "motion/bracketed_newton.hpp"

namespace arcslip {
namespace {

/// (1/2 pi) int e^{jq theta} dtheta from a to b, and its derivative by q or s/w.
struct Integral {
  Complex value;
  Complex rate;
};

/// e^{jqa} and e^{jqb} are known.
Integral integral(double q, double a, double b, const Complex& at_a, const Complex& at_b) {
  constexpr double slow = 1e-4;
  if (std::abs(q) * (b - a) < slow) {  // four terms about the middle
    const double middle = 0.5 * (a + b);
    const double half = 0.5 * (b - a);
    const double t = q * half;
    const Complex turn = std::polar(1.0, q * middle) * half / pi;
    const double sinc = 1 - t * t / 6;
    return {turn * sinc, turn * Complex(-q * half * half / 3, middle * sinc)};
  }
  const Complex over(0, -1 / (two_pi * q));
  const Complex value = over * (at_b - at_a);
  return {value, (b * at_b - a * at_a) / (two_pi * q) - value / q};
}

/// The motion along one line, Re sum y_a e^{j q_a theta}.
class Along {
 public:
  /// What is zero does not count.
  Along(const Vector& q, const ComplexVector& y) {
    const Index count = (y.array() != 0.0).count();
    q_.resize(count);
    y_.resize(count);
    for (Index a = 0, k = 0; a < q.size(); ++a) {
      if (y(a) == 0.0) continue;
      q_(k) = q(a);
      y_(k++) = y(a);
    }
  }

  struct Local {
    double value, first, second;
  };
  Local at(double theta) const {
    Local sum{0, 0, 0};
    for (Index a = 0; a < q_.size(); ++a) {
      const Complex turned = y_(a) * std::polar(1.0, q_(a) * theta);
      sum.value += turned.real();
      sum.first -= q_(a) * turned.imag();
      sum.second -= q_(a) * q_(a) * turned.real();
    }
    return sum;
  }
  double value(double theta) const { return at(theta).value; }

  /// Where it turns back between a and b.
  std::vector<double> turns(double a, double b) const {
    if (q_.size() == 0) return {};
    const double fastest = q_.cwiseAbs().maxCoeff();
    const auto steps = static_cast<Index>(std::ceil((b - a) / two_pi * fastest * samples));
    const double step = (b - a) / static_cast<double>(steps);
    ComplexVector turned = y_;
    ComplexVector turn(q_.size());
    for (Index i = 0; i < q_.size(); ++i) {
      turned(i) *= Complex(0, q_(i)) * std::polar(1.0, q_(i) * a);
      turn(i) = std::polar(1.0, q_(i) * step);
    }
    std::vector<double> found;
    double before = turned.real().sum();
    for (Index k = 1; k <= steps; ++k) {
      turned.array() *= turn.array();
      const double here = turned.real().sum();
      if ((here > 0) != (before > 0)) {
        const double end = a + static_cast<double>(k) * step;
        const double guess = end - step * here / (here - before);
        found.push_back(bracketed_newton(
            [this](double theta) {
              const Local at = this->at(theta);
              return std::pair(at.first, at.second);
            },
            guess, end - step, end, here > before));
      }
      before = here;
    }
    return found;
  }

 private:
  static constexpr double samples = 12;  // in a period of the fastest

  Vector q_;
  ComplexVector y_;
};

/// An arc of stick, f = k (x - z) with z = x(anchor) - direction S, or 0 where nothing has set it; or,
/// without `sticks`, of slip.
struct SliderArc {
  double begin, end;
  bool sticks;
  int direction;
  double anchor;
};

/// What a slider does from theta = -pi to pi, settled over some periods before.
std::vector<SliderArc> slider_arcs(const Along& x, double threshold) {
  constexpr int before = 3;
  const double begin = -pi - two_pi * before;
  std::vector<double> ends = x.turns(begin, pi);
  ends.push_back(pi);
  std::vector<SliderArc> arcs;
  const auto add = [&](SliderArc arc) {
    arc.begin = std::max(arc.begin, -pi);
    if (arc.end > arc.begin) arcs.push_back(arc);
  };
  double place = 0;  // of the slider
  SliderArc stick{begin, begin, true, 0, 0};
  if (const double start = x.value(begin); std::abs(start) > threshold) {
    stick.direction = start > 0 ? 1 : -1;
    stick.anchor = begin;
    place = start - stick.direction * threshold;
  }
  double from = begin;
  for (const double to : ends) {
    const double reached = x.value(to);
    const int direction = reached > x.value(from) ? 1 : -1;
    if (direction * (reached - place) > threshold) {
      const double level = place + direction * threshold;
      double onset = from;
      if (direction * (x.value(from) - level) < 0)
        onset = bracketed_newton(
            [&](double theta) {
              const Along::Local at = x.at(theta);
              return std::pair(at.value - level, at.first);
            },
            0.5 * (from + to), from, to, direction > 0);
      stick.end = onset;
      add(stick);
      add({onset, to, false, direction, 0});
      place = reached - direction * threshold;
      stick = {to, to, true, direction, to};
    }
    from = to;
  }
  stick.end = pi;
  add(stick);
  return arcs;
}

/// Over one arc, of f of stick less what is held since its anchor, with rates by s/w.
struct SlideIntegrals {
  const Vector& q;
  Vector by_ratio;  // of q
  SliderArc arc;
  ComplexVector at_begin, at_end, at_anchor;  // e^{jq theta}

  /// Of e^{-j q_a theta}.
  Integral alone(Index a) const {
    return rated(-by_ratio(a),
                 integral(-q(a), arc.begin, arc.end, std::conj(at_begin(a)), std::conj(at_end(a))));
  }
  /// Of e^{j(q_b - q_a) theta} and e^{-j(q_b + q_a) theta}.
  Integral direct(Index a, Index b, const Integral& alone) const {
    return held(at_anchor(b), by_ratio(b), alone,
                rated(by_ratio(b) - by_ratio(a),
                      integral(q(b) - q(a), arc.begin, arc.end, at_begin(b) * std::conj(at_begin(a)),
                               at_end(b) * std::conj(at_end(a)))));
  }
  Integral turned(Index a, Index b, const Integral& alone) const {
    return held(std::conj(at_anchor(b)), -by_ratio(b), alone,
                rated(-by_ratio(b) - by_ratio(a),
                      integral(-q(b) - q(a), arc.begin, arc.end, std::conj(at_begin(b) * at_begin(a)),
                               std::conj(at_end(b) * at_end(a)))));
  }

 private:
  static Integral rated(double rate, const Integral& by_q) { return {by_q.value, rate * by_q.rate}; }
  Integral held(const Complex& at, double rate, const Integral& alone, const Integral& moving) const {
    if (arc.direction == 0) return moving;
    return {moving.value - at * alone.value,
            moving.rate - at * (Complex(0, rate * arc.anchor) * alone.value + alone.rate)};
  }
};

}  // namespace

TwoPhases::TwoPhases(std::vector<Line> lines, Index places)
    : lines_(std::move(lines)), places_(places), most_k_(most(&Line::k)), most_l_(most(&Line::l)) {}

int TwoPhases::most(int Line::*which) const {
  int most = 0;
  for (const Line& line : lines_) most = std::max(most, std::abs(line.*which));
  return most;
}

/// k + l s/w of each line.
Vector TwoPhases::frequencies(double ratio) const {
  Vector q(std::ssize(lines_));
  std::transform(lines_.begin(), lines_.end(), q.begin(),
                 [ratio](const Line& line) { return line.k + line.l * ratio; });
  return q;
}

/// What a mean over theta_1 from one p counts in a coefficient.
double TwoPhases::share(Index a) const {
  return (lines_[static_cast<std::size_t>(a)] == Line{0, 0} ? 1.0 : 2.0) / static_cast<double>(places_);
}

/// e^{j(k theta_1 + l theta_2)} of all lines.
void TwoPhases::set_turns(double first, double second, ComplexVector& e) const {
  ComplexVector of_k(most_k_ + 1);
  ComplexVector of_l(2 * most_l_ + 1);
  for (int k = 0; k <= most_k_; ++k) of_k(k) = std::polar(1.0, k * first);
  for (int l = -most_l_; l <= most_l_; ++l) of_l(most_l_ + l) = std::polar(1.0, l * second);
  e.resize(std::ssize(lines_));
  for (Index a = 0; a < e.size(); ++a) {
    const Line& line = lines_[static_cast<std::size_t>(a)];
    e(a) = of_k(line.k) * of_l(most_l_ + line.l);
  }
}

void TwoPhases::rest(LineForce& out) const {
  const Index n = std::ssize(lines_);
  for (ComplexVector* one : {&out.force, &out.by_log_load, &out.by_ratio}) one->setZero(n);
  out.linear.setZero(n, n);
  out.conjugate.setZero(n, n);
}

/// f/k alone, by Gauss's nodes over the arcs.
void TwoPhases::slide_force(double threshold, const ComplexVector& x, double ratio,
                            ComplexVector& force) const {
  const Vector q = frequencies(ratio);
  const auto fastest = static_cast<int>(2 * std::ceil(q.cwiseAbs().maxCoeff()));
  force.setZero(x.size());
  ComplexVector e;
  ComplexVector turn;
  for (Index place = 0; place < places_; ++place) {
    const double p = two_pi * static_cast<double>(place) / static_cast<double>(places_);
    set_turns(0, p, turn);
    const Along along(q, turn.cwiseProduct(x));
    for (const SliderArc& arc : slider_arcs(along, threshold)) {
      const double set = arc.direction * threshold;
      const double start = arc.sticks && arc.direction != 0 ? along.value(arc.anchor) : 0;
      each_gauss_node(arc.begin, arc.end, fastest, [&](double theta, double weight) {
        set_turns(theta, p + ratio * theta, e);
        const double stick = arc.sticks ? (x.transpose() * e).value().real() - start : 0;
        force += (weight / two_pi * (stick + set)) * e.conjugate();
      });
    }
  }
  for (Index a = 0; a < x.size(); ++a) force(a) *= share(a);
}

void TwoPhases::slide(double stiffness, double threshold, const ComplexVector& x, double ratio,
                      bool derivatives, LineForce& out) const {
  if (!derivatives) {
    slide_force(threshold, x, ratio, out.force);
    out.force *= stiffness;
    return;
  }
  rest(out);
  const Index n = std::ssize(lines_);
  const Vector q = frequencies(ratio);
  SlideIntegrals over{q, Vector(n), {}, {}, {}, {}};
  for (Index a = 0; a < n; ++a) over.by_ratio(a) = lines_[static_cast<std::size_t>(a)].l;
  ComplexVector turn;
  for (Index place = 0; place < places_; ++place) {
    const double p = two_pi * static_cast<double>(place) / static_cast<double>(places_);
    set_turns(0, p, turn);
    const ComplexVector y = turn.cwiseProduct(x);
    for (const SliderArc& arc : slider_arcs({q, y}, threshold)) {
      over.arc = arc;
      set_turns(arc.begin, ratio * arc.begin, over.at_begin);
      set_turns(arc.end, ratio * arc.end, over.at_end);
      set_turns(arc.anchor, ratio * arc.anchor, over.at_anchor);
      for (Index a = 0; a < n; ++a) {
        const Complex weight = share(a) * std::conj(turn(a));
        const Integral alone = over.alone(a);
        const double set = arc.direction * threshold;
        out.by_log_load(a) += weight * set * alone.value;
        out.by_ratio(a) += weight * set * alone.rate;
        for (Index b = 0; b < n && arc.sticks; ++b) {
          const Integral direct = over.direct(a, b, alone);
          const Integral turned = over.turned(a, b, alone);
          out.linear(a, b) += 0.5 * weight * turn(b) * direct.value;
          out.conjugate(a, b) += 0.5 * weight * std::conj(turn(b)) * turned.value;
          out.by_ratio(a) += 0.5 * weight * (y(b) * direct.rate + std::conj(y(b)) * turned.rate);
        }
      }
    }
  }
  out.linear *= stiffness;
  out.conjugate *= stiffness;
  out.by_ratio *= stiffness;
  out.by_log_load *= stiffness;
  out.force = out.linear * x + out.conjugate * x.conjugate() + out.by_log_load;
}

void TwoPhases::act(const Law& law, const ComplexVector& x, bool derivatives, LineForce& out) const {
  constexpr Index times = 8;
  const Index fast = times * (most_k_ + 1);
  const Index slow = times * (most_l_ + 1);
  rest(out);
  ComplexVector e;
  for (Index i = 0; i < fast * slow; ++i) {
    set_turns(two_pi * static_cast<double>(i / slow) / static_cast<double>(fast),
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
  ComplexMatrix turns(fast, most_k_ + 1);
  for (Index i = 0; i < fast; ++i) {
    for (int k = 0; k <= most_k_; ++k)
      turns(i, k) = std::polar(1.0, two_pi * static_cast<double>(k * i) / static_cast<double>(fast));
  }
  double greatest = 0;
  ComplexVector e;
  ComplexVector of_k(most_k_ + 1);
  for (Index place = 0; place < slow; ++place) {
    set_turns(0, two_pi * static_cast<double>(place) / static_cast<double>(slow), e);
    of_k.setZero();
    for (Index a = 0; a < x.size(); ++a) of_k(lines_[static_cast<std::size_t>(a)].k) += x(a) * e(a);
    greatest = std::max(greatest, (turns * of_k).real().cwiseAbs().maxCoeff());
  }
  return greatest;
}

}  // namespace arcslip
