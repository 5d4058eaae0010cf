// x3d_attributes.cpp: reads the values of attributes.
#include "parse/x3d_attributes.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "xvrml/visit_storage.h"

namespace xvrml {
namespace {

constexpr std::string_view blanks = " \t\r\n";

void setDefault(const FieldTarget& target) {
  const Value value = defaultValue(target.type);
  visitStorage(target.type, target.storage, [&](auto& storage) {
    storage = std::get<std::remove_reference_t<decltype(storage)>>(value);
  });
}

} // namespace

const Attribute* findAttribute(Attributes attributes, std::string_view name) {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const Attribute& one) { return one.name.text == name; });
  return found == attributes.end() ? nullptr : &*found;
}

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// A carriage return with a line feed behind it is one end of a line (XML 1.0 2.11, 3.3.3).
std::string withBlanks(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') continue;
    result += blanks.find(text[i]) == blanks.npos ? text[i] : ' ';
  }
  return result;
}

AttributeReader::AttributeReader(Locator& locator, const Limits& limits, Budget* budget)
    : locator_(locator), limits_(limits), budget_(budget), lexer_(locator),
      values_(lexer_, limits, budget) {
  values_.acceptLowerCase();
  values_.keepElements(nullptr);
}

bool AttributeReader::reserve(const char* at, uint64_t bytes) {
  if (!budget_ || budget_->take(bytes)) return true;
  if (!std::exchange(refused_, true))
    locator_.error(at, fmt::format("the world takes more memory than {}; values beyond are left "
                                   "out",
                                   budget_->name()));
  return false;
}

bool AttributeReader::read(const FieldTarget& target, const Attribute& attribute) {
  locator_.setAnchor(attribute.at);
  bool good = false;
  if (target.type == FieldType::SFString)
    good = readString(*static_cast<std::string*>(target.storage), attribute);
  else if (target.type == FieldType::MFString)
    good = readStrings(target, attribute);
  else
    good = readText(target, attribute.value);
  if (!good) setDefault(target);
  return good;
}

bool AttributeReader::readText(const FieldTarget& target, std::string_view text) {
  lexer_.enter(text);
  return values_.parseAll(target.type, target.storage);
}

// An SFString is the attribute's value itself, without quotes.
bool AttributeReader::readString(std::string& out, const Attribute& attribute) {
  if (attribute.value.size() > limits_.stringBytes) {
    locator_.error(attribute.at, fmt::format("string of {} bytes: more than limit stringBytes={}",
                                             attribute.value.size(), limits_.stringBytes));
    return false;
  }
  if (attribute.value.size() > 2 * sizeof(std::string) &&
      !reserve(attribute.at, attribute.value.size()))
    return false;
  out = attribute.decoded ? std::string(attribute.value) : withBlanks(attribute.value);
  return true;
}

// An MFString is a list of strings in double quotes. A value without any is taken as one string,
// because files have urls so, and nothing else could be meant.
bool AttributeReader::readStrings(const FieldTarget& target, const Attribute& attribute) {
  auto& strings = *static_cast<MFString*>(target.storage);
  const std::string_view text = trimmed(attribute.value);
  if (!text.empty() && text[0] != '"' && text[0] != ',') {
    locator_.warn(attribute.at,
                  fmt::format("the strings of {} stand in double quotes; '{}' is read as one "
                              "string",
                              describe(attribute.name), shortened(text)));
    strings.assign(1, {});
    const bool good =
        readString(strings.front(), {attribute.name, text, attribute.at, attribute.decoded});
    if (good && target.stringLines) target.stringLines->assign(1, locator_.place(text.data()).line);
    return good;
  }
  if (attribute.decoded || attribute.value.find_first_of("\t\r\n") == attribute.value.npos) {
    if (!readText(target, attribute.value)) return false;
  } else {
    const std::string normal = withBlanks(attribute.value);
    if (!readText(target, normal)) return false;
  }
  if (target.stringLines) {
    lexer_.enter(attribute.value);
    *target.stringLines = lexer_.linesOfStrings(attribute.value.data(), lexer_.end());
  }
  return true;
}

} // namespace xvrml
