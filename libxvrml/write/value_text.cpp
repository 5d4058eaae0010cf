// value_text.cpp: parses one value from text, with the lexer and the value parser that read files.
#include "xvrml/value_text.h"

#include <fmt/format.h>

#include "base/value_parser.h"

namespace xvrml {

std::optional<Value> parseValue(FieldType type, std::string_view text, std::string& problem,
                                const Limits& limits) {
  Diagnostics diagnostics;
  Locator locator(text, std::make_shared<const std::string>("value"), diagnostics);
  Lexer lexer(locator);
  Value value = defaultValue(type);
  const bool good = ValueParser(lexer, limits).parse(type, value);
  if (!good || !diagnostics.list().empty()) {
    problem = diagnostics.list().empty() ? fmt::format("no {}", fieldTypeName(type))
                                         : diagnostics.list().front().message;
    return std::nullopt;
  }
  if (const Token rest = lexer.next(); !rest.is(TokenKind::end)) {
    problem =
        fmt::format("expected one {}, found {} behind it", fieldTypeName(type), describe(rest));
    return std::nullopt;
  }
  return value;
}

} // namespace xvrml
