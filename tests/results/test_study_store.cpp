// What a study stores and exports, and how its designs are handed to threads.

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "catch.hpp"
#include "mistakes.hpp"
#include "results/database.hpp"
#include "results/study_results.hpp"
#include "results/study_run.hpp"
#include "results/study_store.hpp"
#include "study_text.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::problems;
using arcslip::testing::read;
using arcslip::testing::study_text;
using arcslip::testing::TemporaryFolder;

namespace {

StudyCase study_of(const TemporaryFolder& folder, const std::string& more) {
  return read_study(folder.write("case.toml", study_text + more));
}

const PeakSensitivity by{0.5, 0.25, 2, -1, 0.125};

/// One peak's branch of two points; the optimum of the given kind on the second.
PreloadStudy made_up(OptimumKind kind) {
  PreloadStudy study;
  study.free_eta = 4;
  study.free_Y = 8;
  const Peak first{PeakType::start, PeakSite::slip, 0.1, 4, 6, 3, 8, by, true};
  const Peak second{PeakType::optimum, PeakSite::corner, 1, 3.5, 2, 1, 0, by, false};
  study.branches = {{first, second}};
  Optimum optimum{kind, second, {}, 0.5, 1.5, 64, std::numeric_limits<double>::quiet_NaN()};
  if (kind == OptimumKind::exchange) optimum.other = first;
  study.optimum = optimum;
  return study;
}

std::string text_of(const std::function<void(const Sink&)>& write) {
  std::string text;
  write([&](std::string_view part) { text += part; });
  return text;
}

const std::string keyless_header =
    "P_opt,eta_opt,Y_opt,ratio_opt,kind,P_low,P_high,Y_nd_max,R_over_S,dissipated,energy,zeta_eq,site,by_P,"
    "by_mu,"
    "by_F,by_mass_ratio,by_frequency_ratio,eta_other,by_P_other,by_mu_other,by_F_other,by_mass_ratio_other,"
    "by_frequency_ratio_other\n";

}  // namespace

TEST_CASE("Tables are exported in the order of the designs, to the last digit, whatever was stored first",
          "[study]") {
  const TemporaryFolder folder;
  const StudyCase study =
      study_of(folder, "for_each = { mass_ratio = [0.1, 2], damping = [{ base = 0.5, damper = 0.25 }] }\n");
  StudyStore store(folder.path(""), study, false);
  store.add(1, study.design(1).values, made_up(OptimumKind::exchange));
  store.add(0, study.design(0).values, made_up(OptimumKind::smooth));
  const std::string damping = R"("{""base"":0.5,""damper"":0.25}")";
  CHECK(text_of([&](const Sink& sink) { store.write_optimum(sink); }) ==
        "curve,mass_ratio,damping," + keyless_header + "0,0.10000000000000001," + damping +
            ",1,3.5,2,0.25,smooth,0.5,1.5,8,1,0,64,nan,corner,0.5,0.25,2,-1,0.125,nan,nan,nan,nan,nan,nan\n1,"
            "2," +
            damping +
            ",1,3.5,2,0.25,exchange,0.5,1.5,8,1,0,64,nan,corner,0.5,0.25,2,-1,0.125,4,0.5,0.25,2,-1,0.125\n");
  CHECK(
      text_of([&](const Sink& sink) { store.write_sweep(sink); }) ==
      "curve,peak_branch,P,eta_peak,Y_max,Y_nd_max,ratio,R_over_S,dissipated,is_global,type,site,by_P,by_mu,"
      "by_F,by_mass_ratio,by_frequency_ratio\n"
      "0,0,0.10000000000000001,4,6,8,0.75,3,8,1,start,slip,0.5,0.25,2,-1,0.125\n"
      "0,0,1,3.5,2,8,0.25,1,0,0,optimum,corner,0.5,0.25,2,-1,0.125\n"
      "1,0,0.10000000000000001,4,6,8,0.75,3,8,1,start,slip,0.5,0.25,2,-1,0.125\n"
      "1,0,1,3.5,2,8,0.25,1,0,0,optimum,corner,0.5,0.25,2,-1,0.125\n");
}

TEST_CASE("A design that failed has the kind failed, nan for what is not known, and its reason", "[study]") {
  const TemporaryFolder folder;
  const StudyCase study = study_of(folder, "for_each = { mass_ratio = [1, 2, 3] }\n");
  StudyStore store(folder.path(""), study, false);
  PreloadStudy broken = made_up(OptimumKind::smooth);
  broken.failure = "lost";
  store.add(0, study.design(0).values, broken);
  store.add(1, study.design(1).values, {});
  store.add(2, study.design(2).values, made_up(OptimumKind::flat));
  const std::string csv = text_of([&](const Sink& sink) { store.write_optimum(sink); });
  const std::string nans = ",nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan\n";
  CHECK_THAT(csv, ContainsSubstring("\n0,1,nan,nan,nan,nan,failed,nan,nan,8" + nans) &&
                      ContainsSubstring("\n1,2,nan,nan,nan,nan,failed,nan,nan,nan" + nans));
  write_results(folder.path(""), study, store, {3, 0.5});
  const auto summary = nlohmann::json::parse(read(folder.path("summary.json")));
  CHECK(summary["designs"] == 3);
  CHECK(summary["designs_per_second"] == 6);
  REQUIRE(summary["failed"].size() == 2);
  CHECK(summary["failed"][0]["failure"] == "lost");
  CHECK(summary["failed"][1]["values"]["mass_ratio"] == 2);
  CHECK(summary["failed"][1]["failure"] == "there is no peak in the window");
}

TEST_CASE("A design is never stored twice, and what is stored outlives the program", "[study]") {
  const TemporaryFolder folder;
  const StudyCase study = study_of(folder, "for_each = { mass_ratio = [1, 2, 3] }\n");
  {
    StudyStore store(folder.path(""), study, true);  // begins: there is nothing to go on with
    store.add(1, study.design(1).values, made_up(OptimumKind::smooth));
    CHECK_THROWS_AS(store.add(1, study.design(1).values, made_up(OptimumKind::smooth)), OutputError);
  }
  CHECK(StudyStore(folder.path(""), study, true).finished() == std::vector<bool>{false, true, false});
  CHECK(StudyStore(folder.path(""), study, false).finished() == std::vector<bool>(3));
}

TEST_CASE("Designs are seen by others once a batch has ended, and none is stored in part", "[study]") {
  const TemporaryFolder folder;
  const StudyCase study = study_of(folder, "for_each = { mass_ratio = [1, 2, 3] }\n");
  StudyStore store(folder.path(""), study, false);
  const auto seen = [&] {
    const Database other(folder.path("study.sqlite"));
    Statement row = other.prepare("SELECT (SELECT count(*) FROM designs), (SELECT count(*) FROM sweep)");
    row.step();
    return std::pair{row.integer(0), row.integer(1)};
  };
  store.add(0, study.design(0).values, made_up(OptimumKind::smooth));
  store.add(2, study.design(2).values, made_up(OptimumKind::smooth));
  CHECK_THROWS_AS(store.add(2, study.design(2).values, made_up(OptimumKind::flat)), OutputError);
  CHECK(seen() == std::pair<std::int64_t, std::int64_t>{0, 0});
  std::this_thread::sleep_for(std::chrono::milliseconds(6));
  store.keep();
  CHECK(seen() == std::pair<std::int64_t, std::int64_t>{2, 4});
}

TEST_CASE("The memory that a study takes does not grow with the number of its designs", "[study]") {
  const TemporaryFolder folder;
  const auto in_use = [] {
    const auto heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
  };
  const auto most_for = [&](std::size_t count) {
    const StudyCase study = study_of(
        folder, fmt::format("for_each.mass_ratio = {{ from = 1.0, to = 2.0, count = {} }}\n", count));
    StudyStore store(folder.path(""), study, false);
    const std::size_t before = in_use();
    std::size_t most = before;
    const auto look = [&] { most = std::max(most, in_use()); };
    PendingDesigns pending(store.finished());
    while (pending.left() > 0) {
      const std::size_t curve = pending.next();
      store.add(curve, study.design(curve).values, made_up(OptimumKind::smooth));
      store.keep();
      if (curve % 64 == 0) look();
    }
    store.write_optimum([&](std::string_view) { look(); });
    store.write_sweep([&](std::string_view) { look(); });
    study_table(study, store, {count, 1});
    return most - before;
  };
  const std::size_t some = most_for(12000);  // more than the database holds in memory
  CHECK(most_for(36000) < some + 24000);     // less than a byte a design
}

TEST_CASE("A study tells what it costs once it knows, if that is long", "[study]") {
  CHECK(plan_of(20000, {.computed = 1, .seconds = 100, .threads = 2}).empty());
  CHECK(plan_of(20000, {.computed = 100, .seconds = 1, .threads = 2}).empty());
  CHECK(plan_of(100, {.computed = 10, .seconds = 4, .threads = 2}).empty());
  CHECK(plan_of(20000, {.computed = 8, .seconds = 4.4, .threads = 2}) ==
        "20000 designs on 2 threads, 1.1 s each: about 3.1 h");
  CHECK(plan_of(1000000, {.computed = 1000, .seconds = 4, .threads = 1}) ==
        "1000000 designs on 1 thread, 4 ms each: about 67 min");
}

TEST_CASE("Another study is refused by --resume, in one line that says what differs", "[study]") {
  const TemporaryFolder folder;
  const auto resumed = [&](const std::string& more, const std::vector<std::string>& settings = {}) {
    const StudyCase study = read_study(folder.write("other.toml", study_text + more), settings);
    return testing::error_of([&] { StudyStore(folder.path(""), study, true); });
  };
  const std::string listed = "for_each = { mass_ratio = [1, 2], force = [1, 2] }\n";
  { const StudyStore store(folder.path(""), study_of(folder, listed), false); }
  CHECK(resumed(listed) == "no error");
  CHECK(resumed(listed, {"title=new"}) == "no error");
  CHECK(resumed(listed + "[branch]\nparameter = \"eta\"\n") == "no error");
  CHECK(resumed(listed, {"study.from=0.90"}) == "no error");
  CHECK(resumed(listed, {"study.from=0.91"}) ==
        folder.path("") +
            "/study.sqlite: --resume: it was begun with another study.from; without --resume it is "
            "begun anew");
  CHECK_THAT(resumed("for_each = { force = [1, 2], mass_ratio = [1, 2] }\n"),
             ContainsSubstring("another study.for_each"));
  CHECK_THAT(resumed("for_each = { mass_ratio = [1, 3], force = [1, 2] }\n"),
             ContainsSubstring("another study.for_each.mass_ratio.1"));
  CHECK_THAT(resumed(listed, {"system.damping.base=0.01"}), ContainsSubstring("another system.damping.base"));
  CHECK_THAT(resumed(listed, {"continuation.tolerance=1e-9"}), ContainsSubstring("another continuation.tol"));
  Database(folder.path("study.sqlite")).execute("UPDATE study SET version = '0.0.1'");
  CHECK_THAT(resumed(listed), ContainsSubstring("it was begun by arcslip 0.0.1, this is "));
  folder.write("study.sqlite",
               "a text that is no database, long enough to have a header of one, which takes "
               "a hundred bytes and a few more");
  CHECK_THAT(resumed(listed), ContainsSubstring("it holds no study"));
  { const StudyStore store(folder.path(""), study_of(folder, listed), false); }
  CHECK(resumed(listed) == "no error");
}

namespace {

/// Two of three designs stored, in a file of its own that is whole.
StudyCase half_done(const TemporaryFolder& folder) {
  StudyCase study = study_of(folder, "for_each = { mass_ratio = [1, 2, 3] }\n");
  StudyStore store(folder.path(""), study, false);
  store.add(2, study.design(2).values, made_up(OptimumKind::smooth));
  store.add(0, study.design(0).values, made_up(OptimumKind::exchange));
  store.tidy();
  return study;
}

std::string tables_of(const StudyStore& store) {
  return text_of([&](const Sink& sink) { store.write_optimum(sink); }) +
         text_of([&](const Sink& sink) { store.write_sweep(sink); });
}

}  // namespace

TEST_CASE("What was changed in the database of a study is refused by --resume, in one line", "[study]") {
  const auto resumed_after = [](const std::string& sql) {
    const TemporaryFolder folder;
    const StudyCase study = half_done(folder);
    Database(folder.path("study.sqlite")).execute(sql);
    return testing::error_of([&] { StudyStore(folder.path(""), study, true); });
  };
  CHECK(resumed_after("UPDATE runs SET begun = 0") == "no error");
  CHECK_THAT(resumed_after("UPDATE designs SET curve = -1 WHERE curve = 2"),
             ContainsSubstring("study.sqlite: --resume: it has a design -1 of 3; without --resume it is "));
  CHECK_THAT(resumed_after("UPDATE designs SET curve = 1000000000 WHERE curve = 2"),
             ContainsSubstring("it has a design 1000000000 of 3;"));
  CHECK_THAT(resumed_after("UPDATE designs SET curve = 1 WHERE curve = 2"),
             ContainsSubstring("design 1 is damaged;"));
  for (const int designs : {-1, 0, 1000})
    CHECK_THAT(resumed_after(fmt::format("UPDATE study SET designs = {}", designs)),
               ContainsSubstring("its input is damaged;"));
  CHECK_THAT(resumed_after("UPDATE study SET input = '{'"), ContainsSubstring("its input is damaged;"));
  CHECK_THAT(resumed_after("UPDATE study SET version = char(27) || '[31m'"),
             ContainsSubstring("its input is damaged;"));
  CHECK_THAT(resumed_after("INSERT INTO study SELECT * FROM study"),
             ContainsSubstring("its input is damaged;"));
  for (const char* change : {"UPDATE designs SET Y_opt = Y_opt + 1e-15", "UPDATE designs SET kind = 'flat'",
                             "UPDATE designs SET P_opt = '1'", "UPDATE designs SET failure = NULL",
                             "UPDATE sweep SET is_global = 1", "DELETE FROM sweep WHERE point = 1"})
    CHECK_THAT(resumed_after(change), ContainsSubstring("design 0 is damaged;"));
  CHECK_THAT(resumed_after("DELETE FROM designs WHERE curve = 2"),
             ContainsSubstring("sweep has rows of no design;"));
  CHECK_THAT(resumed_after("CREATE VIEW more AS SELECT * FROM sweep"),
             ContainsSubstring("its tables are others;"));
  CHECK_THAT(resumed_after("DROP TABLE sweep"), ContainsSubstring("its tables are others;"));
  CHECK_THAT(resumed_after("DROP TABLE study"), ContainsSubstring("it holds no study;"));
}

TEST_CASE("No damage to the file of a study goes into what --resume makes of it", "[study]") {
  const TemporaryFolder folder;
  const StudyCase study = half_done(folder);
  const std::string whole = read(folder.path("study.sqlite"));
  const std::string tables = tables_of(StudyStore(folder.path(""), study, true));
  std::mt19937 draw(5);
  int refused = 0;
  for (int i = 0; i < 60; ++i) {
    std::string damaged = whole;
    const std::size_t at = draw() % whole.size();
    if (i % 3 == 0) {
      damaged.resize(at);
    } else if (i % 3 == 1) {
      damaged.replace(at, 200, std::string(std::min<std::size_t>(200, whole.size() - at), '\0'));
    } else {
      damaged[at] = static_cast<char>(draw());
    }
    folder.write("study.sqlite", damaged);
    std::string resumed = tables;
    try {
      resumed = tables_of(StudyStore(folder.path(""), study, true));
    } catch (const InputError&) {
      ++refused;
    }
    CHECK(resumed == tables);
  }
  CHECK(refused > 20);
}

TEST_CASE("Pending designs are those not finished, in their order", "[study]") {
  PendingDesigns pending({true, false, false, true, false});
  std::vector<std::size_t> order;
  while (pending.left() > 0) order.push_back(pending.next());
  CHECK(order == std::vector<std::size_t>{1, 2, 4});
}

TEST_CASE("Threads compute every design once, and stop where they are told to", "[study]") {
  StudyCase study;
  study.count = 200;
  std::atomic<std::size_t> asked = 0;
  study.design = [&](std::size_t i) {
    ++asked;
    StudyDesign design;  // with an empty range, which the study refuses: a failure at once
    design.values = {{"i", i}};
    return design;
  };
  StudyWorkers workers(study, 3);
  std::set<std::size_t> curves;
  {
    PendingDesigns pending(std::vector<bool>(200));
    CHECK(compute(
              workers, pending,
              [&](const FinishedDesign& design) {
                curves.insert(design.curve);
                CHECK_FALSE(design.result.failure.empty());
                CHECK(design.values["i"] == design.curve);
              },
              [] { return true; }) == 200);
  }
  CHECK(curves.size() == 200);
  CHECK(asked == 200);
  PendingDesigns pending(std::vector<bool>(200));
  const std::size_t computed = compute(
      workers, pending, [](const FinishedDesign&) {}, [] { return false; });
  CHECK(computed <= workers.wanted());
  CHECK(asked == 200 + computed);
  CHECK(workers.open() == 0);
}

TEST_CASE("What is no property of a design ends the study instead of being stored", "[study]") {
  StudyCase study;
  study.count = 10;
  study.design = [](std::size_t) -> StudyDesign { throw std::bad_alloc(); };
  StudyWorkers workers(study, 2);
  PendingDesigns pending(std::vector<bool>(10));
  CHECK_THROWS_AS(compute(
                      workers, pending, [](const FinishedDesign&) {}, [] { return true; }),
                  std::bad_alloc);
}
