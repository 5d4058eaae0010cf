// common_option_words.cpp: words of a command line for CLI11.
#include <gtest/gtest.h>

#include "option_words.h"

namespace {

std::vector<std::string> split(std::string_view word) {
  std::vector<std::string> words;
  appendOptionWord(words, word, [](const std::string& name) { return name == "--size"; });
  return words;
}

TEST(OptionWords, anEmptyValueIsAWordOfItsOwn) {
  EXPECT_EQ(split("--size="), (std::vector<std::string>{"--size", ""}));
}

TEST(OptionWords, allOtherWordsStayAsTheyAre) {
  for (const char* word : {"--size=2x2", "--size", "--size==", "--quiet=", "--other=", "--=", "--",
                           "-s=", "file=", "=", ""})
    EXPECT_EQ(split(word), std::vector<std::string>{word});
}

} // namespace
