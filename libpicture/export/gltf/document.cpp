#include "libpicture/export/gltf/document.h"

#include <numbers>

#include <fmt/format.h>

#include "openrt/openrt.h"

namespace picture::gltf {

std::string textOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

size_t Document::add(const std::string& name, const Json& object) {
  List& list = lists_[name];
  if (list.count > 0) list.text += ',';
  list.text += textOf(object);
  return list.count++;
}

size_t Document::countOf(const std::string& name) const {
  const auto found = lists_.find(name);
  return found == lists_.end() ? 0 : found->second.count;
}

void Document::addExtension(const std::string& name, Json content) {
  use(name);
  extensions_[name] = std::move(content);
}

size_t Document::addBytes(std::string bytes, Target target) {
  Json view = {{"buffer", 0}, {"byteOffset", bufferBytes_}, {"byteLength", bytes.size()}};
  if (target != noTarget) view["target"] = int(target);
  bytes.resize((bytes.size() + 3) / 4 * 4);
  bufferBytes_ += bytes.size();
  buffer_.push_back(std::move(bytes));
  return add("bufferViews", view);
}

size_t Document::add(Elements elements) {
  Json accessor = {{"componentType", int(elements.component)},
                   {"count", elements.count},
                   {"type", elements.type}};
  if (elements.normalized) accessor["normalized"] = true;
  if (!elements.minimum.empty()) accessor["min"] = elements.minimum;
  if (!elements.maximum.empty()) accessor["max"] = elements.maximum;
  accessor["bufferView"] = addBytes(std::move(elements.bytes), elements.target);
  return add("accessors", accessor);
}

void Document::turnZUp() {
  if (roots_.empty()) return;
  constexpr double half = std::numbers::sqrt2 / 2; // sine and cosine for a quarter turn
  roots_ = {
      add("nodes", {{"name", "ZUp"}, {"rotation", {-half, 0.0, 0.0, half}}, {"children", roots_}})};
}

// A list without objects may not be there (glTF 2.0, 5.17).
std::string Document::text(const std::string& bufferUri) const {
  std::string out = fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"vv {}.{}.{}"}},"scene":0,"scenes":[{}])",
      OPENRT_VERSION_MAJOR, OPENRT_VERSION_MINOR, OPENRT_VERSION_PATCH,
      roots_.empty() ? "{}" : fmt::format(R"({{"nodes":[{}]}})", fmt::join(roots_, ",")));
  if (bufferBytes_ > 0) {
    Json buffer = {{"byteLength", bufferBytes_}};
    if (!bufferUri.empty()) buffer["uri"] = bufferUri;
    out += ",\"buffers\":[" + textOf(buffer) + "]";
  }
  for (const auto& [name, list] : lists_) out += ",\"" + name + "\":[" + list.text + "]";
  if (!used_.empty()) out += ",\"extensionsUsed\":" + textOf(Json(used_));
  if (!extensions_.empty()) out += ",\"extensions\":" + textOf(Json(extensions_));
  return out + "}";
}

} // namespace picture::gltf
