#include "elements/circle/circle_changes.hpp"

#include <Eigen/LU>
#include <cmath>

#include "arcslip/dense.hpp"
#include "arcslip/elements/pressed/pressed_contact.hpp"
#include "arcslip/motion/arc_integrals.hpp"

namespace arcslip {
namespace {

using Row = Eigen::RowVectorXd;
using Share = CircleColumns::Share;
using Phase = PressedArcs::Phase;

/// Goes through a course with all columns.
class CirclePassage {
 public:
  CirclePassage(const CircleMotion& motion, const CircleColumns& columns, std::span<const int> orders)
      : motion_(motion), columns_(columns), orders_(orders), touched_(false) {
    const Index rows = 2 * std::ssize(orders);
    out_.x.setZero(rows, columns.size());
    out_.y.setZero(rows, columns.size());
    out_.force_x.setZero(rows);
    out_.force_y.setZero(rows);
    out_.offset.setZero(2, columns.size());
    out_.offset.rightCols<2>().setIdentity();
    direction_.setZero(columns.size());
  }

  CircleChanges through(const CircleCourse& course) {
    touched_ = course.begins_apart();
    for (const CircleCourse::Arc& arc : course.arcs()) {
      out_.arcs.emplace_back();
      if (arc.phase == Phase::stick) stick(arc);
      if (arc.phase == Phase::slip && !arc.panels.empty()) slip(arc);
      touched_ = arc.phase == Phase::apart;
    }
    return std::move(out_);
  }

 private:
  /// A row of what all columns have of a share.
  Row of(double theta, const Share& share) const {
    Row row = Row::Zero(columns_.size());
    columns_.add(theta, share, row);
    return row;
  }

  /// A = w at a theta that moves with b = 0.
  void touch(double theta) {
    const CircleMotion::Local here = motion_.at(theta);
    const Complex moves = here.radius_rate > 0 ? -here.rate / here.radius_rate : 0;
    out_.offset.row(0) = of(theta, {.centre = 1, .radius = moves.real()});
    out_.offset.row(1) = of(theta, {.centre = Complex(0, 1), .radius = moves.imag()});
  }

  void stick(const CircleCourse::Arc& arc) {
    if (touched_) touch(arc.begin);
    out_.arcs.back().offset = out_.offset;
    for (std::size_t a = 0; a < orders_.size(); ++a) {
      const auto row = static_cast<Index>(a);
      const Index other = row + std::ssize(orders_);
      const Complex sum = -scale(a) * arc_integral(arc.begin, arc.width, -orders_[a]);
      add_outer(row, sum.real(), arc.offset);
      add_outer(other, sum.imag(), arc.offset);
    }
  }

  void add_outer(Index row, double factor, Complex offset) {
    out_.x.row(row) += factor * out_.offset.row(0);
    out_.y.row(row) += factor * out_.offset.row(1);
    out_.force_x(row) += factor * offset.real();
    out_.force_y(row) += factor * offset.imag();
  }

  /// Of the direction as slip begins.
  void begin(const SlipPanel& panel) {
    const CircleMotion::Local here = motion_.at(panel.reach.begin);
    const Complex across = Complex(0, 1) * std::polar(1.0, panel.start);
    const double along = std::real(here.rate * std::polar(1.0, -panel.start));
    if (touched_) {
      const double turning =
          std::imag(here.bend * std::polar(1.0, -panel.start)) / (here.radius_rate + along);
      direction_ = of(panel.reach.begin, {.rate = across / along, .radius = -turning / along});
    } else {
      direction_ = of(panel.reach.begin, {.centre = across / here.radius});
      direction_ -= (across.real() / here.radius) * out_.offset.row(0) +
                    (across.imag() / here.radius) * out_.offset.row(1);
    }
  }

  void slip(const CircleCourse::Arc& arc) {
    begin(arc.panels.front());
    Matrix rows(panel_nodes, columns_.size());
    for (const SlipPanel& panel : arc.panels) {
      rows.setZero();
      for (Index j = 0; j < panel_nodes; ++j) {
        const Complex across = Complex(0, 1) * std::polar(1.0, panel.phase(j));
        Row row = Row::Zero(columns_.size());
        columns_.add(panel.angle(j), {.rate = across, .radius = -panel.turning(j)}, row);
        rows.row(j) = row;
      }
      SlipPanel::Changes(panel).solve(direction_, rows);
      direction_ = rows.row(panel_nodes - 1);
      if (!orders_.empty()) add_forces(panel, rows);
    }
    out_.arcs.back().direction_at_end = direction_;
    end(arc.panels.back());
  }

  /// delta A = delta w - delta (b e^{i phi}).
  void end(const SlipPanel& panel) {
    const Index last = panel_nodes - 1;
    const Complex toward = std::polar(1.0, panel.phase(last));
    const Complex across = Complex(0, 1) * toward * panel.radius(last);
    out_.offset.row(0) =
        of(panel.angle(last), {.centre = 1, .radius = -toward.real()}) - across.real() * direction_;
    out_.offset.row(1) = of(panel.angle(last), {.centre = Complex(0, 1), .radius = -toward.imag()}) -
                         across.imag() * direction_;
  }

  void add_forces(const SlipPanel& panel, const Matrix& phases) {
    const Index n = std::ssize(orders_);
    Matrix turns(2 * n, panel_nodes);
    for (Index j = 0; j < panel_nodes; ++j) {
      for (Index a = 0; a < n; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const Complex turn = scale(at) * panel.weight(j) * std::polar(1.0, -orders_[at] * panel.angle(j));
        turns(a, j) = turn.real();
        turns(n + a, j) = turn.imag();
      }
    }
    const PanelVector cosine = panel.phase.array().cos();
    const PanelVector sine = panel.phase.array().sin();
    out_.force_x += turns * panel.radius.cwiseProduct(cosine);
    out_.force_y += turns * panel.radius.cwiseProduct(sine);
    Matrix radius = Matrix::Zero(panel_nodes, columns_.size());
    for (Index j = 0; j < panel_nodes; ++j) {
      Row row = Row::Zero(columns_.size());
      columns_.add(panel.angle(j), {.radius = 1}, row);
      radius.row(j) = row;
    }
    out_.x.noalias() +=
        turns * (cosine.asDiagonal() * radius - panel.radius.cwiseProduct(sine).asDiagonal() * phases);
    out_.y.noalias() +=
        turns * (sine.asDiagonal() * radius + panel.radius.cwiseProduct(cosine).asDiagonal() * phases);
  }

  double scale(std::size_t order) const { return 1 / (orders_[order] == 0 ? two_pi : pi); }

  const CircleMotion& motion_;
  const CircleColumns& columns_;
  std::span<const int> orders_;
  bool touched_;  // whether the parts were apart before
  CircleChanges out_;
  Row direction_;  // of phi
};

}  // namespace

void CircleColumns::add(double theta, const Share& share, Eigen::Ref<Row> row) const {
  if (orders_.empty()) return;
  const Index n = harmonics();
  const PressedSettings& s = motion_.settings();
  const double pressed = s.friction * s.normal_stiffness;
  for (Index a = 0; a < n; ++a) {
    const int h = orders_[static_cast<std::size_t>(a)];
    const Complex turn = std::polar(1.0, h * theta);
    const double own[] = {turn.real(), -turn.imag()};  // of Re x_h and Im x_h
    const double rate[] = {-h * turn.imag(), -h * turn.real()};
    for (Index part = 0; part < 2; ++part) {
      const double x = s.tangential_stiffness * own[part];
      const double x_rate = s.tangential_stiffness * rate[part];
      const Index at = part * n + a;
      row(at) += share.centre.real() * x + share.rate.real() * x_rate;
      row(2 * n + at) += share.centre.imag() * x + share.rate.imag() * x_rate;
      row(4 * n + at) += pressed * (share.radius * own[part] + share.radius_rate * rate[part]);
    }
  }
  add_settings(theta, share, row);
}

void CircleColumns::add_settings(double theta, const Share& share, Eigen::Ref<Row> row) const {
  const PressedSettings& s = motion_.settings();
  const PeriodicMotion::Local x = motion_.x().at(theta);
  const PeriodicMotion::Local y = motion_.y().at(theta);
  const PeriodicMotion::Local press = motion_.press().at(theta);
  const PeriodicMotion::Local closes = motion_.closing().at(theta);
  const Index first = settings();
  row(first + PressedForce::friction) += share.radius * press.value + share.radius_rate * press.first;
  row(first + PressedForce::tangential_stiffness) +=
      dot(share.centre, {x.value, y.value}) + dot(share.rate, {x.first, y.first});
  row(first + PressedForce::normal_stiffness) +=
      s.friction * (share.radius * closes.value + share.radius_rate * closes.first);
  row(first + PressedForce::normal_force) += s.friction * share.radius;
}

ContactNumber CircleColumns::number(double value, const Row& row) const {
  const Index n = harmonics();
  ContactNumber number{value, ComplexVector(3 * n), {}};
  for (Index c = 0; c < 3; ++c) {
    for (Index a = 0; a < n; ++a)
      number.by_motion(c * n + a) = Complex(row(2 * c * n + a), row((2 * c + 1) * n + a));
  }
  for (Index s = 0; s < PressedForce::settings; ++s)
    number.by[static_cast<std::size_t>(s)] = row(settings() + s);
  return number;
}

Matrix start_of(const CircleChanges& changes) {
  const Matrix by = Matrix::Identity(2, 2) - changes.offset.rightCols<2>();
  return solution_of(by, Matrix(changes.offset.leftCols(changes.offset.cols() - 2)));
}

CircleChanges changes_of(const CircleMotion& motion, const CircleCourse& course, const CircleColumns& columns,
                         std::span<const int> orders) {
  return CirclePassage(motion, columns, orders).through(course);
}

Eigen::Matrix2d offset_by_offset(const CircleMotion& motion, const CircleCourse& course) {
  return changes_of(motion, course, CircleColumns(motion, {}), {}).offset;
}

Matrix changes_of(const CircleMotion& motion, const CommonPoint& point, const CircleColumns& columns) {
  const TouchConditions conditions(motion, point);
  Matrix rest = Matrix::Zero(conditions.rest.size(), columns.size());
  const Index count = std::ssize(point.touches);
  for (Index k = 0; k < count; ++k) {
    const double angle = point.touches[static_cast<std::size_t>(k)].angle;
    const CircleMotion::Local w = motion.at(angle);
    const Complex pull = w.centre - point.offset;
    const double radius = w.radius + point.excess;
    const double weight = conditions.weight(k);
    const auto add = [&](Index row, const Share& share) {
      Row sum = Row::Zero(columns.size());
      columns.add(angle, share, sum);
      rest.row(row) += sum;
    };
    add(0, {.centre = weight});
    add(1, {.centre = Complex(0, weight)});
    add(2, {.radius = weight});
    add(3 + k, {.centre = -pull, .radius = radius});
    add(3 + count + k, {.centre = -w.rate, .rate = -pull, .radius = w.radius_rate, .radius_rate = radius});
  }
  return shortest(conditions.by, rest).topRows(2);
}

Matrix changes_of(const CircleMotion& motion, const RestingPlace& place, const CircleColumns& columns) {
  if (place.part == 1) return Matrix::Zero(2, columns.size());
  const Matrix centre = changes_of(motion, place.centre, columns);
  if (place.part == 0) return centre;
  // A = (1 - part) centre with the mean, and |w - A| = b at the disc that ends the way
  const CircleMotion::Local disc = motion.at(place.angle);
  const Complex pull = disc.centre - place.offset;
  const Complex whole = place.centre.offset + motion.mean();
  const double rest = 1 - place.part;
  Row part = Row::Zero(columns.size());
  columns.add(place.angle, {.centre = -pull, .radius = disc.radius}, part);
  part += rest * (pull.real() * centre.row(0) + pull.imag() * centre.row(1));
  part /= dot(pull, whole);
  Matrix offset = rest * centre;
  offset.row(0) -= whole.real() * part;
  offset.row(1) -= whole.imag() * part;
  return offset;
}

}  // namespace arcslip
