#include "arcslip/continuation/cycles/orbit_observables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arcslip::continuation {
namespace {

/// The largest value of an unknown times a sign, and by which nodes.
struct Extremum {
  double value = 0;
  Index first = 0;  // node
  Vector weights;
};

Extremum extremum(const OrbitProblem& problem, const Vector& u, const Regime& regime, Index unknown,
                  double sign) {
  const CollocationRule& rule = problem.frame(regime).mesh.rule();
  const Vector values = sign * problem.orbit(u).row(unknown).transpose();
  const Index m = problem.degree();
  Index highest = 0;
  values.maxCoeff(&highest);
  Extremum best{values(highest), highest, Vector::Ones(1)};
  Vector weights;
  Vector slopes;
  const auto look = [&](Index interval) {  // bisects the slope about the highest of many values
    const auto within = values.segment(interval * m, m + 1);
    const auto value_at = [&](double s) {
      rule.at(s, weights, slopes);
      return within.dot(weights);
    };
    constexpr int looks = 16;
    double top = 0;
    double at = 0;
    for (int i = 0; i <= looks; ++i) {
      const double s = static_cast<double>(i) / looks;
      const double value = value_at(s);
      if (i == 0 || value > top) at = s;
      top = i == 0 ? value : std::max(top, value);
    }
    double low = std::max(0.0, at - 1.0 / looks);
    double high = std::min(1.0, at + 1.0 / looks);
    for (int round = 0; round < 60 && low < high; ++round) {
      at = 0.5 * (low + high);
      value_at(at);
      (within.dot(slopes) > 0 ? low : high) = at;
    }
    const double value = value_at(at);
    if (value > best.value) best = {value, interval * m, weights};
  };
  const Index j = std::min(highest / m, problem.intervals() - 1);
  look(j);
  if (highest % m == 0) look((j + problem.intervals() - 1) % problem.intervals());
  best.value *= sign;
  return best;
}

/// The root of the mean square, and its derivatives.
double norm(const OrbitProblem& problem, const Vector& u, const Regime& regime, Vector& gradient) {
  const OrbitMesh& mesh = problem.frame(regime).mesh;
  const CollocationRule& rule = mesh.rule();
  const Index m = problem.degree();
  const Index n = problem.field().size();
  const Index told = problem.told();
  double square = 0;
  auto by_nodes = gradient.head(n * mesh.nodes()).reshaped(n, mesh.nodes());
  for (Index j = 0; j < mesh.intervals(); ++j) {
    for (Index i = 0; i < m; ++i) {
      const Vector at = problem.orbit(u).block(0, j * m, told, m + 1) * rule.values().row(i).transpose();
      const double weight = mesh.length(j) * rule.weights()(i);
      square += weight * at.squaredNorm();
      by_nodes.block(0, j * m, told, m + 1) += weight * at * rule.values().row(i);
    }
  }
  const double root = std::sqrt(square);
  if (root > 0) gradient /= root;
  return root;
}

}  // namespace

std::vector<Observable> orbit_observables(const OrbitProblem& problem) {
  std::vector<Observable> all;
  const std::vector<std::string> names = problem.field().names();
  for (Index i = 0; i < problem.told(); ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    all.push_back({name + "_max", true});
    all.push_back({name + "_min", true});
  }
  all.push_back({"norm", true});
  return all;
}

Vector observed_on_orbit(const OrbitProblem& problem, const Vector& u, const Regime& regime) {
  const Index told = problem.told();
  Vector values(2 * told + 1);
  for (Index i = 0; i < told; ++i) {
    values(2 * i) = extremum(problem, u, regime, i, 1).value;
    values(2 * i + 1) = extremum(problem, u, regime, i, -1).value;
  }
  Vector unused = Vector::Zero(problem.size());
  values(2 * told) = norm(problem, u, regime, unused);
  return values;
}

double observed_on_orbit(const OrbitProblem& problem, const Vector& u, const Regime& regime, Index which,
                         Vector& gradient) {
  if (which == 2 * problem.told()) return norm(problem, u, regime, gradient);
  const Extremum found = extremum(problem, u, regime, which / 2, which % 2 == 0 ? 1 : -1);
  for (Index k = 0; k < found.weights.size(); ++k)
    gradient((found.first + k) * problem.field().size() + which / 2) = found.weights(k);
  return found.value;
}

double OrbitProblem::least_speed(const Vector& u, const Vector& p, const Regime& regime) const {
  const double length = duration(u, p);
  const Vector at = times(u, p, regime);
  Vector velocity(field_->size());
  double least = std::numeric_limits<double>::infinity();
  for (Index node = 0; node < nodes(); ++node) {
    if (!field_->evaluate(at(node), orbit(u).col(node), p, {&velocity})) continue;
    least = std::min(least, length * velocity.cwiseQuotient(frame(regime).range).lpNorm<Eigen::Infinity>());
  }
  return least;
}

}  // namespace arcslip::continuation
