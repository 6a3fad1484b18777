// A study in several processes. Part of the tests only where the program is built with MPI.

#include <chrono>
#include <future>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "places.hpp"
#include "program.hpp"
#include "results/database.hpp"
#include "study_text.hpp"

using namespace arcslip::testing;

namespace {

/// The program in so many processes, more than there are cores if need be, also for root.
Outcome in_processes(int count, const std::string& arguments) {
  return shell(
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
      "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe '" +
      mpiexec_path() + "' -n " + std::to_string(count) + " '" + program + "' " + arguments);
}

/// How often it is said; mpirun has something to say about a status that is not 0, too.
int times(const std::string& text, const std::string& what) {
  int count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("Several processes give the same tables as one, to the last byte", "[mpi]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  REQUIRE(arcslip_program("study " + path + " --quiet -o " + folder.path("one")).status == 0);
  for (const auto& [count, more] :
       std::vector<std::pair<int, std::string>>{{1, ""}, {2, ""}, {3, ""}, {4, " --jobs 2"}}) {
    const std::string results = folder.path(std::to_string(count));
    const Outcome outcome = in_processes(count, "study " + path + " -o " + results + more);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.out, ContainsSubstring("24 designs, "));
    CHECK(read(results + "/optimum.csv") == read(folder.path("one/optimum.csv")));
    CHECK(read(results + "/sweep.csv") == read(folder.path("one/sweep.csv")));
    CHECK(nlohmann::json::parse(read(results + "/summary.json"))["computed"] == 24);
  }
}

TEST_CASE("A study begun by several processes goes on in one, and the other way round", "[mpi]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  const std::string command = "study " + path + " --quiet --resume -o ";
  REQUIRE(in_processes(3, command + folder.path("r")).status == 0);
  const std::string whole = read(folder.path("r/optimum.csv"));
  arcslip::Database(folder.path("r/study.sqlite"))
      .execute("DELETE FROM designs WHERE curve % 2 = 0; DELETE FROM sweep WHERE curve % 2 = 0");
  REQUIRE(in_processes(3, command + folder.path("r")).status == 0);
  CHECK(nlohmann::json::parse(read(folder.path("r/summary.json")))["computed"] == 12);
  CHECK(read(folder.path("r/optimum.csv")) == whole);
  CHECK(arcslip_program(command + folder.path("r")).status == 0);
  CHECK(read(folder.path("r/optimum.csv")) == whole);
}

TEST_CASE("Several processes end with one status, and one of them speaks", "[mpi]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  folder.write("file", "");
  const Outcome wrong = in_processes(3, "study " + path + " -o " + folder.path("r") + " --set study.to=0.1");
  CHECK(wrong.status == 1);
  CHECK(times(wrong.err, "study.to: expected") == 1);
  const Outcome blocked = in_processes(3, "study " + path + " -o " + folder.path("file/below"));
  CHECK(blocked.status == 4);
  CHECK(times(blocked.err, "the folder cannot be made") == 1);
  const Outcome failed = in_processes(
      3, "study " + path + " --quiet -o " + folder.path("r") + " --set continuation.max_points=5");
  CHECK(failed.status == 3);
  CHECK(times(failed.err, "design 23 ") == 1);
}

TEST_CASE("Where the process that writes can do so no longer, all end with status 4", "[mpi]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  const std::string stored = folder.path("r/study.sqlite");
  auto outcome = std::async(std::launch::async, [&] {
    return in_processes(3, "study " + path + " --quiet -o " + folder.path("r") +
                               " --set study.for_each.frequency_ratio.count=100000");
  });
  // So many designs that the lock comes in time.
  while (!std::filesystem::exists(stored + "-wal") &&
         outcome.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) {
  }
  arcslip::Database other(stored);
  other.execute("PRAGMA busy_timeout = 60000; BEGIN IMMEDIATE");
  const Outcome locked = outcome.get();
  CHECK(locked.status == 4);
  CHECK(times(locked.err, "study.sqlite: cannot be written: another program uses it") == 1);
}
