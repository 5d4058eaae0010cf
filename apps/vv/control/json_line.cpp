#include "control/json_line.h"

#include <set>
#include <vector>

#include <fmt/format.h>

namespace vv::control {

namespace {

// Counts what the parser finds, so that a line cannot take much more memory than its own size.
class Watch {
 public:
  explicit Watch(const Limits& limits) : limits_(limits) {}

  bool see(int depth, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start) {
      if (size_t(depth) >= limits_.lineDepth)
        throw CommandError("limit", fmt::format("the line has more than lineDepth={} arrays and "
                                                "objects within each other",
                                                limits_.lineDepth));
      if (event == Event::object_start) names_.emplace_back();
    }
    if (event == Event::object_end) names_.pop_back();
    if (event == Event::key && !names_.back().insert(parsed.get_ref<const std::string&>()).second)
      throw CommandError("syntax", fmt::format("the member {} is there twice", shownJson(parsed)));
    if (event != Event::object_end && event != Event::array_end && ++values_ > limits_.lineValues)
      throw CommandError(
          "limit", fmt::format("the line has more than lineValues={} values", limits_.lineValues));
    return true;
  }

 private:
  const Limits& limits_;
  size_t values_ = 0;
  std::vector<std::set<std::string>> names_; // of the objects that are open
};

} // namespace

Json readJsonLine(std::string_view line, const Limits& allowed) {
  if (line.size() > allowed.lineBytes)
    throw CommandError(
        "limit", fmt::format("the line is longer than lineBytes={} bytes", allowed.lineBytes));
  Watch watch(allowed);
  Json json;
  try {
    json = Json::parse(line, [&](int depth, Json::parse_event_t event, Json& parsed) {
      return watch.see(depth, event, parsed);
    });
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

std::string jsonText(std::string_view text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string shownJson(const Json& value) {
  constexpr size_t most = 60;
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_object()) return "an object";
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > most) text = text.substr(0, most) + "...";
  return text;
}

} // namespace vv::control
