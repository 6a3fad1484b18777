// Numbers of a case file that no double holds.

#include "case_texts.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::testing::case_texts;
using arcslip::testing::Mistake;
using arcslip::testing::replaced;

TEST_CASE("An integer beyond those that a double counts is read to the last digit, or refused") {
  const auto force = [](const std::string& value) {
    return read_text(replaced(good, "force = 1.0", "force = " + value)).branches[0].problem.system.force;
  };
  CHECK(force("9007199254740992") == 0x1p53);
  CHECK(force("9007199254740994") == 0x1p53 + 2);
  CHECK(force("4611686018427387904") == 0x1p62);
  CHECK(force("9007199254740993.0") == 0x1p53);
  CHECK(read_text(good, {"system.force=9007199254740994"}).branches[0].problem.system.force == 0x1p53 + 2);

  const std::string no_double = ", an integer that no double equals";
  const Mistake mistakes[] = {
      {"force = 1.0", "force = 9007199254740993", ":9:9", "system.force", "a finite number > 0",
       "got 9007199254740993" + no_double + "; 9007199254740993.0 is rounded"},
      {"force = 1.0", "force = 9223372036854775807", ":9:9", "system.force", "a finite number > 0",
       "got 9223372036854775807" + no_double},
      {"force = 1.0", "force = -9223372036854775807", ":9:9", "system.force", "a finite number > 0",
       "got -9223372036854775807" + no_double},
      {"force = 1.0", "force = -9223372036854775808", ":9:9", "system.force", "a finite number > 0",
       "got -9223372036854775808"},
      {"force = 1.0", "force = 9223372036854775808", ":9:", "not valid TOML", "", ""},
      {"force = 1.0", "force = 1.0\ncubic_stiffness = -9007199254740993", ":10:19", "system.cubic_stiffness",
       "a finite number", "got -9007199254740993" + no_double},
      {"force = 1.0", "force = 1.0\ndamping = { base = 9007199254740993 }", ":10:20", "system.damping.base",
       "> -1 and < 1", "got 9007199254740993" + no_double},
      {"force = 1.0", "force = 1.0\nharmonics = [1, 9007199254740993]", ":10:17", "system.harmonics[1]",
       "is whole", "got 9007199254740993" + no_double},
      {"force = 1.0", "force = 1.0\nharmonics = -9223372036854775808", ":10:13", "system.harmonics",
       "an odd integer", "got -9223372036854775808"},
      {"elements = 30", "elements = 9223372036854775807", ":5:12", "system.elements", "an integer",
       "got 9223372036854775807"},
      {"to = 120.0", "to = 9007199254740993", ":15:6", "branch.to", "> 0", no_double},
      {"to = 120.0", "to = 120.0\nfor_each = { preload = [1, 9007199254740993] }",
       ":16:", "branch.for_each.preload[1]", "> 0", no_double},
      {"to = 120.0", "to = 120.0\nfor_each = { preload = { from = 1, to = 9223372036854775807, count = 3 } }",
       ":16:", "branch.for_each.preload.to", "a finite number", no_double},
      {"to = 120.0", "to = 120.0\n[continuation]\nstop_at = [9007199254740993]", ":17:12",
       "continuation.stop_at[0]", ">= 0.5 and <= 120", no_double},
      {"to = 120.0", "to = 120.0\n[continuation]\nmax_points = 9223372036854775807", ":17:14",
       "continuation.max_points", ">= 2", "got 9223372036854775807"},
  };
  for (const Mistake& mistake : mistakes) check_refused(good, mistake);
  CHECK_THAT(error_of(good, {"system.preload=9007199254740993"}),
             ContainsSubstring("--set: system.preload: expected a finite number > 0, got 9007199254740993" +
                               no_double));
}

TEST_CASE("A real number beyond the range of a double is refused, a range that spans more is walked") {
  for (const std::string beyond : {"1e400", "-1e400", "1e-400", "inf", "-inf", "nan"}) {
    CAPTURE(beyond);
    const std::string error = error_of(replaced(good, "force = 1.0", "force = " + beyond));
    CHECK_THAT(error, ContainsSubstring("case.toml:9:"));
    CHECK_THAT(error_of(good, {"system.force=" + beyond}), ContainsSubstring("--set"));
  }
  const Case wide =
      read_text(good + "for_each = { force = { from = 1e-250, to = 1e250, count = 3, scale = \"log\" } }\n");
  REQUIRE(wide.branches.size() == 3);
  CHECK_THAT(wide.branches[1].problem.system.force, WithinRel(1, 1e-12));
}
