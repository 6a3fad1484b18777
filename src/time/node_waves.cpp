#include "arcslip/time/node_waves.hpp"

#include <cmath>

namespace arcslip {
namespace {

/// Waves of 0, 1, ... lengths round N nodes, two of each but those whose values are +-1.
Matrix waves_of(Index nodes) {
  const auto count = static_cast<double>(nodes);
  Matrix waves(nodes, nodes);
  for (Index i = 0; i < nodes; ++i) {
    Index column = 0;
    for (Index wave = 0; 2 * wave <= nodes; ++wave) {
      const double angle = two_pi * static_cast<double>(wave * i % nodes) / count;
      const bool is_single = 2 * wave % nodes == 0;
      waves(i, column++) = std::sqrt((is_single ? 1 : 2) / count) * std::cos(angle);
      if (!is_single) waves(i, column++) = std::sqrt(2 / count) * std::sin(angle);
    }
  }
  return waves;
}

}  // namespace

NodeWaves::NodeWaves(const Ring& ring) : waves_(waves_of(ring.nodes())) {
  constexpr double rounding = 1e-14;  // of products with other waves
  for (Index first = 0; first < ring.motion.rows(); first += ring.nodes()) {
    const Matrix all = waves_.transpose() * ring.motion.middleRows(first, ring.nodes());
    shapes_.emplace_back(all.sparseView(all.cwiseAbs().maxCoeff(), rounding));
    modes_.emplace_back(shapes_.back().transpose());
  }
}

NodeWaves::Rows NodeWaves::of(const std::vector<Index>& rows) const {
  std::vector<std::vector<Index>> places(shapes_.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    places[static_cast<std::size_t>(rows[i] / waves_.rows())].push_back(static_cast<Index>(i));
  Rows all;
  for (std::size_t c = 0; c < places.size(); ++c) {
    if (places[c].empty()) continue;
    std::vector<Index> nodes;
    for (const Index place : places[c])
      nodes.push_back(rows[static_cast<std::size_t>(place)] % waves_.rows());
    all.parts.push_back({static_cast<Index>(c), places[c], waves_(nodes, Eigen::all)});
  }
  return all;
}

void NodeWaves::displace(const Rows& rows, const Matrix& position, Matrix& x) const {
  for (const Rows::Part& part : rows.parts) {
    const Matrix waves = shapes_[static_cast<std::size_t>(part.coordinate)] * position;
    x(part.places, Eigen::all) = Matrix(part.nodes * waves);
  }
}

void NodeWaves::push(const Rows& rows, const Matrix& force, Matrix& pushed) const {
  pushed.setZero();
  for (const Rows::Part& part : rows.parts) {
    const Matrix own = force(part.places, Eigen::all);
    const Matrix waves = part.nodes.transpose() * own;
    pushed.noalias() += modes_[static_cast<std::size_t>(part.coordinate)] * waves;
  }
}

}  // namespace arcslip
