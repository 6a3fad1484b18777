#include "arcslip/sectors/sector_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "arcslip/sectors/sector_reduction.hpp"
#include "sectors/full_response.hpp"
#include "sectors/krylov_space.hpp"
#include "sectors/ritz_space.hpp"
#include "sectors/turning_modes.hpp"
#include "sectors/turning_space.hpp"

namespace arcslip {
namespace {

constexpr double worst_error = 1e-6;  // beyond which modes and matrices are not the same sector

/// How far each mode moves under a unit force on each of `contacts` contacts and under the load (columns), as
/// the matrices have it: with what stiffness their rounding gives to free motions.
ComplexMatrix driven(const SectorModes& found, Index contacts, const Loss& loss, double eta) {
  ComplexMatrix drive(static_cast<Index>(found.frequencies.size()), contacts + 1);
  drive << found.shapes.topRows(contacts).adjoint(), found.loads;
  const ComplexVector denominators = modal_denominators(found, loss, eta);
  for (Index k = 0; k < drive.rows(); ++k) drive.row(k) /= denominators(k);
  return drive;
}

/// Motions of contacts and outputs (rows) under these.
ComplexMatrix response(const SectorModes& found, Index contacts, const Loss& loss, double eta) {
  return found.shapes * driven(found, contacts, loss, eta);
}

/// The sizes of what adds up to the motion of a contact under the load, at most.
double free_terms(const SectorModes& found, Index contacts, const Loss& loss, double eta) {
  const Vector drive = driven(found, contacts, loss, eta).col(contacts).cwiseAbs();
  const Vector terms = found.shapes.topRows(contacts).cwiseAbs() * drive;
  return terms.maxCoeff();
}

/// Largest relative difference; off the diagonal of the compliance motions are measured by the largest of
/// their column. That of a single contact under the load is measured by itself, but where the terms of it
/// cancel, as under a wave in which the load moves no contact.
double difference(const ComplexMatrix& motion, const ComplexMatrix& reference, double terms) {
  constexpr double cancelled = 1e-5;
  const Index contacts = reference.cols() - 1;
  double worst = 0;
  for (Index column = 0; column < reference.cols(); ++column) {
    const double size = reference.col(column).cwiseAbs().maxCoeff();
    for (Index row = 0; row < reference.rows(); ++row) {
      const bool is_free = column == contacts;
      const bool own = row == (is_free ? 0 : column) && (contacts == 1 || !is_free);
      double unit = own ? std::abs(reference(row, column)) : size;
      if (is_free) unit = std::max(unit, cancelled * terms);
      const double error = std::abs(motion(row, column) - reference(row, column));
      worst = std::max(worst, unit > 0 ? error / unit : error);
    }
  }
  return worst;
}

/// The ends of the window, the modes in it that respond, and the middles between all of these. What is free
/// to move has no static response.
std::vector<double> places(const SectorModes& modes, const ModesRequest& request) {
  constexpr double slow = 1e-3;
  const bool from_zero = request.eta_low == 0 && !modes.free_squares.empty();
  std::vector<double> etas = {from_zero ? slow * request.eta_high : request.eta_low};
  for (std::size_t k = 0; k < modes.frequencies.size(); ++k) {
    const double frequency = modes.frequencies[k];
    const bool responds = !modes.shapes.col(static_cast<Index>(k)).isZero(0);
    if (responds && frequency > request.eta_low && frequency < request.eta_high) etas.push_back(frequency);
  }
  if (request.eta_high > request.eta_low) etas.push_back(request.eta_high);
  const std::size_t count = etas.size();
  for (std::size_t i = 0; i + 1 < count; ++i) etas.push_back(0.5 * (etas[i] + etas[i + 1]));
  std::sort(etas.begin(), etas.end());
  return etas;
}

double change(const SectorModes& now, const SectorModes& before, Index contacts,
              const ModesRequest& request) {
  double worst = 0;
  for (const double eta : places(now, request)) {
    worst = std::max(worst, difference(response(before, contacts, request.loss, eta),
                                       response(now, contacts, request.loss, eta),
                                       free_terms(now, contacts, request.loss, eta)));
  }
  return worst;
}

/// Whether the response at speeds is asked for.
bool turns(const ModesRequest& request) { return !request.rotations.empty(); }

/// Where a sector that turns resonates in the window.
std::vector<double> turning_resonances(const SectorModes& modes, Index contacts, const ModesRequest& request,
                                       const Rotation& rotation) {
  std::vector<double> etas;
  for (const ContactMode& mode : turning_modes(modes, contacts, rotation).resonances()) {
    if (mode.frequency > request.eta_low && mode.frequency < request.eta_high) etas.push_back(mode.frequency);
  }
  return etas;
}

/// Some eta of the window at which it is looked at: the ends and the middles between resonances, at which no
/// damping counts.
std::vector<double> turning_places(const std::vector<double>& resonances, const ModesRequest& request) {
  constexpr std::size_t most = 9;
  std::vector<double> etas = {std::max(request.eta_low, 1e-3 * request.eta_high)};
  for (std::size_t i = 0; i + 1 < resonances.size(); ++i)
    etas.push_back(0.5 * (resonances[i] + resonances[i + 1]));
  if (request.eta_high > etas.back()) etas.push_back(request.eta_high);
  if (etas.size() <= most) return etas;
  std::vector<double> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(etas[i * (etas.size() - 1) / (most - 1)]);
  return some;
}

/// Contacts and outputs (rows) under contacts and load (columns) of a sector that turns.
ComplexMatrix stacked(const SectorMotions& motions) {
  const Index m = motions.free.size();
  ComplexMatrix all(m + motions.output_free.size(), m + 1);
  all << motions.compliance, motions.free, motions.output_compliance, motions.output_free;
  return all;
}

double change_in_turning(const SectorModes& now, const SectorModes& before, Index contacts,
                         const ModesRequest& request) {
  double worst = 0;
  for (const Rotation& rotation : request.rotations) {
    const std::vector<double> found = turning_resonances(now, contacts, request, rotation);
    const std::vector<double> known = turning_resonances(before, contacts, request, rotation);
    if (found.size() != known.size()) return 1;
    for (std::size_t k = 0; k < found.size(); ++k)
      worst = std::max(worst, std::abs(found[k] - known[k]) / found[k]);
    for (const double eta : turning_places(found, request)) {
      const double speed = rotation.at(eta);
      worst = std::max(worst, difference(stacked(modal_motions(before, contacts, request.loss, eta, speed)),
                                         stacked(modal_motions(now, contacts, request.loss, eta, speed)),
                                         free_terms(now, contacts, request.loss, eta)));
    }
  }
  return worst;
}

SectorModes lanczos_modes(const FiniteSector& sector, const ModesRequest& request, KrylovSpace& krylov,
                          TurningSpace* turning, RitzSpace& space) {
  constexpr double growth = 1.15;            // of the space between two looks at its modes
  constexpr int calm = 2;                    // looks in a row without a change
  constexpr double turning_rounding = 1e-9;  // what turns is solved for in double
  const bool is_turning = turning != nullptr;
  SectorModes modes;
  double next_look = 6;
  for (int unchanged = 0; unchanged < calm;) {
    const ComplexMatrix block = turning ? turning->take(krylov.next()) : krylov.next();
    space.add(block);
    const ComplexMatrix more = turning ? turning->next() : ComplexMatrix(block.rows(), 0);
    space.add(more);
    const bool exhausted = block.cols() + more.cols() == 0;
    if (!exhausted && static_cast<double>(space.size()) < next_look) continue;
    next_look = std::max(growth * static_cast<double>(space.size()), static_cast<double>(space.size()) + 2);
    SectorModes found = space.modes(request);
    const bool same = !modes.frequencies.empty() &&
                      change(found, modes, std::ssize(sector.contacts), request) <= request.tolerance &&
                      (!is_turning || change_in_turning(found, modes, std::ssize(sector.contacts), request) <=
                                          std::max(request.tolerance, turning_rounding));
    unchanged = exhausted ? calm : same ? unchanged + 1 : 0;
    modes = std::move(found);
  }
  modes.factorisations = krylov.factorisations();
  return modes;
}

/// What the modes may differ by: where the entries of K cancel so far that long double leaves no more digits
/// of w_k^2 - w^2, by that.
double allowed(const SectorModes& modes, const ModesRequest& request, const Loss& loss, double rounding,
               double eta) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const double frequency : modes.frequencies)
    nearest = std::min(nearest, std::abs(ModalDenominator(eta, frequency, loss).value));
  return std::max({worst_error, 1e3 * request.tolerance, rounding / nearest});
}

/// Modal damping has no matrix; the structural one of the same loss at each mode takes its place.
Loss with_matrices(Loss loss) {
  loss.structural += loss.modal;
  loss.modal = 0;
  return loss;
}

/// Compares the modes with the full solve at some places, evenly among all. `rounding` is that of eta_k^2.
void compare(const FullResponse& full, const Loss& loss, Index contacts, const ModesRequest& request,
             double rounding, SectorModes& result) {
  std::vector<double> etas = places(result, request);
  const std::size_t most = 4 + result.frequencies.size() / 10;
  if (etas.size() > most) {
    std::vector<double> some;
    for (std::size_t i = 0; i < most; ++i) some.push_back(etas[i * (etas.size() - 1) / (most - 1)]);
    etas = some;
  }
  // Where nothing damps a resonance there is no response to compare.
  std::erase_if(etas, [&](double eta) {
    const double least = modal_denominators(result, loss, eta).cwiseAbs().minCoeff();
    return least <= std::numeric_limits<double>::epsilon() * eta * eta && eta > 0;
  });
  for (const double eta : etas) {
    const double error = difference(response(result, contacts, loss, eta), full.at(eta),
                                    free_terms(result, contacts, loss, eta));
    if (!(error <= allowed(result, request, loss, rounding, eta)))
      throw SectorError(
          fmt::format("the modes differ from the matrices by {:.1e} at eta = {:g}", error, eta));
    if (!(error <= result.error)) {
      result.error = error;
      result.error_eta = eta;
    }
  }
  result.check_etas = std::move(etas);
}

/// Compares the modes with the full solve of the sector as it turns.
void compare_turning(const FullResponse& full, const Loss& loss, Index contacts, const ModesRequest& request,
                     SectorModes& result) {
  for (const Rotation& rotation : request.rotations) {
    for (const double eta :
         turning_places(turning_resonances(result, contacts, request, rotation), request)) {
      const double speed = rotation.at(eta);
      const double error = difference(stacked(modal_motions(result, contacts, loss, eta, speed)),
                                      full.at(eta, speed), free_terms(result, contacts, loss, eta));
      if (!(error <= std::max(worst_error, 1e3 * request.tolerance)))
        throw SectorError(
            fmt::format("the modes differ from the matrices by {:.1e} at eta = {:g} and a speed of {:g}",
                        error, eta, speed));
      if (error <= result.error) continue;
      result.error = error;
      result.error_eta = eta;
    }
  }
}

/// Refuses a load that moves no contact of a structure without symmetry, not even by rounding.
void check_load(const FiniteSector& sector, const SectorModes& modes) {
  constexpr double rounding = 1e-12;
  if (sector.load.isZero(0)) return;
  const ComplexVector& loads = modes.loads;
  for (Index i = 0; i < std::ssize(sector.contacts); ++i) {
    const ComplexVector shape = modes.shapes.row(i).transpose();
    if (shape.cwiseAbs().dot(loads.cwiseAbs()) > rounding * shape.norm() * loads.norm()) return;
  }
  throw SectorError("the load moves no contact: its dof stands still, or the two of a pair move alike");
}

}  // namespace

Complex SectorWave::forward() const {
  if (2 * wave_number % sectors == 0) return wave_number % sectors == 0 ? 1 : -1;
  return std::polar(1.0, -two_pi * static_cast<double>(wave_number) / static_cast<double>(sectors));
}

ModalModel modal_model(const SectorModes& found, double force, const Loss& loss) {
  std::vector<Mode> modes;
  for (std::size_t k = 0; k < found.frequencies.size(); ++k) {
    const Complex shape = found.shapes(0, static_cast<Index>(k));
    modes.push_back(
        {found.frequencies[k], std::norm(shape), shape * (force * found.loads(static_cast<Index>(k)))});
  }
  return {std::move(modes), loss};
}

SectorModes sector_modes(const FiniteSector& sector, const SectorWave& wave, const ModesRequest& request) {
  SectorReduction reduction(sector);
  reduction.set_forward(wave.forward());
  check_mass(sector, reduction);
  const Index dofs = reduction.size();
  const bool is_turning = turns(request) && sector.feels_rotation();
  RitzSpace space(sector, wave, is_turning);
  std::optional<KrylovSpace> krylov;
  SectorModes result;
  if (dofs <= request.all_modes) {
    space.add(ComplexMatrix::Identity(dofs, dofs));
    result = space.modes(request);
  } else {
    krylov.emplace(space.sector(), reduction, request);
    std::optional<TurningSpace> turning;
    if (is_turning) turning.emplace(space.sector(), reduction, request);
    result = lanczos_modes(sector, request, *krylov, turning ? &*turning : nullptr, space);
  }
  result.dofs = dofs;
  if (!sector.has_boundaries()) check_load(sector, result);
  if (!request.compared) return result;
  constexpr auto digits = static_cast<double>(std::numeric_limits<ExtendedSector::Real>::epsilon());
  const Loss loss = with_matrices(request.loss);
  const FullResponse full(space, krylov ? &*krylov : nullptr, reduction, result, loss);
  const Index contacts = std::ssize(sector.contacts);
  compare(full, loss, contacts, request, digits * largest_square(reduction) / (two_pi * two_pi), result);
  if (is_turning) compare_turning(full, loss, contacts, request, result);
  return result;
}

}  // namespace arcslip
