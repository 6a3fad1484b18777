#include "keys/printable.hpp"

#include "catch.hpp"

using arcslip::printable;

TEST_CASE("A text is shown as it is but for what a terminal would obey", "[printable]") {
  CHECK(printable("") == "");
  CHECK(printable("eta = 1, Ω_D/μ — 'x' \\ 日本 🙂") == "eta = 1, Ω_D/μ — 'x' \\ 日本 🙂");
  CHECK(printable(std::string("a\nb\tc\rd\0e", 9)) == "a\\nb\\tc\\x0dd\\x00e");
  CHECK(printable("\x1b[31mred\x7f\x9b") == "\\x1b[31mred\\x7f\\x9b");
  CHECK(printable("\xc2\x9b"
                  "2J \u2028 \u202e \u2066 \ufeff \u061c") ==
        "\\u009b2J \\u2028 \\u202e \\u2066 \\ufeff \\u061c");
}

TEST_CASE("Bytes that are no UTF-8 are shown one by one", "[printable]") {
  CHECK(printable("\xff\xfe") == "\\xff\\xfe");
  CHECK(printable("\xc0\xaf") == "\\xc0\\xaf");           // '/' in two bytes
  CHECK(printable("\xe0\x80\xaf") == "\\xe0\\x80\\xaf");  // and in three
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");  // half of a pair of UTF-16
  CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");
  CHECK(printable("\xe6\x97") == "\\xe6\\x97");  // cut short
  CHECK(printable("\xe6z") == "\\xe6z");
}

TEST_CASE("A long text is shown by its beginning, cut between characters", "[printable]") {
  CHECK(printable("12345", 5) == "12345");
  CHECK(printable("123456", 5) == "12345... (6 bytes)");
  CHECK(printable("日本語", 4) == "日本... (9 bytes)");
  CHECK(printable(std::string(1'000'000, 'x'), 60) == std::string(60, 'x') + "... (1000000 bytes)");
}
