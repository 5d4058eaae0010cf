// reader_values.cpp: values that VRML 1.0 writes in another way than VRML97 ("Fields" of its
// specification). The others are read by ValueParser.
#include <fmt/format.h>

#include "parse/vrml1/reader.h"

namespace xvrml::vrml1 {
namespace {

constexpr bool isMaskCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

} // namespace

bool Reader::value(FieldType type, Spelling spelling, Value& value) {
  switch (spelling) {
  case Spelling::enumeration: return enumeration(value);
  case Spelling::bitMask: return bitMask(value);
  case Spelling::matrix: return matrix(value);
  case Spelling::plain: break;
  }
  switch (type) {
  case FieldType::SFBool: return truth(value);
  case FieldType::SFString: {
    std::string read;
    if (!text(read)) return false;
    value = std::move(read);
    return true;
  }
  case FieldType::MFString: return texts(value);
  default: return values_.parse(type, value);
  }
}

// SFBool: TRUE, FALSE, 1 or 0
bool Reader::truth(Value& value) {
  const Token token = lexer_.peek();
  const bool isTrue = token.text == "TRUE" || token.text == "1";
  if (!isTrue && token.text != "FALSE" && token.text != "0") {
    lexer_.error(token.at(),
                 fmt::format("expected TRUE or FALSE of SFBool, found {}", describe(token)));
    return false;
  }
  lexer_.next();
  value = isTrue;
  return true;
}

// SFString: characters in double quotes, or a word without white space
bool Reader::text(std::string& value) {
  const Token token = lexer_.peek();
  if (token.is(TokenKind::string)) return values_.parse(FieldType::SFString, &value);
  const char* p = token.at();
  while (p < lexer_.end() && *p != '"' && !isVrmlSeparator(*p)) ++p;
  if (p == token.at()) {
    lexer_.error(token.at(), fmt::format("expected a string, found {}", describe(token)));
    return false;
  }
  value.assign(token.at(), p);
  lexer_.seek(p);
  return true;
}

bool Reader::texts(Value& value) {
  MFString all;
  if (!lexer_.accept(TokenKind::bracketOpen)) {
    if (!text(all.emplace_back())) return false;
  } else {
    while (!lexer_.accept(TokenKind::bracketClose)) {
      if (all.size() >= limits_.arrayElements) {
        lexer_.error(lexer_.peek().at(),
                     fmt::format("more values in one field than limit arrayElements={}",
                                 limits_.arrayElements));
        return false;
      }
      if (!text(all.emplace_back())) return false;
    }
  }
  value = std::move(all);
  return true;
}

// SFEnum: one word
bool Reader::enumeration(Value& value) {
  const Token token = lexer_.peek();
  if (!token.is(TokenKind::identifier)) {
    lexer_.error(token.at(), fmt::format("expected a word of SFEnum, found {}", describe(token)));
    return false;
  }
  lexer_.next();
  value = std::string(token.text);
  return true;
}

// SFBitMask: one word, or words in parentheses: ( SIDES | BOTTOM )
bool Reader::bitMask(Value& value) {
  const char* p = lexer_.skipSpace(lexer_.cursor());
  const char* const start = p;
  const bool list = p < lexer_.end() && *p == '(';
  if (list) ++p;
  MFString words;
  for (;;) {
    while (list && (p = lexer_.skipSpace(p)) < lexer_.end() && *p == '|') ++p;
    const char* const word = p;
    while (p < lexer_.end() && isMaskCharacter(*p)) ++p;
    if (p == word) break;
    words.emplace_back(word, p);
    if (!list && (p == lexer_.end() || *p != '|')) break;
    if (!list) ++p;
  }
  const bool closed = !list || (p < lexer_.end() && *p == ')');
  lexer_.seek(list && closed ? p + 1 : p);
  if (!closed || (words.empty() && !list)) {
    lexer_.error(start,
                 fmt::format("expected words of SFBitMask as in ( SIDES | BOTTOM ), found {}",
                             describe(lexer_.peek())));
    return false;
  }
  value = std::move(words);
  return true;
}

// SFMatrix: 16 numbers, row by row
bool Reader::matrix(Value& value) {
  MFFloat numbers(16);
  for (float& number : numbers)
    if (!values_.parse(FieldType::SFFloat, &number)) return false;
  value = std::move(numbers);
  return true;
}

} // namespace xvrml::vrml1
