// world_edits.cpp: the commands that edit the file of the world, and those about its selection.
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "as_json/perform_step.h"
#include "control/world_commands.h"
#include "edit/shader_parameters.h"
#include "run/outputs.h"

namespace vv::control {

using namespace xvrml;

namespace {

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
  std::string nodes;
  world.step(step.name, [&] {
    nodes = valueText(
        edits::perform(step, world, [this](const NodeName& name) { return nodeOf(name); }));
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

std::string WorldCommands::listParameters(const ListParameters& list) {
  const picture::ShaderClass* const found = classOf(session_.editor(), list.shaderClass, list.file);
  if (!found)
    throw CommandError("value",
                       fmt::format("there is no shader class {}{}", jsonText(list.shaderClass),
                                   list.file.empty() ? "" : " in " + jsonText(list.file)));
  std::string all;
  for (const picture::ShaderParameter& parameter : found->parameters) {
    const std::optional<FieldInfo> field = fieldFor(parameter);
    if (!field) continue; // a matrix
    all += fmt::format(R"({}{{"name":{},"type":"{}","text":{},"default":{})",
                       all.empty() ? "" : ",", jsonText(field->name), fieldTypeName(field->type),
                       jsonText(field->text), valueText(field->defaultValue));
    if (std::isfinite(field->range.minimum))
      all += fmt::format(R"(,"minimum":{})", field->range.minimum);
    if (std::isfinite(field->range.maximum))
      all += fmt::format(R"(,"maximum":{})", field->range.maximum);
    all += "}";
  }
  return "[" + all + "]";
}

std::string WorldCommands::listSelection() { return factsOf(session_.editor().selection()); }

} // namespace vv::control
