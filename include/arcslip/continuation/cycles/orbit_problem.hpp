#pragma once

// Orbits of u' = f(t, u, p) over a duration T, by collocation: with s = t/T and a mesh s_0 = 0 .. s_N = 1,
//
//   sum_k D_ik u_jk - h_j T f(s_ji T, sum_k L_ik u_jk, p) = 0      at the points i = 1 .. m of interval
//   j n conditions on both ends
//
// with the values u_jk at the nodes of a polynomial of degree m on each interval as unknowns, those at the
// ends of intervals but once. What T is, and what holds at the ends, is for those who derive from this.
//
// Errors are O(h^(m+1)), at the ends of intervals O(h^(2m)) with Gauss's points and O(h^(2m-1)) with Radau's,
// as those of T and of parameters are. Trigonometric polynomials on a single interval are met at their nodes
// in place of these points; there errors fall faster than any power of 1/H.
//
// A mesh belongs to an orbit. Along a branch there are several, each a frame: the regime of a point is the
// number of its frame.

#include <memory>
#include <vector>

#include "arcslip/continuation/cycles/field.hpp"
#include "arcslip/continuation/cycles/orbit_mesh.hpp"

namespace arcslip::continuation {

/// Values g of conditions on both ends of an orbit, as many as the field has unknowns, and their derivatives;
/// those that are null are not wanted.
struct EndConditions {
  Vector* values;         ///< n
  Matrix* by_left;        ///< n x n
  Matrix* by_right;       ///< n x n
  Matrix* by_parameters;  ///< n x number of parameters
};

/// Of a field's orbits: sparse ones are large since they discretise what is stiff, and have Radau's points.
CollocationRule rule_for(const Field& field, int degree);

/// What is fixed while a stretch of a branch is traced.
struct OrbitFrame {
  OrbitMesh mesh;
  Vector scale;     ///< n, of the unknowns of the field
  Vector in_units;  ///< its inverse
  Vector ends;      ///< n, of the conditions at the ends: how far these change as unknowns do by their scale
  Vector range;     ///< n, how far these go along the orbit
  Vector phase;  ///< n x nodes: weights of the condition that keeps the orbit from sliding along itself; or
                 ///< empty
  double phase_value = 0;  ///< that of the condition for the frame's own orbit
  OrbitPlaces points;      ///< the Gauss points, m N
  OrbitPlaces opposite;    ///< those half of the way ahead of these
  Matrix apart;           ///< n x m N, what keeps the orbit apart from simpler ones; empty where nothing does
  double size_apart = 0;  ///< of that, the root of its mean square
};

/// What the errors of an orbit are relative to on a mesh that was made for another one: the range of that,
/// but where this goes a thousand times as far.
Vector range_on(const OrbitFrame& frame, const Eigen::Ref<const Matrix>& orbit);

/// Abstract: see `CycleProblem`. Unknowns: n x nodes of a mesh, node by node, then T if it is one. Equations:
/// the conditions at the ends, those at the Gauss points, then that on the phase. Of sparse
/// fields the conditions at the ends must be u(T) - u(0) = w, with a constant w, as those of cycles are.
class OrbitProblem : public Problem {
 public:
  const Field& field() const { return *field_; }
  std::shared_ptr<const Field> shared_field() const { return field_; }

  /// N, m, what OrbitMesh::resolution tells, and whether T is an unknown.
  Index intervals() const { return frames_.front()->mesh.intervals(); }
  Index resolution() const { return frames_.front()->mesh.resolution(); }
  bool is_trigonometric() const { return frames_.front()->mesh.rule().waves() > 0; }
  Index degree() const { return frames_.front()->mesh.rule().degree(); }
  bool has_duration() const { return has_duration_; }

  /// That of a point, and the regime of a further one, of as many intervals, for orbits like this one: values
  /// at the nodes of `mesh`. Not while others read.
  const OrbitFrame& frame(const Regime& regime) const;
  Regime add_frame(const OrbitMesh& mesh, const Matrix& orbit, const Vector& p) const;
  /// The last one that was added.
  Regime last_frame() const;

  /// The values at the nodes, n x nodes, of a vector of unknowns.
  auto orbit(const Vector& u) const { return Eigen::Map<const Matrix>(u.data(), field_->size(), nodes()); }

  /// T, and its derivatives by the parameters where that is not null.
  double duration(const Vector& u, const Vector& p, Vector* by_parameters = nullptr) const;

  /// When the nodes are reached, 0 to T.
  virtual Vector times(const Vector& u, const Vector& p, const Regime& regime) const;

  /// What these are times of, and how many of the field's unknowns, from the first on, are told: the others
  /// are there for conditions.
  virtual std::string time_name() const { return "t"; }
  virtual Index told() const { return field_->size(); }

  /// What is told of an orbit at these times: names, and values of as many unknowns x times.
  virtual std::vector<std::string> told_names() const;
  virtual Matrix told_orbit(const Vector& u) const { return orbit(u).topRows(told()); }

  /// ln(mu) of the Floquet multipliers; empty where there are none.
  virtual ComplexVector log_multipliers(const Vector& /*u*/, const Vector& /*p*/,
                                        const Regime& /*regime*/) const {
    return {};
  }

  /// The same for another orbit, at parameters p.
  virtual std::shared_ptr<OrbitProblem> about(const OrbitMesh& mesh, const Matrix& orbit,
                                              const Vector& p) const = 0;

  /// What an orbit comes to at which `apart` vanishes, as the end of a sentence.
  virtual std::string end_of_kind(const Vector& /*u*/, const Regime& /*regime*/) const { return {}; }

  /// Largest estimated error of an orbit, relative to how far its unknowns go.
  double mesh_error(const Vector& u, const Regime& regime) const;

  /// The least speed on its way, relative to that which goes as far as the unknowns go in the time: the
  /// largest of their entries.
  double least_speed(const Vector& u, const Vector& p, const Regime& regime) const;

  /// Whether its orbits may be at rest and tell nothing of the shape in which branches leave them: these are
  /// held on the mesh as well, and two branch points in one step are looked for.
  virtual bool may_rest() const { return false; }

  /// How nearly the condition on the phase is one on the orbit's own phase: 1 for that of the frame, 0 where
  /// it tells nothing.
  double phase_grip(const Vector& u, const Regime& regime) const;

  /// How much there is of what keeps an orbit apart from those of a simpler kind, over the most that there
  /// was: 0 where it is one of these, below 0 where it is more opposite than alike to that of the frame; 1
  /// where nothing does.
  double apart(const Vector& u, const Regime& regime) const;
  /// The rounding of the unknowns, relative to that part.
  double rounding_apart(const Vector& u, const Regime& regime) const;

  /// Takes an orbit that is nearly of a simpler kind into account for the most that there was, as those of
  /// frames are, and tells how nearly that part is alike to that of the frame: 1 for this, 0 where the sign
  /// of `apart` tells nothing. Not while others read.
  double note_apart(const Vector& u, const Regime& regime) const;

  /// du(s_(j+1))/du(s_j) of each interval, n x n, by the Jacobian at an orbit of a field that is not sparse.
  std::vector<Matrix> transfers(const FactoredJacobian& jacobian) const;

  Index size() const override { return field_->size() * nodes() + (has_duration_ ? 1 : 0); }
  std::vector<std::string> parameter_names() const override { return field_->parameter_names(); }
  bool sparse() const override { return !is_trigonometric(); }
  Determinants determinants() const override {
    return field_->sparse() ? Determinants::over_rows : Determinants::in_own_units;
  }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                              const Evaluation& out) const override;
  [[nodiscard]] bool second(const Vector& u, const Vector& p, const Regime& regime, const Vector& w,
                            const Vector& du, const Vector& dp, Vector& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;
  Index switch_count() const override { return frame_digits; }
  std::string describe(const Regime& regime) const override;

 protected:
  /// `begin` is to follow.
  OrbitProblem(std::shared_ptr<const Field> field, bool has_duration);

  /// Begins with a frame for this orbit.
  void begin(const OrbitMesh& mesh, const Matrix& orbit, const Vector& p);

  [[nodiscard]] virtual bool end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                            const EndConditions& out) const = 0;

  /// That part of an orbit, at the Gauss points of a frame (n x m N), which keeps it apart from orbits of a
  /// simpler kind; empty where it does not matter.
  virtual Matrix part_apart(const OrbitFrame& frame, const Eigen::Ref<const Matrix>& orbit) const = 0;

  /// T where it is no unknown.
  virtual double given_duration(const Vector& p, Vector* by_parameters) const = 0;

  Index nodes() const { return intervals() * degree() + 1; }

  /// The logarithm of what a volume of u grows by along an orbit, by the Jacobian there: T times the mean of
  /// the trace of df/du [J. Liouville, J. Math. Pures Appl. 3 (1838) 342].
  double growth_of_volumes(const OrbitFrame& frame, const SparseMatrix& jacobian) const;

  /// Whether what keeps an orbit apart is little beside how far its unknowns go: not where these come to
  /// rest.
  bool is_nearly_simpler(const Vector& u, const Regime& regime) const;

 private:
  struct Scratch;
  /// Of what keeps an orbit apart.
  struct Apart {
    std::shared_ptr<const OrbitFrame> frame;
    Vector unknowns;
    double size = 0;
    double along = 0;  // how much of it is that of the frame
  };
  static constexpr Index frame_digits = 4;
  static constexpr Index fours = 4;

  const std::shared_ptr<const OrbitFrame>& shared_frame(const Regime& regime) const;
  /// Found once where it is asked for again.
  const Apart& apart_at(const Vector& u, const Regime& regime) const;
  Vector end_scale(const OrbitFrame& frame, const Matrix& orbit, const Vector& p) const;
  /// How many of the conditions one unknown at an end enters.
  Index end_entries() const { return field_->sparse() ? 1 : field_->size(); }
  void build_block(const Matrix& orbit, const Vector& p);
  void build_weights(const CollocationRule& rule);
  void build_pattern();
  void find_places(const OrbitFrame& frame, const Vector& u, double duration, Index first,
                   Scratch& scratch) const;
  [[nodiscard]] bool at_points(const OrbitFrame& frame, const Vector& u, const Vector& p, double duration,
                               Index first, bool derivatives, Scratch& scratch) const;
  [[nodiscard]] bool at_sparse_points(const Vector& p, bool derivatives, Scratch& scratch) const;
  void change_with_parameters(double duration, const Vector& p, Scratch& scratch) const;
  void fill_interval(const OrbitFrame& frame, double duration, Index interval, Index from, Scratch& scratch,
                     const Evaluation& out) const;
  void fill_blocks(const OrbitFrame& frame, double factor, Index interval, Index from, Scratch& scratch,
                   SparseMatrix& out) const;
  bool is_left_of_intervals(const RowsLeft& left) const;
  void take_interval(const SparseMatrix& jacobian, Index interval, Index lane, BlocksSideBySide& out) const;
  [[nodiscard]] bool fill_conditions(const OrbitFrame& frame, const Vector& u, const Vector& p,
                                     const Evaluation& out) const;

  std::shared_ptr<const Field> field_;
  bool has_duration_;
  mutable std::vector<std::shared_ptr<const OrbitFrame>> frames_;  // further ones change none that is there
  SparseMatrix block_;                                             // df/du and the diagonal, n x n
  std::vector<Index> diagonal_;  // where that is in each column of the block
  std::vector<int> places_;      // of the entries of a sparse df/du among those of the block
  Matrix padded_values_;         // the rule's, with rows of zeros that make these a multiple of four,
  Matrix padded_slopes_;         // and its derivatives
  Matrix weights_;               // of the blocks of an interval's points, see fill_blocks, at each node
  SparseMatrix pattern_;
  mutable double most_apart_ = 0;  // what kept any of the orbits apart
};

}  // namespace arcslip::continuation
