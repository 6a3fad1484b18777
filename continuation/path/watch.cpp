#include "arcslip/continuation/path/watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace arcslip::continuation {

int sign_of_rate(const Stepper& stepper, double rate) {
  return std::abs(rate) < stepper.tolerances().no_rate ? 0 : sign_of(rate);
}

namespace {

/// Of an observable's slope, 0 up to `bound` of its size.
int sign_of_slope(const Stepper& stepper, std::size_t observable, const Monitor& monitor, double bound) {
  const double size = stepper.monitors().size_of(observable, monitor.value);
  return std::abs(monitor.slope) <= bound * size ? 0 : sign_of(monitor.slope);
}

}  // namespace

int sign_of_slope(const Stepper& stepper, std::size_t observable, const Monitor& monitor) {
  return sign_of_slope(stepper, observable, monitor, 1e-14);
}

Watch::Watch(const Problem& problem, const std::vector<UserEvent>& events)
    : problem_(problem), events_(events), tests_(problem.test_types()) {
  functions_.reserve(tests_.size() + events.size());
  kept_.reserve(1 + most_past);
}

void Watch::look(const CurvePoint& point, const std::optional<FactoredJacobian>& jacobian) {
  ++looks_;
  functions_.clear();
  if (jacobian && (spectral_ || !tests_.empty()))
    problem_.take_jacobian(point.unknowns, point.parameters, point.regime, *jacobian);
  if (!tests_.empty()) {
    problem_.test(point.unknowns, point.parameters, point.regime, values_);
    functions_.assign(values_.begin(), values_.end());
  }
  for (const UserEvent& event : events_)
    functions_.push_back(event.function(point.unknowns, point.parameters, point.regime));
  for (const UserEvent& event : events_) {
    if (event.piece) functions_.push_back(event.piece(point.unknowns, point.parameters, point.regime));
  }
  spectra_ += static_cast<long>(spectral_);
  const bool seen =
      spectral_ && problem_.eigenvalues(point.unknowns, point.parameters, point.regime, eigenvalues_);
  if (kept_.empty()) {  // the first point shows whether there are any
    spectral_ = seen;
    if (!seen) spectra_ = 0;
  }
  if (!seen) {
    eigenvalues_.resize(0);
    unstable_ = -1;
    return;
  }
  std::sort(eigenvalues_.begin(), eigenvalues_.end(), [](const Complex& a, const Complex& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  unstable_ = static_cast<int>(
      std::count_if(eigenvalues_.begin(), eigenvalues_.end(), [](const Complex& z) { return z.real() > 0; }));
}

void Watch::keep(double chord) {
  if (empty()) return;
  Look last;
  if (kept_.size() > most_past) {
    last = std::move(kept_.back());
    kept_.pop_back();
  }
  for (Look& look : kept_) look.behind += chord;
  last.behind = 0;
  last.functions = functions_;
  last.rates.clear();
  last.turns.clear();
  for (const Complex& value : eigenvalues_) {
    last.rates.push_back(value.real());
    last.turns.push_back(value.imag());
  }
  kept_.insert(kept_.begin(), std::move(last));
}

void Watch::begin(const CurvePoint& here) {
  look(here);
  kept_.clear();
  keep(0);
}

std::vector<double> Watch::sizes() const {
  std::vector<double> result(functions_.size(), 0);
  for (const Look& look : kept_) {
    for (std::size_t i = 0; i < look.functions.size(); ++i)
      result[i] = std::max(result[i], std::abs(look.functions[i]));
  }
  return result;
}

bool Watch::may_vanish(std::vector<double> Look::*values, std::size_t index, double distance,
                       double value) const {
  std::array<double, 2 + most_past> places{distance};
  std::array<double, 2 + most_past> seen{value};
  std::size_t count = 1;
  for (const Look& look : kept_) {
    if (index >= (look.*values).size()) return true;
    places[count] = -look.behind;
    seen[count++] = (look.*values)[index];
  }
  return may_vanish_twice({places.data(), count}, {seen.data(), count});
}

bool Watch::function_may_vanish(std::size_t function, double distance, double value) const {
  return may_vanish(&Look::functions, function, distance, value);
}

bool Watch::rate_may_vanish(std::size_t rate, double distance, double value) const {
  return may_vanish(&Look::rates, rate, distance, value);
}

PointType Watch::type(std::size_t function) const {
  return function < tests_.size() ? tests_[function] : PointType::event;
}

const std::string& Watch::label(std::size_t function) const {
  return function < tests_.size() ? none_ : events_[function - tests_.size()].name;
}

std::optional<std::size_t> Watch::piece_of(std::size_t function) const {
  if (function < tests_.size() || !events_[function - tests_.size()].piece) return std::nullopt;
  std::size_t place = searched();
  for (std::size_t e = 0; e < function - tests_.size(); ++e) place += events_[e].piece ? 1 : 0;
  return place;
}

Signs signs_at_start(const Stepper& stepper, const Watch& watch) {
  Signs signs;
  signs.parameter = sign_of_rate(stepper, stepper.parameter_slope(Hold::tangent));
  for (std::size_t i = 0; i < static_cast<std::size_t>(stepper.monitors().tracked_count()); ++i)
    signs.observables.push_back(
        sign_of_slope(stepper, i, stepper.at_here()[i], stepper.tolerances().no_rate));
  signs.since.assign(signs.observables.size(), std::numeric_limits<double>::infinity());
  for (const double value : watch.functions()) signs.functions.push_back(sign_of(value));
  signs.unstable = watch.unstable();
  return signs;
}

namespace {

/// How many eigenvalues are unstable: one on the axis counts as it did before.
int counted(int before, const Stepper& stepper, const Watch& watch) {
  if (before < 0 || watch.unstable() < 0) return watch.unstable();
  const ComplexVector& values = watch.eigenvalues();
  const double near = values.size() > 0 ? stepper.tolerances().on_axis * values.cwiseAbs().maxCoeff() : 0;
  const auto above = [&](double bound) {
    return static_cast<int>(
        std::count_if(values.begin(), values.end(), [=](const Complex& z) { return z.real() > bound; }));
  };
  return std::clamp(before, above(near), above(-near));
}

}  // namespace

void update(Signs& signs, const Stepper& stepper, const Watch& watch, bool at_event) {
  const auto take = [at_event](int& sign, int now) {
    if (now != 0 && !(at_event && sign != 0)) sign = now;
  };
  take(signs.parameter, sign_of_rate(stepper, stepper.parameter_slope(Hold::tangent)));
  for (std::size_t i = 0; i < signs.observables.size(); ++i)
    take(signs.observables[i], sign_of_slope(stepper, i, stepper.at_here()[i]));
  for (double& since : signs.since) since += stepper.step().past.front().behind;
  for (std::size_t i = 0; i < signs.functions.size(); ++i)
    take(signs.functions[i], sign_of(watch.functions()[i]));
  signs.unstable = counted(signs.unstable, stepper, watch);
  signs.at_crossing = false;
}

}  // namespace arcslip::continuation
