// xvrml_parser_numbers.cpp: numbers and strings: every spelling, correct rounding, and what is
// refused. Everything that the writer writes is read back bit for bit.
#include <bit>
#include <charconv>
#include <cmath>
#include <random>

#include "base/number.h"
#include "base/value_parser.h"
#include "unit/xvrml_parser_support.h"
#include "write/value_writer.h"

namespace {

using namespace parser_test;

struct Parsed {
  bool good = false;
  Value value;
  std::string message, rest;
};

Parsed parseValue(FieldType type, const std::string& text, const Limits& limits = {}) {
  Diagnostics diagnostics;
  Locator locator(text, std::make_shared<const std::string>("f"), diagnostics);
  Lexer lexer(locator);
  Parsed parsed;
  parsed.good = ValueParser(lexer, limits).parse(type, parsed.value);
  if (!diagnostics.list().empty()) parsed.message = diagnostics.list().front().message;
  parsed.rest = lexer.peek().text;
  return parsed;
}

TEST(ParserNumbers, EverySpellingOfAFloat) {
  const std::pair<const char*, float> spellings[] = {
      {"1", 1},
      {"+1", 1},
      {"-1", -1},
      {"1.", 1},
      {".5", 0.5f},
      {"-.5", -0.5f},
      {"+.5", 0.5f},
      {"1e3", 1e3f},
      {"1E3", 1e3f},
      {"1e+3", 1e3f},
      {"1.e-3", 1e-3f},
      {".5e1", 5},
      {"007", 7},
      {"1e-60", 0},
      {"-0", -0.0f},
      {"1e38", 1e38f},
      {"16777217", 16777216},
      {"0.1", 0.1f},
      {"3.4028235e38", 3.4028235e38f},
      {"123456.78", 123456.78f},
      {"0.00000000000000000000000000000000000000000000140129846e0", 1.40129846e-45f}};
  for (const auto& [text, expected] : spellings) {
    // At the end of the text and well before it: the reader has two code paths.
    for (const std::string& tail :
         {std::string(), std::string("                                ")}) {
      const Parsed parsed = parseValue(FieldType::SFFloat, text + tail);
      ASSERT_TRUE(parsed.good) << text << parsed.message;
      EXPECT_EQ(std::bit_cast<uint32_t>(std::get<float>(parsed.value)),
                std::bit_cast<uint32_t>(expected))
          << text;
    }
  }
}

TEST(ParserNumbers, WhatIsNoFloatIsRefused) {
  for (const char* text :
       {"nan",   "NaN",   "inf",  "-inf",  "+nan", "infinity",     "1e400", "-1e39",
        "1.0f",  "0x10",  "1e",   "1e+",   "--1",  "+-1",          ".",     "-",
        "1_000", "1.2.3", "TRUE", "\"1\"", "",     "3.4028236e38", "{",     "]"}) {
    const Parsed parsed = parseValue(FieldType::SFFloat, text);
    EXPECT_FALSE(parsed.good) << text;
    EXPECT_FALSE(parsed.message.empty()) << text;
  }
}

TEST(ParserNumbers, AMillionDigits) {
  EXPECT_EQ(
      std::get<float>(parseValue(FieldType::SFFloat, "0." + std::string(1'000'000, '3')).value),
      1.0f / 3);
  EXPECT_FALSE(parseValue(FieldType::SFFloat, std::string(1'000'000, '9')).good);
  EXPECT_FALSE(parseValue(FieldType::SFInt32, std::string(1'000'000, '9')).good);
  EXPECT_EQ(
      std::get<int32_t>(parseValue(FieldType::SFInt32, std::string(1'000'000, '0') + "7").value),
      7);
}

TEST(ParserNumbers, Integers) {
  const std::pair<const char*, int32_t> spellings[] = {{"0", 0},
                                                       {"-0", 0},
                                                       {"+5", 5},
                                                       {"2147483647", 2147483647},
                                                       {"-2147483648", INT32_MIN},
                                                       {"0x1f", 31},
                                                       {"0X1F", 31},
                                                       {"0xFFFFFFFF", -1},
                                                       {"12345678", 12345678},
                                                       {"123456789", 123456789}};
  for (const auto& [text, expected] : spellings) {
    for (const std::string& tail : {std::string(), std::string("                ")}) {
      const Parsed parsed = parseValue(FieldType::SFInt32, text + tail);
      ASSERT_TRUE(parsed.good) << text << parsed.message;
      EXPECT_EQ(std::get<int32_t>(parsed.value), expected) << text;
    }
  }
  for (const char* text :
       {"2147483648", "-2147483649", "0x100000000", "0x", "1.5", "ten", "1e99"}) {
    EXPECT_FALSE(parseValue(FieldType::SFInt32, text).good) << text;
  }
  // Some writers do this; the reader reports it and accepts it.
  const Parsed real = parseValue(FieldType::SFInt32, "3.0");
  EXPECT_TRUE(real.good);
  EXPECT_EQ(std::get<int32_t>(real.value), 3);
  EXPECT_NE(real.message, "");
}

// The reader agrees with the standard library for decimals of every length, with exponents.
TEST(ParserNumbers, CorrectlyRounded) {
  std::mt19937_64 random(19);
  for (int i = 0; i < 300'000; ++i) {
    std::string text = std::to_string(random() >> (random() % 62));
    if (random() % 4) text.insert(random() % (text.size() + 1), ".");
    if (random() % 8 == 0) text += "e" + std::to_string(int(random() % 60) - 30);
    float expected = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), expected);
    if (end.ec != std::errc()) continue;
    const std::string padded = text + "                                ";
    const char* p = padded.data();
    float got = 0;
    ASSERT_EQ(readNumber(p, padded.data() + padded.size(), got), NumberError::none) << text;
    ASSERT_EQ(std::bit_cast<uint32_t>(got), std::bit_cast<uint32_t>(expected)) << text;
    ASSERT_EQ(p, padded.data() + text.size()) << text;
  }
}

// A number exactly half way between two floats goes to the even one. A digit more or less decides
// otherwise.
TEST(ParserNumbers, TiesToEven) {
  EXPECT_EQ(
      std::get<float>(parseValue(FieldType::SFFloat, "16777217                        ").value),
      16777216.0f);
  EXPECT_EQ(
      std::get<float>(parseValue(FieldType::SFFloat, "16777219                        ").value),
      16777220.0f);
  EXPECT_EQ(
      std::get<float>(parseValue(FieldType::SFFloat, "16777217.0000001                ").value),
      16777218.0f);
}

template <class Float, class Bits> void roundTrip(FieldType type, uint64_t seed) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < 200'000; ++i) {
    const Float number = std::bit_cast<Float>(static_cast<Bits>(random()));
    if (!std::isfinite(number)) continue;
    std::string text;
    writeNumber(text, number);
    const Parsed parsed = parseValue(type, text);
    ASSERT_TRUE(parsed.good) << text;
    ASSERT_EQ(std::bit_cast<Bits>(std::get<Float>(parsed.value)), std::bit_cast<Bits>(number))
        << text;
  }
}
TEST(ParserNumbers, FloatsRoundTrip) { roundTrip<float, uint32_t>(FieldType::SFFloat, 1); }
TEST(ParserNumbers, DoublesRoundTrip) { roundTrip<double, uint64_t>(FieldType::SFTime, 2); }

TEST(ParserNumbers, WhatVrmlCannotSpellIsWrittenAsTheNearest) {
  std::string text;
  writeNumber(text, INFINITY);
  writeNumber(text += ' ', -INFINITY);
  writeNumber(text += ' ', NAN);
  EXPECT_EQ(text, "3.4028235e+38 -3.4028235e+38 0");
}

TEST(ParserStrings, EscapesAndTheirWriting) {
  for (const std::string& content :
       {std::string(), std::string("plain"), std::string("a \"b\" c"), std::string("back\\slash"),
        std::string("\\"), std::string("\\\""), std::string("line\nline\r\n\ttab"),
        std::string("\xc3\xa4 \xe6\x97\xa5"), std::string("# { [ ,")}) {
    std::string text;
    writeString(text, content);
    const Parsed parsed = parseValue(FieldType::SFString, text);
    ASSERT_TRUE(parsed.good) << text;
    EXPECT_EQ(std::get<std::string>(parsed.value), content);
  }
  // Only quotes and backslashes are escaped (5.9). Other backslashes stand for themselves, as in
  // old Windows paths.
  EXPECT_EQ(std::get<std::string>(parseValue(FieldType::SFString, "\"c:\\textures\\n.gif\"").value),
            "c:\\textures\\n.gif");
  EXPECT_FALSE(parseValue(FieldType::SFString, "\"open").good);
  EXPECT_FALSE(parseValue(FieldType::SFString, "\"open\\\"").good);
  Limits limits;
  limits.stringBytes = 10;
  EXPECT_NE(parseValue(FieldType::SFString, "\"" + std::string(20, 'x') + "\"", limits)
                .message.find("stringBytes=10"),
            std::string::npos);
}

TEST(ParserValues, ListsWithAndWithoutBrackets) {
  EXPECT_EQ(std::get<MFVec3f>(parseValue(FieldType::MFVec3f, "[1 2 3,4 5 6,]").value),
            (MFVec3f{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(std::get<MFVec3f>(parseValue(FieldType::MFVec3f, "1 2 3").value), (MFVec3f{{1, 2, 3}}));
  EXPECT_EQ(std::get<MFVec3f>(parseValue(FieldType::MFVec3f, "[ # nothing ]\n ]").value),
            MFVec3f{});
  EXPECT_EQ(std::get<MFString>(parseValue(FieldType::MFString, "[\"a\" \"b\"]").value),
            (MFString{"a", "b"}));
  EXPECT_EQ(std::get<MFInt32>(parseValue(FieldType::MFInt32, "[0x10,-1]").value),
            (MFInt32{16, -1}));
  EXPECT_EQ(std::get<MFTime>(parseValue(FieldType::MFTime, "[.1 1e300]").value),
            (MFTime{.1, 1e300}));
  EXPECT_FALSE(parseValue(FieldType::MFVec2f, "[1 2 3]").good);
  EXPECT_FALSE(parseValue(FieldType::MFFloat, "[1 2").good);
  EXPECT_EQ(parseValue(FieldType::MFFloat, "[1 x]").rest, "x");
}

TEST(ParserValues, Images) {
  const Image image = std::get<Image>(parseValue(FieldType::SFImage, "2 1 3 0xFF8001 258").value);
  EXPECT_EQ(image, (Image{2, 1, 3, {0xff, 0x80, 1, 0, 1, 2}}));
  EXPECT_EQ(std::get<Image>(parseValue(FieldType::SFImage, "1 1 4 0xFFFFFFFE").value).pixels,
            (std::vector<uint8_t>{255, 255, 255, 254}));
  EXPECT_EQ(std::get<Image>(parseValue(FieldType::SFImage, "1 1 4 4294967294").value).pixels,
            (std::vector<uint8_t>{255, 255, 255, 254}));
  EXPECT_FALSE(parseValue(FieldType::SFImage, "1 2 1 0").good);
  EXPECT_NE(parseValue(FieldType::SFImage, "65535 65535 4 0").message.find("imagePixels"),
            std::string::npos);
  EXPECT_NE(parseValue(FieldType::SFImage, "2147483647 2147483647 4 0").message.find("imagePixels"),
            std::string::npos);
}

TEST(ParserPlaces, LinesOfAllKindsAndCharacters) {
  const std::string text = "a\nb\r\nc\rd\xc3\xa4 e";
  Diagnostics diagnostics;
  Locator locator(text, nullptr, diagnostics);
  Lexer lexer(locator);
  const auto place = [&](char c) {
    const SourcePosition where = lexer.place(text.data() + text.find(c));
    return std::pair(where.line, where.column);
  };
  // Forwards and backwards: positions are requested in any order.
  EXPECT_EQ(place('e'), std::pair(4u, 4u));
  EXPECT_EQ(place('a'), std::pair(1u, 1u));
  EXPECT_EQ(place('c'), std::pair(3u, 1u));
  EXPECT_EQ(place('b'), std::pair(2u, 1u));
  EXPECT_EQ(place('d'), std::pair(4u, 1u));
}

TEST(ParserPlaces, AVeryLongLineIsShownInPart) {
  const auto world = parse(std::string(5000, ' ') + "Bax { }" + std::string(5000, ' '));
  ASSERT_EQ(world->diagnostics.list().size(), 1u);
  const Diagnostic& diagnostic = world->diagnostics.list()[0];
  EXPECT_EQ(diagnostic.column, 5001u);
  EXPECT_LT(diagnostic.sourceLine.size(), 400u);
  EXPECT_EQ(diagnostic.sourceLine.substr(diagnostic.caret - 1, 3), "Bax");
}

} // namespace
