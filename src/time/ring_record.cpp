#include "arcslip/time/ring_record.hpp"

#include <boost/math/quadrature/gauss.hpp>

namespace arcslip {
namespace {

struct Node {
  double place;  ///< in (0, 1)
  double weight;
};

const std::vector<Node>& quadrature() {
  static const std::vector<Node> nodes = [] {
    using Rule = boost::math::quadrature::gauss<double, 30>;
    std::vector<Node> all;
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      const double x = Rule::abscissa()[i];
      all.push_back({0.5 * (1 - x), 0.5 * Rule::weights()[i]});
      all.push_back({0.5 * (1 + x), 0.5 * Rule::weights()[i]});
    }
    return all;
  }();
  return nodes;
}

}  // namespace

HarmonicRecord::HarmonicRecord(const RingMotion& motion, std::vector<int> orders)
    : ring_(motion.ring()),
      frequency_(motion.frequency()),
      threshold_(motion.slip_threshold()),
      orders_(std::move(orders)),
      sums_(ComplexMatrix::Zero(static_cast<Index>(orders_.size()), 4)) {}

void HarmonicRecord::follow(const RingSegment& segment, const RingState& state) {
  Matrix series(2, segment.position.cols());
  series.row(0) = ring_.base.row(0) * segment.position;
  series.row(1) = ring_.damper.row(0) * segment.position;
  for (const Node& node : quadrature()) {
    const double t = node.place * segment.length;
    const Vector value = RingSegment::value(series, t / segment.scale);
    const double r = value(1) - value(0);
    const double spring = state.slip[0] == 0 ? r - state.slider(0) : state.slip[0] * threshold_;
    const Eigen::RowVector4d all(value(0), value(1), r, ring_.contact_stiffness * spring);
    for (std::size_t h = 0; h < orders_.size(); ++h) {
      const Complex wave =
          std::polar(node.weight * segment.length, -orders_[h] * frequency_ * (segment.start + t));
      sums_.row(static_cast<Index>(h)) += wave * all.cast<Complex>();
    }
  }
  time_ += segment.length;
}

void EnergyRecord::follow(const RingSegment& segment, const RingState& state) {
  for (const Node& node : quadrature()) {
    const double t = node.place * segment.length;
    const Vector velocity = segment.rate(segment.position, t / segment.scale);
    const double weight = node.weight * segment.length;
    for (const RingLoad& load : ring_.loads) {
      const Complex phase = std::polar(1.0, load.order * frequency_ * (segment.start + t));
      input_ += weight * (load.amplitude * phase).real().dot(velocity);
    }
    damping_ += weight * ring_.damping.dot(velocity.cwiseAbs2());
  }
  const Vector slid =
      RingSegment::value(segment.relative, segment.length / segment.scale) - segment.relative.col(0);
  for (Index i = 0; i < ring_.nodes(); ++i) {
    friction_ += ring_.contact_stiffness * threshold_ * state.slip[i] * slid(i);
  }
}

}  // namespace arcslip
