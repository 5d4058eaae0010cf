// mapper_options.cpp: options of ORTShader nodes: types, several options in a string, and messages
// about bad ones.
#include <gtest/gtest.h>

#include "xvrml/appearance.h"

using namespace xvrml;

namespace {

std::vector<ShaderOption> parse(const xvrml::MFString& options) {
  std::vector<std::string> errors;
  std::vector<ShaderOption> result = parseShaderOptions(options, errors);
  EXPECT_TRUE(errors.empty()) << errors.front();
  return result;
}

std::vector<std::string> errorsOf(const xvrml::MFString& options) {
  std::vector<std::string> errors;
  parseShaderOptions(options, errors);
  return errors;
}

TEST(MapOptions, EveryType) {
  const auto options =
      parse({"1i n -3", "1f a .5", "2f b 1,2", "3f reflectance .9 .9 .9", "4f d 1 2 3 4",
             "bool on true", "color c 1 0.5 +0.25", "string s 'two words'", "texture t wood.png",
             "16f m 1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1"});
  ASSERT_EQ(options.size(), 10u);
  EXPECT_EQ(options[0].type, ShaderOption::Type::integer);
  EXPECT_EQ(options[0].integer, -3);
  EXPECT_EQ(options[1].numbers, std::vector<float>{.5f});
  EXPECT_EQ(options[3].name, "reflectance");
  EXPECT_EQ(options[3].numbers, (std::vector<float>{.9f, .9f, .9f}));
  EXPECT_EQ(options[5].integer, 1);
  EXPECT_EQ(options[6].type, ShaderOption::Type::color);
  EXPECT_EQ(options[6].numbers, (std::vector<float>{1, .5f, .25f}));
  EXPECT_EQ(options[7].text, "two words");
  EXPECT_EQ(options[8].type, ShaderOption::Type::texture);
  EXPECT_EQ(options[8].text, "wood.png");
  EXPECT_EQ(options[9].numbers.size(), 16u);
  EXPECT_EQ(options[9].numbers[12], 4);
}

TEST(MapOptions, ListsGoOnAsLongAsNumbersFollow) {
  const auto options =
      parse({"floats angle .5 1, 1.5 1f a 2", "floats none", "file ies 'a lamp.ies'"});
  ASSERT_EQ(options.size(), 4u);
  EXPECT_EQ(options[0].type, ShaderOption::Type::list);
  EXPECT_EQ(options[0].numbers, (std::vector<float>{.5f, 1, 1.5f}));
  EXPECT_EQ(options[1].numbers, std::vector<float>{2});
  EXPECT_TRUE(options[2].numbers.empty());
  EXPECT_EQ(options[3].type, ShaderOption::Type::file);
  EXPECT_EQ(options[3].text, "a lamp.ies");
}

TEST(MapOptions, SeveralInOneString) {
  const auto options = parse({"1f a 1 color b 1 1 0 string c x"});
  ASSERT_EQ(options.size(), 3u);
  EXPECT_EQ(options[2].text, "x");
}

TEST(MapOptions, BadOnesAreNamedAndTheOthersKept) {
  std::vector<std::string> errors;
  const auto options = parseShaderOptions(
      {"3f a 1 2", "5f b 1", "1f c x", "1i d 1.5", "bool e maybe", "1f", "1f f nan", "1f g 7"},
      errors);
  ASSERT_EQ(options.size(), 1u);
  EXPECT_EQ(options[0].name, "g");
  ASSERT_EQ(errors.size(), 7u);
  EXPECT_NE(errors[0].find("a: too few"), std::string::npos);
  EXPECT_NE(errors[1].find("5f"), std::string::npos);
  EXPECT_NE(errors[2].find("'x'"), std::string::npos);
}

TEST(MapOptions, ATextIsNotCutAtACommaInSilence) {
  std::vector<std::string> errors;
  auto options = parseShaderOptions({"1f a 1 texture t data:image/png;base64,iVBORw0 1f b 2",
                                     "file f a,b.ies", "string s one,two,three", "1f c 3"},
                                    errors);
  ASSERT_EQ(options.size(), 2u);
  EXPECT_EQ(options[0].name, "a");
  EXPECT_EQ(options[1].name, "c");
  EXPECT_EQ(errors,
            (std::vector<std::string>{
                "option t: a comma ends 'data:image/png;base64'; write a value that has a comma in "
                "single quotes",
                "option f: a comma ends 'a'; write a value that has a comma in single quotes",
                "option s: a comma ends 'one'; write a value that has a comma in single quotes"}));
  // In quotes it is whole. A comma may also stand between two options.
  options = parse({"texture t 'data:image/png;base64,iVBORw0',1f b 2", "string s x,1f c 3",
                   "file f a.ies, 1f d 4", "string s last,"});
  ASSERT_EQ(options.size(), 7u);
  EXPECT_EQ(options[0].text, "data:image/png;base64,iVBORw0");
  EXPECT_EQ(options[2].text, "x");
  EXPECT_EQ(options[4].text, "a.ies");
  EXPECT_EQ(options[6].text, "last");
  errors = errorsOf({"string s x, nothing y"}); // with a blank it is a wrong option
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("option type 'nothing'"), std::string::npos) << errors[0];
}

TEST(MapOptions, NotMoreThanAnyShaderHas) {
  std::string text;
  for (size_t i = 0; i < maximumShaderOptions + 10; ++i) text += "1f a 1 ";
  std::vector<std::string> errors;
  EXPECT_EQ(parseShaderOptions({text, text}, errors).size(), maximumShaderOptions);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("more than 10000 options"), std::string::npos);
}

TEST(MapOptions, NothingIsNothing) {
  EXPECT_TRUE(parse({}).empty());
  EXPECT_TRUE(parse({"", "  "}).empty());
  EXPECT_EQ(errorsOf({"string s 'open"}).size(), 0u);
}

} // namespace
