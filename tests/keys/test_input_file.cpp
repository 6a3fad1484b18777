// Files that are none, or that never end: refused in one line, with bounded memory and time.

#include "keys/input_file.hpp"

#include "catch.hpp"
#include "mistakes.hpp"
#include "program.hpp"

using namespace arcslip::testing;
using arcslip::read_text;

namespace {

constexpr std::size_t little = std::size_t{1} << 20;

std::string error_of_file(const std::string& path) {
  return error_of([&] { read_text(path, little); });
}

}  // namespace

TEST_CASE("A file is read whole, a pipe as well", "[input]") {
  const TemporaryFolder folder;
  const std::string text(300'000, 'x');
  CHECK(read_text(folder.write("file", text), little) == text);
  CHECK(read_text(folder.write("empty", ""), little).empty());
  const Outcome once = shell("bash -c \"'" + program + "' check <(cat " + case_named("figure_8") + ")\"");
  CHECK(once.status == 0);
  CHECK_THAT(once.out, ContainsSubstring("branch 4: preload = 50"));
  const Outcome piped = shell("cat " + case_named("figure_8") + " | '" + program + "' check /dev/stdin");
  CHECK(piped.out.substr(piped.out.find(':')) == once.out.substr(once.out.find(':')));
  // Whoever writes into a pipe may come later.
  const Outcome late =
      shell("mkfifo " + folder.path("pipe") + "; { sleep 0.3; cat " + case_named("figure_8") + " >" +
            folder.path("pipe") + "; } & '" + program + "' check " + folder.path("pipe"));
  CHECK(late.status == 0);
}

TEST_CASE("A case in a pipe names its matrices from where the program runs", "[input]") {
  const TemporaryFolder folder;
  REQUIRE(
      arcslip_program("sector ring -o " + folder.path("ring") + " --elements 2 --ring-elements 2").status ==
      0);
  const Outcome outcome =
      shell("cd " + folder.path("ring") + " && cat case.toml | '" + program + "' check /dev/stdin");
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
}

TEST_CASE("What is no file is refused, whatever it holds", "[input]") {
  const TemporaryFolder folder;
  CHECK_THAT(error_of_file("/dev/zero"), ContainsSubstring("/dev/zero: cannot be read: it is a device"));
  CHECK_THAT(error_of_file("/dev/null"), ContainsSubstring("it is a device"));
  CHECK_THAT(error_of_file(folder.path("")), ContainsSubstring("Is a directory"));
  CHECK_THAT(error_of_file(folder.path("none")), ContainsSubstring("No such file"));
  CHECK_THAT(error_of_file(folder.path("none/none")), ContainsSubstring("No such file"));
  CHECK_THAT(error_of_file(std::string("a\0b", 3)), ContainsSubstring("no file has such a name"));
  CHECK_THAT(error_of_file(std::string(5000, 'x')), ContainsSubstring("File name too long"));
}

TEST_CASE("A file or pipe that is too large is refused before it is read whole", "[input]") {
  const TemporaryFolder folder;
  const std::string large = folder.write("large", "");
  std::filesystem::resize_file(large, std::uintmax_t{1} << 40);
  CHECK(error_of_file(large) == large + ": cannot be read: it holds more than 1 MB");
  for (const std::string key : {"mass", "stiffness", "left", "load"}) {
    CAPTURE(key);
    CHECK(
        arcslip_program("sector ring -o " + folder.path("ring") + " --elements 2 --ring-elements 2").status ==
        0);
    const Outcome outcome = arcslip_program("check " + folder.path("ring/case.toml") + " --set system.base." +
                                            key + "='\"" + large + "\"'");
    CHECK(outcome.status == 1);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, ContainsSubstring("system.base." + key) && ContainsSubstring(large));
  }
  const Outcome endless = shell("bash -c \"'" + program + "' check <(cat /dev/zero)\"");
  CHECK(endless.status == 1);
  CHECK(is_one_line(endless.err));
  CHECK_THAT(endless.err, ContainsSubstring("it holds more than 32 MB"));
}

TEST_CASE("A pipe into which nobody writes is waited for some seconds only", "[input]") {
  const TemporaryFolder folder;
  const std::string pipe = folder.path("pipe");
  REQUIRE(shell("mkfifo " + pipe).status == 0);
  CHECK_THAT(error_of_file(pipe), ContainsSubstring("nothing came out of the pipe for"));
}

TEST_CASE("A file that holds no matrix is not quoted, but for numbers", "[input]") {
  const TemporaryFolder folder;
  REQUIRE(
      arcslip_program("sector ring -o " + folder.path("ring") + " --elements 2 --ring-elements 2").status ==
      0);
  const std::string secret = folder.write("secret", "root:x:0:0:the password is swordfish\n");
  for (const std::string key :
       {"mass", "stiffness", "damping", "left", "right", "interior", "contact", "output", "load"}) {
    CAPTURE(key);
    const Outcome outcome = arcslip_program("check " + folder.path("ring/case.toml") + " --set system.base." +
                                            key + "='\"" + secret + "\"'");
    CHECK(outcome.status == 1);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, ContainsSubstring("system.base." + key) &&
                                ContainsSubstring("secret:1: expected") &&
                                ContainsSubstring("got a word that is no number"));
    CHECK_THAT(outcome.err, !ContainsSubstring("root") && !ContainsSubstring("password"));
  }
}
