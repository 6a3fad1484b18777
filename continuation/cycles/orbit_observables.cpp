#include "arcslip/continuation/cycles/orbit_observables.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>

namespace arcslip::continuation {
namespace {

/// Where a function with this slope is highest, if it rises, then falls.
template <class Slope>
double summit(const Slope& slope, double low, double high) {
  const double at_low = slope(low);
  if (!(at_low > 0)) return low;
  const double at_high = slope(high);
  if (!(at_high < 0)) return high;
  std::uintmax_t most = 60;
  const auto [below, above] = boost::math::tools::toms748_solve(
      slope, low, high, at_low, at_high, boost::math::tools::eps_tolerance<double>(), most);
  return 0.5 * (below + above);
}

/// The largest value of an unknown times a sign, by which nodes and at which part of the orbit.
struct Extremum {
  double value = 0;
  Index first = 0;  // node
  Vector weights;
  double place = 0;
};

Extremum extremum(const OrbitProblem& problem, const Vector& u, const Regime& regime, Index unknown,
                  double sign) {
  const OrbitMesh& mesh = problem.frame(regime).mesh;
  const CollocationRule& rule = mesh.rule();
  const Vector values = sign * problem.orbit(u).row(unknown).transpose();
  const Index m = problem.degree();
  Index highest = 0;
  values.maxCoeff(&highest);
  constexpr double closed = 1e-6;  // of how far it goes
  const bool goes_on =
      rule.waves() > 0 && std::abs(values(m) - values(0)) <= closed * (values(highest) - values.minCoeff());
  Extremum best{values(highest), highest, Vector::Ones(1), mesh.place(highest)};
  Vector weights;
  Vector slopes;
  Vector seen;
  const double last = static_cast<double>(rule.looks().rows() - 1);
  constexpr double rises = 0.5;  // between nodes, and between looks, over what it changes by there: no more
  const auto look = [&](Index interval) {
    const auto within = values.segment(interval * m, m + 1);
    const auto slope = [&](double s) {
      rule.at(s, weights, &slopes);
      return within.dot(slopes);
    };
    seen.noalias() = rule.looks() * within;
    for (Index i = 0; i < seen.size(); ++i) {
      const double before = seen(std::max<Index>(i - 1, 0));
      const double behind = seen(std::min(i + 1, seen.size() - 1));
      const bool is_top = seen(i) >= before && seen(i) >= behind;
      if (!is_top || seen(i) + rises * (seen(i) - std::min(before, behind)) < best.value) continue;
      const double least = goes_on ? -1 : 0;  // finds the zero of the slope about it
      const double at = summit(slope, std::max(least, (static_cast<double>(i) - 1) / last),
                               std::min(1 - least, (static_cast<double>(i) + 1) / last));
      rule.at(at, weights);
      const double value = within.dot(weights);
      if (value > best.value)
        best = {value, interval * m, weights, mesh.borders()(interval) + mesh.length(interval) * at};
    }
  };
  for (Index j = 0; j < problem.intervals(); ++j) {
    const auto within = values.segment(j * m, m + 1);
    const double top = within.maxCoeff();
    if (top + rises * (top - within.minCoeff()) >= values(highest)) look(j);
  }
  best.value *= sign;
  return best;
}

/// The root of the mean square, and its derivatives where they are wanted.
double norm(const OrbitProblem& problem, const Vector& u, const Regime& regime, Vector* gradient) {
  const OrbitMesh& mesh = problem.frame(regime).mesh;
  const CollocationRule& rule = mesh.rule();
  const Index m = problem.degree();
  const Index n = problem.field().size();
  const Index told = problem.told();
  const auto orbit = problem.orbit(u);
  Matrix at(told, m);  // the Gauss points
  double square = 0;
  for (Index j = 0; j < mesh.intervals(); ++j) {
    at.noalias() = orbit.block(0, j * m, told, m + 1) * rule.values().transpose();
    square += mesh.length(j) * at.colwise().squaredNorm().dot(rule.weights());
    if (gradient == nullptr) continue;
    at *= mesh.length(j) * rule.weights().asDiagonal();
    gradient->segment(n * j * m, n * (m + 1)).reshaped(n, m + 1).topRows(told) += at * rule.values();
  }
  const double root = std::sqrt(square);
  if (gradient != nullptr && root > 0) *gradient /= root;
  return root;
}

/// How many unknowns have their extrema told: none of large fields, which have more than anyone reads.
Index shown(const OrbitProblem& problem) { return problem.field().sparse() ? 0 : problem.told(); }

}  // namespace

std::string duration_name(const std::vector<std::string>& unknowns,
                          const std::vector<std::string>& parameters) {
  const auto has_one = [](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), "T") != names.end();
  };
  return has_one(unknowns) || has_one(parameters) ? "period" : "T";
}

std::vector<Observable> orbit_observables(const OrbitProblem& problem) {
  std::vector<Observable> all;
  const std::vector<std::string> names = problem.field().names();
  for (Index i = 0; i < shown(problem); ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    all.push_back({name + "_max", true});
    all.push_back({name + "_min", true});
  }
  all.push_back({"norm", true});
  return all;
}

Vector observed_on_orbit(const OrbitProblem& problem, const Vector& u, const Regime& regime) {
  const Index told = shown(problem);
  Vector values(2 * told + 1);
  for (Index i = 0; i < told; ++i) {
    values(2 * i) = extremum(problem, u, regime, i, 1).value;
    values(2 * i + 1) = extremum(problem, u, regime, i, -1).value;
  }
  values(2 * told) = norm(problem, u, regime, nullptr);
  return values;
}

double observed_on_orbit(const OrbitProblem& problem, const Vector& u, const Regime& regime, Index which,
                         Gradient& gradient) {
  if (which == 2 * shown(problem)) return norm(problem, u, regime, &gradient.unknowns);
  const Extremum found = extremum(problem, u, regime, which / 2, which % 2 == 0 ? 1 : -1);
  for (Index k = 0; k < found.weights.size(); ++k)
    gradient.unknowns((found.first + k) * problem.field().size() + which / 2) = found.weights(k);
  const double turn = found.place + 0.5 / orbit_pieces;
  gradient.piece = static_cast<Index>(orbit_pieces * (turn - std::floor(turn)));
  return found.value;
}

std::vector<std::string> OrbitProblem::told_names() const {
  std::vector<std::string> names = field_->names();
  names.resize(static_cast<std::size_t>(told()));
  return names;
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
