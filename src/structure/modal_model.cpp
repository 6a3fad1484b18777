#include "arcslip/structure/modal_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <stdexcept>

#include "arcslip/structure/sector.hpp"

namespace arcslip {
namespace {

Complex rounded(const PreciseComplex& z) {
  return {static_cast<double>(z.real()), static_cast<double>(z.imag())};
}

}  // namespace

ModalModel::ModalModel(const ReducedStructure& structure, Index contact_dof, const Loss& loss) : loss_(loss) {
  if (structure.mass.llt().info() != Eigen::Success) {
    throw std::invalid_argument("ModalModel: the mass matrix of the structure must be positive definite");
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<PreciseComplexMatrix> solver(structure.stiffness,
                                                                              structure.mass);
  const PreciseReal& turn = boost::math::constants::two_pi<PreciseReal>();
  for (Index k = 0; k < structure.load.size(); ++k) {
    const PreciseComplexVector shape = solver.eigenvectors().col(k);
    const PreciseComplex at_contact = shape(contact_dof) / turn;
    const PreciseComplex by_load = shape.dot(structure.load) / turn;  // v^H F
    const PreciseReal eigenvalue = solver.eigenvalues()(k);
    const PreciseReal frequency = eigenvalue > 0 ? PreciseReal(sqrt(eigenvalue) / turn) : PreciseReal(0);
    const PreciseReal residue = at_contact.real() * at_contact.real() + at_contact.imag() * at_contact.imag();
    modes_.push_back(
        {static_cast<double>(frequency), static_cast<double>(residue), rounded(at_contact * by_load)});
  }
}

ModalModel ModalModel::unyielding() const {
  ModalModel model = *this;
  for (Mode& mode : model.modes_) mode.residue = 0;
  return model;
}

ContactResponse ModalModel::at(double eta) const {
  ContactResponse response{};
  for (const Mode& mode : modes_) {
    const ModalDenominator d(eta, mode.frequency, loss_);
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
    const ModalDenominator d(eta, mode.frequency, loss_);
    const Complex inverse = 1.0 / d.value;
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
    const ModalDenominator d(eta, mode.frequency, loss);
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
      if (k * mode.residue > 0) poles.push_back({mode.frequency * mode.frequency, k * mode.residue});
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
