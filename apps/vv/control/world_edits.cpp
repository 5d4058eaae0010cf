// world_edits.cpp: the commands that edit the file of the world, and those about its selection.
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "control/field_json.h"
#include "control/fields.h"
#include "control/world_commands.h"
#include "run/outputs.h"

namespace vv::control {

using namespace xvrml;

namespace {

// Does the edits of a step, one after the other.
class StepDoer {
 public:
  // find: returns the node with a name. Throws CommandError.
  using Find = std::function<NodeRef(const NodeName& name)>;
  StepDoer(WorldEditor& world, Find find) : world_(world), find_(std::move(find)) {}

  // Throws CommandError and EditError.
  void perform(const edits::Edit& edit) {
    made_.push_back(std::visit([this](const auto& one) { return perform(one); }, edit));
  }
  // Returns the node that each edit has made; null if it makes none.
  const MFNode& made() const { return made_; }

 private:
  Editor& editor() { return world_.editor(); }

  NodeRef nodeOf(const edits::EditedNode& name) const {
    if (const auto* made = std::get_if<edits::Made>(&name)) return made_[made->by];
    if (const auto* number = std::get_if<uint64_t>(&name)) return find_(*number);
    return find_(std::get<std::string>(name));
  }
  NodeRef parentOf(const edits::Place& place) const {
    return place.parent ? nodeOf(*place.parent) : NodeRef();
  }

  NodeSlot targetOf(const edits::Place& place) const {
    const NodeRef parent = parentOf(place);
    if (!place.index) return world_.endOf(parent.get(), place.field);
    return {parent.get(), place.field, *place.index};
  }

  NodeSlot placeOf(const Node& node, const std::optional<edits::Place>& at) const {
    if (!at) return world_.placeOf(node);
    const NodeRef parent = parentOf(*at);
    return world_.placeOf(node, [&](const NodeSlot& place) {
      return place.parent == parent.get() && (at->field.empty() || at->field == place.field) &&
             (!at->index || *at->index == place.index);
    });
  }

  NodeRef perform(const edits::SetField& set) {
    const NodeRef node = nodeOf(set.node);
    const FieldInfo& field = storedField(*node, set.field);
    if (field.type == FieldType::SFNode || field.type == FieldType::MFNode)
      throw EditError(fmt::format("{}.{} holds nodes: insert, move or remove them",
                                  node->type().name, field.name));
    editor().set(*node, field.name, readValue(set.value, *node, field, {}));
    return {};
  }
  NodeRef perform(const edits::Insert& insert) {
    return editor().insert(targetOf(insert.to), insert.vrml);
  }
  NodeRef perform(const edits::Use& use) {
    const NodeRef node = nodeOf(use.node);
    editor().use(targetOf(use.to), *node);
    return {};
  }
  NodeRef perform(const edits::Remove& remove) {
    const NodeRef node = nodeOf(remove.node);
    editor().remove(placeOf(*node, remove.at));
    return {};
  }
  NodeRef perform(const edits::Move& move) {
    const NodeRef node = nodeOf(move.node);
    const NodeSlot from = placeOf(*node, move.at);
    NodeSlot to = targetOf(move.to);
    // The end is counted without the node.
    if (!move.to.index && from.parent == to.parent && from.field == to.field && to.index > 0)
      --to.index;
    editor().move(from, to);
    return {};
  }
  NodeRef perform(const edits::Duplicate& duplicate) {
    const NodeRef node = nodeOf(duplicate.node);
    return editor().duplicate(placeOf(*node, duplicate.at));
  }
  NodeRef perform(const edits::Wrap& wrap) {
    const NodeRef node = nodeOf(wrap.node);
    return editor().wrap(placeOf(*node, wrap.at), wrap.type);
  }
  NodeRef perform(const edits::Rename& rename) {
    const NodeRef node = nodeOf(rename.node);
    editor().rename(*node, rename.name);
    return {};
  }
  NodeRef perform(const edits::Route& route) {
    const NodeRef from = nodeOf(route.from), to = nodeOf(route.to);
    if (route.add)
      editor().addRoute(*from, route.out, *to, route.in);
    else
      editor().removeRoute(*from, route.out, *to, route.in);
    return {};
  }

  WorldEditor& world_;
  const Find find_;
  MFNode made_;
};

// The window may be in the middle of a step, which its user can still take back.
void refuseWithinStep(WorldEditor& world) {
  if (world.editor().isInStep())
    throw EditError("the user is in the middle of an edit; try again when it has ended");
}

std::string nameOrNull(const std::string& name) { return name.empty() ? "null" : jsonText(name); }

} // namespace

std::string WorldCommands::edit(const edits::Step& step) {
  WorldEditor& world = session_.editor();
  refuseWithinStep(world);
  StepDoer doer(world, [this](const NodeName& name) { return nodeOf(name); });
  std::string nodes;
  const auto where = [&] { return fmt::format("edit: edits[{}]: ", doer.made().size()); };
  world.step(step.name, [&] {
    try {
      for (const edits::Edit& one : step.edits) doer.perform(one);
    } catch (const EditError& error) {
      throw EditError(where() + error.what());
    } catch (const CommandError& error) { throw CommandError(error.code, where() + error.what()); }
    nodes = valueText(doer.made());
  });
  return fmt::format(R"({{"nodes":{}}})", nodes);
}

std::string WorldCommands::undo(const Undo& undo) {
  refuseWithinStep(session_.editor());
  return nameOrNull(undo.again ? session_.editor().redo() : session_.editor().undo());
}

std::string WorldCommands::save(const Save& save) {
  if (!save.path.empty()) protectFilesOf(browser_.world(), save.path);
  try {
    session_.editor().save(save.path, save.overwrite);
  } catch (const EditError&) { throw; } catch (const std::runtime_error& error) {
    throw CommandError("file", error.what());
  }
  return "null";
}

std::string WorldCommands::listEdits(const ListEdits& list) {
  WorldEditor& world = session_.editor();
  Editor& editor = world.editor();
  const std::optional<FoundJournal>& left = world.journal().left();
  std::string all = fmt::format(
      R"({{"read_only":{},"changed":{},"changed_on_disk":{},"undo":{},"redo":{},"recoverable":{})",
      nameOrNull(editor.whyReadOnly()), editor.isChanged(), editor.isChangedOnDisk(),
      nameOrNull(editor.undoName()), nameOrNull(editor.redoName()),
      left ? fmt::format(R"({{"file":{},"time":{}}})", jsonText(left->path), left->written)
           : "null");
  if (list.withText) all += ",\"text\":" + jsonText(editor.text());
  return all + "}";
}

std::string WorldCommands::throwLeftAway() {
  session_.editor().journal().throwLeftAway();
  return "null";
}

std::string WorldCommands::listParents(const ListParents& list) {
  std::string places;
  for (const NodeSlot& place : session_.editor().editor().placesOf(*nodeOf(list.node)))
    places += fmt::format(R"({}{{"parent":{},"field":{},"index":{}}})", places.empty() ? "" : ",",
                          place.parent ? std::to_string(client_.numbers.of(NodeRef(place.parent)))
                                       : "null",
                          nameOrNull(place.field), place.index);
  return "[" + places + "]";
}

std::string WorldCommands::select(const Select& select) {
  MFNode nodes;
  for (const NodeName& name : select.nodes) nodes.push_back(nodeOf(name));
  session_.editor().select(std::move(nodes));
  return "null";
}

std::string WorldCommands::listSelection() { return factsOf(session_.editor().selection()); }

} // namespace vv::control
