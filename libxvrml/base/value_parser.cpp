// value_parser.cpp: the implementation of ValueParser, one function per kind of value.
#include "base/value_parser.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/number.h"
#include "xvrml/visit_storage.h"

namespace xvrml {
namespace {

// Whether a value of this type is one number.
bool isWhole(FieldType type) {
  return type == FieldType::SFFloat || type == FieldType::SFInt32 || type == FieldType::SFTime ||
         type == FieldType::SFDouble;
}

inline bool endsNumber(const char* p, const char* end) {
  if (p == end || *p == '+' || *p == '-') return true;
  return isVrmlSeparator(*p) && (*p != '#' || !isNonFiniteSuffix({p, size_t(end - p)}));
}

template <class T>
concept Vec = !std::is_same_v<T, Rotation> && requires(T v) {
  v.x;
};

// Makes an element with a number that cannot be read recognisable, where its type has such values:
// nothing is drawn at a point that is not finite, or for an index that no list has. Other elements
// get the default of their type.
template <Numeric T> void markUnreadable(T& element) {
  using Scalar = ScalarOf<T>;
  if constexpr (std::is_integral_v<Scalar>)
    element = std::numeric_limits<Scalar>::max();
  else if constexpr (Vec<T> || numberCount<T> == 1)
    *numbersOf(element) = std::numeric_limits<Scalar>::quiet_NaN();
  else
    element = T{};
}

} // namespace

bool ValueParser::fail(const char* at, std::string message) {
  lexer_.error(at, std::move(message));
  return false;
}

// Handles a token in a list that cannot be read, and has been reported or counted.
ValueParser::AfterFault ValueParser::passFault(const char* at) {
  lexer_.seek(at);
  const Token token = lexer_.peek();
  const bool openString = token.is(TokenKind::invalid) && token.text.starts_with('"');
  if (token.is(TokenKind::braceClose) || token.is(TokenKind::end)) return AfterFault::listEnds;
  if (token.is(TokenKind::braceOpen) || token.is(TokenKind::bracketOpen) || openString)
    return AfterFault::unreadable;
  const bool ends = token.is(TokenKind::identifier) && endsList_ && endsList_(token);
  lexer_.seek(at);
  if (ends) return AfterFault::listEnds;
  // Letters that are glued to the token belong to it: "e-..e" stands for one number.
  const char* p = at;
  while (p < lexer_.end() && !isVrmlSeparator(*p)) ++p;
  lexer_.seek(std::max(p, token.at() + token.text.size()));
  return AfterFault::next;
}

bool ValueParser::failFound(const Token& found, std::string_view expected) {
  return fail(found.at(),
              fmt::format("expected {}, found {}", expected,
                          wholeText_ && found.is(TokenKind::end) ? "the end of the value"
                                                                 : describe(found)));
}

// Reserves memory for a value from the budget. Returns false, after one message, if not enough is
// left.
bool ValueParser::take(const char* at, uint64_t bytes) {
  if (!budget_ || budget_->take(bytes)) return true;
  if (std::exchange(refused_, true)) return false;
  return fail(at, fmt::format("the world takes more memory than {}; values beyond are left out",
                              budget_->name()));
}

// Reads one number at p, which must not be white space, and moves p behind it.
template <class Scalar> bool ValueParser::scalar(const char*& p, Scalar& out, FieldType type) {
  const char* start = p;
  const NumberError error = readNumber(p, lexer_.end(), out);
  if (error == NumberError::none && endsNumber(p, lexer_.end())) return true;
  const std::string_view name = fieldTypeName(type);
  lexer_.seek(start);
  const Token found = lexer_.peek();
  if (error == NumberError::outOfRange) {
    lexer_.next();
    if (faults_ > 0) return false; // only the first of a list is reported in its place
    return fail(start, fmt::format("number {} is out of range for {}", describe(found), name));
  }
  if constexpr (std::is_integral_v<Scalar>) {
    // Some exporters write 1.0 for an integer.
    float real = 0;
    p = start;
    if (readNumber(p, lexer_.end(), real) == NumberError::none && endsNumber(p, lexer_.end()) &&
        std::trunc(real) == real && std::abs(real) < 16777216.0f) {
      lexer_.warn(start, fmt::format("{} is not an integer, but {} needs one; read as {}",
                                     describe(found), name, real));
      out = static_cast<Scalar>(real);
      return true;
    }
  }
  if (faults_ > 0) return false;
  return failFound(found, fmt::format("a{} {} of {}", std::is_integral_v<Scalar> ? "n" : "",
                                      std::is_integral_v<Scalar> ? "integer"
                                      : isWhole(type)            ? "number"
                                                                 : "component",
                                      name));
}

// Reads a colour as pages write it, #FF0000. No encoding of X3D has it, but nothing else is meant.
bool ValueParser::htmlColor(Color& out) {
  const char* const start = lexer_.skipSpace(lexer_.cursor());
  const std::string_view rest(start, size_t(lexer_.end() - start));
  uint32_t bits = 0;
  const bool is = rest.size() >= 7 && rest[0] == '#' &&
                  std::from_chars(start + 1, start + 7, bits, 16).ptr == start + 7 &&
                  (rest.size() == 7 || isVrmlSpace(rest[7]));
  if (!is) return false;
  const auto part = [bits](int shift) { return float(bits >> shift & 255) / 255; };
  out = {part(16), part(8), part(0)};
  lexer_.error(start,
               fmt::format("'{}' is a colour as HTML writes it: X3D writes {} {} {}; read so",
                           rest.substr(0, 7), out.r, out.g, out.b));
  lexer_.seek(start + 7);
  return true;
}

// One or several numbers.
template <Numeric T> bool ValueParser::single(T& out) {
  const char* p = lexer_.cursor();
  if constexpr (std::is_same_v<T, Color>) {
    if (wholeText_ && htmlColor(out)) return true;
  }
  auto* components = numbersOf(out);
  for (int i = 0; i < numberCount<T>; ++i) {
    p = lexer_.skipSpace(p);
    if (!scalar(p, components[i], fieldTypeOf<T>)) return false;
  }
  lexer_.seek(p);
  return true;
}

// sfboolValue ::= TRUE | FALSE
bool ValueParser::single(bool& out) {
  const Token token = lexer_.peek();
  if (token.is("TRUE") || token.is("FALSE")) {
    out = token.text == "TRUE";
  } else if (token.is("true") || token.is("false")) {
    out = token.text == "true";
    if (!lowerCase_)
      lexer_.warn(token.at(),
                  fmt::format("SFBool is written {} in VRML97", out ? "TRUE" : "FALSE"));
  } else {
    return failFound(token, "TRUE or FALSE of SFBool");
  }
  lexer_.next();
  return true;
}

// sfstringValue ::= string
bool ValueParser::single(std::string& out) {
  const Token token = lexer_.peek();
  if (!token.is(TokenKind::string)) return failFound(token, "a string in double quotes");
  lexer_.next();
  if (token.text.size() > limits_.stringBytes) {
    return fail(token.at(), fmt::format("string of {} bytes: more than limit stringBytes={}",
                                        token.text.size(), limits_.stringBytes));
  }
  if (token.text.size() > 2 * sizeof(std::string) && !take(token.at(), token.text.size()))
    return false;
  out = unescape(token.text);
  return true;
}

// sfimageValue ::= int32 int32 int32 ...: width, height, components, then one number per pixel
// (clause 5.5).
bool ValueParser::single(Image& out) {
  const char* start = lexer_.skipSpace(lexer_.cursor());
  int32_t header[3];
  const char* p = start;
  for (int32_t& number : header) {
    p = lexer_.skipSpace(p);
    if (!scalar(p, number, FieldType::SFImage)) return false;
  }
  lexer_.seek(p);
  const auto [width, height, components] = header;
  if (width < 0 || height < 0)
    return fail(
        start, fmt::format("SFImage of {} x {} pixels: sizes must not be negative", width, height));
  if (components < 0 || components > 4)
    return fail(start, fmt::format("SFImage of {} components: expected 0 to 4", components));
  const uint64_t pixels = components > 0 ? uint64_t(width) * uint64_t(height) : 0;
  if (pixels > limits_.imagePixels) {
    return fail(start, fmt::format("SFImage of {} x {} pixels: more than limit imagePixels={}",
                                   width, height, limits_.imagePixels));
  }
  if (!take(start, pixels * uint64_t(components))) return false;
  out = {width, height, components, {}};
  // A pixel takes at least two bytes of text, so a header alone reserves nothing.
  out.pixels.reserve(std::min<uint64_t>(pixels, (lexer_.end() - p) / 2 + 1) * uint64_t(components));
  for (uint64_t i = 0; i < pixels; ++i) {
    p = lexer_.skipSpace(p);
    const char* at = p;
    int32_t number = 0;
    // A 32-bit pixel in decimal does not fit into int32.
    if (readNumber(p, lexer_.end(), number) == NumberError::outOfRange && *at != '-') {
      double real = 0;
      p = at;
      if (readNumber(p, lexer_.end(), real) == NumberError::none && real < 4294967296.0)
        number = static_cast<int32_t>(static_cast<uint32_t>(real));
      else
        p = at;
    }
    if (p == at || !endsNumber(p, lexer_.end())) {
      p = at;
      if (!scalar(p, number, FieldType::SFImage)) return false;
    }
    for (int c = components - 1; c >= 0; --c)
      out.pixels.push_back(static_cast<uint8_t>(static_cast<uint32_t>(number) >> (8 * c)));
  }
  lexer_.seek(p);
  return true;
}

bool ValueParser::single(NodeRef& out) {
  const Token token = lexer_.peek();
  if (!token.is("NULL")) return failFound(token, "NULL");
  lexer_.next();
  out = {};
  return true;
}

// Reserves the vector's capacity. It is extrapolated from the bytes per element so far, so that a
// big array is not copied while it grows.
template <class T>
void ValueParser::reserve(std::vector<T>& out, const char* from, const char* to) {
  const char* close =
      wholeText_ ? lexer_.end()
                 : static_cast<const char*>(std::memchr(to, ']', size_t(lexer_.end() - to)));
  if (!close) close = lexer_.end();
  const double perByte =
      static_cast<double>(out.size()) / static_cast<double>(std::max<ptrdiff_t>(to - from, 1));
  const double rest = perByte * static_cast<double>(close - to) * 1.05;
  out.reserve(out.size() +
              static_cast<size_t>(std::min(rest, static_cast<double>(limits_.arrayElements))) + 16);
}

// mfXValue ::= sfXValue | [ ] | [ sfXValues ]
template <class T> bool ValueParser::multiple(std::vector<T>& out) {
  out.clear();
  if (!lexer_.accept(TokenKind::bracketOpen)) {
    T value{};
    if (!single(value)) return false;
    out.push_back(std::move(value));
    return true;
  }
  if (!elements(out)) return false;
  if (listEnded_ || lexer_.accept(TokenKind::bracketClose)) return true;
  if (!lexer_.peek().is(TokenKind::braceClose)) {
    failFound(lexer_.peek(), "a value or ]");
    return keepsElements_ && lexer_.peek().is(TokenKind::end); // the file ends early
  }
  lexer_.error(lexer_.cursor(),
               "']' is missing before '}'"); // the brace ends the node and its list
  return true;
}

// Reads the values of a list, and reports how many could not be read.
template <class T> bool ValueParser::elements(std::vector<T>& out) {
  faults_ = 0;
  listEnded_ = false;
  const bool good = elementsUpToEnd(out);
  const uint64_t more = std::exchange(faults_, 0);
  if (more > 1)
    lexer_.error(second_, fmt::format("{} more of this list cannot be read; the first one is here",
                                      more - 1));
  return good;
}

// Passes an element that cannot be read. `at`: the token that is wrong. Returns false if the list
// cannot go on.
bool ValueParser::passElement(const char* at) {
  if (!keepsElements_) return false;
  const AfterFault after = passFault(at);
  if (after == AfterFault::unreadable) return false;
  if (after == AfterFault::listEnds) {
    if (faults_ > 0) failFound(lexer_.peek(), "a value or ]"); // it has not been reported
    return listEnded_ = true;
  }
  if (++faults_ == 2) second_ = at;
  return true;
}

// Reads the values of a list up to a bracket or brace, or to the end of the text.
template <class T> bool ValueParser::elementsUpToEnd(std::vector<T>& out) {
  constexpr size_t sample = 1024;
  uint64_t taken = 0; // number of values for which memory has been reserved
  const char* const first = lexer_.cursor();
  const char* p = lexer_.skipSpace(first);
  for (; p < lexer_.end() && *p != ']' && *p != '}'; p = lexer_.skipSpace(p)) {
    T value{};
    const char* start = p;
    if constexpr (Numeric<T>) {
      auto* components = numbersOf(value);
      bool good = true;
      for (int i = 0; i < numberCount<T>; ++i) {
        if (i > 0) p = lexer_.skipSpace(p);
        if (i > 0 && (p < lexer_.end() ? *p == ']' || (keepsElements_ && *p == '}')
                                       : wholeText_ || keepsElements_)) {
          lexer_.seek(p);
          fail(start, fmt::format("{} number{} left over: {} takes {} each", i, i > 1 ? "s" : "",
                                  fieldTypeName(fieldTypeOf<T>), numberCount<T>));
          if (budget_ && keepsElements_) budget_->give((taken - out.size()) * sizeof(T));
          return keepsElements_;
        }
        const char* const at = p;
        if (scalar(p, components[i], fieldTypeOf<T>)) continue;
        if (!passElement(at)) return false;
        p = lexer_.cursor();
        if (listEnded_) break;
        good = false;
      }
      if (listEnded_) break;
      if (!good) markUnreadable(value);
      if (out.size() * numberCount<T> >= limits_.arrayElements) {
        lexer_.seek(p);
        return fail(start, fmt::format("more numbers in one field than limit arrayElements={}",
                                       limits_.arrayElements));
      }
    } else {
      lexer_.seek(p);
      if (!single(value)) {
        if (!passElement(start)) return false;
        p = lexer_.cursor();
        if (listEnded_) break;
        if constexpr (!std::is_same_v<T, bool>) continue;
        value = T{};
      }
      p = lexer_.cursor();
      if (out.size() >= limits_.arrayElements) {
        return fail(start, fmt::format("more values in one field than limit arrayElements={}",
                                       limits_.arrayElements));
      }
    }
    if (out.size() == taken) { // double the reservation, as the vector doubles its capacity
      const uint64_t more = std::max<uint64_t>(taken, 4);
      if (!take(start, more * sizeof(T))) {
        if (budget_) budget_->give(taken * sizeof(T));
        return false;
      }
      taken += more;
    }
    out.push_back(std::move(value));
    if (out.size() == sample) reserve(out, first, p);
  }
  lexer_.seek(p);
  if (budget_) budget_->give((taken - out.size()) * sizeof(T));
  return true;
}

bool ValueParser::parse(FieldType type, void* storage) {
  return visitStorage(type, storage, [this](auto& value) {
    if constexpr (isList<std::remove_reference_t<decltype(value)>>)
      return multiple(value);
    else
      return single(value);
  });
}

bool ValueParser::parseAll(FieldType type, void* storage) {
  wholeText_ = true;
  const bool good = visitStorage(type, storage, [this](auto& value) {
    if constexpr (isList<std::remove_reference_t<decltype(value)>>) {
      value.clear();
      return elements(value);
    } else {
      return single(value);
    }
  });
  const bool ended = !good || lexer_.peek().is(TokenKind::end) ||
                     failFound(lexer_.peek(), isMultiple(type) ? "a value or the end of the value"
                                                               : "the end of the value");
  wholeText_ = false;
  return good && ended;
}

bool ValueParser::parse(FieldType type, Value& value) {
  value = defaultValue(type);
  return parse(type, std::visit([](auto& storage) -> void* { return &storage; }, value));
}

std::string unescape(std::string_view token) {
  if (token.size() < 2) return {};
  token = token.substr(1, token.size() - 2);
  std::string text;
  text.reserve(token.size());
  for (size_t i = 0; i < token.size(); ++i) {
    if (token[i] == '\\' && i + 1 < token.size() && (token[i + 1] == '"' || token[i + 1] == '\\'))
      ++i;
    text += token[i];
  }
  return text;
}

} // namespace xvrml
