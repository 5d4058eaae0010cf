#include "server/texts.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "as_json/json_line.h"
#include "edit/actions.h"
#include "edit/properties.h"
#include "lower_case.h"
#include "options/names.h"
#include "report/describe.h"
#include "server/edit_texts.h"
#include "server/limits.h"
#include "session/input/editor_keys.h"
#include "session/input/keys.h"

namespace vv::server {

namespace {

using json::Json;
using json::jsonLine;

std::string_view nameOf(Page::Role role) {
  return role == Page::Role::leader ? "leader" : role == Page::Role::own ? "own" : "follower";
}

std::string nameOf(const xvrml::ViewpointName& viewpoint, size_t number) {
  return !viewpoint.description.empty() ? viewpoint.description
         : !viewpoint.name.empty()      ? viewpoint.name
                                        : fmt::format("viewpoint {}", number);
}

} // namespace

std::string helloText() {
  Json keys = Json::array(), mouse = Json::array();
  // Pages do not end vv, and they have no legend of false colours.
  for (const KeyInfo& key : keyTable())
    if (key.action != Action::quit && key.action != Action::falseColours)
      keys.push_back({key.keys, key.text});
  for (const MouseInfo& one : mouseTable()) mouse.push_back({one.what, one.text});
  return jsonLine({{"type", "hello"}, {"version", version()}, {"keys", keys}, {"mouse", mouse}});
}

std::string editorText() {
  Json kinds = Json::array(), keys = Json::array();
  for (const NewNode& one : newNodes()) kinds.push_back(one.name);
  kinds.push_back(edit::viewpointKind);
  for (const auto& one : editorTable())
    if (!one.isOfWindow) keys.push_back({one.what, one.text});
  return jsonLine({{"type", "editor"},
                   {"kinds", kinds},
                   {"keys", keys},
                   {"mostBytes", maxEditBytes},
                   {"mostRows", maxRowsShown},
                   {"mostElements", PropertySheet::mostElements},
                   {"mostFileBytes", maxImportBytes}});
}

std::string stateText(const PageState& state) {
  return jsonLine({{"type", "state"},
                   {"world", state.world},
                   {"role", nameOf(state.role)},
                   {"pages", state.pages},
                   {"viewpoint", state.viewpoint},
                   {"hand", state.hand},
                   {"bottom", state.bottom},
                   {"facts", state.facts},
                   {"keys", state.keys}});
}

std::string viewpointsText(const std::vector<xvrml::ViewpointName>& viewpoints) {
  Json list = Json::array();
  for (const xvrml::ViewpointName& one : viewpoints) list.push_back(nameOf(one, list.size()));
  return jsonLine({{"type", "viewpoints"}, {"list", list}});
}

std::string commandText(const std::string& line) {
  return jsonLine({{"type", "command"}, {"text", line}});
}

std::string savedText(const std::string& path, const std::string& name) {
  return jsonLine({{"type", "saved"}, {"path", path}, {"name", name}});
}

std::string openText(const std::string& url) { return jsonLine({{"type", "open"}, {"url", url}}); }

std::string pictureMessage(uint32_t number, const picture::LivePicture& facts, int wanted,
                           std::string_view jpeg) {
  const bool still = facts.purpose == picture::LiveFrame::Purpose::still;
  const std::string header = jsonLine({{"picture", number},
                                       {"width", facts.shownWidth},
                                       {"height", facts.shownHeight},
                                       {"samples", facts.samples},
                                       {"wanted", still ? wanted : 0},
                                       {"preview", facts.preview},
                                       {"finished", still && facts.finished}});
  std::string message;
  message.reserve(4 + header.size() + jpeg.size());
  for (int i = 0; i < 4; ++i) message += char(header.size() >> (8 * i) & 255);
  message += header;
  message += jpeg;
  return message;
}

std::string downloadName(const std::string& world, const std::string& end) {
  const std::string name = fileNamePart(std::filesystem::path(world).stem().string());
  return (name.empty() || name == "-" ? "vv" : name) + end;
}

std::string webUrlOf(std::span<const std::string> urls) {
  for (const std::string& url : urls)
    if (beginsWithoutCase(url, "http://") || beginsWithoutCase(url, "https://")) return url;
  return {};
}

} // namespace vv::server
