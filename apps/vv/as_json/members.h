// members.h: Takes the members of JSON objects one by one, and reads their values. CommandError
// says where something is wrong, and what was expected. `where` names the place of a value, such as
// "set: values[1]". [any thread]
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "as_json/json_line.h"
#include "as_json/node_name.h"

namespace vv::json {

[[noreturn]] void refuse(const std::string& where, const std::string& expected, const Json& got);

// Returns "; did you mean NAME?" for the known name that is nearest, or "" if none is near.
std::string nearTo(const std::string& name, const std::vector<std::string>& known);

// Reads a text. Whatever it is shown or written in would cut it off at a zero byte.
std::string textOf(const std::string& where, const Json& json);
// Reads a text that is not empty.
std::string nameOf(const std::string& where, const Json& json);
bool switchOf(const std::string& where, const Json& json);
int wholeNumberOf(const std::string& where, const Json& json, int least, int most);
// Reads a number from `least` to `most`. expected: what it is, for the message.
double numberOf(const std::string& where, const Json& json, const char* expected, double least,
                double most);
NodeName nodeOf(const std::string& where, const Json& json);
// Reads the path of a file. The system would cut it off at a zero byte.
std::string pathOf(const std::string& where, const Json& json);
// Read one path or text, or an array of them.
std::vector<std::string> pathsOf(const std::string& where, const Json& json);
std::vector<std::string> textsOf(const std::string& where, const Json& json);

template <class T, class Read>
std::vector<T> listOf(const std::string& where, const Json& json, const Read& read) {
  if (!json.is_array()) refuse(where, "an array", json);
  std::vector<T> list;
  for (size_t i = 0; i < json.size(); ++i)
    list.push_back(read(fmt::format("{}[{}]", where, i), json[i]));
  return list;
}

// The members of an object. rest() refuses those that nobody has asked for.
class Members {
 public:
  // Throws CommandError if it is no object.
  Members(std::string where, Json object);

  bool has(const char* name);
  // Throws if the member is missing.
  Json& need(const char* name);
  std::string at(const char* name) const { return fmt::format("{}: {}", where_, name); }
  FieldName field();
  std::string text(const char* name) { return textOf(at(name), need(name)); }
  Json& object() { return object_; }
  void rest();

 private:
  std::string where_;
  Json object_;
  std::vector<std::string> known_;
};

} // namespace vv::json
