#include "results/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "arcslip/assembly/resonances.hpp"
#include "arcslip/assembly/structures.hpp"
#include "arcslip/problems/response/balanced_points.hpp"
#include "results/atomic_file.hpp"
#include "results/output_folder.hpp"

namespace arcslip {
namespace {

using Place = std::array<double, 3>;

constexpr Index most_points = 5'000'000;

const SectorPair* pair_of(const SystemParameters& system) {
  return dynamic_cast<const SectorPair*>(system.structures.get());
}

/// About the z axis.
template <class Value>
std::array<Value, 3> turned(const std::array<Value, 3>& vector, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * vector[0] - s * vector[1], s * vector[0] + c * vector[1], vector[2]};
}

double apart(const Place& a, const Place& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

}  // namespace

std::string why_no_shapes(const SystemParameters& system) {
  if (structures_of(system).whole() != nullptr) return "those of whole rings are not written";
  if (feels_rotation(system)) return "those of sectors that turn are not written";
  const SectorPair* pair = pair_of(system);
  if (pair == nullptr) return "rods, beams and masses on springs have none";
  if (pair->base().places.empty()) return "system.base has no `coordinates`";
  if (pair->damper() != nullptr && pair->damper()->places.empty())
    return "system.damper has no `coordinates`";
  return "";
}

std::string why_no_shapes(const CaseBranch& branch) {
  const ProblemRequest& problem = branch.problem;
  if (problem.model != nullptr) return "models of equations have none";
  if (branch.curve) return "curves have none";
  if (!problem.response->in_time) return "those of a " + problem.response->title + " are not written";
  return why_no_shapes(problem.system);
}

RingShapes::RingShapes(const SystemParameters& system) : system_(system) {
  if (const std::string why = why_no_shapes(system); !why.empty())
    throw std::invalid_argument("shapes are of dofs whose places are known: " + why);
  const SectorPair& pair = *pair_of(system);
  const auto all_told = [](SectorPart part) {
    part.sector.outputs.resize(part.places.size());
    std::iota(part.sector.outputs.begin(), part.sector.outputs.end(), Index{0});
    return part;
  };
  constexpr double tolerance = 1e-6;  // of pictures
  std::optional<SectorPart> damper;
  if (pair.damper() != nullptr) damper = all_told(*pair.damper());
  add_part(pair.base(), 0);
  if (damper) add_part(*damper, 1);
  const auto all_fit = [&](double sense) {
    return fits(pair.base().sector, parts_[0], sense) && (!damper || fits(damper->sector, parts_[1], sense));
  };
  turn_ = all_fit(1) ? 1 : -1;
  if (!all_fit(turn_))
    throw std::invalid_argument(
        fmt::format("the coordinates of `right` are not those of `left` turned by 360/{} degrees about z, or "
                    "base and damper are turned in opposite senses",
                    system.elements));
  system_.structures = std::make_shared<const SectorPair>(all_told(pair.base()), std::move(damper),
                                                          std::max(tolerance, pair.tolerance()), pair.path());
  system_.tells_lag = false;
  const auto points = static_cast<Index>(parts_[0].points.size() + parts_[1].points.size());
  if (points > most_points / system.elements)
    throw std::invalid_argument(
        fmt::format("shapes of {} sectors with {} points each are more than {} points", system.elements,
                    points, most_points));
}

void RingShapes::add_part(const SectorPart& part, std::size_t which) {
  Part& own = parts_[which];
  own.places = part.places;
  own.dofs = std::ssize(own.places);
  std::map<Place, Index> known;
  for (const DofPlace& place : own.places) {
    const auto [at, is_new] = known.try_emplace(place.at, std::ssize(own.points));
    if (is_new) own.points.push_back(place.at);
    own.point_of.push_back(at->second);
  }
}

/// Whether the right boundary is the left one of the next sector, which follows in this sense about z.
bool RingShapes::fits(const FiniteSector& sector, const Part& part, double sense) const {
  constexpr double close = 1e-3;
  const double angle = sense * two_pi / static_cast<double>(system_.elements);
  double size = 0;
  for (const Place& point : part.points) size = std::max(size, std::hypot(point[0], point[1], point[2]));
  for (std::size_t i = 0; i < sector.left.size(); ++i) {
    const DofPlace& left = part.places[static_cast<std::size_t>(sector.left[i])];
    const DofPlace& right = part.places[static_cast<std::size_t>(sector.right[i])];
    const double error = std::max(apart(turned(left.at, angle), right.at) / size,
                                  apart(turned(left.direction, angle), right.direction));
    if (!(error < close)) return false;
  }
  return true;
}

std::vector<ShapeFile> RingShapes::modes() const {
  const ContactSystem wave = build_wave(system_);
  const Index contacts = wave.base.contacts();
  const auto shape_of = [&](std::size_t part, const ContactModes& structure,
                            const ComplexVector& amplitudes) {
    ComplexVector motion = ComplexVector::Zero(parts_[part].dofs);
    const std::size_t first = part == 0 ? 0 : static_cast<std::size_t>(parts_[0].dofs);
    for (Index dof = 0; dof < motion.size(); ++dof) {
      const auto& modes = wave.outputs[first + static_cast<std::size_t>(dof)].modes.modes();
      for (std::size_t k = 0; k < structure.modes().size(); ++k)
        motion(dof) += modes[k].shape(contacts) * amplitudes(static_cast<Index>(k));
    }
    return motion;
  };
  std::vector<ShapeFile> files;
  std::map<std::string, int> numbers;
  const auto add = [&](const std::string& name, double eta, std::array<ComplexVector, 2> motion) {
    if (system_.eta_high > 0 && eta > system_.eta_high) return;
    const double size = std::max(motion[0].size() > 0 ? motion[0].cwiseAbs().maxCoeff() : 0,
                                 motion[1].size() > 0 ? motion[1].cwiseAbs().maxCoeff() : 0);
    for (ComplexVector& one : motion) one /= size > 0 ? size : 1;
    files.push_back({fmt::format("n{}_{}_{}.vtu", system_.wave_number, name, ++numbers[name]),
                     text({{"mode", 1, std::move(motion)}})});
  };
  const auto alone = [&](std::size_t part, const char* name, const ContactModes& structure) {
    const Index count = std::ssize(structure.modes());
    for (Index k = 0; k < count; ++k) {
      std::array<ComplexVector, 2> motion;
      motion[part] = shape_of(part, structure, ComplexVector::Unit(count, k));
      add(name, structure.modes()[static_cast<std::size_t>(k)].frequency, std::move(motion));
    }
  };
  alone(0, "base", wave.base);
  alone(1, "damper", wave.damper);
  for (const JoinedMode& mode : joined_modes({&wave.base, &wave.damper}, contact_springs(wave.contacts))) {
    const Index of_base = std::ssize(wave.base.modes());
    std::array<ComplexVector, 2> motion;
    motion[0] = shape_of(0, wave.base, mode.motion.head(of_base));
    if (parts_[1].dofs > 0)
      motion[1] = shape_of(1, wave.damper, mode.motion.tail(mode.motion.size() - of_base));
    add("stuck", mode.frequency, std::move(motion));
  }
  return files;
}

std::vector<ShapeFile> RingShapes::responses(std::size_t number, const TracedBranch& traced) const {
  const problems::BalancedPoints points(traced.request->problem.system, traced.base.harmonics, traced.branch);
  const std::vector<int>& orders = points.problem().system().orders;
  std::vector<ContactSystem> waves;  // of each harmonic
  std::vector<ShapeFile> files;
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const continuation::BranchPoint& point = traced.branch.points[i];
    if (point.type == continuation::PointType::regular) continue;
    if (waves.empty() || !system_.varied.empty()) waves = waves_at(orders, point.parameters);
    files.push_back({fmt::format("branch_{}_point_{}.vtu", number, i),
                     text(response(waves, points.problem(), points.at(point)))});
  }
  return files;
}

/// Those of the harmonics, at the value of what varies beside eta and the preload.
std::vector<ContactSystem> RingShapes::waves_at(const std::vector<int>& orders,
                                                const Vector& parameters) const {
  const SystemParameters system =
      system_.varied.empty()
          ? system_
          : with_parameter(system_, system_.varied, parameters(problems::HarmonicResponse::further));
  std::vector<ContactSystem> waves;
  for (const int h : orders) waves.push_back(build_order(system, h));
  return waves;
}

std::vector<RingShapes::Shape> RingShapes::response(const std::vector<ContactSystem>& waves,
                                                    const problems::HarmonicResponse& problem,
                                                    const continuation::Guess& at) const {
  const auto forces = problem.element_forces(at.unknowns, at.parameters, at.regime);
  const double eta = at.parameters(problems::HarmonicResponse::eta);
  std::vector<Shape> shapes;
  for (std::size_t a = 0; a < waves.size(); ++a) {
    const HarmonicSystem& system = problem.system();
    Shape& shape = shapes.emplace_back(
        Shape{fmt::format("harmonic_{}", system.name(static_cast<Index>(a))), system.orders[a], {}});
    auto output = waves[a].outputs.begin();
    for (const std::size_t part : {std::size_t{0}, std::size_t{1}}) {
      shape.motion[part].resize(parts_[part].dofs);
      for (Complex& motion : shape.motion[part])
        motion = (output++)->motion(system.multiple(static_cast<Index>(a)) * eta,
                                    (part == 0 ? forces.base : forces.damper)[a]);
    }
  }
  return shapes;
}

/// The points of the parts that the shapes concern, sector by sector.
std::string RingShapes::points(const std::vector<Shape>& shapes) const {
  std::string text;
  for (const std::size_t part : {std::size_t{0}, std::size_t{1}}) {
    if (shapes.front().motion[part].size() == 0) continue;
    for (Index sector = 0; sector < system_.elements; ++sector) {
      const double angle =
          turn_ * two_pi * static_cast<double>(sector) / static_cast<double>(system_.elements);
      for (const Place& point : parts_[part].points) {
        const Place at = turned(point, angle);
        fmt::format_to(std::back_inserter(text), "{:.10g} {:.10g} {:.10g}\n", at[0], at[1], at[2]);
      }
    }
  }
  return text;
}

/// Real and imaginary part of the displacement at these points: sector i repeats the first one i a h later.
std::string RingShapes::vectors(const Shape& shape) const {
  std::array<std::string, 2> text;
  for (const std::size_t part : {std::size_t{0}, std::size_t{1}}) {
    const ComplexVector& motion = shape.motion[part];
    if (motion.size() == 0) continue;
    std::vector<std::array<Complex, 3>> moves(parts_[part].points.size());
    for (Index dof = 0; dof < motion.size(); ++dof) {
      const auto i = static_cast<std::size_t>(dof);
      for (std::size_t axis = 0; axis < 3; ++axis)
        moves[static_cast<std::size_t>(parts_[part].point_of[i])][axis] +=
            parts_[part].places[i].direction[axis] * motion(dof);
    }
    for (Index sector = 0; sector < system_.elements; ++sector) {
      const double angle = two_pi * static_cast<double>(sector) / static_cast<double>(system_.elements);
      const Index waves = shape.order * system_.first_wave() % system_.elements;
      const Complex lag = std::polar(1.0, -angle * static_cast<double>(waves));
      for (const auto& move : moves) {
        const auto at = turned(move, turn_ * angle);
        const std::array<Complex, 3> value{lag * at[0], lag * at[1], lag * at[2]};
        fmt::format_to(std::back_inserter(text[0]), "{:.10g} {:.10g} {:.10g}\n", value[0].real(),
                       value[1].real(), value[2].real());
        fmt::format_to(std::back_inserter(text[1]), "{:.10g} {:.10g} {:.10g}\n", value[0].imag(),
                       value[1].imag(), value[2].imag());
      }
    }
  }
  std::string arrays;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    arrays += fmt::format(
        "<DataArray type=\"Float64\" Name=\"{}_{}\" NumberOfComponents=\"3\" "
        "format=\"ascii\">\n{}</DataArray>\n",
        shape.name, side == 0 ? "real" : "imaginary", text[side]);
  }
  return arrays;
}

std::string RingShapes::text(const std::vector<Shape>& shapes) const {
  std::string part_numbers;
  Index count = 0;
  for (const std::size_t part : {std::size_t{0}, std::size_t{1}}) {
    if (shapes.front().motion[part].size() == 0) continue;
    const Index own = std::ssize(parts_[part].points) * system_.elements;
    for (Index i = 0; i < own; ++i) part_numbers += part == 0 ? "0\n" : "1\n";
    count += own;
  }
  std::string numbers;
  std::string ends;
  std::string types;
  for (Index i = 0; i < count; ++i) {
    fmt::format_to(std::back_inserter(numbers), "{}\n", i);
    fmt::format_to(std::back_inserter(ends), "{}\n", i + 1);
    types += "1\n";  // VTK_VERTEX
  }
  std::string arrays;
  for (const Shape& shape : shapes) arrays += vectors(shape);
  const auto array = [](const char* type, const char* name, const std::string& values) {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">\n{}</DataArray>\n", type, name,
                       values);
  };
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{0}\" "
      "NumberOfCells=\"{0}\">\n"
      "<PointData>\n{1}{2}</PointData>\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">\n{3}</DataArray>\n</Points>\n<Cells>\n{4}{5}{6}</Cells>\n</Piece>\n"
      "</UnstructuredGrid>\n</VTKFile>\n",
      count, array("UInt8", "part", part_numbers), arrays, points(shapes),
      array("Int64", "connectivity", numbers), array("Int64", "offsets", ends),
      array("UInt8", "types", types));
}

void write_shapes(const std::string& folder, const std::vector<ShapeFile>& files) {
  const OutputFolder shapes(folder + "/shapes");
  for (const ShapeFile& one : files) {
    AtomicFile written(shapes.path() + "/" + one.name);
    written.write(one.text);
    written.commit();
  }
}

}  // namespace arcslip
