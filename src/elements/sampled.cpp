#include "arcslip/elements/sampled.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/elements/two_phases.hpp"

namespace arcslip {
namespace {

constexpr double settled_to = 1e-13;  // of the mean magnitude
constexpr Index most_samples = 4096;  // in half a period

/// Angles in half a period with e_h = e^{jh theta} of each order, angles x orders, and the motion there.
struct SampledTurn {
  Vector theta;
  ComplexMatrix e;
  Vector x;

  SampledTurn(Vector at, std::span<const int> orders, const HarmonicVector& motion)
      : theta(std::move(at)), e(theta.size(), std::ssize(orders)) {
    for (Index a = 0; a < e.cols(); ++a) {
      const double order = orders[static_cast<std::size_t>(a)];
      e.col(a).real() = (order * theta.array()).cos();
      e.col(a).imag() = (order * theta.array()).sin();
    }
    x = along(motion);
  }

  Vector along(const HarmonicVector& motion) const { return (e * motion).real(); }
};

/// What is averaged: columns like a force, odd in half a period, and one like a slope, even.
struct SampledTerms {
  Matrix forces;
  Vector slope;  ///< may be empty
};

/// 2 mean(f conj(e_h)) of each column, and c_m = mean(slope conj(e_m)) for m = 0, 2, ...
struct SampledMeans {
  ComplexMatrix forces;
  ComplexVector slope;
  double force_size = 0;  ///< mean magnitudes
  double slope_size = 0;

  static SampledMeans of(const SampledTurn& turn, const SampledTerms& terms, int highest) {
    SampledMeans means;
    const auto count = static_cast<double>(turn.theta.size());
    means.forces = 2 / count * (turn.e.adjoint() * terms.forces);
    means.force_size = terms.forces.cwiseAbs().sum() / count;
    if (terms.slope.size() == 0) return means;
    means.slope_size = terms.slope.cwiseAbs().sum() / count;
    means.slope.resize(highest + 1);
    ComplexVector turned = terms.slope.cast<Complex>() / count;
    const ComplexVector back = (-2.0 * Complex(0, 1) * turn.theta.cast<Complex>()).array().exp();
    for (Index m = 0; m <= highest; ++m) {
      means.slope(m) = turned.sum();
      turned.array() *= back.array();
    }
    return means;
  }

  /// The mean of both; tells whether they were the same.
  bool join(const SampledMeans& between) {
    const auto differ = [](const auto& a, const auto& b) {
      return a.size() == 0 ? 0.0 : (a - b).cwiseAbs().maxCoeff();
    };
    force_size = std::max(force_size, between.force_size);
    slope_size = std::max(slope_size, between.slope_size);
    const bool same = differ(forces, between.forces) <= settled_to * force_size &&
                      differ(slope, between.slope) <= settled_to * slope_size;
    forces = 0.5 * (forces + between.forces);
    slope = 0.5 * (slope + between.slope);
    return same;
  }

  void add_slope(std::span<const int> orders, ComplexMatrix& linear, ComplexMatrix& conjugate) const {
    for (Index l = 0; l < linear.cols(); ++l) {
      for (Index h = 0; h < linear.rows(); ++h) {
        const int of_row = orders[static_cast<std::size_t>(h)];
        const int of_column = orders[static_cast<std::size_t>(l)];
        const int m = (of_row - of_column) / 2;
        linear(h, l) += m < 0 ? std::conj(slope(-m)) : slope(m);
        conjugate(h, l) += slope((of_row + of_column) / 2);
      }
    }
  }
};

/// `terms` gives what is averaged over a turn.
template <class Terms>
SampledMeans settled_means(std::span<const int> orders, const HarmonicVector& x, const Terms& terms) {
  const int highest = highest_order(orders);
  Index count = 32;
  while (count < 4 * highest) count *= 2;
  const auto angles = [&](double shift) -> Vector {
    return (Vector::LinSpaced(count, 0, static_cast<double>(count - 1)).array() + shift) *
           (pi / static_cast<double>(count));
  };
  const auto at = [&](double shift) {
    const SampledTurn turn(angles(shift), orders, x);
    return SampledMeans::of(turn, terms(turn), highest);
  };
  SampledMeans means = at(0);
  for (;; count *= 2) {
    if (means.join(at(0.5)) || count >= most_samples) return means;
  }
}

}  // namespace

SampledElement::SampledElement(std::shared_ptr<const SampledLaw> law, double reference)
    : law_(std::move(law)), reference_(reference) {
  if (!(reference > 0)) throw std::invalid_argument("SampledElement: the reference must be positive");
}

void SampledElement::force(std::span<const int> orders, const HarmonicVector& x, double /*load*/,
                           bool /*beyond*/, bool derivatives, ElementForce& out) const {
  const SampledMeans means = settled_means(orders, x, [&](const SampledTurn& turn) {
    LawSamples samples;
    law_->at(turn.x, derivatives ? 1 : 0, samples);
    SampledTerms terms{samples.force, {}};
    if (!derivatives) return terms;
    terms.slope = std::move(samples.slope);
    if (samples.by_setting.size() == 0) return terms;
    terms.forces.conservativeResize(Eigen::NoChange, 2);
    terms.forces.col(1) = samples.by_setting;
    return terms;
  });
  out.harmonics = means.forces.col(0);
  out.energy = 0;
  out.by_setting.resize(0);
  if (!derivatives) return;
  if (means.forces.cols() > 1) out.by_setting = means.forces.col(1);
  out.linear.setZero(x.size(), x.size());
  out.conjugate.setZero(x.size(), x.size());
  out.by_log_load.setZero(x.size());
  means.add_slope(orders, out.linear, out.conjugate);
}

bool SampledElement::in_two_phases(const TwoPhases& phases, double /*load*/, const ComplexVector& x,
                                   double /*ratio*/, bool derivatives, LineForce& out) const {
  LawSamples here;
  const auto law = [&](double at) {
    law_->at(Vector::Constant(1, at), 1, here);
    return std::pair(here.force(0), here.slope(0));
  };
  phases.act(law, x, derivatives, out);
  return true;
}

VaryingStiffness SampledElement::stiffness_in_time(std::span<const int> orders,
                                                   const HarmonicVector& x) const {
  constexpr double negligible = 1e-14;
  SampledMeans means;
  for (Index count = 64;; count *= 2) {
    const Vector theta =
        Vector::LinSpaced(count, 0, static_cast<double>(count - 1)) * (pi / static_cast<double>(count));
    const SampledTurn turn(theta, orders, x);
    LawSamples samples;
    law_->at(turn.x, 1, samples);
    means = SampledMeans::of(turn, {Matrix(count, 0), samples.slope}, static_cast<int>(count / 2 - 1));
    const double rest = means.slope.tail(count / 8).cwiseAbs().maxCoeff();
    if (rest <= negligible * means.slope_size || count >= most_samples / 4) break;
  }
  Index last = means.slope.size() - 1;
  while (last > 0 && std::abs(means.slope(last)) <= negligible * means.slope_size) --last;
  VaryingStiffness stiffness;
  for (Index m = 0; m <= last; ++m) stiffness.harmonics.push_back((m == 0 ? 1.0 : 2.0) * means.slope(m));
  return stiffness;
}

void SampledElement::second(const ElementForce& /*at*/, std::span<const int> orders, const HarmonicVector& x,
                            double /*load*/, bool /*beyond*/, const Way& way, ElementForce& change) const {
  const SampledMeans means = settled_means(orders, x, [&](const SampledTurn& turn) {
    LawSamples samples;
    law_->at(turn.x, 2, samples);
    const Vector dx = turn.along(way.motion);
    SampledTerms terms{Matrix(dx.size(), 0), samples.curvature.cwiseProduct(dx)};
    if (samples.slope_by_setting.size() == 0) return terms;
    terms.slope += samples.slope_by_setting * way.setting;
    terms.forces = samples.slope_by_setting.cwiseProduct(dx) + samples.second_by_setting * way.setting;
    return terms;
  });
  means.add_slope(orders, change.linear, change.conjugate);
  if (means.forces.cols() > 0) change.by_setting += means.forces.col(0);
}

}  // namespace arcslip
