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

HarmonicRecord::HarmonicRecord(const RingMotion& motion, std::vector<int> orders, bool all_nodes)
    : motion_(motion),
      orders_(std::move(orders)),
      all_nodes_(all_nodes),
      sums_(ComplexMatrix::Zero(static_cast<Index>(orders_.size()),
                                1 + 2 * motion.ring().motion.rows() / motion.ring().nodes())) {}

void HarmonicRecord::follow(const RingSegment& segment, const RingState& /*state*/) {
  const Ring& ring = motion_.ring();
  const Index nodes = ring.nodes();
  const Index count = all_nodes_ ? nodes : 1;
  const Matrix base = ring.base.topRows(count) * segment.position;
  for (const Node& node : quadrature()) {
    const double t = node.place * segment.length;
    const Vector y = RingSegment::value(base, t / segment.scale);
    const Vector x = RingSegment::value(segment.motion, t / segment.scale);
    const Vector force =
        motion_.forces(segment, t / segment.scale, x, segment.rate(segment.motion, t / segment.scale));
    for (std::size_t h = 0; h < orders_.size(); ++h) {
      const Complex wave =
          std::polar(node.weight * segment.length, -orders_[h] * motion_.frequency() * (segment.start + t));
      auto sums = sums_.row(static_cast<Index>(h));
      for (Index i = 0; i < count; ++i) {
        const auto turns = static_cast<double>(orders_[h] * ring.wave_number * i % nodes);
        const Complex here = wave * std::polar(1.0, two_pi * turns / static_cast<double>(nodes));
        sums(0) += here * y(i);
        for (Index c = 0; 2 * c + 2 < sums.size(); ++c) {
          sums(1 + 2 * c) += here * x(c * nodes + i);
          sums(2 + 2 * c) += here * force(c * nodes + i);
        }
      }
    }
  }
  time_ += static_cast<double>(count) * segment.length;
}

ComplexVector HarmonicRecord::mean(Index quantity) const {
  ComplexVector all = sums_.col(quantity) * (2 / time_);
  for (std::size_t h = 0; h < orders_.size(); ++h) {
    if (orders_[h] == 0) all(static_cast<Index>(h)) *= 0.5;
  }
  return all;
}

ComplexVector HarmonicRecord::base() const {
  ComplexVector all = mean(0);
  for (const UnseenMotion& one : motion_.ring().unseen) {
    for (std::size_t h = 0; h < orders_.size(); ++h) {
      const double w = one.order * motion_.frequency();
      if (orders_[h] == one.order)
        all(static_cast<Index>(h)) += one.residue / (one.stiffness + Complex(-w * w, w * one.damping));
    }
  }
  return all;
}

void EnergyRecord::follow(const RingSegment& segment, const RingState& /*state*/) {
  const Ring& ring = motion_.ring();
  for (const Node& node : quadrature()) {
    const double t = node.place * segment.length;
    const Vector velocity = segment.rate(segment.position, t / segment.scale);
    const double weight = node.weight * segment.length;
    for (const RingLoad& load : ring.loads) {
      const Complex phase = std::polar(1.0, load.order * motion_.frequency() * (segment.start + t));
      input_ += weight * (load.amplitude * phase).real().dot(velocity);
    }
    damping_ += weight * ring.damping.dot(velocity.cwiseAbs2());
    if (ring.coupling.size() > 0) {
      const Vector position = RingSegment::value(segment.position, t / segment.scale);
      damping_ -= weight * ring.coupled(position).col(0).dot(velocity);
    }
    const Vector x = RingSegment::value(segment.motion, t / segment.scale);
    const Vector rate = ring.motion * velocity;
    elements_ += weight * motion_.forces(segment, t / segment.scale, x, rate).dot(rate);
  }
}

}  // namespace arcslip
