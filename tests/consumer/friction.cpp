// What another project writes to trace a frequency response with the installed library: two rods, from far
// below their first resonance to beyond it.

#include <arcslip/continuation/path/trace.hpp>
#include <arcslip/problems/response/forced_response.hpp>
#include <iostream>

int main() {
  const arcslip::SystemParameters rods{.model = arcslip::StructureModel::rods,
                                       .mass_ratio = 5,
                                       .frequency_ratio = 4,
                                       .interface_stiffness = 1000};
  const arcslip::problems::ForcedResponse problem(arcslip::build_system(rods));

  arcslip::continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = 0.5;
  options.to = 20;
  options.extrema_of = {"Y"};
  const auto branch = trace(problem, problem.guess(options.from, rods.preload), options);

  std::cout << branch.points.size() << " points: " << branch.explanation << '\n';
  return branch.complete() ? 0 : 1;
}
