#include <klu.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <stdexcept>

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/linear/row_scale.hpp"
#include "arcslip/continuation/linear/sparse_factors.hpp"

namespace arcslip::continuation {
namespace {

// Of a diagonal entry over the largest of its column, where it is taken as a pivot: a hundredth of that, as
// is the rule, lets entries grow so much that solutions along orbits with multipliers of 1e-30 lose all
// digits. Where they grow even so, as near homoclinic orbits, none but the largest is taken.
constexpr double least_pivot = 0.1;
constexpr double worst_growth = 1e9;  // of entries, of which refinement gives back the digits
constexpr double most_growth = 1e3;   // with old pivots, over that when they were chosen
constexpr double last_weight =
    1e-6;                        // of the largest entry of a row for the end where that of others is 1 to 2
constexpr double most_fill = 2;  // over the least: pivots that fill more were a makeshift, which is not kept

/// Owns what KLU allocates.
class KluFactors final : public SparseFactors {
 public:
  KluFactors(SparseMatrix& pattern, std::vector<int>& order, const std::vector<Index>& last_rows)
      : scaled_(pattern), last_rows_(last_rows), seen_(static_cast<std::size_t>(pattern.rows())) {
    klu_defaults(&common_);
    common_.btf = 0;  // the borders couple everything to one block
    common_.scale = -1;
    symbolic_ = klu_analyze_given(static_cast<int>(pattern.rows()), pattern.outerIndexPtr(),
                                  pattern.innerIndexPtr(), order.data(), order.data(), &common_);
    if (symbolic_ == nullptr) check_memory();
  }
  ~KluFactors() override {
    klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }
  KluFactors(const KluFactors&) = delete;
  KluFactors& operator=(const KluFactors&) = delete;

  double factor(const SparseMatrix& matrix) override {
    if (!find_row_scale(matrix, row_scale_)) return 0;
    for (const Index row : last_rows_) row_scale_(row) *= last_weight;
    const int* const rows = matrix.innerIndexPtr();
    for (Index k = 0; k < matrix.nonZeros(); ++k)
      scaled_.valuePtr()[k] = matrix.valuePtr()[k] * row_scale_(rows[k]);
    if (factor_with_old_pivots()) {
      const double result = sign();
      if (result != 0) return result;
    }
    return factor_with_new_pivots() ? sign() : 0;
  }

  void multiply_determinant(LogProduct& product) const override {
    const auto* pivots = static_cast<const double*>(numeric_->Udiag);
    for (int i = 0; i < numeric_->n; ++i) product *= pivots[i];
    for (const double scale : row_scale_) product /= scale;
  }

  double growth() const override { return growth_; }

  void solve(Vector& x) override {
    x.array() *= row_scale_.array();
    klu_solve(symbolic_, numeric_, numeric_->n, 1, x.data(), &common_);
  }
  void solve_transposed(Vector& x) override {
    klu_tsolve(symbolic_, numeric_, numeric_->n, 1, x.data(), &common_);
    x.array() *= row_scale_.array();
  }

 private:
  void check_memory() const {
    if (common_.status == KLU_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common_.status < 0)
      throw std::length_error("sparse factorisation: more entries than indices can count");
  }

  bool factor_with_new_pivots() {
    return factor_with(least_pivot) && (growth_ <= worst_growth || factor_with(1));
  }

  bool factor_with(double tolerance) {
    common_.tol = tolerance;
    klu_free_numeric(&numeric_, &common_);
    numeric_ =
        klu_factor(scaled_.outerIndexPtr(), scaled_.innerIndexPtr(), scaled_.valuePtr(), symbolic_, &common_);
    check_memory();
    if (numeric_ == nullptr || common_.status != KLU_OK) return false;
    least_fill_ = least_fill_ > 0 ? std::min(least_fill_, fill()) : fill();
    set_growth();
    chosen_growth_ = growth_;
    permutations_sign_ = permutation_sign(numeric_->Pnum, seen_) * permutation_sign(symbolic_->Q, seen_);
    return true;
  }

  bool factor_with_old_pivots() {
    if (numeric_ == nullptr || fill() > most_fill * least_fill_) return false;
    const int done = klu_refactor(scaled_.outerIndexPtr(), scaled_.innerIndexPtr(), scaled_.valuePtr(),
                                  symbolic_, numeric_, &common_);
    if (done == 0 || common_.status != KLU_OK) return false;
    set_growth();
    return growth_ <= std::min(most_growth * chosen_growth_, std::max(worst_growth, chosen_growth_));
  }

  double fill() const { return static_cast<double>(numeric_->lnz) + static_cast<double>(numeric_->unz); }

  void set_growth() {
    klu_rgrowth(scaled_.outerIndexPtr(), scaled_.innerIndexPtr(), scaled_.valuePtr(), symbolic_, numeric_,
                &common_);
    growth_ = 1 / common_.rgrowth;
  }

  double sign() const {
    const auto* pivots = static_cast<const double*>(numeric_->Udiag);
    double sign = permutations_sign_;
    for (int i = 0; i < numeric_->n; ++i) {
      if (pivots[i] == 0 || !std::isfinite(pivots[i])) return 0;
      if (pivots[i] < 0) sign = -sign;
    }
    return sign;
  }

  SparseMatrix scaled_;
  Vector row_scale_;
  std::vector<Index> last_rows_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  double growth_ = 1;
  double chosen_growth_ = 1;
  double least_fill_ = 0;
  double permutations_sign_ = 1;
  std::vector<char> seen_;  // of a permutation
};

}  // namespace

std::unique_ptr<SparseFactors> make_klu_factors(SparseMatrix& pattern, std::vector<int>& order,
                                                const std::vector<Index>& last_rows) {
  return std::make_unique<KluFactors>(pattern, order, last_rows);
}

}  // namespace arcslip::continuation
