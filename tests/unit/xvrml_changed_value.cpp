// xvrml_changed_value.cpp: Tests that the text of a changed value keeps what has not changed.
#include <algorithm>
#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "edit/alignment.h"
#include "edit/changed_value.h"
#include "edit/lines.h"
#include "edit/list_steps.h"
#include "xvrml/value_text.h"

namespace {

using namespace xvrml;

// Returns the text for a new value, which is given as text, too.
std::string changed(FieldType type, std::string_view text, std::string_view after) {
  std::string problem;
  const auto before = parseValue(type, text, problem), now = parseValue(type, after, problem);
  EXPECT_TRUE(before && now) << problem;
  const std::string out = changedValue(text, type, *before, *now, {2, lineFeedOf(text)});
  const auto read = parseValue(type, out, problem);
  EXPECT_TRUE(read && *read == *now) << out << ": " << problem;
  return out;
}

TEST(ChangedValue, OnlyTheNumbersThatDifferChange) {
  EXPECT_EQ(changed(FieldType::SFVec3f, "1.0  .5\t0.250", "1 .5 3"), "1.0  .5\t3");
  EXPECT_EQ(changed(FieldType::SFVec3f, "1 0 0", "1 0 0"), "1 0 0");
  EXPECT_EQ(changed(FieldType::SFInt32, "0x10", "17"), "17");
  EXPECT_EQ(changed(FieldType::SFBool, "TRUE", "FALSE"), "FALSE");
  EXPECT_EQ(changed(FieldType::SFString, "\"a\"", "\"b \\\"c\\\"\""), "\"b \\\"c\\\"\"");
  EXPECT_EQ(changed(FieldType::MFVec3f, "[ 0 0 0, # the first\n  1.50 0 0,\n  2 2 2 ]",
                    "[ 0 0 0 1.5 0 9 2 2 2 ]"),
            "[ 0 0 0, # the first\n  1.50 0 9,\n  2 2 2 ]");
}

TEST(ChangedValue, ElementsAreInsertedAndRemovedInTheirPlace) {
  const std::string list = "[ 0 0, # a\n 1 1, # b\n 2 2 ]";
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 0 0 1 1 2 2 3 3 ]"),
            "[ 0 0, # a\n 1 1, # b\n 2 2, 3 3 ]");
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 9 9 0 0 1 1 2 2 ]"),
            "[ 9 9, 0 0, # a\n 1 1, # b\n 2 2 ]");
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 0 0 2 2 ]"), "[ 0 0, # a\n # b\n 2 2 ]");
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 0 0 1 1 ]"), "[ 0 0, # a\n 1 1, # b\n ]");
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 1 1 2 2 ]"), "[ # a\n 1 1, # b\n 2 2 ]");
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 0 0 5 5 6 6 2 2 ]"),
            "[ 0 0, # a\n 5 5, # b\n 6 6,\n 2 2 ]");
  EXPECT_EQ(changed(FieldType::MFInt32, "[ 1 2 3 ]", "[ 1 3 ]"), "[ 1 3 ]");
  EXPECT_EQ(changed(FieldType::MFString, "[ \"a\" \"b\" ]", "[ \"a\" \"x\" \"b\" ]"),
            "[ \"a\" \"x\" \"b\" ]");
}

TEST(ChangedValue, WhatHasNoSuchFormIsWrittenAnew) {
  changed(FieldType::MFFloat, "3", "[ 1 2 ]");
  changed(FieldType::MFFloat, "[ ]", "[ 1 2 ]");
  EXPECT_EQ(changed(FieldType::MFFloat, "3", "4"), "4");
  changed(FieldType::SFImage, "1 1 1 0xff", "2 1 1 0 1");
}

TEST(ChangedValue, ChangesInSeveralPlacesLeaveTheRest) {
  const std::string list = "[\n  0 0, # a\n  1.0 1, # b\n\n  # above\n  2 2, # c\n  3 3 # d\n]";
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 0 5 1 1 2 2 4 4 ]"),
            "[\n  0 5, # a\n  1.0 1, # b\n\n  # above\n  2 2, # c\n  4 4 # d\n]");
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 9 9 0 0 1 1 7 7 2 2 3 3 8 8 ]"),
            "[\n  9 9,\n  0 0, # a\n  1.0 1, # b\n  7 7,\n\n  # above\n  2 2, # c\n"
            "  3 3, # d\n  8 8\n]");
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 1 1 2 2 ]"),
            "[\n  # a\n  1.0 1, # b\n\n  # above\n  2 2, # c\n  # d\n]");
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ 1 1 2 2 3 3 4 4 ]"),
            "[\n  # a\n  1.0 1, # b\n\n  # above\n  2 2, # c\n  3 3, # d\n  4 4\n]")
      << "what moves up keeps its text";
  EXPECT_EQ(changed(FieldType::MFVec2f, list, "[ ]"), "[\n  # a\n  # b\n\n  # above\n"
                                                      "  # c\n  # d\n]");
}

TEST(ChangedValue, ElementsWithoutALineOfTheirOwnGoIntoTheirs) {
  EXPECT_EQ(
      changed(FieldType::MFInt32, "[ 0 1 2 -1, # a\n  2 3 0 -1 ]", "[ 0 1 2 4 -1 2 3 0 -1 7 ]"),
      "[ 0 1 2 4 -1, # a\n  2 3 0 -1 7 ]");
  EXPECT_EQ(changed(FieldType::MFInt32, "[ 0 1 2 -1 # a\n  2 3 0 -1 # b\n  4 4 ]",
                    "[ 0 2 -1 2 3 0 9 -1 4 ]"),
            "[ 0 2 -1 # a\n  2 3 0 9 -1 # b\n  4 ]");
  EXPECT_EQ(changed(FieldType::MFString, "[\"a\",\"b\", \"c\"]", "[ \"x\" \"a\" \"c\" \"d\" ]"),
            "[\"x\",\"a\", \"c\", \"d\"]");
  EXPECT_EQ(changed(FieldType::MFInt32, "[1-2 3]", "[ 1 3 ]"), "[1 3]");
  EXPECT_EQ(changed(FieldType::MFInt32, "[1-2-3]", "[ 1 2 -3 ]"), "[1 2 -3]");
}

TEST(ChangedValue, LinesAreRemovedWithTheirElements) {
  EXPECT_EQ(changed(FieldType::MFFloat, "[\r\n\t1\r\n\t2\r\n\t3\r\n]", "[ 1 3 4 ]"),
            "[\r\n\t1\r\n\t3\r\n\t4\r\n]");
  EXPECT_EQ(changed(FieldType::MFVec2f, "[\n 0 0, 1 1,\n 2 2, 3 3,\n 4 4\n]", "[ 0 0 1 1 4 4 ]"),
            "[\n 0 0, 1 1,\n 4 4\n]");
}

TEST(ChangedValue, AnEmptyListWithACommentIsFilled) {
  EXPECT_EQ(changed(FieldType::MFVec2f, "[ # none\n ]", "[ 1 1 2 2 ]"),
            "[ # none\n   1 1, 2 2\n ]");
}

TEST(ChangedValue, AnEmptyListWithACommaKeepsItsComment) {
  const std::string now = changed(FieldType::MFString, "[ # c1\n , ]", "[ \"a\" \"b\" ]");
  EXPECT_EQ(now.substr(0, 7), "[ # c1\n");
  EXPECT_EQ(std::count(now.begin(), now.end(), ','), 0) << now;
}

TEST(ChangedValue, LongPartsAreBrokenIntoLines) {
  std::string many = "[ 0 3 ";
  for (int i = 0; i < 1000; ++i) many += std::to_string(i + 1000) + " ";
  const std::string out = changed(FieldType::MFInt32, "[ 0 3 # a\n  1 2 # b\n ]", many + "1 2 ]");
  EXPECT_TRUE(out.starts_with("[ 0 3 1000 1001 ")) << out;
  EXPECT_TRUE(out.ends_with(" 1999 # a\n  1 2 # b\n ]")) << out;
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 140u);
}

TEST(ChangedValue, PixelsChangeInTheirPlaces) {
  EXPECT_EQ(changed(FieldType::SFImage, "2 2 3\n 0xFF0000 0x00FF00 # first row\n 255, 0",
                    "2 2 3 0xff0000 0xab 0xff 0x100"),
            "2 2 3\n 0xFF0000 0x0000AB # first row\n 255, 256");
  EXPECT_EQ(changed(FieldType::SFImage, "1 2 1 0x0a 0XFF", "1 2 1 0xb 0xc"), "1 2 1 0x0b 0X0C");
  EXPECT_EQ(changed(FieldType::SFImage, "1 2 4 -1 0x1", "1 2 4 0xfffffffe 0x12345"),
            "1 2 4 4294967294 0x12345");
}

TEST(ChangedValue, AttributesOfXml) {
  const auto change = [](std::string_view text, MFString before, MFString after) {
    return changedAttribute(text, FieldType::MFString, before, after, {}, '\'');
  };
  EXPECT_EQ(change("\"a\"  \"b\"", {"a", "b"}, {"a", "c"}), "\"a\"  \"c\"");
  EXPECT_EQ(change("a", {"a"}, {"a", "b"}), "\"a\" \"b\"") << "a list without quotes";
  EXPECT_EQ(change("", {}, {"<"}), "\"&lt;\"");
  EXPECT_EQ(change("\"a\" \"b\" \"c\"", {"a", "b", "c"}, {"x", "b", "d", "c"}),
            "\"x\" \"b\" \"d\" \"c\"");
  EXPECT_EQ(change("\"a\" \"b\"", {"a", "b"}, {}), "");
  const auto points = [](std::string_view text, MFVec2f before, MFVec2f after) {
    return changedAttribute(text, FieldType::MFVec2f, before, after, {4}, '\'');
  };
  EXPECT_EQ(points("0 0,\n  1.0 1,\n  2 2", {{0, 0}, {1, 1}, {2, 2}},
                   {{9, 9}, {0, 0}, {1, 1}, {5, 5}, {2, 2}, {3, 3}}),
            "9 9, 0 0,\n  1.0 1,\n  5 5,\n  2 2,\n  3 3");
  EXPECT_EQ(points("0 0,\n  1.0 1,\n  2 2", {{0, 0}, {1, 1}, {2, 2}}, {{1, 1}}), "1.0 1");
  EXPECT_EQ(changedAttribute("1 2 1 0x0A 7", FieldType::SFImage, Image{1, 2, 1, {10, 7}},
                             Image{1, 2, 1, {200, 9}}, {}, '"'),
            "1 2 1 0xC8 9");
  EXPECT_EQ(changedAttribute("TRUE", FieldType::SFBool, true, false, {}, '"'), "FALSE");
  EXPECT_EQ(changedAttribute("true", FieldType::SFBool, true, false, {}, '"'), "false");
}

// Returns how many elements two lists have in common in the same order, found by trying all.
size_t inCommon(const std::vector<uint64_t>& a, const std::vector<uint64_t>& b) {
  std::vector<std::vector<size_t>> most(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t j = 0; j < b.size(); ++j)
      most[i + 1][j + 1] = a[i] == b[j] ? most[i][j] + 1 : std::max(most[i][j + 1], most[i + 1][j]);
  return most[a.size()][b.size()];
}

TEST(Alignment, ChangesFewElements) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<uint64_t> olds(random() % 12), news(random() % 12);
    const uint64_t kinds = random() % 8 + 1;
    for (uint64_t& one : olds) one = random() % kinds;
    for (uint64_t& one : news) one = random() % kinds;
    const Alignment kept = fewestChanges(olds, news);
    ASSERT_EQ(kept.size(), news.size());
    size_t count = 0, changes = 0, last = 0, inPlace = 0;
    for (size_t i = 0; i < kept.size(); ++i) {
      if (kept[i] == fresh) continue;
      ASSERT_LT(kept[i], olds.size());
      ASSERT_EQ(olds[kept[i]], news[i]);
      ASSERT_TRUE(count == 0 || kept[i] > last);
      last = kept[i];
      ++count;
    }
    forEachStep(kept, olds.size(), [&](AlignmentStep step, size_t, size_t) {
      changes += step != AlignmentStep::keep;
    });
    for (size_t i = 0; i < std::max(olds.size(), news.size()); ++i)
      inPlace += i >= olds.size() || i >= news.size() || olds[i] != news[i];
    ASSERT_LE(changes, inPlace);
    ASSERT_LE(changes, olds.size() + news.size() - 2 * inCommon(olds, news));
  }
}

TEST(Alignment, LargeListsThatHaveNothingInCommonAreBounded) {
  std::vector<uint64_t> olds(300'000), news(300'000);
  for (size_t i = 0; i < olds.size(); ++i) {
    olds[i] = i * 7919 % 100'003;
    news[i] = i * 104'729 % 99'991;
  }
  const Alignment kept = fewestChanges(olds, news);
  EXPECT_EQ(kept.size(), news.size());
  std::vector<uint64_t> same(200'000, 1), other(200'000, 1);
  for (size_t i = 0; i < same.size(); i += 97) other[i] = 2;
  same[0] = 3;
  EXPECT_EQ(fewestChanges(same, other).size(), other.size());
}

TEST(Lines, KnowWhereTheyBegin) {
  const std::string text = "a\n  b c # d\r\n\te";
  EXPECT_TRUE(startsLine(text, 4));
  EXPECT_FALSE(startsLine(text, 6));
  EXPECT_TRUE(endsLine(text, 7));
  EXPECT_FALSE(endsLine(text, 5));
  EXPECT_EQ(indentationAt(text, 7), "  ");
  EXPECT_EQ(indentationAt(text, text.size()), "\t");
  EXPECT_EQ(lineFeedOf(text), "\n");
  EXPECT_EQ(lineFeedOf("a\r\nb"), "\r\n");
}

TEST(Lines, ValuesAndTextsOfXmlKeepTheirIndentation) {
  EXPECT_EQ(indentedXml("<A\n  b='x\n  y'>\n  <!-- '\n  -->\n  <![CDATA[\n  c]]>\n  text\n  </A>",
                        "  ", "    "),
            "<A\n    b='x\n  y'>\n    <!-- '\n    -->\n    <![CDATA[\n  c]]>\n  text\n    </A>");
  EXPECT_TRUE(endsXmlLine("<A/> <!-- c --> \n<B/>", 4));
  EXPECT_FALSE(endsXmlLine("<A/> <!-- c --><B/>", 4));
}

TEST(Lines, StringsKeepTheirIndentation) {
  EXPECT_EQ(indented("A {\n  b \"x\n  y\" # \"\n  c\n }", "  ", "    "),
            "A {\n    b \"x\n  y\" # \"\n    c\n }");
}

} // namespace
