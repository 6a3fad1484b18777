#include "results/verification_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/assembly/structures.hpp"

namespace arcslip {
namespace {

using problems::Verification;

double eta_of(const VerifiedBranch& branch, const Verification& point) {
  return branch.traced->branch.points[point.point].parameters(0);
}

/// The largest difference of Y that `other` tells, where it does, and at which eta.
std::string largest(const VerifiedBranch& branch, double Verification::*other) {
  double most = -1;
  double eta = 0;
  for (const Verification& point : branch.points) {
    const double difference = std::abs(point.*other / point.Y - 1);
    if (difference > most) {
      most = difference;
      eta = eta_of(branch, point);
    }
  }
  return most < 0 ? "without result" : fmt::format("{:.2g} at eta = {:.9g}", most, eta);
}

/// How far Y changes with where sliders rest that stick for ever, of the branch's points that have such.
std::string by_offsets(const VerifiedBranch& branch) {
  long known = 0;
  std::string reason;
  double most = 0;
  double eta = 0;
  for (const Verification& point : branch.points) {
    if (!point.offsets) continue;
    if (!point.offsets->reason.empty()) reason = point.offsets->reason;
    if (!point.offsets->reason.empty()) continue;
    ++known;
    for (const auto& [name, value, least, greatest] : point.offsets->quantities) {
      const double change = std::max(greatest - value, value - least) / value;
      if (name != "Y" || !(change > most)) continue;
      most = change;
      eta = eta_of(branch, point);
    }
  }
  std::string text;
  if (known > 0)
    text =
        fmt::format("; at {} of them contacts stick for ever, and where their sliders rest changes Y by {}",
                    known, most > 0 ? fmt::format("at most {:.2g} at eta = {:.9g}", most, eta) : "nothing");
  if (!reason.empty()) text += "; what it changes is not known at others: " + reason;
  return text;
}

}  // namespace

std::string why_not_verifiable(const CaseBranch& branch) {
  const ProblemRequest& problem = branch.problem;
  if (problem.model != nullptr) return "a model of equations";
  if (!problem.response->in_time) return problem.response->title;
  if (!structures_of(problem.system).has_equations()) return "structures by their responses alone";
  return branch.curve ? "curves" : "";
}

VerifiedBranch verify(std::size_t number, const TracedBranch& traced, problems::VerifyOptions options) {
  VerifiedBranch verified{number, &traced, {}, 0};
  if (traced.branch.points.empty() || !why_not_verifiable(*traced.request).empty()) return verified;
  const auto progress = std::move(options.progress);
  options.progress = [&](std::size_t point, std::size_t chosen) {
    verified.chosen = chosen;
    return progress(point, chosen);
  };
  options.refused = [&](const std::string& why) { verified.untimed = why; };
  verified.points =
      problems::verify(traced.request->problem.system, traced.base.harmonics, traced.branch, options);
  return verified;
}

std::string verification_header() {
  return "branch,point,type,eta,P,Y,power_error,harmonics,Y_harmonics,difference_harmonics,Y_time,"
         "difference_time,growth\n";
}

std::string verification_row(std::size_t number, const TracedBranch& traced, const Verification& point) {
  const continuation::BranchPoint& at = traced.branch.points[point.point];
  return fmt::format("{},{},{},{:.17g},{:.17g},{:.17g},{:.3g},{},{:.17g},{:.6g},{:.17g},{:.6g},{:.10g}\n",
                     number, point.point, at.type_name(), at.parameters(0), at.parameters(1), point.Y,
                     point.power_error, point.highest, point.Y_harmonics, point.Y_harmonics / point.Y - 1,
                     point.Y_time, point.Y_time / point.Y - 1, point.growth);
}

std::string offsets_header() { return "branch,point,type,eta,P,quantity,value,least,greatest,reason\n"; }

std::string offset_rows(std::size_t number, const TracedBranch& traced, const Verification& point) {
  if (!point.offsets) return "";
  const continuation::BranchPoint& at = traced.branch.points[point.point];
  std::string reason = point.offsets->reason;
  std::replace(reason.begin(), reason.end(), ',', ';');  // what separates columns
  std::string rows;
  for (const auto& [name, value, least, greatest] : point.offsets->quantities)
    rows +=
        fmt::format("{},{},{},{:.17g},{:.17g},{},{:.17g},{:.17g},{:.17g},{}\n", number, point.point,
                    at.type_name(), at.parameters(0), at.parameters(1), name, value, least, greatest, reason);
  return rows;
}

std::string interrupted_verification_row(std::size_t number) {
  return fmt::format("{},nan,interrupted,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan\n", number);
}

std::string describe_verification(const VerifiedBranch& branch) {
  if (branch.points.empty()) return fmt::format("branch {}: no point to verify\n", branch.number);
  double power = 0;
  double growth = 0;
  long unsolved = 0;
  long timed = 0;
  for (const Verification& point : branch.points) {
    power = std::max(power, point.power_error);
    unsolved += static_cast<long>(std::isnan(point.Y_harmonics));
    if (std::isnan(point.Y_time)) continue;
    ++timed;
    growth = std::max(growth, point.growth);
  }
  std::string text = fmt::format(
      "branch {}: {} points solved anew; power in and out differ by {:.1e}; Y with harmonics up to {} "
      "differs by {}",
      branch.number, branch.points.size(), power, branch.points.front().highest,
      largest(branch, &Verification::Y_harmonics));
  if (unsolved > 0) text += fmt::format(", of {} none was found", unsolved);
  if (timed > 0) {
    text += fmt::format("; {} integrated in time: by {}; disturbances grow by at most {:.6g} a period", timed,
                        largest(branch, &Verification::Y_time), growth);
  }
  if (!branch.untimed.empty())
    text += (timed > 0 ? "; others were not: " : "; not integrated in time: ") + branch.untimed;
  return text + by_offsets(branch) + "\n";
}

}  // namespace arcslip
