#include "arcslip/continuation/path/readings.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {
namespace {

constexpr double plainly = 100;    // times rounding
constexpr double wider = 100;      // times the offset before
constexpr double farthest = 1e-3;  // of the step: from where slopes are taken

void read_slopes(double parameter_rate, const std::vector<Monitor>& monitors, Index tracked,
                 std::vector<double>& values) {
  values.push_back(parameter_rate);
  for (Index i = 0; i < tracked; ++i) values.push_back(monitors[static_cast<std::size_t>(i)].slope);
  for (Index i = 0; i < tracked; ++i)
    values.push_back(static_cast<double>(monitors[static_cast<std::size_t>(i)].piece));
}

void read_functions(const std::vector<double>& functions, const ComplexVector& eigenvalues,
                    std::vector<double>& values) {
  values.insert(values.end(), functions.begin(), functions.end());
  for (const Complex& eigenvalue : eigenvalues) values.push_back(eigenvalue.real());
}

}  // namespace

Readings::Place* Readings::at(double s) {
  const auto known =
      std::find_if(places_.begin(), places_.end(), [s](const Place& place) { return place.s == s; });
  if (known != places_.end()) return &*known;
  const bool is_known = s == 0 || s == stepper_.step().distance;
  if (!is_known && !stepper_.prober().probe(s)) return nullptr;
  const Values values = s == 0 ? read_start() : is_known ? read_end() : read(stepper_.prober().probed());
  return &places_.emplace_back(Place{s, values, {}});
}

Readings::Values Readings::read_start() {
  const std::size_t begin = numbers_.size();
  read_slopes(stepper_.step().parameter_rate_from(), stepper_.step().from,
              stepper_.monitors().tracked_count(), numbers_);
  if (watch_.empty()) return since(begin);
  const Look& here = watch_.kept().front();
  numbers_.insert(numbers_.end(), here.functions.begin(), here.functions.end());
  numbers_.insert(numbers_.end(), here.rates.begin(), here.rates.end());
  return since(begin);
}

Readings::Values Readings::read_end() {
  const std::size_t begin = numbers_.size();
  read_slopes(stepper_.step().parameter_rate_to(), stepper_.step().to, stepper_.monitors().tracked_count(),
              numbers_);
  read_functions(functions_at_end_, eigenvalues_at_end_, numbers_);
  return since(begin);
}

Readings::Values Readings::read(const Probe& probe) {
  const std::size_t begin = numbers_.size();
  read_slopes(probe.parameter_rate(), probe.monitors, stepper_.monitors().tracked_count(), numbers_);
  if (watch_.empty()) return since(begin);
  watch_.look(probe.point);
  read_functions(watch_.functions(), watch_.eigenvalues(), numbers_);
  return since(begin);
}

std::optional<double> Readings::value(std::size_t which, double s) {
  const Place* place = at(s);
  if (place == nullptr || which >= place->values.count) return std::nullopt;
  const double value = numbers_[place->values.begin + which];
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<Node> Readings::node(std::size_t which, double s) {
  const std::optional<double> here = value(which, s);
  if (!here) return std::nullopt;
  Place& place = *at(s);
  if (place.beside.count == 0) look_beside(place, 0);
  while (is_rounding(place, which) && look_beside(place, wider * std::abs(place.offset))) {
  }
  const bool known = which < place.beside.count;
  return Node{s, *here, known ? (numbers_[place.beside.begin + which] - *here) / place.offset : std::nan("")};
}

/// At least so far from the place; false where nothing is told there.
bool Readings::look_beside(Place& place, double least) {
  if (least > farthest * stepper_.step().distance || !stepper_.prober().probe(place.s)) return false;
  const double offset = stepper_.prober().look_beside(least);
  if (offset == 0) return false;
  place.offset = offset;
  place.beside = read(stepper_.prober().beside());
  return true;
}

/// Whether a real part does not change by more than rounding from the place to the one beside it.
bool Readings::is_rounding(const Place& place, std::size_t which) const {
  if (which < real_part(0) || which >= place.beside.count || eigenvalues_at_end_.size() == 0) return false;
  const double change = numbers_[place.beside.begin + which] - numbers_[place.values.begin + which];
  return std::abs(change) <
         plainly * stepper_.tolerances().on_axis * eigenvalues_at_end_.cwiseAbs().maxCoeff();
}

}  // namespace arcslip::continuation
