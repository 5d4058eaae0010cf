#include "edit/changed_value.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "edit/value_edit.h"
#include "edit/value_words.h"
#include "write/value_writer.h"
#include "write/xml_escape.h"

namespace xvrml {
namespace {

const void* storageOf(const Value& value) {
  return std::visit([](const auto& stored) -> const void* { return &stored; }, value);
}

std::string escaped(std::string_view text, char quote) {
  std::string out;
  escapeXml(out, text, {&quote, 1});
  return out;
}

std::vector<std::string> wordsOf(FieldType type, const Value& value, const ValueSyntax& syntax) {
  const ValueWords elements(type, value);
  std::vector<std::string> all;
  for (size_t i = 0; i < elements.size(); ++i)
    for (std::string& word : elements.words(i, syntax)) all.push_back(std::move(word));
  return all;
}

// Returns a value of JSON: one word, or a list of them, in lines that are not too long.
std::string wholeJson(FieldType type, const Value& value, const ValueLines& lines) {
  constexpr size_t lineWidth = 120;
  const std::vector<std::string> words = wordsOf(type, value, {0, true});
  if (words.size() == 1 && !isMultiple(type)) return words[0];
  std::string out = "[";
  size_t line = 0; // where the line begins
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += ',';
    if (out.size() - line > lineWidth) {
      out += lines.feed;
      line = out.size();
      out.append(lines.indent + 2, ' ');
    } else if (i > 0) {
      out += ' ';
    }
    out += words[i];
  }
  return out + "]";
}

// Returns a text that has other ends of lines than "\n".
std::string withFeeds(const std::string& text, std::string_view feed) {
  std::string out;
  for (const char c : text) {
    if (c == '\n')
      out += feed;
    else
      out += c;
  }
  return out;
}

std::string whole(FieldType type, const Value& value, const ValueLines& lines,
                  const ValueSyntax& syntax) {
  if (syntax.isJson) return wholeJson(type, value, lines);
  if (syntax.isXml() && type == FieldType::SFString)
    return escaped(std::get<std::string>(value), syntax.quote);
  std::string out;
  if (syntax.isXml() && type == FieldType::MFString) {
    // There are no ends of lines, which XML would have to escape.
    for (const std::string& word : wordsOf(type, value, syntax))
      out += (out.empty() ? "" : " ") + word;
    return out;
  }
  if (syntax.isXml())
    writeXmlValue(out, type, storageOf(value), lines.indent);
  else
    writeValue(out, type, storageOf(value), lines.indent);
  const bool hasStrings = type == FieldType::SFString || type == FieldType::MFString;
  return hasStrings || lines.feed == "\n" ? out : withFeeds(out, lines.feed);
}

std::string changed(std::string_view text, FieldType type, const Value& before, const Value& after,
                    const ValueLines& lines, const ValueSyntax& syntax) {
  // A single string of XML is the text itself, also in a list without quotes, and entities are not
  // what their bytes say.
  const bool isText =
      type == FieldType::SFString || (type == FieldType::MFString && text.find('"') == text.npos);
  const ValueWords olds(type, before), news(type, after);
  const bool isWhole = (syntax.isXml() && (isText || text.find('&') != text.npos)) ||
                       (syntax.isJson && news.size() == 0); // there are no comments to keep
  if (isWhole) return whole(type, after, lines, syntax);
  const bool isList = isMultiple(type) && type != FieldType::MFImage &&
                      (syntax.isXml() || (text.starts_with('[') && text.ends_with(']')));
  ValueEdit edit(text, syntax, olds, news, lines);
  std::optional<std::string> edited;
  if (isList)
    edited = edit.withElements();
  else if (olds.size() == news.size())
    edited = edit.withWords();
  return edited ? std::move(*edited) : whole(type, after, lines, syntax);
}

} // namespace

std::string changedValue(std::string_view text, FieldType type, const Value& before,
                         const Value& after, const ValueLines& lines) {
  return changed(text, type, before, after, lines, {});
}

std::string changedAttribute(std::string_view text, FieldType type, const Value& before,
                             const Value& after, const ValueLines& lines, char quote) {
  return changed(text, type, before, after, lines, {quote});
}

std::string changedJson(std::string_view text, FieldType type, const Value& before,
                        const Value& after, const ValueLines& lines) {
  // Some files have numbers in a string, as XML has them.
  const bool isString = type == FieldType::SFString || type == FieldType::MFString;
  if (text.size() < 2 || text[0] != '"' || isString || text.find('\\') != text.npos)
    return changed(text, type, before, after, lines, {0, true});
  std::string out =
      changed(text.substr(1, text.size() - 2), type, before, after, lines, {'"', false});
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return '"' + out + '"';
}

std::string valueText(FieldType type, const Value& value, const ValueLines& lines) {
  return whole(type, value, lines, {});
}

std::string jsonText(FieldType type, const Value& value, const ValueLines& lines) {
  return wholeJson(type, value, lines);
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

std::string attributeText(FieldType type, const Value& value, const ValueLines& lines, char quote) {
  return whole(type, value, lines, {quote});
}

} // namespace xvrml
