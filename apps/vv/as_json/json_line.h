// json_line.h: Reads one line of text as JSON, within limits, and quotes texts. [any thread]
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace vv::json {

using Json = nlohmann::json;

// Bounds the cost of a line that somebody else has written.
struct LineLimits {
  size_t lineBytes = size_t(32) << 20; // bytes of one line
  size_t lineDepth = 32;               // arrays and objects within each other in a line
  size_t lineValues = 2'000'000;       // values of one line
};

// Why a line cannot be obeyed. The codes are listed in docs/control.md.
struct CommandError : std::runtime_error {
  CommandError(std::string errorCode, const std::string& message)
      : runtime_error(message), code(std::move(errorCode)) {}
  std::string code; // "syntax", "command", "node", "field", "value", "limit", ...
};

// Reads a line that holds one JSON object. Throws CommandError: "syntax" if it is no JSON, holds
// text that is not UTF-8 or a number beyond the range of a double, or if an object has a member
// twice; "limit" if it is too deep or has too many values.
Json readJsonLine(std::string_view line, const LineLimits& allowed);

// Returns a value in one line. Bytes of texts that are not UTF-8 become U+FFFD.
std::string jsonLine(const Json& value);
// Does the same for a text, which becomes a JSON string.
std::string jsonText(std::string_view text);

// Returns the beginning of a value, for messages.
std::string shownJson(const Json& value);

} // namespace vv::json
