#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "io/cursor.h"
#include "io_testing.h"

namespace matstruct {
namespace {

using testing::error_of;

constexpr Item kItem{"thing", 7};

TEST(Cursor, WordsAreSeparatedByBlanksOfAnyKind) {
  Cursor cursor("  a\tbc\r\n\n d", "f");
  EXPECT_EQ(cursor.word(kItem), "a");
  EXPECT_EQ(cursor.word(kItem), "bc");
  EXPECT_EQ(cursor.peek(), "d");
  EXPECT_EQ(cursor.word(kItem), "d");
  EXPECT_TRUE(cursor.at_end());
  EXPECT_EQ(error_of([&] { cursor.word(kItem); }),
            "f, line 3: the file ends before thing 7 is complete: it is truncated; copy or export it again.");
}

TEST(Cursor, CommentsAreBlankOnlyWhereTheFormatHasThem) {
  Cursor with("a#b c\n#d\ne", "f", '#');
  EXPECT_EQ(with.word(kItem), "a");
  EXPECT_EQ(with.word(kItem), "e");
  Cursor without("a#b c", "f");
  EXPECT_EQ(without.word(kItem), "a#b");
}

TEST(Cursor, LineEndsWhereTheLineEnds) {
  Cursor cursor("1 2 # 3\r\n4", "f", '#');
  Cursor line = cursor.line();
  EXPECT_EQ(line.integer(kItem), 1);
  EXPECT_EQ(line.integer(kItem), 2);
  EXPECT_TRUE(line.at_end());
  EXPECT_EQ(error_of([&] { line.integer(kItem); }),
            "f, line 1: the line ends before thing 7 is complete; correct it or export the file again.");
  EXPECT_EQ(cursor.integer(kItem), 4);
}

TEST(Cursor, NumbersOfText) {
  Cursor cursor("+1.5 -.25 1e3 7 -0 1e-999 4e-324", "f");
  for (const double expected : {1.5, -0.25, 1000.0, 7.0, -0.0, 0.0, 4e-324}) EXPECT_EQ(cursor.real(kItem), expected);
  EXPECT_EQ(Cursor("1e999", "f").real(kItem), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Cursor("-1e999", "f").real(kItem), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(Cursor("NaN", "f").real(kItem)));
}

TEST(Cursor, WhatIsNoNumberIsRefusedByName) {
  for (const char* word : {"1,5", "one", "0x10", "1.5.2", "1-2", "+", "+-1", "--1", "1e", ""}) {
    const std::string text = std::string("\n ") + word;
    EXPECT_NE(error_of([&] { Cursor(text, "f").real(kItem); }).find("thing 7"), std::string::npos) << word;
    EXPECT_NE(error_of([&] { Cursor(text, "f").integer(kItem); }).find("thing 7"), std::string::npos) << word;
  }
  for (const char* word : {"1.0", "1e3", "99999999999999999999"})
    EXPECT_NE(error_of([&] { Cursor(word, "f").integer(kItem); }).find(word), std::string::npos);
}

TEST(Cursor, StrangeWordsAreShownPrintableAndShort) {
  EXPECT_EQ(shown("a\x01\xff z"), "'a?? z'");
  EXPECT_EQ(shown(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(Cursor, BinaryValuesOfEitherByteOrder) {
  const std::string bytes("\x01\x02\x03\x04\x3f\xf8\0\0\0\0\0\0", 12);
  Cursor big(bytes, "f");
  big.set_binary(std::endian::big);
  EXPECT_EQ(big.integer(kItem), 0x01020304);
  EXPECT_EQ(big.real(kItem), 1.5);
  Cursor little(bytes, "f");
  little.set_binary(std::endian::little);
  EXPECT_EQ(little.integer(kItem), 0x04030201);
  little.skip(8, kItem);
  EXPECT_EQ(error_of([&] { little.integer(kItem); }),
            "f, byte 12: the file ends before thing 7 is complete: it is truncated; copy or export it again.");
}

TEST(Cursor, CountsAreCheckedAgainstTheBytesLeft) {
  Cursor text("1 2 3", "f");
  EXPECT_EQ(text.check_count(3, 2, "numbers"), 3u);  // the last number needs no blank
  EXPECT_NE(error_of([&] { text.check_count(4, 2, "numbers"); }).find("only 5 bytes follow"), std::string::npos);
  EXPECT_NE(error_of([&] { text.check_count(-1, 2, "numbers"); }).find("is -1"), std::string::npos);
  const std::int64_t too_many = std::int64_t{std::numeric_limits<Index>::max()} + 1;
  EXPECT_NE(error_of([&] { text.check_count(too_many, 2, "numbers"); }).find("can be handled"), std::string::npos);
}

TEST(Cursor, IndicesAreCheckedAgainstBothEnds) {
  const Cursor cursor("", "f");
  EXPECT_EQ(cursor.check_index(1, 3, 1, kItem), 0);
  EXPECT_EQ(cursor.check_index(3, 3, 1, kItem), 2);
  for (const std::int64_t i : {std::int64_t{0}, std::int64_t{4}, std::numeric_limits<std::int64_t>::min(),
                               std::numeric_limits<std::int64_t>::max()})
    EXPECT_NE(error_of([&] { cursor.check_index(i, 3, 1, kItem); }).find("refers to vertex"), std::string::npos) << i;
}

}  // namespace
}  // namespace matstruct
