#include "arcslip/elements/hysteretic.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace arcslip {
namespace {

constexpr Index samples_of_harmonic = 8;  // in its own period
constexpr double difference_step = 0.05;  // of the motion, for second derivatives

/// The samples of a period, the first where the motion is largest, which moves with the motion.
class CycleTurn {
 public:
  CycleTurn(std::span<const int> orders, const HarmonicVector& motion, Index samples)
      : h_(Eigen::Map<const Eigen::VectorXi>(orders.data(), std::ssize(orders)).cast<double>()) {
    const OddMotion passes(orders, motion);
    maximum_ = passes.maximum();
    const double begin = maximum_.angle;
    const double step = two_pi / static_cast<double>(samples);
    const Vector theta =
        begin + step * Vector::LinSpaced(samples, 0, static_cast<double>(samples - 1)).array();
    e_ = (Complex(0, 1) * (theta * h_.transpose()).cast<Complex>()).array().exp();
    x_ = (e_ * motion).real();
    speed_ = (e_ * (Complex(0, 1) * h_.cast<Complex>()).cwiseProduct(motion)).real();
    const double bend = passes.slopes(begin).second;
    shift_.setZero(2 * h_.size());
    if (!(std::abs(bend) > flat * std::abs(x_(0)))) return;  // a motion that is zero, or a plateau
    for (Index l = 0; l < h_.size(); ++l) {
      const Complex slope = Complex(0, 1) * h_(l) * e_(0, l);  // of e^{jh theta}
      shift_(2 * l) = -slope.real() / bend;
      shift_(2 * l + 1) = slope.imag() / bend;
    }
  }

  const Vector& x() const { return x_; }
  OddMotion::Maximum maximum() const { return maximum_; }

  /// How x changes at the samples with the real and the imaginary part of each coefficient.
  Matrix ways() const {
    Matrix all(x_.size(), 2 * h_.size());
    for (Index l = 0; l < h_.size(); ++l) {
      all.col(2 * l) = e_.col(l).real();
      all.col(2 * l + 1) = -e_.col(l).imag();
    }
    return all + speed_ * shift_.transpose();
  }

  HarmonicVector harmonics(const Vector& samples) const {
    return 2 / static_cast<double>(samples.size()) * (e_.adjoint() * samples);
  }

  /// Those of the force along the k-th of the ways.
  HarmonicVector change(const Vector& samples, const HarmonicVector& force, Index k) const {
    return harmonics(samples) - (Complex(0, shift_(k)) * h_.cast<Complex>()).cwiseProduct(force);
  }

 private:
  static constexpr double flat = 1e-3;

  OddMotion::Maximum maximum_;
  Vector h_;
  ComplexMatrix e_;  // e^{jh theta}, samples x orders
  Vector x_;
  Vector speed_;  // dx/dtheta
  Vector shift_;  // of the first sample along each of the ways
};

}  // namespace

HystereticElement::HystereticElement(std::shared_ptr<const CycleLaw> law, double reference)
    : law_(std::move(law)), reference_(reference), stuck_(law_->stuck()) {
  if (!(reference > 0)) throw std::invalid_argument("HystereticElement: the reference must be positive");
}

void HystereticElement::force(std::span<const int> orders, const HarmonicVector& x, double /*load*/,
                              bool beyond, bool derivatives, ElementForce& out) const {
  if (beyond || !stuck_) return at(orders, x, 0, derivatives, out);
  const Jet& k = stuck_->stiffness;
  out.set_linear(k.value, x, derivatives);
  if (derivatives) out.by_setting = k.first * x;
}

void HystereticElement::at(std::span<const int> orders, const HarmonicVector& x, double setting,
                           bool derivatives, ElementForce& out) const {
  const Index least = samples_of_harmonic * highest_order(orders);
  const CycleTurn turn(orders, x, std::max(law_->samples(), least));
  CycleSamples samples;
  law_->at(turn.x(), derivatives ? turn.ways() : Matrix(), setting, derivatives, samples);
  out.harmonics = turn.harmonics(samples.force);
  out.energy = cycle_energy(orders, out.harmonics, x);
  out.swing = Swing::of_odd(turn.maximum());
  out.by_setting.resize(0);
  if (!derivatives) return;
  out.by_log_load.setZero(x.size());
  if (samples.by_setting.size() > 0) out.by_setting = turn.harmonics(samples.by_setting);
  out.linear.resize(x.size(), x.size());
  out.conjugate.resize(x.size(), x.size());
  for (Index l = 0; l < x.size(); ++l) {
    const HarmonicVector real = turn.change(samples.changes.col(2 * l), out.harmonics, 2 * l);
    const HarmonicVector imaginary = turn.change(samples.changes.col(2 * l + 1), out.harmonics, 2 * l + 1);
    out.linear.col(l) = 0.5 * (real - Complex(0, 1) * imaginary);
    out.conjugate.col(l) = 0.5 * (real + Complex(0, 1) * imaginary);
  }
}

void HystereticElement::second(const ElementForce& /*at*/, std::span<const int> orders,
                               const HarmonicVector& x, double /*load*/, bool beyond, const Way& way,
                               ElementForce& change) const {
  if (!beyond && stuck_) {
    const Jet& k = stuck_->stiffness;
    change.linear.diagonal().array() += k.first * way.setting;
    change.by_setting += k.first * way.motion + k.second * way.setting * x;
    return;
  }
  const auto moved = [&](const HarmonicVector& motion, double, double setting, ElementForce& out) {
    this->at(orders, motion, setting, true, out);
  };
  difference(moved, x, {way.motion, 0, way.setting}, law_->setting_scale(), difference_step, change);
}

}  // namespace arcslip
