#include "feature_list.h"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "libpicture/features.h"
#include "printable.h"
#include "server/server.h"
#include "window/window.h"

namespace vv {

namespace {

using Json = nlohmann::ordered_json;
using picture::Feature;

// library: the one that provides it, with its version; "": it is missing.
Feature built(const char* name, const char* text, const std::string& library, const char* how) {
  return {name, text, !library.empty(), library, "", library.empty() ? how : ""};
}

// Returns the rows in the order of the list: what all programs have, and what vv has.
std::vector<Feature> rowsOf(const std::string& scriptPath) {
  std::vector<Feature> rows = picture::listFeatures(scriptPath);
  rows.push_back(built("window", "the window", windowLibrary(),
                       "build with SDL 2 (Debian: libsdl2-dev); -o makes pictures without it"));
  rows.push_back(built("edit", "vv edit, which changes a world and keeps its file", editorLibrary(),
                       "build with Dear ImGui (Debian: libimgui-dev)"));
  rows.push_back(built("serve", "vv serve, which shows a world on a page", serverLibrary(),
                       "build with libwebsockets 4.1 or newer (Debian: libwebsockets-dev)"));
  return rows;
}

} // namespace

std::string listFeatures(const std::string& scriptPath, bool json) {
  Json list = Json::array();
  std::string text;
  for (const Feature& row : rowsOf(scriptPath)) {
    list.push_back({{"name", row.name},
                    {"text", row.text},
                    {"available", row.available},
                    {"detail", row.detail},
                    {"file", row.file},
                    {"how", row.how}});
    text += fmt::format("{:<11} {:<4} {}\n", row.name, row.available ? "yes" : "no", row.text);
    for (const auto& [head, value] : {std::pair("", &row.detail), std::pair("library: ", &row.file),
                                      std::pair("to get it: ", &row.how)})
      if (!value->empty()) text += fmt::format("{:17}{}{}\n", "", head, printable(*value));
  }
  if (json)
    return printableJson(Json({{"features", std::move(list)}})
                             .dump(2, ' ', false, Json::error_handler_t::replace)) +
           "\n";
  return text;
}

} // namespace vv
