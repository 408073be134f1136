// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/printable.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace mmbrdf {
namespace {

TEST(TextOfOthers, KeepsWhatPeopleWrite) {
  for (const std::string text : {"", "ptfe 532", "Spektralon, wei\u00df", "\u6f2b\u53cd\u5c04", "\U0001f4a1 a\\b 'c'"})
    EXPECT_EQ(printable(text, 100), text);
}

TEST(TextOfOthers, ShowsWhatWouldDoSomethingToATerminal) {
  EXPECT_EQ(printable("a\nb\x1b[31m\x7f", 100), "a\\x0ab\\x1b[31m\\x7f");
  EXPECT_EQ(printable("\u009b2J", 100), "\\xc2\\x9b2J");                 // control, of two bytes
  EXPECT_EQ(printable("\u202egnp.exe", 100), "\\xe2\\x80\\xaegnp.exe");  // from right to left
  EXPECT_EQ(printable("\xc0\x8a \xed\xa0\x80 \xe2\x80", 100),            // a long form, a surrogate, half a character
            "\\xc0\\x8a \\xed\\xa0\\x80 \\xe2\\x80");
}

TEST(TextOfOthers, IsCutBetweenCharacters) {
  EXPECT_EQ(printable("abcdef", 6), "abcdef");
  EXPECT_EQ(printable("abcdefg", 6), "abcdef...");
  EXPECT_EQ(printable("abcde\u00df", 6), "abcde...");
  EXPECT_EQ(printable("abcde\n", 6), "abcde...");
  EXPECT_EQ(in_quotes(std::string(9000, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(TextOfOthers, IsQuotedWhereItIsNoName) {
  for (const std::string name : {"theta_i_deg", "blocks[1]", "f11", "a-b.c"}) EXPECT_EQ(shown_name(name), name);
  for (const std::string name : {"", "a b", "a\x1b", "\u00df"}) EXPECT_EQ(shown_name(name), in_quotes(name));
}

RC_GTEST_PROP(TextOfOthers, IsAlwaysOneLineAndShort, (const std::string& text)) {
  const std::string shown = printable(text, 30);
  RC_ASSERT(shown.size() <= 33u);
  RC_ASSERT(std::ranges::none_of(shown, [](char c) { return (c >= 0 && c < 0x20) || c == 0x7f; }));
  RC_ASSERT(printable(shown, 100) == shown);
}

}  // namespace
}  // namespace mmbrdf
