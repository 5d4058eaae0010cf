// json_text.h: How reports write JSON. [any thread]
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "printable.h"

namespace vv {

using Json = nlohmann::ordered_json;

// Returns JSON as lines of text. Names may contain bytes that are not UTF-8; they become the
// replacement character.
inline std::string dump(const Json& json) {
  return printableJson(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

} // namespace vv
