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

int most(const std::vector<Line>& lines, int Line::*which) {
  int most = 0;
  for (const Line& line : lines) most = std::max(most, std::abs(line.*which));
  return most;
}

/// k + l s/w of each line.
Vector frequencies(const std::vector<Line>& lines, double ratio) {
  Vector q(std::ssize(lines));
  std::transform(lines.begin(), lines.end(), q.begin(),
                 [ratio](const Line& line) { return line.k + line.l * ratio; });
  return q;
}

/// e^{j(k theta_1 + l theta_2)} of lines, by powers of those of k = 1 and l = 1.
class Turns {
 public:
  explicit Turns(const std::vector<Line>& lines)
      : lines_(lines), of_k_(most(lines, &Line::k) + 1), of_l_(most(lines, &Line::l) + 1) {}

  void set(double first, double second, ComplexVector& e) {
    set_powers(first, of_k_);
    set_powers(second, of_l_);
    e.resize(std::ssize(lines_));
    for (Index a = 0; a < e.size(); ++a) {
      const auto [k, l] = lines_[static_cast<std::size_t>(a)];
      e(a) = of_k_(k) * (l < 0 ? std::conj(of_l_(-l)) : of_l_(l));
    }
  }

 private:
  static void set_powers(double angle, ComplexVector& powers) {
    const Complex one = std::polar(1.0, angle);
    powers(0) = 1;
    for (Index i = 1; i < powers.size(); ++i) powers(i) = powers(i - 1) * one;
  }

  const std::vector<Line>& lines_;
  ComplexVector of_k_;
  ComplexVector of_l_;
};

/// The motion along the line theta_2 = (s/w) theta_1, Re sum y_a e^{j q_a theta_1}.
class Along {
 public:
  /// What is zero does not count.
  Along(const std::vector<Line>& lines, const ComplexVector& y, double ratio)
      : lines_(moving(lines, y)),
        ratio_(ratio),
        q_(frequencies(lines_, ratio)),
        y_(q_.size()),
        turns_(lines_) {
    std::copy_if(y.begin(), y.end(), y_.begin(), [](const Complex& one) { return one != 0.0; });
  }

  struct Local {
    double value, first, second;
  };
  Local at(double theta) {
    Local sum{0, 0, 0};
    turns_.set(theta, ratio_ * theta, e_);
    for (Index a = 0; a < q_.size(); ++a) {
      const Complex turned = y_(a) * e_(a);
      sum.value += turned.real();
      sum.first -= q_(a) * turned.imag();
      sum.second -= q_(a) * q_(a) * turned.real();
    }
    return sum;
  }
  double value(double theta) { return at(theta).value; }

  /// Where it turns back between a and b.
  std::vector<double> turns(double a, double b) {
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

  static std::vector<Line> moving(const std::vector<Line>& lines, const ComplexVector& y) {
    std::vector<Line> moving;
    for (std::size_t a = 0; a < lines.size(); ++a) {
      if (y(static_cast<Index>(a)) != 0.0) moving.push_back(lines[a]);
    }
    return moving;
  }

  std::vector<Line> lines_;
  double ratio_;
  Vector q_;
  ComplexVector y_;
  Turns turns_;  // of lines_
  ComplexVector e_;
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
std::vector<SliderArc> slider_arcs(Along& x, double threshold) {
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

/// Over one arc, with rates by s/w.
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
  /// Of e^{j(q_b - q_a) theta}; where a and b change places, their conjugates.
  Integral direct(Index a, Index b) const {
    return rated(by_ratio(b) - by_ratio(a),
                 integral(q(b) - q(a), arc.begin, arc.end, at_begin(b) * std::conj(at_begin(a)),
                          at_end(b) * std::conj(at_end(a))));
  }
  /// Of e^{-j(q_b + q_a) theta}, whichever is a.
  Integral turned(Index a, Index b) const {
    return rated(-by_ratio(b) - by_ratio(a),
                 integral(-q(b) - q(a), arc.begin, arc.end, std::conj(at_begin(b) * at_begin(a)),
                          std::conj(at_end(b) * at_end(a))));
  }
  /// Of e^{-j q_a theta} e^{j q_b theta}, or its conjugate, less what is held of the latter since the anchor.
  Integral less_held(Integral moving, Index b, bool conjugate, const Integral& alone) const {
    if (arc.direction == 0) return moving;
    const Complex at = conjugate ? std::conj(at_anchor(b)) : at_anchor(b);
    const double rate = conjugate ? -by_ratio(b) : by_ratio(b);
    moving.value -= at * alone.value;
    moving.rate -= at * (Complex(0, rate * arc.anchor) * alone.value + alone.rate);
    return moving;
  }

 private:
  static Integral rated(double rate, const Integral& by_q) { return {by_q.value, rate * by_q.rate}; }
};

}  // namespace

TwoPhases::TwoPhases(std::vector<Line> lines, Index places)
    : lines_(std::move(lines)),
      places_(places),
      most_k_(most(lines_, &Line::k)),
      most_l_(most(lines_, &Line::l)) {}

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

/// f/k alone, by Gauss's nodes over the arcs.
void TwoPhases::slide_force(double threshold, const ComplexVector& x, double ratio,
                            ComplexVector& force) const {
  const auto fastest = static_cast<int>(2 * std::ceil(frequencies(lines_, ratio).cwiseAbs().maxCoeff()));
  force.setZero(x.size());
  Turns turns(lines_);
  ComplexVector e;
  ComplexVector turn;
  for (Index place = 0; place < places_; ++place) {
    const double p = two_pi * static_cast<double>(place) / static_cast<double>(places_);
    turns.set(0, p, turn);
    Along along(lines_, turn.cwiseProduct(x), ratio);
    for (const SliderArc& arc : slider_arcs(along, threshold)) {
      const double set = arc.direction * threshold;
      const double start = arc.sticks && arc.direction != 0 ? along.value(arc.anchor) : 0;
      each_gauss_node(arc.begin, arc.end, fastest, [&](double theta, double weight) {
        turns.set(theta, p + ratio * theta, e);
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
  const Vector q = frequencies(lines_, ratio);
  SlideIntegrals over{q, Vector(n), {}, {}, {}, {}};
  std::vector<Integral> alone(lines_.size());
  for (Index a = 0; a < n; ++a) over.by_ratio(a) = lines_[static_cast<std::size_t>(a)].l;
  Turns turns(lines_);
  ComplexVector turn;
  for (Index place = 0; place < places_; ++place) {
    const double p = two_pi * static_cast<double>(place) / static_cast<double>(places_);
    turns.set(0, p, turn);
    const ComplexVector y = turn.cwiseProduct(x);
    Along along(lines_, y, ratio);
    for (const SliderArc& arc : slider_arcs(along, threshold)) {
      over.arc = arc;
      turns.set(arc.begin, ratio * arc.begin, over.at_begin);
      turns.set(arc.end, ratio * arc.end, over.at_end);
      turns.set(arc.anchor, ratio * arc.anchor, over.at_anchor);
      const double set = arc.direction * threshold;
      const auto add = [&](Index a, Index b, const Integral& direct, const Integral& turned) {
        const Complex half = 0.5 * share(a) * std::conj(turn(a));
        const auto& at = alone[static_cast<std::size_t>(a)];
        const Integral straight = over.less_held(direct, b, false, at);
        const Integral mirrored = over.less_held(turned, b, true, at);
        out.linear(a, b) += half * turn(b) * straight.value;
        out.conjugate(a, b) += half * std::conj(turn(b)) * mirrored.value;
        out.by_ratio(a) += half * (y(b) * straight.rate + std::conj(y(b)) * mirrored.rate);
      };
      for (Index a = 0; a < n; ++a) {
        const Integral& own = alone[static_cast<std::size_t>(a)] = over.alone(a);
        const Complex weight = share(a) * set * std::conj(turn(a));
        out.by_log_load(a) += weight * own.value;
        out.by_ratio(a) += weight * own.rate;
        for (Index b = 0; b <= a && arc.sticks; ++b) {
          const Integral direct = over.direct(a, b);
          const Integral turned = over.turned(a, b);
          add(a, b, direct, turned);
          if (b != a) add(b, a, {std::conj(direct.value), std::conj(direct.rate)}, turned);
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
  Turns turns(lines_);
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
  Turns turns(lines_);
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
