// The modes of a part of a whole ring whose sectors are not alike, in those of the equal sectors.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "arcslip/dense.hpp"
#include "assembly/ring_part.hpp"

namespace arcslip {

struct RingPart::SameModes {
  double frequency;
  ContactMatrix shapes;  ///< ports x modes
  ContactVector load;    ///< modes
};

std::vector<RingPart::SameModes> RingPart::same_modes(const ContactModes& wave) {
  constexpr double alike = 1e-9;  // well above what is left of equal frequencies by their computation
  std::vector<ContactMode> modes = wave.modes();
  std::stable_sort(modes.begin(), modes.end(),
                   [](const ContactMode& a, const ContactMode& b) { return a.frequency < b.frequency; });
  std::vector<SameModes> all;
  double before = 0;
  for (const ContactMode& mode : modes) {
    if (all.empty() || mode.frequency - before > alike * mode.frequency)
      all.push_back({mode.frequency, ContactMatrix(wave.contacts(), 0), {}});
    SameModes& group = all.back();
    const Index last = group.load.size();
    group.shapes.conservativeResize(Eigen::NoChange, last + 1);
    group.shapes.col(last) = mode.shape;
    group.load.conservativeResize(last + 1);
    group.load(last) = mode.load;
    before = mode.frequency;
  }
  return all;
}

/// That which moves the ports of sector i by part Re(shape e^{-j a_m i}).
void RingPart::add_real(Index wave, const ContactVector& shape, double part, double square, Complex load,
                        RealModes& all) const {
  Vector motion(count() * ports_);
  for (Index i = 0; i < count(); ++i) {
    const Complex turn = turns_(wave, i);
    motion.segment(i * ports_, ports_) = part * (turn * shape).real();
  }
  all.squares.push_back(square);
  all.motion.push_back(std::move(motion));
  all.load.push_back(load);
}

/// Of a wave that is its own conjugate, whose modes are real but for how they are combined.
void RingPart::add_single(Index wave, const SameModes& modes, RealModes& all) const {
  constexpr double negligible = 1e-10;
  Matrix both(ports_, 2 * modes.load.size());
  both << modes.shapes.real(), modes.shapes.imag();
  const auto [directions, sizes, from] = singular_axes(both);
  const double part = 1 / std::sqrt(static_cast<double>(count()));
  for (Index k = 0; k < modes.load.size(); ++k) {
    const bool is_seen = k < sizes.size() && sizes(k) > negligible * sizes(0);
    ContactVector shape = ContactVector::Zero(ports_);
    Complex load = 0;
    if (is_seen) {
      shape.real() = sizes(k) * directions.col(k);
      load = (shape.transpose() * modes.shapes * modes.load).value() / (sizes(k) * sizes(k));
    }
    add_real(wave, shape, part, modes.frequency * modes.frequency, load, all);
  }
}

/// Of a wave and the opposite one, `back`, whose modes move like these backwards but for how they are
/// combined.
void RingPart::add_pairs(Index wave, const SameModes& modes, const std::vector<SameModes>& back,
                         RealModes& all) const {
  constexpr double alike = 1e-8;
  ContactVector load_back = ContactVector::Zero(modes.load.size());
  const auto found = std::find_if(back.begin(), back.end(), [&](const SameModes& one) {
    return std::abs(one.frequency - modes.frequency) <= alike * modes.frequency;
  });
  if (found != back.end() && !found->load.isZero(0)) {
    const ContactMatrix opposite = modes.shapes.conjugate();
    load_back = shortest(opposite, ContactVector(found->shapes * found->load));
  }
  const double part = std::sqrt(2 / static_cast<double>(count()));
  const double square = modes.frequency * modes.frequency;
  const Complex j(0, 1);
  for (Index k = 0; k < modes.load.size(); ++k) {
    const Complex sum = (modes.load(k) + load_back(k)) / std::sqrt(2.0);
    const Complex difference = j * (load_back(k) - modes.load(k)) / std::sqrt(2.0);
    add_real(wave, modes.shapes.col(k), part, square, sum, all);
    add_real(wave, j * modes.shapes.col(k), part, square, difference, all);
  }
}

RingPart::RealModes RingPart::real_modes() const {
  RealModes all;
  for (Index m = 0; 2 * m <= count(); ++m) {
    const ContactModes& wave = given_.waves[static_cast<std::size_t>(m)];
    const bool is_single = 2 * m % count() == 0;
    std::vector<SameModes> back;
    if (!is_single && is_loaded_[static_cast<std::size_t>(count() - m)])
      back = same_modes(given_.waves[static_cast<std::size_t>(count() - m)]);
    for (const SameModes& modes : same_modes(wave))
      is_single ? add_single(m, modes, all) : add_pairs(m, modes, back, all);
  }
  return all;
}

/// The modes at rest of a wave and of the opposite one, which are theirs backwards, also those that no port
/// sees.
void RingPart::add_turning(Index wave, RealModes& all) const {
  constexpr double alike = 1e-8;
  const bool is_single = 2 * wave % count() == 0;
  const ContactModes& forward = given_.waves[static_cast<std::size_t>(wave)];
  const ContactModes& back = given_.waves[static_cast<std::size_t>((count() - wave) % count())];
  const double part = std::sqrt((is_single ? 1 : 2) / static_cast<double>(count()));
  const Complex j(0, 1);
  for (std::size_t k = 0; k < forward.modes().size(); ++k) {
    const ContactMode& mode = forward.modes()[k];
    const double square = mode.frequency * mode.frequency;
    if (!((back.modes()[k].shape - mode.shape.conjugate()).norm() <= alike * mode.shape.norm()))
      throw std::invalid_argument("modes of waves that run opposite ways are not found as conjugates");
    add_real(wave, mode.shape, part, square, mode.load, all);
    if (is_single) continue;
    const Complex load_back = back.modes()[k].load;
    all.load.back() = (mode.load + load_back) / std::sqrt(2.0);
    add_real(wave, j * mode.shape, part, square, j * (load_back - mode.load) / std::sqrt(2.0), all);
  }
}

/// Puts what couples the modes of one wave at its place among all, two real modes for each.
void RingPart::couple(Index wave, Index first, const ComplexMatrix& of_wave, Matrix& all) const {
  const Index parts = 2 * wave % count() == 0 ? 1 : 2;
  for (Index i = 0; i < of_wave.rows(); ++i) {
    for (Index k = 0; k < of_wave.cols(); ++k) {
      const Complex& one = of_wave(i, k);
      auto block = all.block(first + parts * i, first + parts * k, parts, parts);
      block.diagonal().setConstant(one.real());
      if (parts == 1) continue;
      block(0, 1) = -one.imag();
      block(1, 0) = one.imag();
    }
  }
}

RingPart::RealModes RingPart::turning_modes() const {
  RealModes all;
  std::vector<Index> firsts;
  for (Index m = 0; 2 * m <= count(); ++m) {
    firsts.push_back(std::ssize(all.squares));
    add_turning(m, all);
  }
  const Index size = std::ssize(all.squares);
  all.gyroscopic = all.stiffness_speed2 = Matrix::Zero(size, size);
  for (Index m = 0; 2 * m <= count(); ++m) {
    const auto at = static_cast<std::size_t>(m);
    couple(m, firsts[at], given_.turning[at]->gyroscopic, all.gyroscopic);
    couple(m, firsts[at], given_.turning[at]->stiffness_speed2, all.stiffness_speed2);
  }
  return all;
}

/// What the changes meet of each mode.
Matrix RingPart::changed_rows(const RealModes& all) const {
  Matrix rows = Matrix::Zero(std::ssize(rows_), std::ssize(all.motion));
  for (Index k = 0; k < rows.cols(); ++k) {
    const Vector& motion = all.motion[static_cast<std::size_t>(k)];
    for (Index i = 0; i < rows.rows(); ++i) {
      for (const RingChange::Term& term : rows_[static_cast<std::size_t>(i)])
        rows(i, k) += term.weight * motion(place(term.sector, term.port));
    }
  }
  return rows;
}

namespace {

/// Values of a symmetric matrix, the least first, and their vectors.
Pencil<Matrix> axes_of(const Matrix& matrix) {
  auto axes = pencil(matrix, Matrix::Identity(matrix.rows(), matrix.cols()));
  if (!axes) throw std::invalid_argument("what mistuning and cuts leave of the ring was not found");
  return std::move(*axes);
}

/// Whether D + B^T X B, D definite, is so as well, by C = B D^-1 B^T: -X^-1 - C has as many negative values
/// as -X^-1 (Sylvester's law of inertia). `margin` is that part of X which may be missing, < 0, or is kept.
bool stays_definite(const Matrix& compliance, const Matrix& change, double margin) {
  const Pencil<Matrix> axes = axes_of(change);
  const double least = 1e-12 * axes.values.cwiseAbs().maxCoeff();  // what is below is rounding, and no change
  const Vector sizes = axes.values.cwiseAbs().unaryExpr([=](double size) { return size > least ? size : 0; });
  const Matrix roots = axes.vectors * sizes.cwiseSqrt().asDiagonal();
  Matrix rest = -(roots.transpose() * compliance * roots);
  rest.diagonal() += axes.values.unaryExpr([](double value) { return value > 0 ? -1.0 : 1.0; });
  return (axes_of(rest).values.array() < margin).count() == (axes.values.array() > 0).count();
}

}  // namespace

void RingPart::check_changes() const {
  if (rows_.empty() || !is_modal_) return;
  const RealModes all = real_modes();
  check_changes(all, changed_rows(all));
}

/// Rigid motions are held by a millionth of the least elastic stiffness.
void RingPart::check_changes(const RealModes& all, const Matrix& rows) const {
  constexpr double rounding = 1e-12;     // of the largest square of a frequency, and of a mass
  constexpr double of_stiffness = 1e-6;  // modes of beams have errors of 1e-8
  if (!stays_definite(rows * rows.transpose(), rate() * mass_, rounding))
    throw std::invalid_argument("mistuning and cuts leave a part of the ring without mass");
  const Vector squares = Vector::Map(all.squares.data(), rows.cols());
  const double rigid = rounding * squares.maxCoeff();
  const double elastic =
      squares.unaryExpr([=](double one) { return one > rigid ? one : squares.maxCoeff(); }).minCoeff();
  const Vector held = (squares.array().max(0) + 1e-6 * elastic).inverse();
  if (!stays_definite(rows * held.asDiagonal() * rows.transpose(), stiffness_, -of_stiffness))
    throw std::invalid_argument("mistuning and cuts leave a part of the ring less than no stiffness");
}

/// Squares of the frequencies of the changed whole, and its modes in those of the equal sectors.
RingPart::ChangedModes RingPart::with_changes(const RealModes& all) const {
  constexpr double rounding = 1e-12;  // of the largest square of a frequency
  const Index size = std::ssize(all.squares);
  ChangedModes changed{Vector::Map(all.squares.data(), size), Matrix::Identity(size, size)};
  if (rows_.empty() || size == 0) return changed;
  const Matrix rows = changed_rows(all);
  check_changes(all, rows);
  Matrix stiffness = changed.squares.asDiagonal();
  stiffness.noalias() += rows.transpose() * stiffness_ * rows;
  Matrix mass = changed.shapes;
  mass.noalias() += rate() * (rows.transpose() * mass_ * rows);
  auto modes = pencil(stiffness, mass);
  if (!modes) throw std::invalid_argument("the modes of the ring with mistuning and cuts were not found");
  const double least = rounding * std::max(changed.squares.maxCoeff(), stiffness.diagonal().maxCoeff());
  changed.squares = modes->values.unaryExpr([&](double one) { return one > least ? one : 0; });
  changed.shapes = std::move(modes->vectors);
  return changed;
}

RingPart::Changed RingPart::changed_modes() const {
  const Loss loss = given_.waves.front().loss();
  if (!rows_.empty() && loss.modal != 0)
    throw std::invalid_argument(
        "modal damping is that of equal sectors, whose modes mistuning and cuts couple");
  const RealModes all = given_.turning.empty() ? real_modes() : turning_modes();
  const Index size = std::ssize(all.squares);
  Matrix motion(std::ssize(contacts_), size);
  for (Index k = 0; k < size; ++k) {
    for (Index i = 0; i < motion.rows(); ++i) {
      const auto& [sector, port] = contacts_[static_cast<std::size_t>(i)];
      motion(i, k) = all.motion[static_cast<std::size_t>(k)](place(sector, port));
    }
  }
  const ChangedModes changed = with_changes(all);
  const ComplexMatrix shapes = (motion * changed.shapes).cast<Complex>();
  const ComplexVector load =
      changed.shapes.transpose().cast<Complex>() * ComplexVector::Map(all.load.data(), size);
  std::vector<ContactMode> modes;
  for (Index k = 0; k < size; ++k) modes.push_back({std::sqrt(changed.squares(k)), shapes.col(k), load(k)});
  const auto coupled = [&](const Matrix& by) -> Matrix {
    return by.size() > 0 ? changed.shapes.transpose() * by * changed.shapes : Matrix();
  };
  return {ContactModes(motion.rows(), std::move(modes), loss), coupled(all.gyroscopic),
          coupled(all.stiffness_speed2)};
}

}  // namespace arcslip
