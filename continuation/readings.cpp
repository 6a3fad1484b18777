#include "arcslip/continuation/readings.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {

Readings::Place* Readings::at(double s) {
  const auto known =
      std::find_if(places_.begin(), places_.end(), [s](const Place& place) { return place.s == s; });
  if (known != places_.end()) return &*known;
  if (!stepper_.probe(s)) return nullptr;
  Place& place = places_.emplace_back(Place{s, {}, {}});
  read(stepper_.probed_point(), stepper_.probed_parameter_rate(), stepper_.probed(), place.values);
  return &place;
}

void Readings::read(const CurvePoint& point, double parameter_rate, const std::vector<Monitor>& monitors,
                    std::vector<double>& values) {
  values.push_back(parameter_rate);
  for (Index i = 0; i < stepper_.tracked_count(); ++i)
    values.push_back(monitors[static_cast<std::size_t>(i)].slope);
  if (watch_.empty()) return;
  watch_.look(point);
  values.insert(values.end(), watch_.functions().begin(), watch_.functions().end());
  for (const Complex& eigenvalue : watch_.eigenvalues()) values.push_back(eigenvalue.real());
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
  if (place.beside.empty() && stepper_.probe(s)) {
    place.offset = stepper_.look_beside();
    if (place.offset != 0)
      read(stepper_.beside_point(), stepper_.beside_parameter_rate(), stepper_.beside_monitors(),
           place.beside);
  }
  const bool known = which < place.beside.size();
  return Node{s, *here, known ? (place.beside[which] - *here) / place.offset : std::nan("")};
}

}  // namespace arcslip::continuation
