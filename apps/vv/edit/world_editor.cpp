#include "edit/world_editor.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "libpicture/files/save_edits.h"
#include "xvrml/versions.h"

namespace vv {

using namespace xvrml;

namespace {

std::atomic<int> readers{0}; // threads that read files

bool allStand(const Editor& editor, const MFNode& nodes) {
  return std::all_of(nodes.begin(), nodes.end(),
                     [&editor](const NodeRef& node) { return editor.stands(*node); });
}

} // namespace

bool WorldEditor::prepare() {
  constexpr uintmax_t small = 256 << 10; // bytes, which are read in some hundredths of a second
  if (std::function<void()> read = editor_.preparation()) {
    std::error_code none;
    if (std::filesystem::file_size(browser_.world().path, none) < small) {
      read();
      return true;
    }
    ++readers;
    try {
      std::thread([read = std::move(read)]() mutable {
        read();
        read = nullptr; // forgets a file that nobody edits any more, before the process may end
        --readers;
      }).detach();
    } catch (const std::system_error&) { --readers; } // the first edit reads it
  }
  return !editor_.isPreparing();
}

bool WorldEditor::isReading() { return readers > 0; }

const std::vector<picture::ShaderClass>& WorldEditor::shaderClasses() {
  if (!shaderClasses_) {
    shaderClasses_.emplace();
    std::vector<std::string> problems; // vv --list-shaders says them
    try {
      shaderClasses_ = picture::installedShaders(shaderPath_, problems);
    } catch (const std::runtime_error&) {} // there are no classes then
  }
  return *shaderClasses_;
}

void WorldEditor::select(MFNode nodes) {
  constexpr size_t mostKept = 64;
  if (nodes == selection_) return;
  earlier_.push_back(std::exchange(selection_, std::move(nodes)));
  if (earlier_.size() > mostKept) earlier_.pop_front();
}

void WorldEditor::choose(const NodeRef& node, bool add) {
  MFNode nodes = add ? selection_ : MFNode();
  const auto known = std::find(nodes.begin(), nodes.end(), node);
  if (known != nodes.end())
    nodes.erase(known);
  else if (node)
    nodes.push_back(node);
  select(std::move(nodes));
}

void WorldEditor::step(const std::string& name, const std::function<void()>& edits) {
  editor_.begin(name);
  try {
    edits();
  } catch (...) {
    editor_.cancel();
    throw;
  }
  editor_.end();
}

NodeSlot WorldEditor::placeOf(const Node& node, const Accepts& accepts) {
  std::vector<NodeSlot> places = editor_.placesOf(node);
  if (accepts) std::erase_if(places, [&](const NodeSlot& place) { return !accepts(place); });
  if (places.size() == 1) return places.front();
  if (places.empty() && !accepts && editor_.stands(node))
    throw EditError(fmt::format("a Script has taken this {} out of the world; its values can be "
                                "edited, its place once the world is loaded again",
                                node.type().name));
  throw EditError(places.empty()
                      ? fmt::format("this {} does not stand {}", node.type().name,
                                    accepts ? "there" : "in the world's own file")
                      : fmt::format("this {} stands in {} places: say which one is meant",
                                    node.type().name, places.size()));
}

NodeSlot WorldEditor::endOf(Node* parent, const std::string& field) const {
  if (!parent) return {nullptr, "", browser_.world().scope.roots.size()};
  const FieldInfo* info = findField(*parent, field);
  const bool isList = info && info->type == FieldType::MFNode && holdsValue(*info);
  return {parent, std::string(ownName(*parent, field)),
          isList ? static_cast<const MFNode*>(parent->storage(*info))->size() : 0};
}

std::string WorldEditor::undo() {
  const std::string name = editor_.undoName();
  const bool stood = allStand(editor_, selection_);
  if (!editor_.undo()) return {};
  if (!stood) return name; // it has been removed before, or is in no file
  while (!allStand(editor_, selection_) && !earlier_.empty()) {
    selection_ = std::move(earlier_.back());
    earlier_.pop_back();
  }
  return name;
}

std::string WorldEditor::redo() {
  const std::string name = editor_.redoName();
  return editor_.redo() ? name : std::string();
}

void WorldEditor::save(const std::string& path, bool overwrite) {
  picture::saveEdits(editor_, browser_.world(), path, overwrite);
  journal_.settle();
  ++saves_;
}

} // namespace vv
