#include "arcslip/problems/response/floquet_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/problems/response/more_harmonics.hpp"

namespace arcslip::problems {
namespace {

using continuation::Guess;
using continuation::PointType;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

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

/// The harmonics of the response by which one tells its error: four times as high, so that little of the
/// error is left, where exponents then cost no more; else twice as high; half as high where that is too many.
/// Nearer ones tell nothing: what is left out does not fall from each harmonic to the next.
std::vector<int> other_orders(const SystemParameters& parameters) {
  const bool odd = all_odd(parameters.harmonics);
  const int most = odd ? 2 * most_harmonics - 1 : most_harmonics / 2 - 1;
  const int highest = highest_order(parameters.harmonics);
  const auto up_to = [&](int other) { return orders_up_to(other, parameters.periods(), odd); };
  if (2 * highest + 1 > most) return up_to(std::max(1, highest / 2));
  const int wide = std::min(4 * highest + 3, most);
  const Index waves = parameters.elements / std::gcd(parameters.first_wave(), parameters.elements);
  const bool is_exact =
      structures_of(parameters).whole() == nullptr && RingDisturbances::is_exact(waves, wide);
  return up_to(is_exact ? wide : 2 * highest + 1);
}

}  // namespace

DisturbedRing::DisturbedRing(HarmonicSystem system, const RingWaves& waves)
    : system_(std::move(system)), waves_(waves) {
  for (const Index wave : RingDisturbances::waves(waves.wave_number(), waves.nodes(), system_.orders))
    under_.emplace(wave, waves.structures(wave));
  const RingWaves known(waves.wave_number(), waves.nodes(), [this](Index wave) { return under_.at(wave); });
  given_ = std::make_shared<const RingDisturbances>(system_, known);
}

RingDisturbances DisturbedRing::at(std::optional<double> zeta, double influence) const {
  const auto changed = [&](const ContactModes& base) {
    const Loss loss = zeta ? system_.base_loss_fixed + *zeta * system_.base_loss_per_zeta : base.loss();
    return influence == 1 ? base.with(loss) : base.varied({.loss = loss, .influence = influence});
  };
  HarmonicSystem system = system_;
  for (ContactModes& base : system.base) base = changed(base);
  const RingWaves waves(waves_.wave_number(), waves_.nodes(), [&](Index wave) {
    RingWaves::Structures under = under_.at(wave);
    under.base = changed(under.base);
    return under;
  });
  return {system, waves};
}

template <class Motion>
std::atomic<long> FloquetOf<Motion>::made_ = 0;

template <class Motion>
FloquetOf<Motion>::FloquetOf(const HarmonicSystem& system, const RingWaves& waves,
                             std::shared_ptr<const FloquetOf> finer)
    : Motion(system), ring_(system, waves), finer_(std::move(finer)) {}

template <class Motion>
FloquetOf<Motion>::FloquetOf(const HarmonicSystem& system, const HarmonicSystem& in_modes,
                             const RingWaves& waves, std::shared_ptr<const FloquetOf> finer)
    : Motion(system), ring_(in_modes, waves), is_in_modes_(false), finer_(std::move(finer)) {}

/// The factor on what a flow does.
template <class Motion>
double FloquetOf<Motion>::influence(const Vector& p) const {
  if (!this->is_varied() || this->system().varied->kind != SystemParameter::Kind::flow) return 1;
  return this->system().varied->at(p(Motion::further)).here.base.influence;
}

/// Calls `use` with what disturbances run through at these parameters.
template <class Motion>
template <class Use>
auto FloquetOf<Motion>::with_ring(const Vector& p, const Use& use) const {
  if constexpr (is_cycle) {
    return use(ring_.at(p(Motion::zeta), influence(p)));
  } else {
    return influence(p) == 1 ? use(ring_.given()) : use(ring_.at({}, influence(p)));
  }
}

/// Of an element, as it is here.
template <class Motion>
DisturbedLaw FloquetOf<Motion>::law(Index element, const Vector& u, const Vector& p,
                                    const continuation::Regime& regime) const {
  DisturbedLaw found = this->with_element(element, u, p, [&](const Element& one) {
    return one.disturbed(this->system().orders, this->element_motion(u, p, element),
                         this->load(element, u, p), slips(regime, element));
  });
  if (const double factor = this->force_factor(element, u, p); factor != 1) found.scale(factor);
  return found;
}

template <class Motion>
std::vector<StickPattern> FloquetOf<Motion>::patterns(const Vector& u, const Vector& p,
                                                      const continuation::Regime& regime) const {
  const std::vector<int>& orders = this->system().orders;
  std::vector<StickPattern> all;
  const bool is_odd = all_odd(orders);
  for (Index e = 0; e < this->coordinates_.elements() && !is_odd; ++e)
    all.push_back({.law = law(e, u, p, regime)});
  for (Index i = 0; i < this->contacts() && is_odd; ++i) {
    all.push_back(stick_pattern(orders, HarmonicProblem::motion(u, p, i),
                                HarmonicProblem::slip_threshold(i, u, p), slips(regime, i)));
  }
  for (Index e = this->contacts(); e < this->coordinates_.elements() && is_odd; ++e) {
    const Index first = this->coordinates_.first(e);
    const Element& element = this->coordinates_.element(e);
    if (element.is_told_by_law()) {
      all.push_back({.law = law(e, u, p, regime)});
    } else {
      all.push_back({false, {}, element.stiffness_in_time(orders, HarmonicProblem::motion(u, p, first))});
    }
  }
  if (!is_cycle) return all;
  const std::vector<ElementForce>& forces = this->forces(u, p, regime, false);
  for (Index c = 0; c < this->coordinates_.size(); ++c) {
    const auto e = static_cast<std::size_t>(this->coordinates_.element_of(c));
    ComplexVector& free = all[e].free_force.emplace_back(ComplexVector::Zero(highest_order(orders) + 1));
    for (Index a = 0; a < this->harmonics(); ++a)
      free(orders[static_cast<std::size_t>(a)]) = forces[e].harmonics(this->place(c, a));
  }
  return all;
}

template <class Motion>
RingDisturbances::Disturbances FloquetOf<Motion>::found(const RingDisturbances& ring, const Vector& u,
                                                        const Vector& p, const continuation::Regime& regime,
                                                        std::span<const StickPattern> contacts,
                                                        bool active) const {
  RingDisturbances::Disturbances found = ring.at(turns(u, p), contacts, active);
  const bool may_fold =
      std::any_of(found.all.begin(), found.all.end(), [](const auto& one) { return one.is_own; });
  if ((ring.is_balanced() && is_in_modes_) || !may_fold) return found;
  Matrix jacobian(this->size(), this->size());
  continuation::Evaluation out;
  out.jacobian = &jacobian;
  // Of a cycle the determinant is that of all disturbances over the exponent of its velocity, with the first
  // two columns exchanged; so it is of each drift over that of a place elsewhere.
  const bool is_exchanged = is_cycle != (this->drifting(regime).size() % 2 != 0);
  const int odd = is_exchanged ? 1 : -1;
  if (this->evaluate(u, p, regime, out)) make_odd(orientation(jacobian) == odd, found.all);
  return found;
}

/// What was found where a thread last looked: eigenvalues and test functions are asked for one after the
/// other.
template <class Motion>
struct FloquetOf<Motion>::Last {
  long problem = 0;  ///< its number
  Vector unknowns;
  Vector parameters;
  continuation::Regime regime;
  RingDisturbances::Disturbances active;
};

template <class Motion>
auto FloquetOf<Motion>::last(const Vector& u, const Vector& p, const continuation::Regime& regime) const
    -> const Last& {
  thread_local Last last;
  const bool known =
      last.problem == number_ && last.regime == regime && last.unknowns == u && last.parameters == p;
  if (known) return last;
  last = {number_, u, p, regime, with_ring(p, [&](const RingDisturbances& ring) {
            return found(ring, u, p, regime, patterns(u, p, regime), true);
          })};
  return last;
}

template <class Motion>
bool FloquetOf<Motion>::eigenvalues(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                    ComplexVector& values) const {
  const auto& all = last(u, p, regime).active.all;
  values.resize(std::ssize(all));
  std::transform(all.begin(), all.end(), values.begin(), [](const auto& one) { return one.exponent; });
  return true;
}

template <class Motion>
std::vector<PointType> FloquetOf<Motion>::test_types() const {
  std::vector<PointType> types;
  for (const bool doubles : ring_.given().doubles())
    types.push_back(doubles ? PointType::period_doubling : PointType::symmetry_breaking);
  return types;
}

template <class Motion>
void FloquetOf<Motion>::test(const Vector& u, const Vector& p, const continuation::Regime& regime,
                             Vector& values) const {
  const std::vector<double>& all = last(u, p, regime).active.symmetries;
  values = Vector::Map(all.data(), std::ssize(all));
}

template <class Motion>
std::vector<RingDisturbances::Disturbance> FloquetOf<Motion>::disturbances(
    const Vector& u, const Vector& p, const continuation::Regime& regime) const {
  return with_ring(p, [&](const RingDisturbances& ring) {
    return found(ring, u, p, regime, patterns(u, p, regime), false).all;
  });
}

template <class Motion>
Floquet::Worst FloquetOf<Motion>::worst(const Vector& u, const Vector& p,
                                        const continuation::Regime& regime) const {
  return with_ring(p, [&](const RingDisturbances& ring) -> Worst {
    const std::vector<StickPattern> contacts = patterns(u, p, regime);
    const auto all = found(ring, u, p, regime, contacts, false).all;
    const auto most = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
      return a.exponent.real() < b.exponent.real();
    });
    if (most == all.end()) return {0, 0};
    const double turns = this->turns(u, p);
    return {std::exp(two_pi * most->exponent.real() / turns), ring.wave_of(*most, turns, contacts)};
  });
}

template <class Motion>
std::vector<continuation::Observable> FloquetOf<Motion>::observables() const {
  std::vector<continuation::Observable> all = Motion::observables();
  for (const char* name : {"growth", "growth_error", "worst_wave", "stable"}) all.push_back({name});
  return all;
}

template <class Motion>
void FloquetOf<Motion>::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                Vector& values) const {
  Motion::observe(u, p, regime, values);
  const Worst found = worst(u, p, regime);
  const double error = growth_error(u, p, regime, found.growth);
  const double stable = found.growth + error <= 1 ? 1 : found.growth - error > 1 ? 0 : none;
  const Index before = values.size();
  values.conservativeResize(before + 4);
  const bool is_whole = this->system().sectors > 1;  // whose disturbances are of many waves
  values.tail<4>() << found.growth, error, is_whole ? none : static_cast<double>(found.wave), stable;
}

template <class Motion>
void FloquetOf<Motion>::observe_quickly(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                        Vector& values) const {
  Motion::observe(u, p, regime, values);
  values.conservativeResize(values.size() + 4);
  values.tail<4>().setConstant(none);
}

/// What is left out falls as h^-3, though not from each harmonic to the next: twice what that gives.
template <class Motion>
double FloquetOf<Motion>::growth_error(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                       double growth) const {
  if (finer_ == nullptr) return none;
  if (all_stick(regime) && !this->coordinates_.has_others()) return 0;
  const std::optional<Guess> at = solved_in(*finer_, *this, {u, p, regime});
  if (!at) return none;
  const double other = finer_->worst(at->unknowns, at->parameters, at->regime).growth;
  const double ratio = static_cast<double>(highest_order(this->system().orders)) / finer_highest();
  if (growth == other) return 0;
  return 2 * std::abs(growth - other) / std::abs(1 - std::pow(ratio, 3));
}

/// A disturbance that is told from others by how it turns.
template <class Motion>
struct FloquetOf<Motion>::Followed {
  double rate;
  Complex turned;
};

/// The one that turns most nearly so or, without that, is nearest to the imaginary axis.
template <class Motion>
auto FloquetOf<Motion>::nearest(const Guess& at, std::optional<Complex> turned) const
    -> std::optional<Followed> {
  const auto all = disturbances(at.unknowns, at.parameters, at.regime);
  const double turns = this->turns(at.unknowns, at.parameters);
  const auto distance = [&](const RingDisturbances::Disturbance& one) {
    return turned ? std::abs(ring_.given().turned(one, turns) - *turned) : std::abs(one.exponent.real());
  };
  const auto found = std::min_element(
      all.begin(), all.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  if (found == all.end()) return std::nullopt;
  return Followed{found->exponent.real(), ring_.given().turned(*found, turns)};
}

/// By secants.
template <class Motion>
std::optional<double> FloquetOf<Motion>::moved_by(const Guess& at, Index parameter) const {
  if (finer_ == nullptr) return std::nullopt;
  std::optional<Followed> followed = nearest(at, std::nullopt);
  if (!followed) return std::nullopt;
  std::optional<Guess> finer = solved_in(*finer_, *this, at);
  const double start = at.parameters(parameter);
  double here = start;
  double rate_before = 0;
  double before = 0;
  for (int round = 0; finer && round < 12; ++round) {
    followed = finer_->nearest(*finer, followed->turned);
    const double rate = followed->rate;
    const double step = round == 0 ? 1e-5 * start : -rate * (here - before) / (rate - rate_before);
    if (rate == 0 || (round > 0 && std::abs(step) < 1e-10 * std::abs(start))) return here - start;
    if (!(std::abs(here + step - start) < 0.1 * std::abs(start))) return std::nullopt;
    before = here;
    rate_before = rate;
    here += step;
    finer->parameters(parameter) = here;
    finer = solved_in(*finer_, *finer_, *finer);
  }
  return std::nullopt;
}

template class FloquetOf<HarmonicResponse>;
template class FloquetOf<HarmonicCycle>;

std::set<Index> disturbed_waves(const SystemParameters& parameters) {
  const RingNodes nodes = ring_nodes(parameters);
  std::set<Index> all;
  for (const std::vector<int>& orders : {parameters.harmonics, other_orders(parameters)})
    all.merge(RingDisturbances::waves(nodes.wave_number, nodes.count, orders));
  return all;
}

namespace {

template <class Problem>
std::shared_ptr<Problem> build_floquet(const SystemParameters& parameters) {
  const std::shared_ptr<const Structures> modal = structures_of(parameters).in_modes();
  const auto build = [&](const SystemParameters& one, std::shared_ptr<const Problem> finer) {
    SystemParameters in_modes = one;
    if (modal) in_modes.structures = modal;
    const RingWaves waves = ring_waves(in_modes, highest_order(one.harmonics) + 1);
    const HarmonicSystem system = build_harmonic_system(one);
    if (!modal) return std::make_shared<Problem>(system, waves, std::move(finer));
    return std::make_shared<Problem>(system, build_harmonic_system(in_modes), waves, std::move(finer));
  };
  SystemParameters other = parameters;
  other.harmonics = other_orders(parameters);
  std::shared_ptr<const Problem> finer;
  try {
    finer = build(other, nullptr);
  } catch (const std::invalid_argument&) {  // more harmonics than an element takes: none to compare with
  }
  return build(parameters, std::move(finer));
}

}  // namespace

std::shared_ptr<FloquetResponse> build_floquet_response(const SystemParameters& parameters) {
  return build_floquet<FloquetResponse>(parameters);
}

std::shared_ptr<FloquetCycle> build_floquet_cycle(const SystemParameters& parameters) {
  return build_floquet<FloquetCycle>(parameters);
}

}  // namespace arcslip::problems
