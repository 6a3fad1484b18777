#include "results/certificate_results.hpp"

#include <fmt/format.h>

#include <cmath>

namespace arcslip {

using continuation::BranchPoint;
using nlohmann::ordered_json;

ordered_json certificate_to_json(const problems::Certificate& certificate) {
  ordered_json turns = ordered_json::array();
  for (const problems::Turn& turn : certificate.turns)
    turns.push_back({{"low", turn.low}, {"high", turn.high}, {"certain", turn.certain}});
  ordered_json json = {{"proven", certificate.proven()},
                       {"from", certificate.from},
                       {"to", certificate.to},
                       {"boxes", certificate.boxes},
                       {"widest", certificate.widest},
                       {"folds", turns},
                       {"single_valued", certificate.single_valued}};
  if (certificate.gap) json["gap"] = {{"point", certificate.gap->point}, {"reason", certificate.gap->reason}};
  json["seconds"] = certificate.seconds;
  return json;
}

std::string describe_certificate(std::size_t number, const TracedBranch& traced) {
  const problems::Certificate& certificate = traced.certificate.value();
  const std::string& parameter = traced.request->options.parameter;
  const continuation::Problem& problem = traced.problem();
  const Index index = continuation::index_of(problem.parameter_names(), parameter);
  if (certificate.gap) {
    const std::size_t i = certificate.gap->point;
    const std::vector<BranchPoint>& points = traced.branch.points;
    const auto at = [&](std::size_t k) { return k < points.size() ? points[k].parameters(index) : NAN; };
    return fmt::format(
        "branch {}: not certified: the segment from point {} to {}, {} = {:.9g} to {:.9g}: {}\n", number, i,
        i + 1, parameter, at(i), at(i + 1), certificate.gap->reason);
  }
  std::string folds = certificate.turns.empty() ? "no fold" : "";
  for (const problems::Turn& turn : certificate.turns) {
    folds += fmt::format("{}{} in {:.9g} to {:.9g}", folds.empty() ? "" : ", ",
                         turn.certain ? "fold" : "perhaps folds", turn.low, turn.high);
  }
  if (!certificate.turns.empty()) folds += ", none elsewhere";
  std::string text = fmt::format(
      "branch {}: certified: {}, no jump between {} = {:.9g} and {:.9g} ({} boxes, {:.2g} s)\n", number,
      folds, parameter, certificate.from, certificate.to, certificate.boxes, certificate.seconds);
  if (certificate.single_valued)
    text += fmt::format("branch {}: certified: no other solution for these eta at any P, since Im c < 0\n",
                        number);
  return text;
}

}  // namespace arcslip
