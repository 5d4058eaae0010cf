#include "as_json/json_line.h"

#include <set>
#include <vector>

#include <fmt/format.h>

namespace vv::json {

namespace {

// Counts what the parser finds, so that a line cannot take much more memory than its own size. It
// goes before the parser that makes values, because that one searches the whole list behind each
// object if it has to ask somebody.
class Watch : public nlohmann::json_sax<Json> {
 public:
  explicit Watch(const LineLimits& limits) : limits_(limits) {}

  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return false; } // JSON has none
  bool start_object(size_t) override { return open(); }
  bool start_array(size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    if (!names_.back().insert(name).second)
      throw CommandError("syntax",
                         fmt::format("the member {} is there twice", shownJson(Json(name))));
    return count();
  }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false; // the other parser says it
  }

 private:
  bool count() {
    if (++values_ > limits_.lineValues)
      throw CommandError(
          "limit", fmt::format("the line has more than lineValues={} values", limits_.lineValues));
    return true;
  }
  bool open() {
    if (names_.size() >= limits_.lineDepth)
      throw CommandError("limit", fmt::format("the line has more than lineDepth={} arrays and "
                                              "objects within each other",
                                              limits_.lineDepth));
    names_.emplace_back();
    return count();
  }
  bool close() {
    names_.pop_back();
    return true;
  }

  const LineLimits& limits_;
  size_t values_ = 0;
  std::vector<std::set<std::string>> names_; // names in objects around, and none in arrays
};

} // namespace

Json readJsonLine(std::string_view line, const LineLimits& allowed) {
  if (line.size() > allowed.lineBytes)
    throw CommandError(
        "limit", fmt::format("the line is longer than lineBytes={} bytes", allowed.lineBytes));
  Watch watch(allowed);
  Json json;
  try {
    Json::sax_parse(line, &watch);
    json = Json::parse(line);
  } catch (const nlohmann::detail::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error ..."
    std::string_view why = error.what();
    if (const size_t end = why.find("] "); end != why.npos) why.remove_prefix(end + 2);
    throw CommandError("syntax", fmt::format("the line is not JSON: {}", why.substr(0, 300)));
  }
  if (!json.is_object())
    throw CommandError("syntax",
                       fmt::format("a JSON object was expected, not {}", shownJson(json)));
  return json;
}

std::string jsonLine(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string jsonText(std::string_view text) { return jsonLine(Json(text)); }

std::string shownJson(const Json& value) {
  constexpr size_t most = 60;
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_object()) return "an object";
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > most) text = text.substr(0, most) + "...";
  return text;
}

} // namespace vv::json
