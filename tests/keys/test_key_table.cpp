// A key of a case file, said once, serves all who ask for it.

#include "keys/key_table.hpp"

#include "catch.hpp"
#include "mistakes.hpp"
#include "temporary_folder.hpp"

namespace {

using namespace arcslip;

enum class Kind { soft, hard };

struct Part {
  double width = 2;
};

struct Settings {
  double least = 1;
  std::optional<double> most = {};
  int count = 3;
  bool is_open = false;
  Kind kind = Kind::soft;
  std::vector<double> places = {0.5};
  Part part = {};
};

const KeyTable<Settings>& table() {
  using K = Key<Settings>;
  static const KeyTable<Part> part{{Key<Part>("width", &Part::width, positive(), "of it", unit("m"))}};
  const auto above = [](const Settings& settings) {
    return NumberRule{[least = settings.least](double x) { return x > least; },
                      fmt::format(" > least = {:g}", settings.least)};
  };
  const auto is_hard = [](const Settings& settings, const TomlSection&) {
    return settings.kind == Kind::hard;
  };
  const auto is_even = [](const Settings& settings, const TomlSection& section) {
    if (settings.count % 2 != 0) section.fail("count", "expected an even one");
  };
  static const KeyTable<Settings> keys{
      {K("least", &Settings::least, positive(), "the lower end", required, parameter("x")),
       K("most", &Settings::most, {" > least", above}, "the upper end")},
      {K("count", &Settings::count, at_least(1), "how many", then(is_even)),
       K::flag("is_open", &Settings::is_open, "whether it is"),
       K::choice("kind", &Settings::kind, {{"soft", Kind::soft}, {"hard", Kind::hard}}, "how", "", unlisted)},
      {K("places", &Settings::places, inside(0, 1), "where", only("only if hard", is_hard)),
       K::table("part", &Settings::part, part, "a part", "a table { width }", "a part", unlisted)}};
  return keys;
}

Settings read_settings(const std::string& text) {
  const testing::TemporaryFolder folder;
  const TomlDocument document(folder.write("case.toml", text), {});
  Settings settings;
  table().read(settings, TomlSection(document, "room"));
  return settings;
}

std::string refusal(const std::string& text) {
  return testing::error_of([&] { read_settings("[room]\n" + text); });
}

}  // namespace

TEST_CASE("Keys that are given are read, and others leave the settings as they are") {
  const Settings settings =
      read_settings("[room]\nleast = 2\nmost = 2.5\nkind = \"hard\"\nplaces = []\npart.width = 4\n");
  CHECK(settings.least == 2);
  CHECK(settings.most == 2.5);
  CHECK(settings.count == 3);
  CHECK(settings.kind == Kind::hard);
  CHECK(settings.places.empty());
  CHECK(settings.part.width == 4);
}

TEST_CASE("What a table does not allow is refused with its key") {
  CHECK_THAT(refusal("most = 2"), ContainsSubstring("room.least: missing; expected a finite number > 0"));
  CHECK_THAT(refusal("least = 2\nmost = 2"),
             ContainsSubstring(":3:8: room.most: expected a finite number > least = 2, got 2"));
  CHECK_THAT(refusal("least = 2\ncount = 5"), ContainsSubstring("room.count: expected an even one"));
  CHECK_THAT(refusal("least = 2\ncount = 0"), ContainsSubstring("expected an integer >= 1, got 0"));
  CHECK_THAT(refusal("least = 2\nplaces = [0.1]"), ContainsSubstring("room.places: only if hard"));
  CHECK_THAT(refusal("least = 2\nkind = \"so\""), ContainsSubstring("expected \"soft\" or \"hard\""));
  CHECK_THAT(refusal("least = 2\npart = 3"), ContainsSubstring("expected a table { width }, got 3"));
  CHECK_THAT(refusal("least = 2\npart.widht = 3"),
             ContainsSubstring("room.part.widht: unknown key; did you mean 'width'?"));
  CHECK_THAT(refusal("least = 2\nis_opn = true"), ContainsSubstring("did you mean 'is_open'?"));
}

TEST_CASE("A table tells its keys, their defaults and which may be listed") {
  const nlohmann::ordered_json values = table().values({});
  CHECK(values.dump() == R"({"count":3,"is_open":false,"kind":"soft","places":[0.5],"part":{"width":2.0}})");
  nlohmann::ordered_json given = {{"kind", 7}, {"part", {{"height", 1}}}};
  fill(given, values);
  CHECK(given["kind"] == 7);
  CHECK(given["part"].dump() == R"({"height":1,"width":2.0})");
  const std::vector<KeyWords> words = table().words();
  CHECK(words[0].otherwise == "required");
  CHECK(words[0].parameter == "x");
  CHECK(words[1].allowed == " > least");
  CHECK(words[2].otherwise == "3");
  CHECK(words[4].otherwise == "\"soft\"");
  CHECK(words[5].condition == "only if hard");
  CHECK(words[6].inner[0].unit == "m");
  const std::vector<ListedKey> listed = listed_keys(words, "room");
  REQUIRE(listed.size() == 6);
  CHECK(listed[4].name == "places");
  CHECK(listed[5].name == "part.width");
  CHECK(listed[5].path == "room.part.width");
}
