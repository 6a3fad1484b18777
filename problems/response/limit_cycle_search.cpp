#include "arcslip/problems/response/limit_cycle_search.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <iterator>
#include <optional>

#include "arcslip/elements/contact.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::problems {
namespace {

/// -1/(k c) over eta at one zeta_B.
class Search {
 public:
  Search(const FrictionSystem& system, double zeta) : system_(system), zeta_(zeta), places_(places()) {}

  std::vector<CycleAtZeta> run() const {
    std::vector<CycleAtZeta> found;
    const std::vector<double> ends = ends_of_stretches();
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const double middle = z(0.5 * (ends[i] + ends[i + 1])).real();
      if (middle > 0 && middle < 1) search(ends[i], ends[i + 1], found);
    }
    return found;
  }

 private:
  Complex compliance(double eta) const { return base(eta).value + system_.damper.at(eta).compliance; }

  DampedCompliance base(double eta) const {
    return system_.base.compliance(eta, zeta_, system_.base_loss_per_zeta, system_.base_loss_fixed);
  }

  Complex z(double eta) const { return -1.0 / (system_.contact_stiffness * compliance(eta)); }

  /// Places between which Re z may turn: ever denser towards the resonances, and evenly in ln eta beyond.
  std::vector<double> places() const {
    std::vector<double> marks;
    for (const double w : joined_frequencies({&system_.base, &system_.damper}, system_.contact_stiffness))
      marks.push_back(w);
    for (const ModalModel* part : {&system_.base, &system_.damper}) {
      for (const Mode& mode : part->modes())
        marks.push_back(std::sqrt(mode.influence.square(mode.frequency)));
    }
    std::erase_if(marks, [](double w) { return !(w > 0); });
    std::vector<double> etas;
    if (marks.empty()) return etas;
    const auto [low, high] = std::minmax_element(marks.begin(), marks.end());
    constexpr double beyond = 10;
    constexpr double ratio = 1.005;
    for (double eta = *low / beyond; eta < *high * beyond; eta *= ratio) etas.push_back(eta);
    for (const double w : marks) {
      for (double distance = 1e-15; distance < 0.5; distance *= 1.25) {
        etas.push_back(w * (1 - distance));
        etas.push_back(w * (1 + distance));
      }
    }
    std::sort(etas.begin(), etas.end());
    return etas;
  }

  /// Where Re z is 0 or 1.
  std::vector<double> ends_of_stretches() const {
    std::vector<double> ends;
    for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
      for (const double level : {0.0, 1.0}) {
        const auto away = [&](double eta) { return z(eta).real() - level; };
        const double from = away(places_[i]);
        const double to = away(places_[i + 1]);
        if ((from < 0) == (to < 0)) continue;
        const double eta = zero_between(away, places_[i], places_[i + 1], from, to, 52);
        if (std::abs(away(eta)) < std::abs(from) + std::abs(to)) ends.push_back(eta);  // no pole
      }
    }
    std::sort(ends.begin(), ends.end());
    return ends;
  }

  /// Im phi where Re phi is this.
  static double on_arc(double real) {
    constexpr double largest = 60;  // R/S = 1e26
    const auto away = [&](double t) { return slip_coefficient(t).phi.real() - real; };
    if (!(real < 1)) return 0;
    return slip_coefficient(zero_between(away, 0, largest, away(0), away(largest))).phi.imag();
  }

  /// Along a stretch, ever denser towards its ends: there the small and the large cycles are.
  void search(double from, double to, std::vector<CycleAtZeta>& found) const {
    const auto above = [&](double eta) {
      const Complex at = z(eta);
      return at.imag() - (at.real() > 0 ? on_arc(at.real()) : 0);
    };
    std::vector<double> etas{from, to};
    for (double share = 0.5; share > 1e-16; share *= 0.8) {
      etas.push_back(from + share * (to - from));
      etas.push_back(to - share * (to - from));
    }
    std::copy_if(places_.begin(), places_.end(), std::back_inserter(etas),
                 [&](double eta) { return eta > from && eta < to; });
    std::sort(etas.begin(), etas.end());
    std::vector<double> heights;
    for (const double eta : etas) heights.push_back(above(eta));
    heights.front() = z(from).imag();  // the arc's ends are real
    heights.back() = z(to).imag();
    for (std::size_t i = 0; i + 1 < etas.size(); ++i) {
      cross(above, etas[i], etas[i + 1], heights[i], heights[i + 1], found);
      if (i > 0) touch(above, &etas[i - 1], &heights[i - 1], found);
    }
  }

  template <class Function>
  void cross(const Function& above, double a, double b, double at_a, double at_b,
             std::vector<CycleAtZeta>& found) const {
    if ((at_a < 0) == (at_b < 0)) return;
    if (const auto cycle = solve(zero_between(above, a, b, at_a, at_b, 52))) found.push_back(*cycle);
  }

  /// Two cycles between three places, the middle one of which is nearest to the arc.
  template <class Function>
  void touch(const Function& above, const double* etas, const double* heights,
             std::vector<CycleAtZeta>& found) const {
    const double side = heights[1] < 0 ? -1 : 1;
    if (!(side * heights[1] < side * heights[0] && side * heights[1] < side * heights[2])) return;
    std::uintmax_t iterations = 40;
    const auto [eta, height] = boost::math::tools::brent_find_minima(
        [&](double x) { return side * above(x); }, etas[0], etas[2], 26, iterations);
    if (height >= 0) return;
    cross(above, etas[0], eta, heights[0], side * height, found);
    cross(above, eta, etas[2], side * height, heights[2], found);
  }

  /// Newton's method from a place next to the arc; of the two x of its Im phi the nearer one.
  std::optional<CycleAtZeta> solve(double eta) const {
    const Complex near = z(eta);
    const double root = std::sqrt(std::max(0.0, 1 - pi * near.imag()));
    const double small = 0.5 * pi * near.imag() / (1 + root);
    const auto away = [&](double x) { return std::abs(slip_coefficient(-std::log(x)).phi - near); };
    if (!(small > 0)) return std::nullopt;
    double t = -std::log(away(small) < away(1 - small) ? small : 1 - small);
    const double k = system_.contact_stiffness;
    for (int iteration = 0; iteration < 50; ++iteration) {
      const DampedCompliance at_base = base(eta);
      const ContactResponse damper = system_.damper.at(eta);
      const HarmonicCoefficient law = slip_coefficient(t);
      const Complex c = at_base.value + damper.compliance;
      const Complex value = k * law.phi + 1.0 / c;
      const Complex by_eta = -(at_base.by_eta + damper.compliance_eta) / (c * c);
      const Complex by_t = k * law.phi_log;
      const double determinant = std::imag(std::conj(by_eta) * by_t);
      const double eta_step = -std::imag(std::conj(value) * by_t) / determinant;
      const double t_step = -std::imag(std::conj(by_eta) * value) / determinant;
      eta += eta_step;
      t += t_step;
      if (!(eta > 0 && t > 0)) return std::nullopt;
      if (std::abs(eta_step) > 1e-12 * eta || std::abs(t_step) > 1e-9) continue;
      const Complex by_zeta = -at_base.by_zeta / (c * c);
      const double zeta_by_t = -std::imag(std::conj(by_eta) * by_t) / std::imag(std::conj(by_eta) * by_zeta);
      return CycleAtZeta{eta, t, zeta_by_t < 0};
    }
    return std::nullopt;
  }

  const FrictionSystem& system_;
  double zeta_;
  std::vector<double> places_;
};

}  // namespace

std::vector<CycleAtZeta> cycles_at(const FrictionSystem& system, double zeta) {
  return Search(system, zeta).run();
}

}  // namespace arcslip::problems
