#include "edit/changed_value.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/lexer.h"
#include "base/visit_storage.h"
#include "write/value_writer.h"
#include "write/xml_escape.h"
#include "xvrml/numbers.h"

namespace xvrml {
namespace {

void* storageOf(Value& value) {
  return std::visit([](auto& stored) -> void* { return &stored; }, value);
}

std::string escaped(std::string_view text, char quote) {
  std::string out;
  escapeXml(out, text, {&quote, 1});
  return out;
}

// How a file writes values.
struct Syntax {
  char quote = 0; // around attributes of XML; 0: VRML97
  bool isXml() const { return quote != 0; }
};

// A value as the words that a file has for it; empty for one that is written as a whole.
struct Words {
  std::vector<std::string> words;
  size_t ofElement = 1; // words of one element of a list
};

template <class T>
void append(std::vector<std::string>& words, const T& value, const Syntax& syntax) {
  if constexpr (Numeric<T>) {
    for (int i = 0; i < numberCount<T>; ++i) writeNumber(words.emplace_back(), numbersOf(value)[i]);
  } else if constexpr (std::is_same_v<T, std::string>) {
    std::string& word = words.emplace_back();
    writeString(word, value);
    if (syntax.isXml()) word = escaped(word, syntax.quote);
  } else if constexpr (std::is_same_v<T, bool>) {
    if (syntax.isXml())
      words.emplace_back(value ? "true" : "false");
    else
      words.emplace_back(value ? "TRUE" : "FALSE");
  }
}

Words wordsOf(FieldType type, Value value, const Syntax& syntax) {
  Words out;
  visitStorage(type, storageOf(value), [&](auto& stored) {
    using T = std::remove_reference_t<decltype(stored)>;
    if constexpr (isList<T>) {
      using Element = typename T::value_type;
      if constexpr (Numeric<Element>) out.ofElement = size_t(numberCount<Element>);
      for (const auto& element : std::as_const(stored)) append(out.words, element, syntax);
    } else {
      append(out.words, stored, syntax);
    }
  });
  return out;
}

// Returns the tokens of a value's text, without brackets.
std::vector<std::string_view> tokensOf(std::string_view text, const Syntax& syntax) {
  Diagnostics none;
  none.limit = 0;
  Locator locator(text, nullptr, none);
  Lexer lexer(locator);
  if (syntax.isXml()) lexer.enter(text);
  std::vector<std::string_view> tokens;
  for (Token token = lexer.next(); !token.is(TokenKind::end); token = lexer.next())
    if (!token.is(TokenKind::bracketOpen) && !token.is(TokenKind::bracketClose))
      tokens.push_back(token.text);
  return tokens;
}

std::string whole(FieldType type, Value value, size_t indent, const Syntax& syntax) {
  std::string out;
  if (!syntax.isXml()) {
    writeValue(out, type, storageOf(value), indent);
  } else if (type == FieldType::SFString) {
    out = escaped(std::get<std::string>(value), syntax.quote);
  } else if (type == FieldType::MFString) { // no ends of lines, which XML would have to escape
    for (const std::string& word : wordsOf(type, value, syntax).words)
      out += (out.empty() ? "" : " ") + word;
  } else {
    writeXmlValue(out, type, storageOf(value), indent);
  }
  return out;
}

// Returns a word as the file spells it: X3D in XML may also have TRUE and FALSE.
std::string spelledLike(std::string_view token, const std::string& word) {
  if (word == "true" && (token == "TRUE" || token == "FALSE")) return "TRUE";
  if (word == "false" && (token == "TRUE" || token == "FALSE")) return "FALSE";
  return word;
}

// Replaces the words that differ, where both values have the same number of words.
std::string wordByWord(std::string_view text, const std::vector<std::string_view>& tokens,
                       const Words& before, const Words& after) {
  std::string out;
  const char* at = text.data();
  for (size_t i = 0; i < tokens.size(); ++i) {
    if (before.words[i] == after.words[i]) continue;
    out.append(at, tokens[i].data());
    out += spelledLike(tokens[i], after.words[i]);
    at = tokens[i].data() + tokens[i].size();
  }
  return out.append(at, text.data() + text.size());
}

// Replaces the elements between those at the beginning and at the end that both lists share.
std::string elementsBetween(std::string_view text, const std::vector<std::string_view>& tokens,
                            const Words& before, const Words& after) {
  const size_t size = before.ofElement,
               most = std::min(before.words.size(), after.words.size()) / size;
  const auto sameElement = [&](size_t i, size_t j) {
    return std::equal(before.words.begin() + std::ptrdiff_t(i * size),
                      before.words.begin() + std::ptrdiff_t((i + 1) * size),
                      after.words.begin() + std::ptrdiff_t(j * size));
  };
  const size_t olds = before.words.size() / size, news = after.words.size() / size;
  size_t first = 0, last = 0; // elements that stay at the beginning and at the end
  while (first < most && sameElement(first, first)) ++first;
  while (first + last < most && sameElement(olds - 1 - last, news - 1 - last)) ++last;
  // Elements are separated as those of the file are.
  const bool commas = size > 1 && (olds < 2 || text.find(',') != text.npos);
  const std::string_view between = commas ? ", " : " ";
  std::string middle;
  for (size_t i = first * size; i < (news - last) * size; ++i) {
    if (i > first * size) middle += i % size == 0 ? between : " ";
    middle += after.words[i];
  }
  const auto beginOf = [&](size_t element) { return tokens[element * size].data(); };
  const auto endOf = [&](size_t element) {
    const std::string_view token = tokens[(element + 1) * size - 1];
    return token.data() + token.size();
  };
  const char* const end = text.data() + text.size();
  std::string out;
  if (first < olds - last) { // some go
    out.append(text.data(), beginOf(first)).append(middle);
    if (!middle.empty()) return out.append(endOf(olds - last - 1), end);
    // Nothing takes their place; a comma behind them goes, too.
    const char* rest = endOf(olds - last - 1);
    while (rest < end && (*rest == ' ' || *rest == '\t' || *rest == ',')) ++rest;
    return out.append(rest, end);
  }
  if (first > 0)
    return out.append(text.data(), endOf(first - 1))
        .append(between)
        .append(middle)
        .append(endOf(first - 1), end);
  return out.append(text.data(), beginOf(0)).append(middle).append(between).append(beginOf(0), end);
}

std::string changed(std::string_view text, FieldType type, const Value& before, const Value& after,
                    size_t indent, const Syntax& syntax) {
  // A single string of XML is the text itself, also in a list without quotes, and entities are not
  // what their bytes say.
  const bool isText =
      type == FieldType::SFString || (type == FieldType::MFString && text.find('"') == text.npos);
  const bool isWhole = syntax.isXml() && (isText || text.find('&') != text.npos);
  if (isWhole) return whole(type, after, indent, syntax);
  const Words olds = wordsOf(type, before, syntax), news = wordsOf(type, after, syntax);
  const std::vector<std::string_view> tokens = tokensOf(text, syntax);
  const bool known = !olds.words.empty() && tokens.size() == olds.words.size();
  if (known && olds.words.size() == news.words.size()) return wordByWord(text, tokens, olds, news);
  const bool isList =
      isMultiple(type) && (syntax.isXml() || (text.starts_with('[') && text.ends_with(']')));
  if (known && isList && !news.words.empty()) return elementsBetween(text, tokens, olds, news);
  return whole(type, after, indent, syntax);
}

} // namespace

std::string changedValue(std::string_view text, FieldType type, const Value& before,
                         const Value& after, size_t indent) {
  return changed(text, type, before, after, indent, {});
}

std::string changedAttribute(std::string_view text, FieldType type, const Value& before,
                             const Value& after, size_t indent, char quote) {
  return changed(text, type, before, after, indent, {quote});
}

std::string attributeText(FieldType type, const Value& value, size_t indent, char quote) {
  return whole(type, value, indent, {quote});
}

} // namespace xvrml
