#include "describe.h"

#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "libpicture/walk.h"
#include "openrt/openrt.h"
#include "xvrml/numbers.h"

namespace vv {

namespace {

using namespace xvrml;

std::string text(bool v) { return v ? "TRUE" : "FALSE"; }
template <Numeric T> std::string text(const T& v) {
  const auto* numbers = numbersOf(v);
  return fmt::format("{}", fmt::join(numbers, numbers + numberCount<T>, " "));
}
std::string text(const NodeRef& v) { return v ? v->type().name + " { }" : "NULL"; }
std::string text(const Image& v) {
  std::string out = fmt::format("{} {} {}", v.width, v.height, v.components);
  for (size_t i = 0; v.components > 0 && i + size_t(v.components) <= v.pixels.size();
       i += size_t(v.components)) {
    out += " 0x";
    for (size_t c = 0; c < size_t(v.components); ++c) out += fmt::format("{:02X}", v.pixels[i + c]);
  }
  return out;
}
std::string text(const std::string& v) {
  std::string out = "\"";
  for (char c : v) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}
template <class T> std::string text(const std::vector<T>& list) {
  std::string out = "[";
  for (const auto& v : list)
    out += (out.size() > 1 ? ", " : "") + text(ElementOf<std::vector<T>>(v));
  return out + "]";
}

using picture::walkInto;

void nothing(const Scope&) {}

} // namespace

std::string version() {
  return fmt::format("{}.{}.{}", OPENRT_VERSION_MAJOR, OPENRT_VERSION_MINOR, OPENRT_VERSION_PATCH);
}

std::string valueText(const Value& value) {
  return std::visit([](const auto& v) { return text(v); }, value);
}

std::string counted(uint64_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string oneLine(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\t' || c == '\r') c = ' ';
  return text;
}

void forEachNode(const World& world, const std::function<void(const Node& node)>& visit) {
  walkInto(world.scope, visit, nothing);
}

void forEachNodeBelow(const Node& node, const std::function<void(const Node& node)>& visit) {
  walkInto(picture::NodeList{&node}, visit, nothing);
}

std::string scriptProtocol(const std::vector<std::string>& urls) {
  if (urls.empty()) return "none";
  const std::string& url = urls[0];
  size_t start = url.find_first_not_of(" \t\r\n");
  start = start == url.npos ? url.size() : start;
  size_t end = start;
  while (end < url.size() &&
         (std::isalnum(static_cast<unsigned char>(url[end])) || url[end] == '+' || url[end] == '-'))
    ++end;
  std::string scheme = url.substr(start, end - start);
  for (char& c : scheme)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  const bool place = scheme == "http" || scheme == "https" || scheme == "ftp" || scheme == "file" ||
                     scheme == "urn";
  if (end < url.size() && url[end] == ':' && end > start && !place) return scheme;
  static const std::pair<std::string_view, const char*> suffixes[] = {
      {".js", "javascript"}, {".class", "java"}, {".jar", "java"},
      {".vs", "vrmlscript"}, {".tcl", "tcl"},    {".py", "python"}};
  for (const auto& [suffix, protocol] : suffixes)
    if (url.ends_with(suffix)) return protocol;
  return "file";
}

namespace {

void countScript(const Node& node, std::map<std::string, uint64_t>& scripts) {
  if (!nodeCast<ScriptNode>(&node)) return;
  if (const FieldInfo* url = node.type().find("url"))
    ++scripts[scriptProtocol(*static_cast<const MFString*>(node.storage(*url)))];
}

// Counts the bodies of prototypes, including prototypes declared inside them.
void countDeclared(const Scope& scope, WorldCounts& counts) {
  const auto count = [&](const Node& node) { countScript(node, counts.declaredScripts); };
  std::vector<const Scope*> open{&scope};
  while (!open.empty()) {
    const Scope& next = *open.back();
    open.pop_back();
    for (const ProtoPtr& prototype : next.prototypes) {
      open.push_back(&prototype->body);
      walkInto(prototype->body, count, nothing);
    }
  }
}

} // namespace

WorldCounts countWorld(const World& world) {
  WorldCounts counts;
  const auto count = [&](const Node& node) {
    ++counts.types[node.type().name];
    countScript(node, counts.scripts);
  };
  walkInto(world.scope, count, [&](const Scope& scope) { counts.routes += scope.routes.size(); });
  countDeclared(world.scope, counts);
  for (const ProtoPtr& prototype : world.scope.prototypes)
    counts.prototypes.push_back(prototype->type->name);
  for (const auto& [name, node] : world.scope.names) counts.names.push_back(name);
  return counts;
}

std::string headText(const xvrml::FileHead& head) {
  const xvrml::Encoding encoding = head.version.encoding;
  std::string text = fmt::format("file        {}", encodingName(encoding));
  if (isMesh(encoding)) text += ", read as X3D";
  if (encoding != xvrml::Encoding::vrml1) // its name says the version
    text += fmt::format(" {}.{}", head.version.major, head.version.minor);
  text += head.profile.empty() ? "\n" : fmt::format(", profile {}\n", head.profile);
  for (const auto& one : head.components)
    text += fmt::format("component   {}:{}\n", one.name, one.level);
  for (const auto& one : head.units)
    text += fmt::format("unit        {} {} {}\n", one.category, one.name, one.factor);
  for (const auto& one : head.meta)
    text += fmt::format("meta        {}: {}\n", oneLine(one.name), oneLine(one.content));
  return text;
}

} // namespace vv
