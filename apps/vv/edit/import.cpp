#include "edit/import.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "edit/actions.h"
#include "edit/node_fields.h"

namespace vv {

using namespace xvrml;
namespace fs = std::filesystem;

namespace {

// Returns a path that does not depend on what relative ones count from.
fs::path pathOf(const World& world, const std::string& file) {
  const char* const home = std::getenv("HOME");
  if (home && file.starts_with("~/")) return fs::path(home) / file.substr(2);
  return fs::path(world.path).parent_path() / file; // an absolute one replaces the folder
}

// Returns the name of a file as one that a node can have, with a number if another node has it.
std::string nameFor(const World& world, const fs::path& file) {
  constexpr size_t longest = 64;
  std::string name = file.stem().string().substr(0, longest);
  for (char& c : name) {
    const bool isPlain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                         (c >= 'a' && c <= 'z') || c == '_' || c == '-';
    if (!isPlain) c = '_';
  }
  if (name.empty() || name[0] == '-' || (name[0] >= '0' && name[0] <= '9')) name.insert(0, "_");
  std::string fresh = name;
  for (int i = 2; world.scope.names.contains(fresh); ++i) fresh = fmt::format("{}_{}", name, i);
  return fresh;
}

// Returns whether an Inline has anything to show. A file that is broken from its beginning gives
// content without nodes.
bool showsSomething(const Node& made) {
  const Scope* const content = inlineScope(made);
  return content && std::any_of(content->roots.begin(), content->roots.end(),
                                [](const NodeRef& root) { return bool(root); });
}

// Returns why the file of an Inline has not been read: the last of the messages since there were
// `before`.
std::string whyEmpty(const World& world, size_t before) {
  const std::vector<Diagnostic>& messages = world.diagnostics.list();
  return messages.size() > before ? messages.back().message : "it holds nothing that can be shown";
}

} // namespace

void importFile(WorldEditor& editor, const std::string& file) {
  const World& world = editor.browser().world();
  if (const std::string why = editor.editor().whyReadOnly(); !why.empty()) throw EditError(why);
  const fs::path path = pathOf(world, file);
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw EditError(fmt::format("there is no file {}", path.string()));
  if (fs::equivalent(path, world.path, error))
    throw EditError("a world cannot be a part of itself");
  const std::string name = nameFor(world, path);
  const size_t before = world.diagnostics.list().size();
  NodeRef made;
  editor.step(fmt::format("Import {}", name), [&] {
    made = insertNew(editor, placeForNew(editor), "Inline");
    // The world loads the content of an Inline when its URL is set.
    editor.editor().set(*made, "url", MFString{relativeUrl(path.string(), world.path)});
    if (!showsSomething(*made))
      throw EditError(
          fmt::format("{} is not imported: {}", path.string(), whyEmpty(world, before)));
    editor.editor().rename(*made, name);
  });
  editor.select({made});
}

} // namespace vv
