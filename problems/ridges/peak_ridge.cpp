#include "arcslip/problems/ridges/peak_ridge.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "arcslip/dense.hpp"
#include "arcslip/elements/contact.hpp"
#include "arcslip/problems/response/contact_problem.hpp"

namespace arcslip::problems {
namespace {

/// phi with d phi/dt and their derivatives in w, t = w^2.
struct LawInRoot {
  Complex phi;
  Complex by_t;
  Complex by_w;
  Complex by_t_w;
};

LawInRoot law_in_root(double w) {
  const double t = w * w;
  const HarmonicCoefficient law = slip_coefficient(t);
  const double x = std::exp(-t);
  const double rest = -std::expm1(-t);
  const double per_root = t > 0 ? std::sqrt(rest / t) : 1;  // sqrt(1 - x)/w
  const double root = w * per_root;
  constexpr double inverse_pi = std::numbers::inv_pi;
  // With the sign of w the square roots go on analytically beyond the border.
  const double real_t = -8 * inverse_pi * x * std::sqrt(x) * root;
  // 2 w d/dt of x^1.5 (1 - x)^0.5
  const double real_t_w = -8 * inverse_pi * x * std::sqrt(x) * (x / per_root - 3 * w * root);
  const double imaginary_t = -4 * inverse_pi * x * (rest - x);
  const double imaginary_t_w = -8 * inverse_pi * w * x * (4 * x - 1);
  const double real = w < 0 ? 2 - law.phi.real() : law.phi.real();
  return {{real, law.phi.imag()},
          {real_t, imaginary_t},
          {2 * w * real_t, 2 * w * imaginary_t},
          {real_t_w, imaginary_t_w}};
}

/// What g and h are made of, or its derivative in one direction.
struct Terms {
  double log_R = 0;
  Complex phi;
  Complex phi_t;
  Complex c;
  Complex c_eta;
  Complex damper;
  Complex damper_eta;
  double log_free = 0;
  double log_free_eta = 0;
  double threshold_eta = 0;  // d ln S/d eta
};

/// g and h at a point, and their derivatives in any direction.
class Ridge {
 public:
  Ridge(double k, const Terms& at) : at_(at), k_(k) {
    q_ = 1.0 + k * at.phi * at.c;
    q_damper_ = 1.0 + k * at.phi * at.damper;
    inverse_ = std::conj(q_) / std::norm(q_);
    gain_ = k * inverse_;
    damper_gain_ = k * std::conj(q_damper_) / std::norm(q_damper_);
    by_ratio_ = std::real(gain_ * at.phi_t * at.c);
    log_R_eta_ = (at.log_free_eta - std::real(gain_ * at.phi * at.c_eta) + by_ratio_ * at.threshold_eta) /
                 (1 + by_ratio_);
    log_ratio_eta_ = log_R_eta_ - at.threshold_eta;
    own_ = at.phi * at.damper_eta + log_ratio_eta_ * at.phi_t * at.damper;
  }

  double log_Y() const { return at_.log_R + 0.5 * std::log(std::norm(q_damper_)); }

  Eigen::Vector2d values() const {
    return {at_.log_R + 0.5 * std::log(std::norm(q_)) - at_.log_free,
            log_R_eta_ + std::real(damper_gain_ * own_)};
  }

  Eigen::Vector2d along(const Terms& d) const {
    const Complex d_q = k_ * (d.phi * at_.c + at_.phi * d.c);
    const Complex d_log_q = d_q * inverse_;
    const Complex d_gain = -gain_ * d_log_q;
    const double d_by_ratio =
        std::real(d_gain * at_.phi_t * at_.c + gain_ * (d.phi_t * at_.c + at_.phi_t * d.c));
    const double d_sum =
        d.log_free_eta -
        std::real(d_gain * at_.phi * at_.c_eta + gain_ * (d.phi * at_.c_eta + at_.phi * d.c_eta)) +
        d_by_ratio * at_.threshold_eta + by_ratio_ * d.threshold_eta;
    const double d_log_R_eta = (d_sum - log_R_eta_ * d_by_ratio) / (1 + by_ratio_);
    const double d_log_ratio_eta = d_log_R_eta - d.threshold_eta;
    const Complex d_damper_gain = -damper_gain_ * damper_gain_ * (d.phi * at_.damper + at_.phi * d.damper);
    const Complex d_own = d.phi * at_.damper_eta + at_.phi * d.damper_eta +
                          d_log_ratio_eta * at_.phi_t * at_.damper +
                          log_ratio_eta_ * (d.phi_t * at_.damper + at_.phi_t * d.damper);
    return {d.log_R + d_log_q.real() - d.log_free,
            d_log_R_eta + std::real(d_damper_gain * own_ + damper_gain_ * d_own)};
  }

 private:
  const Terms& at_;
  double k_;
  Complex q_, q_damper_;        // 1 + k phi c, 1 + k phi c_D
  Complex inverse_;             // 1/q
  Complex gain_, damper_gain_;  // k over both
  double by_ratio_;             // dg/dt through phi
  double log_R_eta_, log_ratio_eta_;
  Complex own_;
};

}  // namespace

RidgePoint ridge_point(const FrictionSystem& system, double w, double eta, double preload) {
  const ContactResponse base = system.base.at(eta);
  const ContactResponse damper = system.damper.at(eta);
  const ContactCurvature base_bend = system.base.curvature(eta);
  const ContactCurvature damper_bend = system.damper.curvature(eta);
  const LogThreshold threshold = system.log_threshold(eta, preload);
  const LawInRoot law = law_in_root(w);
  const Complex per_free = std::conj(base.free) / std::norm(base.free);
  const Complex free_eta = base.free_eta * per_free;

  Terms at;
  at.log_R = threshold.value + w * w;
  at.phi = law.phi;
  at.phi_t = law.by_t;
  at.c = base.compliance + damper.compliance;
  at.c_eta = base.compliance_eta + damper.compliance_eta;
  at.damper = damper.compliance;
  at.damper_eta = damper.compliance_eta;
  at.log_free = 0.5 * std::log(std::norm(base.free));
  at.log_free_eta = free_eta.real();
  at.threshold_eta = threshold.by_eta;

  Terms by_w;
  by_w.log_R = 2 * w;
  by_w.phi = law.by_w;
  by_w.phi_t = law.by_t_w;

  Terms by_eta;
  by_eta.log_R = threshold.by_eta;
  by_eta.c = at.c_eta;
  by_eta.c_eta = base_bend.compliance + damper_bend.compliance;
  by_eta.damper = at.damper_eta;
  by_eta.damper_eta = damper_bend.compliance;
  by_eta.log_free = at.log_free_eta;
  by_eta.log_free_eta = std::real(base_bend.free * per_free - free_eta * free_eta);
  by_eta.threshold_eta =
      2 * system.preload_growth * threshold.by_preload - threshold.by_eta * threshold.by_eta;

  Terms by_preload;
  by_preload.log_R = threshold.by_preload;
  by_preload.threshold_eta = -threshold.by_eta * threshold.by_preload;

  const Ridge ridge(system.contact_stiffness, at);
  RidgePoint point{at.log_R, ridge.log_Y(), ridge.values(), {}, ridge.along(by_preload)};
  point.by_place.col(0) = ridge.along(by_w);
  point.by_place.col(1) = ridge.along(by_eta);
  return point;
}

bool PeakRidge::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                         const continuation::Evaluation& out) const {
  if (!(u(eta) > 0) || !system_.is_loaded(u(eta), p(0))) return false;
  RidgePoint at = ridge_point(system_, u(root_of_log_ratio), u(eta), p(0));
  at.values(1) /= steepness_;
  at.by_place.row(1) /= steepness_;
  at.by_preload(1) /= steepness_;
  if (out.residual != nullptr) *out.residual = at.values;
  if (out.jacobian != nullptr) *out.jacobian = at.by_place;
  if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = at.by_preload;
  return true;
}

void PeakRidge::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns << 1, u(eta);
  parameters = p;
}

double PeakRidge::border(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                         int /*border*/, continuation::Gradient* gradient) const {
  if (gradient != nullptr) {
    gradient->unknowns << -1, 0;
    gradient->parameters.setZero();
  }
  return -u(root_of_log_ratio);
}

void PeakRidge::adapt(const Vector& u, const Vector& p) {
  const RidgePoint at = ridge_point(system_, u(root_of_log_ratio), u(eta), p(0));
  steepness_ = std::max(1.0, std::hypot(at.by_place(1, 0), at.by_place(1, 1) * u(eta)));
}

bool solve_ridge(const FrictionSystem& system, double preload, double& w, double& eta) {
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < 40; ++iteration) {
    const RidgePoint at = ridge_point(system, w, eta, preload);
    const Eigen::Vector2d step = solution_of(at.by_place, at.values);
    const double size = std::abs(step(0)) + std::abs(step(1)) / eta;
    if (!std::isfinite(size)) return false;
    if (size < 1e-9 && !(size < 0.5 * before)) return true;  // at rounding
    w -= step(0);
    eta -= step(1);
    before = size;
  }
  return false;
}

}  // namespace arcslip::problems
