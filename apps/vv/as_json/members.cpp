#include "as_json/members.h"

#include <algorithm>
#include <utility>

#include "nearest.h"

namespace vv::json {

void refuse(const std::string& where, const std::string& expected, const Json& got) {
  throw CommandError("command",
                     fmt::format("{}: {} was expected, not {}", where, expected, shownJson(got)));
}

std::string nearTo(const std::string& name, const std::vector<std::string>& known) {
  constexpr size_t longest = 64; // the search takes time that grows with the name
  const std::string near = name.size() > longest ? "" : nearest::word(name, known);
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

std::string shownNode(const NodeName& name) {
  if (const auto* number = std::get_if<uint64_t>(&name)) return fmt::format("node {}", *number);
  return "node " + shownJson(std::get<std::string>(name));
}

// --- Values ---

std::string textOf(const std::string& where, const Json& json) {
  if (!json.is_string()) refuse(where, "a text", json);
  std::string text = json.get<std::string>();
  if (text.find('\0') != text.npos) refuse(where, "a text without zero bytes", json);
  return text;
}

std::string nameOf(const std::string& where, const Json& json) {
  if (!json.is_string() || json.get_ref<const std::string&>().empty())
    refuse(where, "a name", json);
  return textOf(where, json);
}

bool switchOf(const std::string& where, const Json& json) {
  if (!json.is_boolean()) refuse(where, "true or false", json);
  return json.get<bool>();
}

int wholeNumberOf(const std::string& where, const Json& json, int least, int most) {
  if (!json.is_number_integer() || json < least || json > most)
    refuse(where, fmt::format("a whole number from {} to {}", least, most), json);
  return json.get<int>();
}

double numberOf(const std::string& where, const Json& json, const char* expected, double least,
                double most) {
  if (!json.is_number() || !(json.get<double>() >= least && json.get<double>() <= most))
    refuse(where, fmt::format("{} from {} to {}", expected, least, most), json);
  return json.get<double>();
}

NodeName nodeOf(const std::string& where, const Json& json) {
  if (json.is_number_unsigned()) return json.get<uint64_t>();
  if (json.is_string()) return json.get<std::string>();
  refuse(where, "the DEF name or the number of a node", json);
}

std::string pathOf(const std::string& where, const Json& json) {
  if (!json.is_string()) refuse(where, "a text", json);
  std::string path = json.get<std::string>();
  if (path.empty() || path.find('\0') != path.npos) refuse(where, "the path of a file", json);
  return path;
}

std::vector<std::string> pathsOf(const std::string& where, const Json& json) {
  if (json.is_string()) return {pathOf(where, json)};
  return listOf<std::string>(where, json, pathOf);
}

std::vector<std::string> textsOf(const std::string& where, const Json& json) {
  if (json.is_string()) return {textOf(where, json)};
  return listOf<std::string>(where, json, textOf);
}

// --- Members ---

Members::Members(std::string where, Json object)
    : where_(std::move(where)), object_(std::move(object)) {
  if (!object_.is_object()) refuse(where_, "an object", object_);
}

bool Members::has(const char* name) {
  known_.emplace_back(name);
  return object_.contains(name);
}

Json& Members::need(const char* name) {
  if (!has(name))
    throw CommandError("command", fmt::format("{}: the member \"{}\" is missing", where_, name));
  return object_[name];
}

FieldName Members::field() {
  return {nodeOf(at("node"), need("node")), textOf(at("field"), need("field"))};
}

void Members::rest() {
  for (const auto& [name, value] : object_.items())
    if (std::find(known_.begin(), known_.end(), name) == known_.end())
      throw CommandError("command", fmt::format("{}: there is no member {}{}", where_,
                                                shownJson(name), nearTo(name, known_)));
}

} // namespace vv::json
