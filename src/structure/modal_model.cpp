#include "arcslip/structure/modal_model.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "arcslip/structure/sector.hpp"

namespace arcslip {
namespace {

Complex rounded(const PreciseComplex& z) {
  return {static_cast<double>(z.real()), static_cast<double>(z.imag())};
}

PreciseReal squared(const PreciseComplex& z) { return z.real() * z.real() + z.imag() * z.imag(); }

/// By Newton's method, which doubles the digits of a double twice: the library's, digit by digit, takes
/// twenty times as long.
PreciseReal square_root(const PreciseReal& x) {
  const double near = std::sqrt(static_cast<double>(x));
  if (!(near > 1e-150 && near < 1e150)) return sqrt(x);  // out of a double's range, or 0
  PreciseReal y = near;
  for (int i = 0; i < 2; ++i) y = (y + x / y) / 2;
  return y;
}

/// The modes of K v = lambda M v with v^H M v = 1: shapes of unit mass, turned two at a time until the
/// stiffness joins no two of them (Jacobi 1846). One turn is exact for two dofs. Without Eigen's products and
/// solvers, which would take most of a minute to compile in fifty digits, for structures of one or two dofs.
class PreciseModes {
 public:
  /// Throws std::invalid_argument where the mass is not positive definite.
  explicit PreciseModes(const ReducedStructure& structure)
      : structure_(structure), dofs_(structure.mass.rows()), shapes_(dofs_, dofs_) {
    for (Index k = 0; k < dofs_; ++k) find_shape(k);
    PreciseReal largest = 0;
    for (Index k = 0; k < dofs_; ++k) largest += abs(eigenvalue(k));
    for (bool turned = true; turned;) {
      turned = false;
      for (Index p = 0; p < dofs_; ++p) {
        for (Index q = p + 1; q < dofs_; ++q) turned = turn(p, q, largest) || turned;
      }
    }
  }

  PreciseReal eigenvalue(Index k) const { return between(k, structure_.stiffness, k).real(); }

  /// sqrt(lambda_k)/(2 pi), rounded; 0 of what rounding leaves below.
  double frequency(Index k) const {
    const PreciseReal value = eigenvalue(k);
    return value > 0 ? static_cast<double>(
                           PreciseReal(square_root(value) / boost::math::constants::two_pi<PreciseReal>()))
                     : 0;
  }

  const PreciseComplex& at(Index dof, Index k) const { return shapes_(dof, k); }

  /// v_k^H F
  PreciseComplex by_load(Index k) const {
    PreciseComplex sum = 0;
    for (Index i = 0; i < dofs_; ++i) sum += conj(shapes_(i, k)) * structure_.load(i);
    return sum;
  }

  /// Which mode is first, second ... by frequency.
  std::vector<Index> ascending() const {
    std::vector<Index> order(static_cast<std::size_t>(dofs_));
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return eigenvalue(a) < eigenvalue(b); });
    return order;
  }

 private:
  /// v_p^H A v_q
  PreciseComplex between(Index p, const PreciseComplexMatrix& matrix, Index q) const {
    PreciseComplex sum = 0;
    for (Index column = 0; column < dofs_; ++column) {
      PreciseComplex part = 0;
      for (Index row = 0; row < dofs_; ++row) part += conj(shapes_(row, p)) * matrix(row, column);
      sum += part * shapes_(column, q);
    }
    return sum;
  }

  /// Dof k less its part in the shapes before, which it has no mass in common with then.
  void find_shape(Index k) {
    for (Index i = 0; i < dofs_; ++i) shapes_(i, k) = i == k ? 1 : 0;
    for (Index p = 0; p < k; ++p) {
      const PreciseComplex part = between(p, structure_.mass, k);
      for (Index i = 0; i < dofs_; ++i) shapes_(i, k) -= part * shapes_(i, p);
    }
    const PreciseReal mass = between(k, structure_.mass, k).real();
    if (!(mass > 0))
      throw std::invalid_argument("ModalModel: the mass matrix of the structure must be positive definite");
    for (Index i = 0; i < dofs_; ++i) shapes_(i, k) /= PreciseComplex(square_root(mass));
  }

  /// False where the stiffness joins the two by no more than 1e-45 of the largest eigenvalue: above what
  /// fifty digits leave of nothing, and of no effect on frequencies and shapes rounded to sixteen.
  bool turn(Index p, Index q, const PreciseReal& largest) {
    const PreciseComplex joint = between(p, structure_.stiffness, q);
    const PreciseReal modulus = square_root(squared(joint));
    if (!(modulus > 1e-45 * largest)) return false;
    const PreciseReal cotangent = (eigenvalue(q) - eigenvalue(p)) / (2 * modulus);  // of twice the angle
    const PreciseReal root = square_root(1 + cotangent * cotangent);
    const PreciseReal tangent = cotangent < 0 ? 1 / (cotangent - root) : 1 / (cotangent + root);
    const PreciseReal cosine = 1 / square_root(1 + tangent * tangent);
    const PreciseComplex sine = joint / PreciseComplex(modulus) * PreciseComplex(tangent * cosine);
    for (Index i = 0; i < dofs_; ++i) {
      const PreciseComplex before = shapes_(i, p);
      shapes_(i, p) = PreciseComplex(cosine) * before - conj(sine) * shapes_(i, q);
      shapes_(i, q) = sine * before + PreciseComplex(cosine) * shapes_(i, q);
    }
    return true;
  }

  const ReducedStructure& structure_;
  Index dofs_;
  PreciseComplexMatrix shapes_;
};

}  // namespace

std::vector<SeenMode> seen_modes(const ReducedStructure& structure, const PreciseComplexMatrix& rows) {
  const PreciseModes modes(structure);
  const PreciseReal& turn = boost::math::constants::two_pi<PreciseReal>();
  std::vector<SeenMode> all;
  for (const Index k : modes.ascending()) {
    SeenMode mode{modes.frequency(k), ComplexVector(rows.rows()),
                  rounded(modes.by_load(k) / PreciseComplex(turn))};
    for (Index i = 0; i < rows.rows(); ++i) {
      PreciseComplex sum = 0;
      for (Index dof = 0; dof < rows.cols(); ++dof) sum += rows(i, dof) * modes.at(dof, k);
      mode.shape(i) = rounded(sum / PreciseComplex(turn));
    }
    all.push_back(std::move(mode));
  }
  return all;
}

ModalModel::ModalModel(const ReducedStructure& structure, Index contact_dof, const Loss& loss) : loss_(loss) {
  const PreciseModes modes(structure);
  const PreciseReal& turn = boost::math::constants::two_pi<PreciseReal>();
  for (const Index k : modes.ascending()) {
    const PreciseComplex at_contact = modes.at(contact_dof, k) / PreciseComplex(turn);
    const PreciseComplex by_load = modes.by_load(k) / PreciseComplex(turn);
    modes_.push_back(
        {modes.frequency(k), static_cast<double>(squared(at_contact)), rounded(at_contact * by_load)});
  }
}

ModalModel ModalModel::turned(const Complex& turn) const {
  ModalModel other = *this;
  for (Mode& mode : other.modes_) mode.load_residue *= turn;
  return other;
}

ModalModel ModalModel::unyielding() const {
  ModalModel model = *this;
  for (Mode& mode : model.modes_) mode.residue = 0;
  return model;
}

ContactResponse ModalModel::at(double eta) const {
  ContactResponse response{};
  for (const Mode& mode : modes_) {
    const ModalDenominator d(eta, mode.frequency, loss_, mode.influence);
    const Complex inverse = std::conj(d.value) / std::norm(d.value);
    const Complex slope = -inverse * inverse * d.by_eta;
    response.compliance += mode.residue * inverse;
    response.compliance_eta += mode.residue * slope;
    response.free += mode.load_residue * inverse;
    response.free_eta += mode.load_residue * slope;
  }
  return response;
}

ContactCurvature ModalModel::curvature(double eta) const {
  ContactCurvature curvature{};
  for (const Mode& mode : modes_) {
    const ModalDenominator d(eta, mode.frequency, loss_, mode.influence);
    const Complex inverse = std::conj(d.value) / std::norm(d.value);
    const Complex bend = 2.0 * inverse * inverse * (inverse * d.by_eta * d.by_eta + 1.0);  // d2d/deta2 = -2
    curvature.compliance += mode.residue * bend;
    curvature.free += mode.load_residue * bend;
  }
  return curvature;
}

DampedCompliance ModalModel::compliance(double eta, double zeta, const Loss& per_zeta,
                                        const Loss& fixed) const {
  DampedCompliance compliance{};
  const Loss loss = fixed + zeta * per_zeta;
  for (const Mode& mode : modes_) {
    const ModalDenominator d(eta, mode.frequency, loss, mode.influence);
    const Complex inverse = std::conj(d.value) / std::norm(d.value);
    const Complex slope = -mode.residue * inverse * inverse;  // dc/dd
    compliance.value += mode.residue * inverse;
    compliance.by_eta += slope * d.by_eta;
    compliance.by_zeta += slope * Complex(0, per_zeta.part(eta, mode.frequency));
  }
  return compliance;
}

std::vector<double> joined_frequencies(const std::vector<const ModalModel*>& models, double k) {
  struct Pole {
    double square;
    double residue;
  };
  std::vector<Pole> poles;
  for (const ModalModel* model : models) {
    for (const Mode& mode : model->modes()) {
      if (k * mode.residue > 0) poles.push_back({mode.influence.square(mode.frequency), k * mode.residue});
    }
  }
  std::sort(poles.begin(), poles.end(), [](const Pole& a, const Pole& b) { return a.square < b.square; });

  double total = 0;
  for (const Pole& pole : poles) total += pole.residue;
  std::vector<double> roots;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    // 1 + sum a/(p - x) rises from -inf to +inf between two poles, and beyond the last one from -inf to 1.
    // With x = p_i + t its nearest pole is exact in t.
    const double base = poles[i].square;
    const double width = i + 1 < poles.size() ? poles[i + 1].square - base : 2 * total;
    if (!(width > 4e-16 * base)) {
      roots.push_back(std::sqrt(base));
      continue;
    }
    const auto secular = [&](double t) {
      double sum = 1;
      for (const Pole& pole : poles) sum += pole.residue / ((pole.square - base) - t);
      return sum;
    };
    double low = 1e-3 * width;
    double high = i + 1 < poles.size() ? width - low : width;
    while (low > 0 && secular(low) > 0) low *= 1e-3;
    while (high < width && secular(high) < 0) high = width - 1e-3 * (width - high);
    if (!(low > 0 && high > low) || secular(high) < 0) {  // the root is within rounding of a pole
      roots.push_back(std::sqrt(low > 0 ? base + width : base));
      continue;
    }
    std::uintmax_t iterations = 200;
    const auto bracket = boost::math::tools::toms748_solve(
        secular, low, high, boost::math::tools::eps_tolerance<double>(50), iterations);
    roots.push_back(std::sqrt(base + 0.5 * (bracket.first + bracket.second)));
  }
  return roots;
}

}  // namespace arcslip
