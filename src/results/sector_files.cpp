#include "results/sector_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <deque>

#include "arcslip/sectors/matrix_market.hpp"
#include "results/atomic_file.hpp"
#include "results/output_folder.hpp"

namespace arcslip {
namespace {

/// Files that appear together.
class Files {
 public:
  explicit Files(std::string folder) : folder_(std::move(folder)) {}

  void add(const std::string& name, const std::string& text) {
    files_.emplace_back(fmt::format("{}/{}", folder_.path(), name)).write(text);
  }

  void commit() {
    for (AtomicFile& file : files_) file.sync();
    for (AtomicFile& file : files_) file.commit();
  }

 private:
  OutputFolder folder_;
  std::deque<AtomicFile> files_;
};

std::string lines(const std::vector<Index>& dofs) {
  std::string text;
  for (const Index dof : dofs) text += fmt::format("{}\n", dof + 1);
  return text;
}

std::string load_lines(const ComplexVector& load) {
  std::string text = "# dof, force, imaginary part\n";
  for (Index dof = 0; dof < load.size(); ++dof) {
    if (load(dof) == 0.0) continue;
    const double imaginary = load(dof).imag() + 0.0;  // no -0
    text += fmt::format("{} {:.17g} {:.17g}\n", dof + 1, load(dof).real(), imaginary);
  }
  return text;
}

void add_files(Files& files, const std::string& name, const FiniteSector& sector) {
  files.add(name + "_mass.mtx", write_matrix_market(sector.mass, MatrixSymmetry::symmetric));
  files.add(name + "_stiffness.mtx", write_matrix_market(sector.stiffness, MatrixSymmetry::symmetric));
  if (sector.gyroscopic.size() != 0)
    files.add(name + "_gyroscopic.mtx", write_matrix_market(sector.gyroscopic, MatrixSymmetry::general));
  if (sector.stiffness_speed2.size() != 0) {
    files.add(name + "_stiffness_speed2.mtx",
              write_matrix_market(sector.stiffness_speed2, MatrixSymmetry::symmetric));
  }
  files.add(name + "_left.txt", lines(sector.left));
  files.add(name + "_right.txt", lines(sector.right));
}

std::string section(const std::string& name, const FiniteSector& sector, const SectorDamping& damping) {
  std::vector<Index> contacts = sector.contacts;
  for (Index& dof : contacts) ++dof;
  std::string text = fmt::format(
      "\n[system.{0}]                  # {1} dofs\nmass = \"{0}_mass.mtx\"\nstiffness = "
      "\"{0}_stiffness.mtx\"\n"
      "left = \"{0}_left.txt\"\nright = \"{0}_right.txt\"\ncontact = [{2}]\n",
      name, sector.mass.rows(), fmt::join(contacts, ", "));
  if (sector.gyroscopic.size() != 0) text += fmt::format("gyroscopic = \"{}_gyroscopic.mtx\"\n", name);
  if (sector.stiffness_speed2.size() != 0)
    text += fmt::format("stiffness_speed2 = \"{}_stiffness_speed2.mtx\"\n", name);
  if (damping.reference > 0) {
    text += fmt::format("damping_kind = \"viscous\"\nreference_frequency = {}\n", damping.reference);
  } else {
    text += "damping_kind = \"structural\"\n";
  }
  return text;
}

std::string case_text(const SectorCase& input) {
  std::string text = fmt::format(
      "{}title = \"{}\"\n\n[system]\nmodel = \"sector\"\n{}wave_number = {}\nsectors = {}\n"
      "contact_stiffness = {}\nlimit_per_preload = {}\nforce = {}\npreload = {}\n"
      "damping = {{ base = {}, damper = {} }}\n",
      input.notes, input.title, input.si ? "units = \"SI\"\n" : "", input.wave_number, input.sectors,
      input.contact_stiffness, input.limit_per_preload, input.force, input.preload, input.base_damping.zeta,
      input.damper_damping.zeta);
  if (input.speed > 0) text += fmt::format("speed = {}\n", input.speed);
  text += section("base", input.base, input.base_damping) + "load = \"base_load.txt\"\n";
  text += section("damper", input.damper, input.damper_damping);
  text += fmt::format(
      "\n[branch]\nparameter = \"eta\"\nfrom = {}\nto = {}\nfor_each = {{ preload = [{}, {}, {}] }}\n",
      input.eta_from, input.eta_to, input.preload / 100, input.preload, input.preload * 100);
  return text + fmt::format("\n[study]\nparameter = \"P\"\nfrom = {}\nto = {}\neta = [{}, {}]\n",
                            input.preload / 100, input.preload * 100, input.eta_from, input.eta_to);
}

}  // namespace

void write_sector_case(const std::string& folder, const SectorCase& input) {
  Files files(folder);
  add_files(files, "base", input.base);
  files.add("base_load.txt", load_lines(input.base.load));
  add_files(files, "damper", input.damper);
  files.add("case.toml", case_text(input));
  files.commit();
}

}  // namespace arcslip
