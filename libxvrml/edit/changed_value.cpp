#include "edit/changed_value.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/lexer.h"
#include "write/value_writer.h"
#include "write/xml_escape.h"
#include "xvrml/numbers.h"
#include "xvrml/visit_storage.h"

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
  char quote = 0; // around attributes of XML; 0: VRML97 or JSON
  bool isJson = false;
  bool isXml() const { return quote != 0; }
};

void appendPixels(std::vector<std::string>& words, const Image& image) {
  for (const int32_t number : {image.width, image.height, image.components})
    writeNumber(words.emplace_back(), number);
  const size_t components = size_t(std::clamp(image.components, 0, 4));
  for (size_t i = 0; components > 0 && i + components <= image.pixels.size(); i += components) {
    uint32_t pixel = 0;
    for (size_t c = 0; c < components; ++c) pixel = pixel << 8 | image.pixels[i + c];
    words.push_back(fmt::format("{}", pixel));
  }
}

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
    if (syntax.isJson) {
      word = jsonString(value);
      return;
    }
    writeString(word, value);
    if (syntax.isXml()) word = escaped(word, syntax.quote);
  } else if constexpr (std::is_same_v<T, Image>) {
    if (syntax.isJson) appendPixels(words, value);
  } else if constexpr (std::is_same_v<T, bool>) {
    if (syntax.isXml() || syntax.isJson)
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

// Returns a value of JSON: one word, or a list of them, in lines that are not too long.
std::string wholeJson(FieldType type, const Value& value, size_t indent) {
  constexpr size_t lineWidth = 120;
  const std::vector<std::string> words = wordsOf(type, value, {0, true}).words;
  if (words.size() == 1 && !isMultiple(type)) return words[0];
  std::string out = "[";
  size_t line = 0; // where the line begins
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += ',';
    if (out.size() - line > lineWidth) {
      out += '\n';
      line = out.size();
      out.append(indent + 2, ' ');
    } else if (i > 0) {
      out += ' ';
    }
    out += words[i];
  }
  return out + "]";
}

std::string whole(FieldType type, Value value, size_t indent, const Syntax& syntax) {
  if (syntax.isJson) return wholeJson(type, value, indent);
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
                            const Words& before, const Words& after, const Syntax& syntax) {
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
  const bool commas = (size > 1 && (olds < 2 || text.find(',') != text.npos)) || syntax.isJson;
  const std::string_view between = commas ? ", " : " ", within = syntax.isJson ? ", " : " ";
  std::string middle;
  for (size_t i = first * size; i < (news - last) * size; ++i) {
    if (i > first * size) middle += i % size == 0 ? between : within;
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
  if (known && isList && !news.words.empty())
    return elementsBetween(text, tokens, olds, news, syntax);
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

std::string changedJson(std::string_view text, FieldType type, const Value& before,
                        const Value& after, size_t indent) {
  // Some files have numbers in a string, as XML has them.
  const bool isString = type == FieldType::SFString || type == FieldType::MFString;
  if (text.size() < 2 || text[0] != '"' || isString || text.find('\\') != text.npos)
    return changed(text, type, before, after, indent, {0, true});
  std::string out =
      changed(text.substr(1, text.size() - 2), type, before, after, indent, {'"', false});
  std::replace(out.begin(), out.end(), '\n', ' ');
  return '"' + out + '"';
}

std::string jsonText(FieldType type, const Value& value, size_t indent) {
  return wholeJson(type, value, indent);
}

std::string jsonString(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (c == '\n')
      out += "\\n";
    else if (c >= 0 && c < 0x20)
      out += fmt::format("\\u{:04x}", int(c));
    else
      out += c;
  }
  return out + '"';
}

std::string attributeText(FieldType type, const Value& value, size_t indent, char quote) {
  return whole(type, value, indent, {quote});
}

} // namespace xvrml
