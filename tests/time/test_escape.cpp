// Motions in time that no force holds.

#include "arcslip/cases/case_file.hpp"
#include "arcslip/time/ring_motion.hpp"
#include "catch.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("Beyond the hill of a softening spring a motion in time is said to grow without bound", "[ring]") {
  const TemporaryFolder folder;
  const Case input = read_case(folder.write(
      "case.toml",
      "[system]\nmodel = \"spring_mass\"\nbase = { mass = [1.0], stiffness = [1.0] }\ncontact_stiffness = "
      "0.1\n"
      "preload = 1.0\nharmonics = 3\n[[element]]\nkind = \"cubic\"\nat = \"base\"\ncoefficient = -0.01\n"
      "[branch]\nparameter = \"eta\"\nfrom = 0.2\nto = 0.5\n"));
  RingMotion motion(build_ring(input.branches.front().problem.system), 0.2, 1);
  RingState inside = motion.at_rest();
  CHECK_NOTHROW(motion.advance(inside, motion.period()));
  RingState beyond = motion.at_rest();
  beyond.position.setConstant(1e3);
  CHECK_THROWS_WITH(motion.advance(beyond, motion.period()), ContainsSubstring("grows without bound"));
}
