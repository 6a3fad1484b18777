#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iterator>

#include "arcslip/case_file.hpp"
#include "arcslip/results.hpp"
#include "certificate_results.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "stability_results.hpp"
#include "verification_results.hpp"

namespace arcslip {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string progress(std::size_t i, const Case& input, const continuation::BranchPoint& point,
                     std::size_t points) {
  const continuation::TraceOptions& options = input.branches[i].options;
  return fmt::format("branch {} of {}: {} points, arclength {:.4g}, {} from {:g} to {:g}", i + 1,
                     input.branches.size(), points, point.arclength, options.parameter, options.from,
                     options.to);
}

std::vector<TracedBranch> trace_all(const Case& input, bool quiet) {
  std::vector<TracedBranch> all;
  ProgressLine line(!quiet);
  for (std::size_t i = 0; i < input.branches.size() && !interrupted(); ++i) {
    std::size_t points = 0;
    const auto watch = [&](const continuation::BranchPoint& point) {
      if (++points % 256 == 0) line.show([&] { return progress(i, input, point, points); });
      return !interrupted();
    };
    std::vector<TracedBranch> traced = trace(input.branches[i], watch);
    std::move(traced.begin(), traced.end(), std::back_inserter(all));
  }
  return all;
}

/// Why a branch is not whole, or nothing if it is: a border beyond which the problem has no regime is an end
/// as good as any, and of a branch traced both ways both parts must have one.
std::string complaint(const continuation::Branch& branch) {
  if (!is_end(branch.stop)) return fmt::format("{}: {}", to_string(branch.stop), branch.explanation);
  if (branch.first_stop && !is_end(*branch.first_stop))
    return fmt::format("{}: this ended the part before the start", to_string(*branch.first_stop));
  return "";
}

std::string tables(const Case& input, const std::vector<TracedBranch>& traced, const std::string& folder,
                   double seconds) {
  std::string text = input.title.empty() ? "" : input.title + "\n\n";
  std::size_t points = 0;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    const std::string values = describe(traced[i].request->values);
    if (!values.empty()) text += fmt::format("{}{}\n", i == 0 ? "" : "\n", values);
    const ProblemRequest& problem = traced[i].request->problem;
    if (problem.geometry) text += describe_groups(problem) + "\n" + describe_units(problem) + "\n";
    text += describe_harmonics(traced[i]) + special_table_header(traced[i]) + special_table(i, traced[i]) +
            describe_stability(traced[i]);
    if (traced[i].branch.stop != continuation::Stop::reached_end)
      text += fmt::format("{}: {}\n", to_string(traced[i].branch.stop), traced[i].branch.explanation);
    points += traced[i].branch.points.size();
  }
  return text + fmt::format("\n{} branch{}, {} points, {:.3g} s: {}/branches.csv, summary.json\n",
                            traced.size(), traced.size() == 1 ? "" : "es", points, seconds, folder);
}

/// Refuses before anything runs what cannot be verified.
void require_verifiable(const Case& input, const std::string& path) {
  for (const CaseBranch& branch : input.branches) {
    const std::string why = why_not_verifiable(branch);
    if (!why.empty())
      throw InputError(fmt::format("{}: --verify is for forced responses, not for {}", path, why));
  }
}

std::vector<VerifiedBranch> verify_all(const std::vector<TracedBranch>& traced, bool quiet) {
  std::vector<VerifiedBranch> all;
  ProgressLine line(!quiet);
  for (std::size_t i = 0; i < traced.size() && !interrupted(); ++i) {
    const auto progress = [&](std::size_t point, std::size_t points) {
      line.show([&] {
        return fmt::format("verifying branch {} of {}: point {} of {}", i + 1, traced.size(), point + 1,
                           points);
      });
      return !interrupted();
    };
    all.push_back(verify(i, traced[i], progress));
  }
  return all;
}

/// Refuses before anything runs what no certificate covers.
void require_certifiable(const Case& input, const std::string& path) {
  for (const CaseBranch& branch : input.branches) {
    const std::string why = why_not_certifiable(branch);
    if (why.empty()) continue;
    throw InputError(
        fmt::format("{}: --certify is for forced responses of one contact with linear structures, not for {}",
                    path, why));
  }
}

void certify_all(std::vector<TracedBranch>& traced) {
  for (TracedBranch& branch : traced) {
    if (interrupted()) return;
    certify(branch);
  }
}

/// Prints what is proven, on stderr what is not. Whether all is.
bool report_certificates(const std::vector<TracedBranch>& traced, bool quiet) {
  bool all = true;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    const auto& certificate = traced[i].certificate;
    const bool proven = certificate && certificate->proven();
    all = all && proven;
    if (!certificate) {
      fmt::print(stderr, "arcslip: branch {}: not certified: interrupted\n", i);
    } else if (!proven) {
      fmt::print(stderr, "arcslip: {}", describe_certificate(i, traced[i]));
    } else if (!quiet) {
      print(describe_certificate(i, traced[i]));
    }
  }
  return all;
}

}  // namespace

std::string results_folder(const std::string& given, const std::string& case_path) {
  return !given.empty() ? given : "out/" + std::filesystem::path(case_path).stem().string();
}

int run_command(const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  const Case input = read_case(options.case_path, options.settings);
  const std::string folder = results_folder(options.folder, options.case_path);
  if (options.verify) require_verifiable(input, options.case_path);
  if (options.certify) require_certifiable(input, options.case_path);
  create_folder(folder);
  AtomicFile branches(folder + "/branches.csv");
  AtomicFile summary(folder + "/summary.json");

  catch_interrupts();
  std::vector<TracedBranch> traced = trace_all(input, options.quiet);
  if (options.certify) certify_all(traced);
  const double seconds = seconds_since(start);

  write_branches(traced, [&](std::string_view text) { branches.write(text); });
  summary.write(summarize(input, traced, seconds).dump(2));
  summary.write("\n");
  branches.sync();
  summary.sync();
  branches.commit();
  summary.commit();
  if (!options.quiet) print(tables(input, traced, folder, seconds));
  if (options.verify) {
    const std::vector<VerifiedBranch> verified = verify_all(traced, options.quiet);
    AtomicFile file(folder + "/verify.csv");
    write_verification(verified, [&](std::string_view text) { file.write(text); });
    file.sync();
    file.commit();
    for (const VerifiedBranch& branch : verified) {
      if (!options.quiet) print(describe_verification(branch));
    }
  }

  int result = status::done;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    const std::string why = complaint(traced[i].branch);
    if (why.empty()) continue;
    result = status::incomplete_branch;
    fmt::print(stderr, "arcslip: branch {}: {}\n", i, why);
  }
  if (options.certify && !report_certificates(traced, options.quiet)) result = status::incomplete_branch;
  const auto begun = traced.empty() ? 0 : traced.back().request - input.branches.data() + 1;
  const auto missing = static_cast<std::ptrdiff_t>(input.branches.size()) - begun;
  if (missing > 0) {
    result = status::incomplete_branch;
    fmt::print(stderr, "arcslip: interrupted: {} of {} branches were not begun\n", missing,
               input.branches.size());
  }
  return result;
}

}  // namespace arcslip
