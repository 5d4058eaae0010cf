// option_words.h: Splits --NAME= into two words for CLI11, which takes the next word of the command
// line for a value that is empty. The programs call this before they parse. [any thread]
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

// Appends a word that is not the value of the word before. An empty value becomes a word of its
// own. takesValue(NAME) tells whether an option takes a value; NAME has its dashes.
template <typename TakesValue> void appendOptionWord(std::vector<std::string>& words,
                                                     std::string_view word,
                                                     const TakesValue& takesValue) {
  const std::string_view name = word.substr(0, word.find('='));
  const bool empty =
      word.starts_with("--") && name.size() + 1 == word.size() && takesValue(std::string(name));
  words.emplace_back(empty ? name : word);
  if (empty) words.emplace_back();
}

// Returns all words of a command line for CLI::App::parse(), which expects a vector in reverse.
template <typename App> std::vector<std::string> optionWords(int argc, char** argv, App& app) {
  const auto takesValue = [&](const std::string& name) {
    const auto* const option = app.get_option_no_throw(name);
    return option && option->get_items_expected_max() > 0;
  };
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--") {
      words.insert(words.end(), argv + i, argv + argc);
      break;
    }
    if (!words.empty() && takesValue(words.back()))
      words.emplace_back(argv[i]);
    else
      appendOptionWord(words, argv[i], takesValue);
  }
  std::reverse(words.begin(), words.end());
  return words;
}
