#include "cases/cycles_section.hpp"

#include <climits>

namespace arcslip {

const KeyTable<CaseBranch>& cycles_keys() {
  using continuation::CollocationRule;
  using continuation::CycleOptions;
  using K = Key<CaseBranch>;
  const auto of = [](auto member) {
    return [member](auto& branch) -> auto& { return branch.cycles.options.*member; };
  };
  const auto of_flow =
      only("only of flows by [model] or of the library", [](const CaseBranch& branch, const TomlSection&) {
        const problems::LibraryModel* model = branch.problem.model.get();
        return model != nullptr && (!model->orbit || model->is_piecewise);
      });
  const auto of_smooth = only("only of flows without pieces by [model] or of the library",
                              [](const CaseBranch& branch, const TomlSection&) {
                                return branch.problem.model != nullptr && !branch.problem.model->orbit;
                              });
  const auto of_orbits =
      only("only of flows and boundary value problems by [model] or of the library",
           [](const CaseBranch& branch, const TomlSection&) { return branch.problem.model != nullptr; });
  static const KeyTable<CaseBranch> keys{
      {K("settle", at(&CaseBranch::cycles, &CyclesRequest::settle), positive(),
         "trace cycles from the start: the one that the motion from the guess has come to by then", of_flow),
       K::choice("discretisation", of(&CycleOptions::trigonometric),
                 {{"collocation", false}, {"balance", true}},
                 "how cycles are held: by polynomials on intervals, or by harmonics", "", of_smooth,
                 only("not beside curve",
                      [](const CaseBranch& branch, const TomlSection&) { return !branch.curve; })),
       K("harmonics", of(&CycleOptions::waves), within(2, 128),
         "of a balance to begin with; twice as many where their tail asks for it",
         only("only beside discretisation = \"balance\"",
              [](const CaseBranch& branch, const TomlSection&) {
                return branch.cycles.options.trigonometric;
              })),
       K("intervals", of(&CycleOptions::intervals), within(4, 100000),
         "on which an orbit is held to begin with; twice as many where its error asks for it", of_orbits),
       K("degree", of(&CycleOptions::degree), within(CollocationRule::least, CollocationRule::most),
         "of its polynomials", of_orbits),
       K("tolerance", of(&CycleOptions::tolerance), inside(0, 1),
         "of an orbit, relative to how far its unknowns go", of_orbits),
       K("doublings", of(&CycleOptions::doublings), within(0, 20),
         "how often doubled periods are followed, beside switching", of_flow),
       K::flag("tori", of(&CycleOptions::tori),
               "whether tori that leave cycles are followed, beside switching", of_smooth),
       K("max_branches", of(&CycleOptions::max_branches), at_least(1, INT_MAX),
         "of cycles, or of a boundary value problem, beside switching", of_orbits)}};
  return keys;
}

}  // namespace arcslip
