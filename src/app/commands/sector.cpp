// `arcslip sector`: its arguments, and what it does with them.

#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/sector_kinds.hpp"
#include "app/wrap.hpp"
#include "arcslip/keys/input_error.hpp"
#include "results/output.hpp"

namespace arcslip {
namespace {

/// The brake rotor and the paper's figure 8, where not told otherwise.
struct SectorOptions {
  PairOptions pair;
  SystemParameters paper;
  std::optional<double> slenderness;
  double poisson_ratio = 0.3;  ///< of the paper's damper
  Index per_sector = 1;
  AnnularPlate plate;
  SolidRing ring;
  SolidOptions solid;
  std::string folder;
  CLI::App* rods = nullptr;
  CLI::App* beams = nullptr;
  CLI::App* plates = nullptr;
};

constexpr const char* sector_notes = R"(
Writes into DIR the matrices of one sector of the base and of the damper in Matrix Market format (base_mass.mtx,
base_stiffness.mtx, damper_...), their boundaries as lists of dofs (base_left.txt, base_right.txt, ...), the load
(base_load.txt) and a case file, case.toml.

Examples
  arcslip sector plate -o rotor                   a brake rotor, clamped at its hub, with a ring damper at its rim
  arcslip run rotor/case.toml                     its response at three preloads
  arcslip study rotor/case.toml                   its best preload
  arcslip sector plate --wave-number 2 --thickness 0.008 --ring-width 0.003 -o thin_rotor
  arcslip sector plate --radial-elements 8 --angular-elements 4 -o coarse_rotor
  arcslip sector ring --contact tangential --wave-number 4 -o ring
  arcslip sector ring --contact radial --speed 50 -o turning_ring
  arcslip sector plate --speed 100 -o turning_rotor
  arcslip sector beams --wave-number 1 -o beams   figure 8 from matrices
  arcslip sector plate --help                     all of a kind's options, with what they are if not given)";

CLI::Option* count(CLI::App* app, const std::string& name, Index& value, const std::string& help) {
  return app->add_option(name, value, help)
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
}

CLI::Option* positive(CLI::App* app, const std::string& name, double& value, const std::string& help) {
  return app->add_option(name, value, help)->capture_default_str()->type_name("X")->check(positive_number());
}

void poisson_ratio(CLI::App* app, const std::string& name, double& value) {
  app->add_option(name, value, "")->capture_default_str()->type_name("X")->check(CLI::Range(0.0, 0.499));
}

void add_shared(CLI::App* app, SectorOptions& options) {
  PairOptions& pair = options.pair;
  add_folder(app, "-o,--output", options.folder, "Folder for the files")->required();
  app->add_option("--wave-number", pair.wave_number, "n, waves round the circumference")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(0, 1000000));
  positive(app, "--force", pair.force, "Amplitude of the travelling force");
  positive(app, "--preload", pair.preload, "P; the case covers a hundredth to a hundredfold");
  positive(app, "--base-damping", pair.base_damping, "zeta of the base");
  positive(app, "--damper-damping", pair.damper_damping, "zeta of the damper");
  app->add_option("--from", pair.eta_from, "Lowest eta; beside the lowest frequencies if not given")
      ->type_name("X")
      ->check(positive_number());
  app->add_option("--to", pair.eta_to, "Highest eta")->type_name("X")->check(positive_number());
}

CLI::App* add_paper(CLI::App* sector, SectorOptions& options, const char* name, const char* help) {
  CLI::App* app = sector->add_subcommand(name, help);
  app->footer(
      fmt::format("\nExample: arcslip sector {} --wave-number 1 --elements-per-sector 3 -o {}", name, name));
  SystemParameters& system = options.paper;
  add_shared(app, options);
  count(app, "--elements", system.elements, "N, elements of the whole ring");
  count(app, "--elements-per-sector", options.per_sector, "Of which each has a contact");
  positive(app, "--mass-ratio", system.mass_ratio, "M*");
  positive(app, "--frequency-ratio", system.frequency_ratio, "gamma");
  CLI::Option* stiffness =
      positive(app, "--interface-stiffness", system.interface_stiffness, "K_FD, in place of --slenderness");
  stiffness->default_str("");
  app->add_option("--slenderness", options.slenderness, "L/h_D, which gives K_FD; 33.3 if neither is given")
      ->type_name("X")
      ->check(positive_number())
      ->excludes(stiffness);
  return app;
}

/// The options of a ring whose names begin with `prefix`.
void add_ring(CLI::App* app, SolidRing& ring, const std::string& prefix, const std::string& whose) {
  positive(app, prefix + "radius", ring.radius, "Of the centre line of " + whose + ", m");
  positive(app, prefix + "width", ring.width, "Of the section, along the axis, m");
  positive(app, prefix + "height", ring.height, "Of the section, along the radius, m");
  positive(app, prefix + "youngs-modulus", ring.youngs_modulus, "Pa");
  poisson_ratio(app, prefix + "poisson-ratio", ring.poisson_ratio);
  positive(app, prefix + "density", ring.density, "kg/m^3");
  count(app, prefix + "elements", ring.elements, "Elements of " + whose + " in a sector");
}

void add_solid(CLI::App* app, SectorOptions& options) {
  add_shared(app, options);
  count(app, "--contacts", options.solid.contacts, "Contacts of a sector");
  app->add_option("--contact-stiffness", options.solid.contact_stiffness,
                  "N/m, of each; of the inner half of the ring in shear if not given")
      ->type_name("X")
      ->check(positive_number());
  positive(app, "--speed", options.solid.speed,
           "Of both, revolutions a second along the numbers of the sectors")
      ->default_str("");
}

CLI::App* add_plate(CLI::App* sector, SectorOptions& options) {
  CLI::App* app =
      sector->add_subcommand("plate", "An annular plate that bends, with a ring damper at its rim");
  app->footer(
      "\nExample: arcslip sector plate --wave-number 2 --thickness 0.008 --ring-width 0.003 -o rotor");
  AnnularPlate& plate = options.plate;
  const std::map<std::string, EdgeSupport> edges{
      {"free", EdgeSupport::free}, {"supported", EdgeSupport::supported}, {"clamped", EdgeSupport::clamped}};
  add_solid(app, options);
  count(app, "--sectors", plate.sectors, "N");
  positive(app, "--inner-radius", plate.inner_radius, "m");
  positive(app, "--outer-radius", plate.outer_radius, "m");
  positive(app, "--thickness", plate.thickness, "m");
  positive(app, "--youngs-modulus", plate.youngs_modulus, "Pa");
  poisson_ratio(app, "--poisson-ratio", plate.poisson_ratio);
  positive(app, "--density", plate.density, "kg/m^3");
  app->add_option("--inner-edge", plate.inner_edge, "free, supported or clamped (if not given)")
      ->type_name("EDGE")
      ->transform(CLI::CheckedTransformer(edges));
  app->add_option("--outer-edge", plate.outer_edge, "free")
      ->type_name("EDGE")
      ->transform(CLI::CheckedTransformer(edges));
  count(app, "--radial-elements", plate.radial_elements, "Elements from edge to edge");
  count(app, "--angular-elements", plate.angular_elements, "Elements through a sector's angle");
  add_ring(app, options.solid.damper, "--ring-", "the damper");
  return app;
}

void add_rings(CLI::App* sector, SectorOptions& options) {
  CLI::App* app = sector->add_subcommand("ring", "A ring, in its plane or out of it, with a ring damper");
  app->footer("\nExample: arcslip sector ring --contact tangential --wave-number 4 -o ring");
  const std::map<std::string, RingDirection> directions{{"radial", RingDirection::radial},
                                                        {"tangential", RingDirection::tangential},
                                                        {"axial", RingDirection::axial}};
  add_solid(app, options);
  count(app, "--sectors", options.ring.sectors, "N");
  app->add_option("--contact", options.ring.contact, "Direction in which it rubs: radial, tangential, axial")
      ->type_name("DIRECTION")
      ->transform(CLI::CheckedTransformer(directions));
  add_ring(app, options.ring, "--", "the base");
  add_ring(app, options.solid.damper, "--ring-", "the damper");
}

void set_defaults(SectorOptions& options) {
  options.paper.mass_ratio = 5;
  options.paper.frequency_ratio = 4;
  // Grey cast iron and spring steel.
  options.plate = {.inner_radius = 0.07,
                   .outer_radius = 0.14,
                   .thickness = 0.012,
                   .youngs_modulus = 110e9,
                   .poisson_ratio = 0.26,
                   .density = 7200,
                   .inner_edge = EdgeSupport::clamped,
                   .outer_edge = EdgeSupport::free,
                   .sectors = 24,
                   .radial_elements = 40,
                   .angular_elements = 24};
  options.ring = {.radius = 0.14,
                  .width = 0.03,
                  .height = 0.02,
                  .youngs_modulus = 110e9,
                  .poisson_ratio = 0.26,
                  .density = 7200,
                  .contact = RingDirection::axial,
                  .sectors = 24,
                  .elements = 12};
  options.solid.damper = {.radius = 0.14,
                          .width = 0.004,
                          .height = 0.006,
                          .youngs_modulus = 210e9,
                          .poisson_ratio = 0.29,
                          .density = 7850,
                          .contact = RingDirection::axial,
                          .sectors = 24,
                          .elements = 12};
}

SectorCase make(const SectorOptions& given) {
  SectorOptions options = given;
  if (options.rods->parsed() || options.beams->parsed()) {
    const bool rods = options.rods->parsed();
    SystemParameters& system = options.paper;
    system.model = rods ? StructureModel::rods : StructureModel::beams;
    const CLI::App* app = rods ? options.rods : options.beams;
    if (app->count("--interface-stiffness") == 0) {
      system.interface_stiffness =
          shear_interface_stiffness(system.model, options.slenderness.value_or(33.3), options.poisson_ratio);
    }
    return paper_case(options.pair, system, options.per_sector);
  }
  SolidRing& damper = options.solid.damper;
  const bool plate = options.plates->parsed();
  damper.sectors = plate ? options.plate.sectors : options.ring.sectors;
  damper.contact = plate ? RingDirection::axial : options.ring.contact;
  damper.turns = options.ring.turns = options.plate.turns = options.solid.speed > 0;
  return plate ? plate_case(options.pair, options.plate, options.solid)
               : ring_case(options.pair, options.ring, options.solid);
}

/// Writes the files and prints what they hold.
int write_sectors(const SectorOptions& options) {
  catch_interrupts();
  const BeforeTheEnd say_so([] { complain("arcslip: interrupted"); });
  SectorCase made;
  try {
    made = make(options);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("arcslip sector: {}", error.what()));
  }
  const BeforeTheEnd finish_by_itself({});  // all files or none
  write_sector_case(options.folder, made);
  print(fmt::format("{}{} dofs of the base, {} of the damper, eta from {:g} to {:g}: {}/case.toml\n",
                    made.notes, made.base.mass.rows(), made.damper.mass.rows(), made.eta_from, made.eta_to,
                    options.folder));
  return status::done;
}

/// Its kinds are commands of their own.
Command::Action add_sector(CLI::App& app) {
  const auto options = std::make_shared<SectorOptions>();
  set_defaults(*options);
  CLI::App* sector =
      app.add_subcommand("sector", "Write matrices and a case file of sectors of known shapes");
  sector->require_subcommand(1);
  options->rods = add_paper(sector, *options, "rods", "The paper's longitudinal rods");
  options->beams = add_paper(sector, *options, "beams", "The paper's transverse beams");
  options->plates = add_plate(sector, *options);
  add_rings(sector, *options);
  sector->footer(as_paragraphs(sector_notes));
  return [options] { return write_sectors(*options); };
}

}  // namespace

Command sector_command() { return {"sector", add_sector}; }

}  // namespace arcslip
