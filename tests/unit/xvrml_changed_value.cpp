// xvrml_changed_value.cpp: Tests that the text of a changed value keeps what has not changed.
#include <gtest/gtest.h>

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
  const std::string out = changedValue(text, type, *before, *now, 2);
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
            "[ 0 0, # a\n 5 5, 6 6, # b\n 2 2 ]");
  EXPECT_EQ(changed(FieldType::MFInt32, "[ 1 2 3 ]", "[ 1 3 ]"), "[ 1 3 ]");
  EXPECT_EQ(changed(FieldType::MFString, "[ \"a\" \"b\" ]", "[ \"a\" \"x\" \"b\" ]"),
            "[ \"a\" \"x\" \"b\" ]");
}

TEST(ChangedValue, WhatHasNoSuchFormIsWrittenAnew) {
  changed(FieldType::MFFloat, "3", "[ 1 2 ]");
  changed(FieldType::MFFloat, "[ ]", "[ 1 2 ]");
  changed(FieldType::MFFloat, "[ 1 2 ]", "[ ]");
  EXPECT_EQ(changed(FieldType::MFFloat, "3", "4"), "4");
  changed(FieldType::SFImage, "1 1 1 0xff", "2 1 1 0 1");
}

TEST(ChangedValue, AttributesOfXml) {
  const auto change = [](std::string_view text, MFString before, MFString after) {
    return changedAttribute(text, FieldType::MFString, before, after, 0, '\'');
  };
  EXPECT_EQ(change("\"a\"  \"b\"", {"a", "b"}, {"a", "c"}), "\"a\"  \"c\"");
  EXPECT_EQ(change("a", {"a"}, {"a", "b"}), "\"a\" \"b\"") << "a list without quotes";
  EXPECT_EQ(change("", {}, {"<"}), "\"&lt;\"");
  EXPECT_EQ(changedAttribute("TRUE", FieldType::SFBool, true, false, 0, '"'), "FALSE");
  EXPECT_EQ(changedAttribute("true", FieldType::SFBool, true, false, 0, '"'), "false");
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
