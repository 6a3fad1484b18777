#include "arcslip/continuation/points/centre_manifold.hpp"

#include <cmath>
#include <functional>
#include <random>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/linear/complex_sparse_factors.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

/// [z - A, B; C^H, 0], factored, dense or sparse; A transposed where that is asked for.
class ShiftedMatrix {
 public:
  ShiftedMatrix(const Linearization& at, Complex z, const ComplexMatrix& columns, const ComplexMatrix& rows,
                bool transposed = false) {
    const Index n = at.residual().size();
    const Index whole = n + columns.cols();
    if (!at.sparse()) {
      ComplexMatrix matrix = ComplexMatrix::Zero(whole, whole);
      matrix.topLeftCorner(n, n) =
          -(transposed ? Matrix(at.jacobian().transpose()) : at.jacobian()).cast<Complex>();
      matrix.topLeftCorner(n, n).diagonal().array() += z;
      matrix.topRightCorner(n, columns.cols()) = columns;
      matrix.bottomLeftCorner(columns.cols(), n) = rows.adjoint();
      solver_ = solver_of(matrix);
      return;
    }
    std::vector<Eigen::Triplet<Complex>> entries;
    const SparseMatrix& jacobian = at.sparse_jacobian();
    for (Index column = 0; column < n; ++column) {
      const auto place = static_cast<int>(column);
      for (SparseMatrix::InnerIterator entry(jacobian, column); entry; ++entry) {
        const auto row = static_cast<int>(entry.row());
        entries.emplace_back(transposed ? place : row, transposed ? row : place, -entry.value());
      }
      entries.emplace_back(place, place, z);
      for (Index k = 0; k < columns.cols(); ++k) {
        entries.emplace_back(place, static_cast<int>(n + k), columns(column, k));
        entries.emplace_back(static_cast<int>(n + k), place, std::conj(rows(column, k)));
      }
    }
    ComplexSparse matrix(whole, whole);
    matrix.setFromTriplets(entries.begin(), entries.end());
    solver_ = [factors = ComplexSparseFactors(matrix)](const ComplexVector& right) {
      return factors.solve(right);
    };
  }

  ComplexVector solve(const ComplexVector& right) const { return solver_(right); }

 private:
  std::function<ComplexMatrix(const ComplexMatrix& right)> solver_;
};

/// All exponents of this order of so many variables.
std::vector<Exponents> exponents_of(int order, std::size_t variables) {
  std::vector<Exponents> all;
  Exponents one{};
  const std::function<void(std::size_t, int)> fill = [&](std::size_t variable, int rest) {
    if (variable + 1 == variables) {
      one[variable] = rest;
      all.push_back(one);
      return;
    }
    for (int power = 0; power <= rest; ++power) {
      one[variable] = power;
      fill(variable + 1, rest - power);
    }
  };
  fill(0, order);
  return all;
}

int order_of(const Exponents& a) { return a[0] + a[1] + a[2] + a[3]; }

Exponents sum(Exponents a, const Exponents& b, std::size_t without) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  --a[without];
  return a;
}

Complex power(const std::vector<Complex>& w, const Exponents& a) {
  Complex value = 1;
  for (std::size_t i = 0; i < w.size(); ++i) {
    for (int k = 0; k < a[i]; ++k) value *= w[i];
  }
  return value;
}

/// As many directions in the space of the variables as suffice for all monomials, spread over it.
std::vector<std::vector<Complex>> directions(std::size_t count, const std::vector<std::size_t>& conjugates) {
  std::mt19937 numbers;  // the same wherever
  const auto next = [&] { return 2 * static_cast<double>(numbers()) / std::mt19937::max() - 1; };
  std::vector<std::vector<Complex>> all(2 * count, std::vector<Complex>(conjugates.size()));
  for (std::vector<Complex>& one : all) {
    double square = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
      if (conjugates[i] == i) one[i] = next();
      if (conjugates[i] > i) one[i] = Complex(next(), next());
      if (conjugates[i] < i) one[i] = std::conj(one[conjugates[i]]);
      square += std::norm(one[i]);
    }
    for (Complex& value : one) value /= std::sqrt(square);
  }
  return all;
}

}  // namespace

CentreManifold::CentreManifold(const Problem& problem, const Guess& point) : point_(point), at_(problem) {}

std::optional<CentreManifold> CentreManifold::at(const Problem& problem, const Guess& point, bool has_zero,
                                                 const std::vector<double>& omegas) {
  CentreManifold found(problem, point);
  if (!found.at_.evaluate(point.unknowns, point.parameters, point.regime)) return std::nullopt;
  if (has_zero && !found.add_mode(0, {0, 0})) return std::nullopt;
  for (std::size_t k = 0; k < omegas.size(); ++k) {
    found.rates_[k] = omegas[k];
    std::array<int, 2> multiples{};
    multiples[k] = 1;
    if (!found.add_mode({0, omegas[k]}, multiples)) return std::nullopt;
  }
  return found;
}

/// By inverse iteration next to the eigenvalue.
bool CentreManifold::add_mode(Complex value, std::array<int, 2> multiples) {
  const Index n = at_.residual().size();
  constexpr double beside = 1e-9;
  const double size = at_.sparse() ? at_.sparse_jacobian().norm() : at_.jacobian().norm();
  const Complex shift = value + beside * (size > 0 ? size : 1);
  ComplexVector found[2];
  for (const bool transposed : {false, true}) {
    const ComplexMatrix none(n, 0);
    const ShiftedMatrix matrix(at_, transposed ? std::conj(shift) : shift, none, none, transposed);
    ComplexVector& x = found[transposed ? 1 : 0];
    x = ComplexVector::LinSpaced(n, Complex(1, 0.3), Complex(0.4, 1));
    for (int i = 0; i < 4; ++i) x = matrix.solve(x).normalized();
    if (!x.allFinite()) return false;
  }
  const bool is_real = multiples == std::array<int, 2>{};
  if (is_real) {
    for (ComplexVector& x : found) x = (x / largest_entry(x)).real().normalized().cast<Complex>().eval();
  }
  found[1] /= std::conj(found[1].dot(found[0]));
  if (!found[1].allFinite()) return false;
  modes_.push_back({multiples, found[0], found[1]});
  conjugates_.push_back(modes_.size() - 1);
  if (is_real) return true;
  for (int& one : multiples) one = -one;
  modes_.push_back({multiples, found[0].conjugate(), found[1].conjugate()});
  conjugates_.back() = modes_.size() - 1;
  conjugates_.push_back(modes_.size() - 2);
  return true;
}

std::array<int, 2> CentreManifold::multiples_of(const Exponents& a) const {
  std::array<int, 2> result{};
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) result[k] += a[i] * modes_[i].multiples[k];
  }
  return result;
}

Exponents CentreManifold::conjugate(const Exponents& a) const {
  Exponents result{};
  for (std::size_t i = 0; i < conjugates_.size(); ++i) result[conjugates_[i]] = a[i];
  return result;
}

Complex CentreManifold::coefficient(std::size_t variable, const Exponents& a) const {
  const auto found = g_.find(a);
  return found == g_.end() ? 0 : found->second(static_cast<Index>(variable));
}

bool CentreManifold::reduce(Expansion& expansion, int order) {
  h_.clear();
  g_.clear();
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    Exponents one{};
    one[i] = 1;
    h_[one] = modes_[i].right;
  }
  for (int k = 2; k <= order; ++k) {
    const std::vector<Exponents> all = exponents_of(k, modes_.size());
    Terms terms;
    if (!read(expansion, k, all, terms)) return false;
    subtract_lower(k, terms);
    for (const Exponents& a : all) {
      if (h_.count(a) == 0 && !solve(a, terms[a], k == order)) return false;
    }
  }
  return true;
}

/// The terms of F(u* + sum h_a w^a) of this order, from those along lines in the space of w.
bool CentreManifold::read(Expansion& expansion, int order, const std::vector<Exponents>& all, Terms& terms) {
  const Index n = point_.unknowns.size();
  const auto lines = directions(all.size(), conjugates_);
  ComplexMatrix powers(std::ssize(lines), std::ssize(all));
  ComplexMatrix values(std::ssize(lines), n);
  Matrix out;
  for (std::size_t j = 0; j < lines.size(); ++j) {
    const auto row = static_cast<Index>(j);
    Matrix u = Matrix::Zero(n, order + 1);
    u.col(0) = point_.unknowns;
    for (const auto& [a, h] : h_) u.col(order_of(a)) += (power(lines[j], a) * h).real();
    if (!expansion.along(u, point_.parameters, point_.regime, out)) return false;
    values.row(row) = out.col(order).transpose().cast<Complex>();
    for (std::size_t i = 0; i < all.size(); ++i) powers(row, static_cast<Index>(i)) = power(lines[j], all[i]);
  }
  const ComplexMatrix found = shortest(powers, values);
  for (std::size_t i = 0; i < all.size(); ++i) terms[all[i]] = found.row(static_cast<Index>(i)).transpose();
  return true;
}

/// What products of lower orders of h and g have in u'.
void CentreManifold::subtract_lower(int order, Terms& terms) const {
  for (const auto& [a, h] : h_) {
    for (const auto& [b, g] : g_) {
      if (order_of(a) < 2 || order_of(a) + order_of(b) != order + 1) continue;
      for (std::size_t i = 0; i < modes_.size(); ++i) {
        if (a[i] > 0) terms[sum(a, b, i)] -= static_cast<double>(a[i]) * g(static_cast<Index>(i)) * h;
      }
    }
  }
}

bool CentreManifold::solve(const Exponents& a, const ComplexVector& right, bool is_last) {
  const Index n = right.size();
  const std::array<int, 2> multiples = multiples_of(a);
  std::vector<std::size_t> matching;
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    if (modes_[i].multiples == multiples) matching.push_back(i);
  }
  if (is_last && matching.empty()) return true;
  ComplexMatrix columns(n, std::ssize(matching));
  ComplexMatrix rows(n, std::ssize(matching));
  for (std::size_t k = 0; k < matching.size(); ++k) {
    columns.col(static_cast<Index>(k)) = modes_[matching[k]].right;
    rows.col(static_cast<Index>(k)) = modes_[matching[k]].left;
  }
  const Complex value(0, multiples[0] * rates_[0] + multiples[1] * rates_[1]);
  ComplexVector whole = ComplexVector::Zero(n + columns.cols());
  whole.head(n) = right;
  whole = ShiftedMatrix(at_, value, columns, rows).solve(whole);
  if (!whole.allFinite()) return false;
  h_[a] = whole.head(n);
  h_[conjugate(a)] = whole.head(n).conjugate();
  if (matching.empty()) return true;
  ComplexVector g = ComplexVector::Zero(std::ssize(modes_));
  for (std::size_t k = 0; k < matching.size(); ++k)
    g(static_cast<Index>(matching[k])) = whole(n + static_cast<Index>(k));
  ComplexVector turned(g.size());
  for (std::size_t i = 0; i < modes_.size(); ++i)
    turned(static_cast<Index>(conjugates_[i])) = std::conj(g(static_cast<Index>(i)));
  g_[a] = g;
  g_[conjugate(a)] = turned;
  return true;
}

}  // namespace arcslip::continuation
