#include "arcslip/problems/response/floquet_response.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/problems/response/more_harmonics.hpp"

namespace arcslip::problems {
namespace {

using continuation::Guess;
using continuation::PointType;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Sign of the determinant.
int orientation(const Matrix& matrix) {
  const Eigen::PartialPivLU<Matrix> factors(matrix);
  const auto negative = (factors.matrixLU().diagonal().array() < 0).count();
  return factors.permutationP().determinant() * (negative % 2 == 0 ? 1 : -1);
}

/// Gives the own exponent nearest to zero the sign that makes those above zero odd or even in number.
void make_odd(bool odd, std::vector<RingDisturbances::Disturbance>& all) {
  bool is_odd = false;
  RingDisturbances::Disturbance* nearest = nullptr;
  for (RingDisturbances::Disturbance& one : all) {
    if (!one.is_own) continue;
    is_odd = is_odd != (one.exponent.real() > 0);
    if (nearest == nullptr || std::abs(one.exponent.real()) < std::abs(nearest->exponent.real()))
      nearest = &one;
  }
  if (nearest != nullptr && is_odd != odd) nearest->exponent *= -1.0;
}

/// The highest harmonic of the response by which one tells its error: four times as high, so that little of
/// the error is left, where exponents then cost no more; else twice as high; half as high where that is too
/// many. Nearer ones tell nothing: what is left out does not fall from each harmonic to the next.
int other_highest(const SystemParameters& parameters) {
  constexpr int most = 2 * most_harmonics - 1;
  const int highest = parameters.harmonics.back();
  if (2 * highest + 1 > most) return highest / 2;
  const int wide = std::min(4 * highest + 3, most);
  const Index waves = parameters.elements / std::gcd(parameters.wave_number, parameters.elements);
  return RingDisturbances::is_exact(waves, wide) ? wide : 2 * highest + 1;
}

}  // namespace

std::atomic<long> FloquetResponse::made_ = 0;

FloquetResponse::FloquetResponse(const HarmonicSystem& system, const RingWaves& waves,
                                 std::shared_ptr<const FloquetResponse> finer)
    : HarmonicResponse(system), disturbances_(system, waves), finer_(std::move(finer)) {}

FloquetResponse::FloquetResponse(const HarmonicSystem& system, const HarmonicSystem& in_modes,
                                 const RingWaves& waves, std::shared_ptr<const FloquetResponse> finer)
    : HarmonicResponse(system),
      disturbances_(in_modes, waves),
      is_in_modes_(false),
      finer_(std::move(finer)) {}

std::vector<StickPattern> FloquetResponse::patterns(const Vector& u, const Vector& p,
                                                    const continuation::Regime& regime) const {
  std::vector<StickPattern> all;
  for (Index i = 0; i < contacts(); ++i)
    all.push_back(stick_pattern(system().orders, motion(u, i), slip_threshold(i, p), slips(regime, i)));
  for (Index i = contacts(); i < coordinates_.size(); ++i)
    all.push_back({false, {}, coordinates_.element(i).stiffness_in_time(system().orders, motion(u, i))});
  return all;
}

RingDisturbances::Disturbances FloquetResponse::found(const Vector& u, const Vector& p,
                                                      const continuation::Regime& regime,
                                                      std::span<const StickPattern> contacts,
                                                      bool active) const {
  RingDisturbances::Disturbances found = disturbances_.at(p(eta), contacts, active);
  const bool may_fold =
      std::any_of(found.all.begin(), found.all.end(), [](const auto& one) { return one.is_own; });
  if ((disturbances_.is_balanced() && is_in_modes_) || !may_fold) return found;
  Matrix jacobian(size(), size());
  continuation::Evaluation out;
  out.jacobian = &jacobian;
  if (evaluate(u, p, regime, out)) make_odd(orientation(jacobian) < 0, found.all);
  return found;
}

/// What was found where a thread last looked: eigenvalues and test functions are asked for one after the
/// other.
struct FloquetResponse::Last {
  long problem = 0;  ///< its number
  Vector unknowns;
  Vector parameters;
  continuation::Regime regime;
  RingDisturbances::Disturbances active;
};

const FloquetResponse::Last& FloquetResponse::last(const Vector& u, const Vector& p,
                                                   const continuation::Regime& regime) const {
  thread_local Last last;
  const bool known =
      last.problem == number_ && last.regime == regime && last.unknowns == u && last.parameters == p;
  if (!known) last = {number_, u, p, regime, found(u, p, regime, patterns(u, p, regime), true)};
  return last;
}

bool FloquetResponse::eigenvalues(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                  ComplexVector& values) const {
  const auto& all = last(u, p, regime).active.all;
  values.resize(std::ssize(all));
  std::transform(all.begin(), all.end(), values.begin(), [](const auto& one) { return one.exponent; });
  return true;
}

std::vector<PointType> FloquetResponse::test_types() const {
  return std::vector<PointType>(disturbances_.symmetries(), PointType::symmetry_breaking);
}

void FloquetResponse::test(const Vector& u, const Vector& p, const continuation::Regime& regime,
                           Vector& values) const {
  const std::vector<double>& all = last(u, p, regime).active.symmetries;
  values = Vector::Map(all.data(), std::ssize(all));
}

std::vector<RingDisturbances::Disturbance> FloquetResponse::disturbances(
    const Vector& u, const Vector& p, const continuation::Regime& regime) const {
  return found(u, p, regime, patterns(u, p, regime), false).all;
}

FloquetResponse::Worst FloquetResponse::worst(const Vector& u, const Vector& p,
                                              const continuation::Regime& regime) const {
  const std::vector<StickPattern> contacts = patterns(u, p, regime);
  const auto all = found(u, p, regime, contacts, false).all;
  const auto most = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.exponent.real() < b.exponent.real();
  });
  if (most == all.end()) return {0, 0};
  return {std::exp(two_pi * most->exponent.real() / p(eta)), disturbances_.wave_of(*most, p(eta), contacts)};
}

std::vector<continuation::Observable> FloquetResponse::observables() const {
  std::vector<continuation::Observable> all = HarmonicResponse::observables();
  for (const char* name : {"growth", "growth_error", "worst_wave", "stable"}) all.push_back({name});
  return all;
}

void FloquetResponse::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              Vector& values) const {
  HarmonicResponse::observe(u, p, regime, values);
  const Worst found = worst(u, p, regime);
  const double error = growth_error(u, p, regime, found.growth);
  const double stable = found.growth + error <= 1 ? 1 : found.growth - error > 1 ? 0 : none;
  const Index before = values.size();
  values.conservativeResize(before + 4);
  values.tail<4>() << found.growth, error, static_cast<double>(found.wave), stable;
}

/// What is left out falls as h^-3, though not from each harmonic to the next: twice what that gives.
double FloquetResponse::growth_error(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                     double growth) const {
  if (finer_ == nullptr) return none;
  if (all_stick(regime) && !coordinates_.has_others()) return 0;
  const std::optional<Guess> at = solved_in(*finer_, *this, {u, p, regime});
  if (!at) return none;
  const double other = finer_->worst(at->unknowns, at->parameters, at->regime).growth;
  const double ratio = static_cast<double>(system().orders.back()) / finer_->system().orders.back();
  if (growth == other) return 0;
  return 2 * std::abs(growth - other) / std::abs(1 - std::pow(ratio, 3));
}

/// By secants.
std::optional<double> FloquetResponse::moved_by(const Guess& at, Index parameter) const {
  if (finer_ == nullptr) return std::nullopt;
  const auto own = disturbances(at.unknowns, at.parameters, at.regime);
  const auto on_axis = std::min_element(own.begin(), own.end(), [](const auto& a, const auto& b) {
    return std::abs(a.exponent.real()) < std::abs(b.exponent.real());
  });
  if (on_axis == own.end()) return std::nullopt;
  Complex nu = disturbances_.turned(*on_axis, at.parameters(eta));
  std::optional<Guess> finer = solved_in(*finer_, *this, at);
  const double start = at.parameters(parameter);
  double here = start;
  double rate_before = 0;
  double before = 0;
  for (int round = 0; finer && round < 12; ++round) {
    const auto all = finer_->disturbances(finer->unknowns, finer->parameters, finer->regime);
    const auto same = std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
      return std::abs(finer_->disturbances_.turned(a, finer->parameters(eta)) - nu) <
             std::abs(finer_->disturbances_.turned(b, finer->parameters(eta)) - nu);
    });
    nu = finer_->disturbances_.turned(*same, finer->parameters(eta));
    const double rate = same->exponent.real();
    const double step = round == 0 ? 1e-5 * start : -rate * (here - before) / (rate - rate_before);
    if (rate == 0 || (round > 0 && std::abs(step) < 1e-10 * start)) return here - start;
    if (!(std::abs(here + step - start) < 0.1 * start)) return std::nullopt;
    before = here;
    rate_before = rate;
    here += step;
    finer->parameters(parameter) = here;
    finer = solved_in(*finer_, *finer_, *finer);
  }
  return std::nullopt;
}

std::set<Index> disturbed_waves(const SystemParameters& parameters) {
  std::set<Index> all;
  for (const int highest : {parameters.harmonics.back(), other_highest(parameters)})
    all.merge(RingDisturbances::waves(parameters.wave_number, parameters.elements, highest));
  return all;
}

std::shared_ptr<FloquetResponse> build_floquet_response(const SystemParameters& parameters) {
  const std::shared_ptr<const Structures> modal = structures_of(parameters).in_modes();
  const auto build = [&](const SystemParameters& one, std::shared_ptr<const FloquetResponse> finer) {
    SystemParameters in_modes = one;
    if (modal) in_modes.structures = modal;
    const RingWaves waves = ring_waves(in_modes, one.harmonics.back() + 1);
    const HarmonicSystem system = build_harmonic_system(one);
    if (!modal) return std::make_shared<FloquetResponse>(system, waves, std::move(finer));
    return std::make_shared<FloquetResponse>(system, build_harmonic_system(in_modes), waves,
                                             std::move(finer));
  };
  SystemParameters other = parameters;
  other.harmonics = odd_up_to(other_highest(parameters));
  return build(parameters, build(other, nullptr));
}

}  // namespace arcslip::problems
