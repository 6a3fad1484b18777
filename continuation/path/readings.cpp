#include "arcslip/continuation/path/readings.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {
namespace {

void read_slopes(double parameter_rate, const std::vector<Monitor>& monitors, Index tracked,
                 std::vector<double>& values) {
  values.push_back(parameter_rate);
  for (Index i = 0; i < tracked; ++i) values.push_back(monitors[static_cast<std::size_t>(i)].slope);
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
  Place& place = places_.emplace_back(Place{s, {}, {}});
  if (s == 0) {
    read_start(place.values);
  } else if (is_known) {
    read_end(place.values);
  } else {
    read(stepper_.prober().probed(), place.values);
  }
  return &place;
}

void Readings::read_start(std::vector<double>& values) const {
  read_slopes(stepper_.step().parameter_rate_from(), stepper_.step().from,
              stepper_.monitors().tracked_count(), values);
  if (watch_.empty()) return;
  const Look& here = watch_.kept().front();
  values.insert(values.end(), here.functions.begin(), here.functions.end());
  values.insert(values.end(), here.rates.begin(), here.rates.end());
}

void Readings::read_end(std::vector<double>& values) const {
  read_slopes(stepper_.step().parameter_rate_to(), stepper_.step().to, stepper_.monitors().tracked_count(),
              values);
  read_functions(functions_at_end_, eigenvalues_at_end_, values);
}

void Readings::read(const Probe& probe, std::vector<double>& values) {
  read_slopes(probe.parameter_rate(), probe.monitors, stepper_.monitors().tracked_count(), values);
  if (watch_.empty()) return;
  watch_.look(probe.point);
  read_functions(watch_.functions(), watch_.eigenvalues(), values);
}

std::optional<double> Readings::value(std::size_t which, double s) {
  const Place* place = at(s);
  if (place == nullptr || which >= place->values.size() || !std::isfinite(place->values[which]))
    return std::nullopt;
  return place->values[which];
}

std::optional<Node> Readings::node(std::size_t which, double s) {
  const std::optional<double> here = value(which, s);
  if (!here) return std::nullopt;
  Place& place = *at(s);
  if (place.beside.empty() && stepper_.prober().probe(s)) {
    place.offset = stepper_.prober().look_beside();
    if (place.offset != 0) read(stepper_.prober().beside(), place.beside);
  }
  const bool known = which < place.beside.size();
  return Node{s, *here, known ? (place.beside[which] - *here) / place.offset : std::nan("")};
}

}  // namespace arcslip::continuation
