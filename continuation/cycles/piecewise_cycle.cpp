#include "arcslip/continuation/cycles/piecewise_cycle.hpp"

#include <cmath>
#include <limits>

#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/cycles/orbit_observables.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

/// All pieces side by side, and how long each lasts.
class SideBySide : public Field {
 public:
  explicit SideBySide(std::shared_ptr<const PiecewiseField> pieces) : pieces_(std::move(pieces)) {}

  Index size() const override { return (pieces_->size() + 1) * pieces_->pieces(); }
  std::vector<std::string> parameter_names() const override { return pieces_->parameter_names(); }

  std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const std::string& piece : pieces_->piece_names()) {
      for (const std::string& name : pieces_->names()) all.push_back(name + "_" + piece);
    }
    for (const std::string& piece : pieces_->piece_names()) all.push_back("T_" + piece);
    return all;
  }

  bool evaluate(double /*t*/, const Vector& u, const Vector& p, const FieldValues& out) const override {
    const Index n = pieces_->size();
    const Index count = pieces_->pieces();
    if (out.velocity != nullptr) out.velocity->setZero();
    if (out.by_unknowns != nullptr) out.by_unknowns->setZero();
    if (out.by_parameters != nullptr) out.by_parameters->setZero();
    if (out.by_time != nullptr) out.by_time->setZero();
    Vector velocity(n);
    Matrix by_unknowns(n, n);
    Matrix by_parameters(n, p.size());
    for (Index k = 0; k < count; ++k) {
      const double lasts = u(n * count + k);
      const FieldValues own{&velocity, out.by_unknowns != nullptr ? &by_unknowns : nullptr,
                            out.by_parameters != nullptr ? &by_parameters : nullptr};
      if (!pieces_->velocity(k, u.segment(n * k, n), p, own)) return false;
      if (out.velocity != nullptr) out.velocity->segment(n * k, n) = lasts * velocity;
      if (out.by_unknowns != nullptr) {
        out.by_unknowns->block(n * k, n * k, n, n) = lasts * by_unknowns;
        out.by_unknowns->block(n * k, n * count + k, n, 1) = velocity;
      }
      if (out.by_parameters != nullptr) out.by_parameters->middleRows(n * k, n) = lasts * by_parameters;
    }
    return true;
  }

  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    const Index n = pieces_->size();
    const Index count = pieces_->pieces();
    unknowns.resize(size());
    Vector own;
    for (Index k = 0; k < count; ++k) {
      pieces_->scale(u.segment(n * k, n), p, own, parameters);
      unknowns.segment(n * k, n) = own;
    }
    unknowns.tail(count).setConstant(u.tail(count).cwiseAbs().sum() / static_cast<double>(count));
    unknowns = (unknowns.array() > 0).select(unknowns, 1.0);
  }

 private:
  std::shared_ptr<const PiecewiseField> pieces_;
};

}  // namespace

PiecewiseCycle::PiecewiseCycle(std::shared_ptr<const PiecewiseField> pieces, const OrbitMesh& mesh,
                               const Matrix& orbit, const Vector& p, bool doubled)
    : PeriodicOrbit(std::make_shared<SideBySide>(pieces), false),
      pieces_(std::move(pieces)),
      n_(pieces_->size()),
      count_(pieces_->pieces()),
      doubled_(doubled),
      winding_(Vector::Zero(n_)) {
  Vector next(n_);
  if (pieces_->jump(count_ - 1, orbit.col(orbit.cols() - 1).segment(n_ * (count_ - 1), n_), p, {&next})) {
    for (Index i = 0; i < n_; ++i) {
      if (const double turn = pieces_->turn(i); turn > 0)
        winding_(i) = turn * std::round((next(i) - orbit(i, 0)) / turn);
    }
  }
  begin(mesh, orbit, p);
}

/// Both rounds side by side.
Matrix PiecewiseCycle::two_rounds(const Matrix& once, double sign) const {
  const auto places = once.topRows(n_ * count_);
  const auto times = once.bottomRows(count_);
  Matrix both(2 * once.rows(), once.cols());
  both << places, sign * places, times, sign * times;
  if (sign > 0)
    both.middleRows(n_ * count_, n_ * count_).colwise() += winding_.replicate(count_, 1).reshaped();
  return both;
}

std::shared_ptr<OrbitProblem> PiecewiseCycle::doubled(const OrbitMesh& mesh, const Matrix& orbit,
                                                      const Vector& p) const {
  return std::make_shared<PiecewiseCycle>(two_rounds_of(pieces_), mesh, orbit, p, true);
}

/// Of a doubled one half of what tells both of its rounds apart.
Matrix PiecewiseCycle::part_apart(const OrbitFrame& frame, const Eigen::Ref<const Matrix>& orbit) const {
  if (!doubled_) return {};
  const Index half = count_ / 2;
  const Vector turn = 0.5 * winding_.replicate(half, 1).reshaped();
  const Matrix here = frame.mesh.at(orbit, frame.points);
  Matrix places = 0.5 * (here.topRows(n_ * half) - here.middleRows(n_ * half, n_ * half));
  places.colwise() += 0.5 * turn;
  const Matrix times = 0.5 * (here.middleRows(n_ * count_, half) - here.bottomRows(half));
  Matrix part(here.rows(), here.cols());
  part << places, -places, times, -times;
  return part;
}

double PiecewiseCycle::given_duration(const Vector& p, Vector* by_parameters) const {
  if (by_parameters != nullptr) by_parameters->setZero(p.size());
  return 1;
}

std::vector<std::string> PiecewiseCycle::told_names() const {
  std::vector<std::string> names = pieces_->names();
  names.resize(static_cast<std::size_t>(pieces_->told()));
  return names;
}

Matrix PiecewiseCycle::told_orbit(const Vector& u) const {
  const Index told = pieces_->told();
  Matrix all(told, count_ * nodes());
  for (Index k = 0; k < count_; ++k) all.middleCols(k * nodes(), nodes()) = orbit(u).middleRows(n_ * k, told);
  return all;
}

Vector PiecewiseCycle::times(const Vector& u, const Vector& p, const Regime& regime) const {
  const Vector places = OrbitProblem::times(u, p, regime);
  Vector all(count_ * nodes());
  double begin = pieces_->time_at(u.head(n_), p);
  for (Index k = 0; k < count_; ++k) {
    all.segment(k * nodes(), nodes()) = begin + lasts(u)(k) * places.array();
    begin += lasts(u)(k);
  }
  return all;
}

/// Continuity but for jumps, piece by piece, then the borders.
bool PiecewiseCycle::end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                    const EndConditions& out) const {
  Vector next(n_);
  Matrix by_unknowns(n_, n_);
  Matrix by_parameters(n_, p.size());
  Vector level(1);
  Matrix level_by_unknowns(1, n_);
  Matrix level_by_parameters(1, p.size());
  if (out.by_left != nullptr) out.by_left->setZero();
  if (out.by_right != nullptr) out.by_right->setZero();
  if (out.by_parameters != nullptr) out.by_parameters->setZero();
  for (Index k = 0; k < count_; ++k) {
    const Vector end = right.segment(n_ * k, n_);
    if (!pieces_->jump(k, end, p, {&next, &by_unknowns, &by_parameters}) ||
        !pieces_->border(k, end, p, {&level, &level_by_unknowns, &level_by_parameters}))
      return false;
    const bool is_last = k + 1 == count_;
    const Index behind = is_last ? 0 : n_ * (k + 1);
    const Index row = n_ * k;
    const Index border = n_ * count_ + k;
    if (out.values != nullptr) {
      out.values->segment(row, n_) = next - left.segment(behind, n_);
      if (is_last) out.values->segment(row, n_) -= winding_;
      (*out.values)(border) = level(0);
    }
    if (out.by_left != nullptr) out.by_left->block(row, behind, n_, n_).diagonal().setConstant(-1);
    if (out.by_right != nullptr) {
      out.by_right->block(row, n_ * k, n_, n_) = by_unknowns;
      out.by_right->block(border, n_ * k, 1, n_) = level_by_unknowns;
    }
    if (out.by_parameters != nullptr) {
      out.by_parameters->middleRows(row, n_) = by_parameters;
      out.by_parameters->row(border) = level_by_parameters;
    }
  }
  return true;
}

/// In coordinates on the border that a piece ends on.
ComplexVector PiecewiseCycle::multipliers_by(const Vector& u, const Vector& p, const Regime& /*regime*/,
                                             const FactoredJacobian& jacobian) const {
  if (n_ == 1) return ComplexVector(0);
  const std::vector<Matrix> all = transfers(jacobian);
  Vector velocity(n_);
  Vector level(1);
  Vector next(n_);
  Matrix by_unknowns(1, n_);
  Matrix jump(n_, n_);
  std::vector<Matrix> onto;  // from the start of a piece to the border
  std::vector<Matrix> from;  // from there to the start of the next one
  for (Index k = 0; k < count_; ++k) {
    const Vector end = orbit(u).col(nodes() - 1).segment(n_ * k, n_);
    if (!pieces_->velocity(k, end, p, {&velocity}) || !pieces_->border(k, end, p, {&level, &by_unknowns}) ||
        !pieces_->jump(k, end, p, {&next, &jump}))
      return {};
    Matrix transfer = Matrix::Identity(n_, n_);
    for (const Matrix& one : all) transfer = one.block(n_ * k, n_ * k, n_, n_) * transfer;
    const Matrix along = perpendicular(by_unknowns.transpose());
    const double rate = (by_unknowns * velocity)(0);
    transfer -= velocity * (by_unknowns * transfer) / rate;
    onto.emplace_back(along.transpose() * transfer);
    from.emplace_back(jump * along);
  }
  std::vector<Matrix> factors;
  for (Index k = 0; k < count_; ++k) {
    const auto before = static_cast<std::size_t>((k + count_ - 1) % count_);
    factors.emplace_back(onto[static_cast<std::size_t>(k)] * from[before]);
  }
  return continuation::log_multipliers(factors);
}

double PiecewiseCycle::border(const Vector& u, const Vector& p, const Regime& regime, int border,
                              Gradient* gradient) const {
  constexpr double vanished =
      1e-8;  // of the period: what meets the branch where a piece is 0 may be 0 all along
  if (border >= count_) return early_meeting(u, p, regime, border - count_, gradient);
  const double whole = lasts(u).cwiseAbs().sum();
  if (gradient != nullptr) {
    gradient->unknowns.setZero();
    gradient->parameters.setZero();
    gradient->unknowns.segment(n_ * count_, count_) = lasts(u)(border) * lasts(u).cwiseSign();
    gradient->unknowns(n_ * count_ + border) -= whole;
    gradient->unknowns /= whole * whole;
  }
  return vanished - lasts(u)(border) / whole;
}

/// The level of the border where it comes nearest to 0 within the piece, below 0 as long as it does not reach
/// it; where it does not turn before the end, what it has at its farthest.
double PiecewiseCycle::early_meeting(const Vector& u, const Vector& p, const Regime& regime, Index piece,
                                     Gradient* gradient) const {
  const OrbitMesh& mesh = frame(regime).mesh;
  const auto values = orbit(u);
  Vector level(1);
  Matrix by_unknowns(1, n_);
  Matrix by_parameters(1, p.size());
  Vector all;
  Vector slope;
  const auto at = [&](double s) {  // h and dh/ds
    mesh.at(values, s, all, &slope);
    if (!pieces_->border(piece, all.segment(n_ * piece, n_), p, {&level, &by_unknowns, &by_parameters}))
      return std::pair(std::nan(""), std::nan(""));
    return std::pair(level(0), by_unknowns.row(0).dot(slope.segment(n_ * piece, n_)));
  };
  const double side = at(1).second > 0 ? -1 : 1;  // on which the piece is
  Vector levels(nodes());
  for (Index i = 0; i < nodes(); ++i) levels(i) = side * at(mesh.place(i)).first;
  Index farthest = 0;
  levels.maxCoeff(&farthest);
  double place = mesh.place(farthest);
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 1; i + 1 < nodes(); ++i) {
    const bool is_valley = levels(i) < levels(i - 1) && levels(i) <= levels(i + 1);
    if (!is_valley || levels(i) >= least) continue;
    const auto rate = [&](double s) { return at(s).second; };
    const double low = mesh.place(i - 1);
    const double high = mesh.place(i + 1);
    place = zero_between(rate, low, high, rate(low), rate(high));
    least = levels(i);
  }
  const double value = side * at(place).first;
  if (gradient == nullptr) return -value;
  gradient->parameters = -side * by_parameters.row(0).transpose();
  gradient->unknowns.setZero();
  const Index interval = mesh.interval(place);
  Vector weights;
  mesh.rule().at((place - mesh.borders()(interval)) / mesh.length(interval), weights);
  for (Index i = 0; i < weights.size(); ++i) {
    const Index node = interval * degree() + i;
    gradient->unknowns.segment(field().size() * node + n_ * piece, n_) -=
        side * weights(i) * by_unknowns.row(0).transpose();
  }
  return -value;
}

std::vector<Observable> PiecewiseCycle::observables() const {
  std::vector<Observable> all{{duration_name(told_names(), parameter_names()), true}};
  for (const std::string& piece : pieces_->piece_names()) all.push_back({"T_" + piece, true});
  for (const std::string& name : told_names()) {
    all.push_back({name + "_max", true});
    all.push_back({name + "_min", true});
  }
  return all;
}

void PiecewiseCycle::observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  values.resize(1 + count_ + 2 * pieces_->told());
  Gradient gradient{Vector::Zero(size()), Vector::Zero(p.size())};
  for (Index i = 0; i < values.size(); ++i) values(i) = observe(u, p, regime, i, gradient);
}

double PiecewiseCycle::observe(const Vector& u, const Vector& /*p*/, const Regime& regime, Index which,
                               Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  const Index extremum = which - 1 - count_;
  if (which == 0) {
    gradient.unknowns.segment(n_ * count_, count_).setOnes();
    return lasts(u).sum();
  }
  if (extremum < 0) {
    gradient.unknowns(n_ * count_ + which - 1) = 1;
    return lasts(u)(which - 1);
  }
  const double sign = extremum % 2 == 0 ? 1 : -1;
  double best = -std::numeric_limits<double>::infinity();
  for (Index k = 0; k < count_; ++k) {
    Gradient one{Vector::Zero(size()), {}};
    const Index of_piece = 2 * (n_ * k + extremum / 2) + extremum % 2;
    const double value = sign * observed_on_orbit(*this, u, regime, of_piece, one);
    if (value <= best) continue;
    best = value;
    gradient.unknowns = one.unknowns;
    gradient.piece = k * orbit_pieces + one.piece;
  }
  return sign * best;
}

}  // namespace arcslip::continuation
