#pragma once

// The quantities of a point of a harmonic problem, with their gradients.

#include <algorithm>
#include <cmath>

#include "arcslip/problems/response/contact_problem.hpp"
#include "arcslip/problems/response/harmonic_problem.hpp"

namespace arcslip::problems {

/// What is known of one point, with the gradient of what is asked of it.
class HarmonicProblem::Observation {
 public:
  Observation(const HarmonicProblem& problem, const Vector& u, const Vector& p,
              const continuation::Regime& regime, continuation::Gradient* gradient)
      : problem_(problem),
        system_(problem.system_),
        u_(u),
        p_(p),
        regime_(regime),
        gradient_(gradient),
        elements_(problem.forces(u, p, regime, gradient != nullptr)),
        work_(last_forces()) {}

  /// A quantity; its gradient is added.
  double value(const Quantity& quantity) {
    switch (quantity.measure) {
      case Measure::frequency: return plain(problem_.layout_.eta);
      case Measure::damping: return plain(problem_.layout_.damping);
      case Measure::threshold: return threshold(quantity.which, 1);
      case Measure::ratio: return ratio(quantity.which);
      case Measure::amplitude: return amplitude(quantity, 1);
      case Measure::mean: return mean(quantity);
      case Measure::lag: return lag_of(quantity);
      case Measure::drift: return drift(quantity.which);
      case Measure::dissipated: return dissipated(quantity.which);
      case Measure::energy: return energy(quantity.which);
      case Measure::greatest: return greatest(quantity.of, quantity.which);
      case Measure::force: return problem_.synthesised_force(u_, p_, regime_);
      case Measure::reading: return reading(quantity.which, quantity.order);
      case Measure::largest: return largest(quantity);
      case Measure::amplification: return largest(quantity) / *system_.equal_peak;
      case Measure::least: return of_sectors(quantity).cwiseAbs().minCoeff();
      case Measure::wave: return of_wave(quantity);
      case Measure::slipping: return slipping();
      case Measure::losses: return losses();
    }
    return 0;
  }

 private:
  double plain(const Place& place) {
    add(place, 1);
    return problem_.value(place, u_, p_);
  }

  /// S of a contact, with so much of its gradient.
  double threshold(Index contact, double part) {
    const double S = problem_.slip_threshold(contact, u_, p_);
    add_log_load(part * S, contact);
    return S;
  }

  double ratio(Index contact) {
    const double R = std::abs(phasor(Body::contact, contact, 0));
    const double S = problem_.slip_threshold(contact, u_, p_);
    if (gradient_ != nullptr) {
      amplitude({"", Measure::amplitude, Body::contact, contact, 0}, 1 / S);
      threshold(contact, -R / (S * S));
    }
    return R / S;
  }

  /// Of what is zero but for rounding the gradient is zero, the mean of those all around.
  double amplitude(const Quantity& quantity, double part) {
    constexpr double rounding = 1e-15;
    const Complex z = phasor(quantity.of, quantity.which, quantity.order);
    const double size = std::abs(z);
    if (gradient_ != nullptr && size > rounding * usual_size(quantity))
      add(quantity.of, quantity.which, quantity.order, part / size * z);
    return size;
  }

  // Of whole rings, in harmonic_observation_ring.cpp.
  double largest(const Quantity& quantity);
  Index in_sector(Body of) const;
  const ComplexVector& of_sectors(const Quantity& quantity);
  double of_wave(const Quantity& quantity);
  double slipping() const;
  double losses() const;

  /// What rounding of a motion is measured by: of an output by the parts that it is the
  /// sum of in the first harmonic.
  double usual_size(const Quantity& quantity) {
    if (quantity.of != Body::output) return u_.norm();
    const Row row = row_of(quantity.of, quantity.which, 0);
    const auto parts = row.response.compliance.row(row.index).head(row.forces.size());
    return std::abs(row.response.free(row.index)) +
           parts.transpose().cwiseProduct(row.forces).cwiseAbs().sum();
  }

  double mean(const Quantity& quantity) {
    add(quantity.of, quantity.which, quantity.order, 1);
    return phasor(quantity.of, quantity.which, quantity.order).real();
  }

  /// v of a coordinate that drifts, x = v theta + ...; 0 of others.
  double drift_of(Index coordinate) {
    for (const Drift* one : problem_.drifting(regime_)) {
      if (problem_.coordinates_.first(one->element) == coordinate)
        return problem_.motion(u_, p_, coordinate)(problem_.rigid_.order()).imag();
    }
    return 0;
  }

  double drift(Index coordinate) {
    const double v = drift_of(coordinate);
    if (v != 0) add_motion(coordinate, problem_.rigid_.order(), Complex(0, 1.0 / system_.periods()));
    return v / system_.periods();
  }

  double lag_of(const Quantity& quantity) {
    const Complex z = phasor(quantity.of, quantity.which, quantity.order);
    if (z != 0.0) add(quantity.of, quantity.which, quantity.order, Complex(0, -1) / std::conj(z));
    return lag(z);
  }

  /// E/(k S^2) of a contact, E = pi sum_h h Im(f_h conj(x_h)), since x has no other harmonics, in each of the
  /// load's periods.
  double dissipated(Index contact) {
    const double S = problem_.slip_threshold(contact, u_, p_);
    const double unit = system_.periods() * problem_.reference_stiffness(contact, u_, p_) * S * S;
    const ElementForce& element = elements_[at(contact)];
    if (gradient_ != nullptr) {
      const HarmonicVector x = problem_.motion(u_, p_, contact);
      for (Index a = 0; a < problem_.harmonics(); ++a) {
        const Complex per = Complex(0, pi * system_.orders[at(a)] / unit);
        add_force(contact, a, per * x(a));
        add_motion(contact, a, -per * element.harmonics(a));
      }
      add_drift_energy(contact, 1 / unit);
      threshold(contact, -2 * element.energy / (unit * S));
      add_log_force(contact, -element.energy / unit);
    }
    return element.energy / unit;
  }

  /// E = pi sum_h h Im(f_h conj(x_h)) of an element, over all its coordinates, in each of the load's periods.
  double energy(Index of) {
    const ElementForce& element = elements_[at(of)];
    const double part = 1.0 / system_.periods();
    const Index begin = problem_.coordinates_.first(of);
    const Index end = begin + problem_.coordinates_.element(of).coordinates();
    for (Index j = begin; j < end && gradient_ != nullptr; ++j) {
      const HarmonicVector x = problem_.motion(u_, p_, j);
      for (Index a = 0; a < problem_.harmonics(); ++a) {
        const Complex per = Complex(0, part * pi * system_.orders[at(a)]);
        add_force(j, a, per * x(a));
        add_motion(j, a, -per * element.harmonics(problem_.place(j, a)));
      }
    }
    if (gradient_ != nullptr) add_drift_energy(begin, part);
    return part * element.energy;
  }

  /// Adds so much of the energy of a drift, 2 pi v f_0.
  void add_drift_energy(Index coordinate, double part) {
    const double v = drift_of(coordinate);
    if (v == 0) return;
    const Index mean = problem_.rigid_.order();
    const Index of = problem_.coordinates_.element_of(coordinate);
    const double f = elements_[at(of)].harmonics(problem_.place(coordinate, mean)).real();
    add_force(coordinate, mean, part * two_pi * v);
    add_motion(coordinate, mean, Complex(0, part * two_pi * f));
  }

  /// Found together with the others of its element, which follow one another.
  double reading(Index of, Index which) {
    if (read_ != of) {
      told_ = problem_.with_element(of, u_, p_, [&](const Element& element) {
        return element.read(system_.orders, problem_.element_motion(u_, p_, of), problem_.load(of, u_, p_),
                            slips(regime_, of), gradient_ != nullptr);
      });
    }
    read_ = of;
    MotionNumber told = told_[at(which)];
    if (problem_.coordinates_.element(of).readings()[at(which)].is_force) {
      const double factor = problem_.force_factor(of, u_, p_);
      told = {factor * told.value, factor * told.by_motion, factor * told.by_log_load,
              factor * told.by_setting};
      if (gradient_ != nullptr) add_log_force(of, told.value);
    }
    if (gradient_ != nullptr) problem_.add(told, of, u_, p_, *gradient_);
    return told.value;
  }

  /// The greatest value in time, which changes as the value at its own time.
  double greatest(Body of, Index which) {
    HarmonicVector motion(problem_.harmonics());
    for (Index a = 0; a < motion.size(); ++a) motion(a) = phasor(of, which, a);
    const Farthest peak = farthest_of(system_.orders, motion);
    for (Index a = 0; a < motion.size() && gradient_ != nullptr; ++a) add(of, which, a, peak.by(a));
    return peak.value;
  }

  /// One harmonic of a motion: of the base y = u - x.
  Complex phasor(Body of, Index which, Index order) {
    if (of == Body::contact) return problem_.motion(u_, p_, which)(order);
    const Row row = row_of(of, which, order);
    Complex z = row.times(row.response.compliance);
    if (of == Body::output) z += row.response.free(row.index);
    if (of == Body::base) z -= problem_.motion(u_, p_, which)(order);
    if (is_rigid(order)) z += (row.rigid.transpose() * moved_).value();
    return z;
  }

  /// Whether rigid motions are part of a harmonic.
  bool is_rigid(Index order) const { return problem_.rigid_.count() > 0 && problem_.rigid_.order() == order; }

  /// Adds what they add to the same.
  void add_rigid(const ComplexVector& rigid, Index order, Complex weight) {
    const ComplexVector by_force = rest_.joint.compliance.transpose() * rigid;
    for (Index i = 0; i < rigid.size(); ++i) {
      add_motion(i, order, std::real(rigid(i) * std::conj(weight)));
      add_force(i, order, std::conj(by_force(i)) * weight);
    }
    if (!problem_.is_varied()) return;
    ContactVector force(rigid.size());
    for (Index i = 0; i < rigid.size(); ++i)
      force(i) = elements_[at(problem_.coordinates_.element_of(i))].harmonics(problem_.place(i, order));
    const ContactVector by_varied = rest_.by_varied * force + rest_.free_by_varied;
    add(problem_.layout_.varied, std::real(std::conj(weight) * (rigid.transpose() * by_varied).value()));
  }

  /// Adds Re(conj(weight) dz) of that harmonic.
  void add(Body of, Index which, Index order, Complex weight) {
    if (gradient_ == nullptr) return;
    if (of == Body::contact) return add_motion(which, order, weight);
    if (of == Body::base) add_motion(which, order, -weight);
    const Row row = row_of(of, which, order);
    if (is_rigid(order)) add_rigid(row.rigid, order, weight);
    Complex by_eta = row.times(row.response.compliance_eta);
    if (of == Body::output) by_eta += row.response.free_eta(row.index);
    add(problem_.layout_.eta, std::real(std::conj(weight) * by_eta));
    if (problem_.layout_.damping.of != Place::nowhere)
      add(problem_.layout_.damping, std::real(std::conj(weight) * row.times(row.response.by_damping)));
    if (problem_.is_varied()) {
      Complex by_varied = row.times(row.response.by_varied);
      if (of == Body::output) by_varied += row.response.free_by_varied(row.index);
      add(problem_.layout_.varied, std::real(std::conj(weight) * by_varied));
    }
    for (Index j = 0; j < problem_.coordinates(); ++j) {
      const double share = problem_.coordinates_[j].push(row.is_base);
      if (share == 0) continue;
      const Complex c = row.response.compliance(row.index, problem_.coordinates_[j].dof);
      add_force(j, order, -share * std::conj(c) * weight);
    }
  }

  void add_motion(Index coordinate, Index order, Complex weight) {
    if (gradient_ == nullptr) return;
    const Index place = 2 * (coordinate * problem_.harmonics() + order);
    add(problem_.place_of(place), weight.real());
    add(problem_.place_of(place + 1), weight.imag());
  }

  void add_force(Index coordinate, Index order, Complex weight) {
    const Index of = problem_.coordinates_.element_of(coordinate);
    const Index first = problem_.coordinates_.first(of);
    const Index row = problem_.place(coordinate, order);
    const ElementForce& element = elements_[at(of)];
    const Complex w = std::conj(weight);
    for (Index b = 0; b < element.linear.cols(); ++b) {
      const Complex linear = w * element.linear(row, b);
      const Complex conjugate = w * element.conjugate(row, b);
      add_motion(first + b / problem_.harmonics(), b % problem_.harmonics(),
                 {std::real(linear + conjugate), -std::imag(linear - conjugate)});
    }
    add_log_load(std::real(w * element.by_log_load(row)), of);
    add_log_force(of, std::real(w * element.harmonics(row)));
    if (element.by_eta.size() > 0) add(problem_.layout_.eta, std::real(w * element.by_eta(row)));
    if (element.by_setting.size() > 0) add(problem_.layout_.varied, std::real(w * element.by_setting(row)));
  }

  /// What is `value` times a change of the logarithm of the factor on a force.
  void add_log_force(Index element, double value) {
    if (!problem_.is_varied()) return;
    add(problem_.layout_.varied, value * problem_.log_force_rate(element, problem_.variation(u_, p_)));
  }

  void add_log_load(double value, Index element) {
    if (gradient_ != nullptr) problem_.add_log_load(value, element, u_, p_, *gradient_);
  }
  void add(const Place& place, double value) {
    if (gradient_ != nullptr) HarmonicProblem::add(place, value, *gradient_);
  }

  /// The row of a structure's compliance that a motion of damper or output is, found once for quantities that
  /// follow one another, and the forces on it.
  struct Row {
    const Response& response;
    bool is_base;
    Index index;
    const ContactVector& forces;
    ComplexVector rigid;  // of the harmonic that has rigid motions, what each coordinate tells of them

    Complex times(const ContactMatrix& compliance) const {
      return (compliance.row(index).head(forces.size()) * forces).value();
    }
  };
  Row row_of(Body of, Index which, Index order) {
    const Index outputs = std::max<Index>(1, std::ssize(system_.outputs));
    const ContactOutput* output = of == Body::output ? &system_.output(which % outputs, order) : nullptr;
    const ContactModes* structure = output != nullptr ? &output->modes : &system_.damper[at(order)];
    const bool is_base = output != nullptr && output->on_base;
    if (structure != responded_) problem_.respond(*structure, is_base, order, u_, p_, work_.response);
    responded_ = structure;
    problem_.coordinates_.forces_on(is_base, elements_, order, work_.on_structure);
    const Index index = output != nullptr ? problem_.contacts() + which / outputs : which;
    Row row{work_.response, is_base, index, work_.on_structure, {}};
    if (!is_rigid(order)) return row;
    const RigidMotions& rigid = problem_.rigid_;
    row.rigid = rigid.parts().transpose() * rigid.at(*structure, is_base, index);
    if (moved_.size() == 0) {
      problem_.respond_at_rest(u_, p_, rest_);
      moved_ = problem_.moved_at_rest(rest_, elements_, u_, p_);
    }
    return row;
  }

  const HarmonicProblem& problem_;
  const HarmonicSystem& system_;
  const Vector& u_;
  const Vector& p_;
  continuation::Regime regime_;
  continuation::Gradient* gradient_;
  const std::vector<ElementForce>& elements_;
  Forces& work_;
  const ContactModes* responded_ = nullptr;
  Rest rest_;                        // found once it is asked for
  ContactVector moved_;              // of the coordinates, by rigid motions
  const Quantity* known_ = nullptr;  // whose motion of all sectors is known
  ComplexVector sectors_;
  Index read_ = -1;  // the element whose readings are known
  std::vector<MotionNumber> told_;
};

}  // namespace arcslip::problems
