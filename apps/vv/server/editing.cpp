#include "server/editing.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "as_json/field_json.h"
#include "as_json/fields.h"
#include "as_json/perform_step.h"
#include "edit/actions.h"
#include "edit/shader_parameters.h"
#include "server/edit_texts.h"

namespace vv::server {

using namespace xvrml;
using json::CommandError;

namespace {

constexpr double interval = 0.05; // seconds between two looks at what has changed

NodeRef nodeOf(const json::NodeNumbers& numbers, uint64_t number) {
  NodeRef node = numbers.find(number);
  if (!node) throw CommandError("node", "this node is not shown any more: choose it again");
  return node;
}

NodeRef namedNode(const json::NodeNumbers& numbers, const json::NodeName& name) {
  if (const auto* number = std::get_if<uint64_t>(&name)) return nodeOf(numbers, *number);
  throw CommandError("node", "a page names nodes by their numbers");
}

const FieldInfo& valueField(const Node& node, const std::string& name) {
  const FieldInfo& field = json::storedField(node, name);
  if (field.type == FieldType::SFNode || field.type == FieldType::MFNode)
    throw EditError(
        fmt::format("{}.{} holds nodes: insert or remove them", node.type().name, field.name));
  return field;
}

} // namespace

void Editing::join(uint64_t page) { host_.sendText(page, "", edit::editorText()); }

void Editing::leave(uint64_t page) {
  const auto found = faces_.find(page);
  if (found == faces_.end()) return;
  endDrag(page, found->second);
  faces_.erase(found);
}

void Editing::take(uint64_t page, const edit::Command& command) {
  if (std::holds_alternative<edit::ShowRows>(command) && !open(page)) return;
  const auto found = faces_.find(page);
  if (found == faces_.end()) return; // its editor is closed
  Face& face = found->second;
  face.isStale = true;
  try {
    std::visit([&](const auto& one) { perform(page, face, one); }, command);
  } catch (const std::exception& error) {
    say(page, error.what(), true);
    face.told.erase("sheet"); // the page shows what was refused
  }
}

void Editing::beginAnew() {
  for (auto& [page, face] : faces_) {
    Face fresh;
    fresh.first = face.first;
    fresh.count = face.count;
    face = std::move(fresh);
  }
  probes_.clear();
}

void Editing::update(double now) {
  if (faces_.empty()) return;
  Session& session = world_.session();
  readProbes(session, now);
  const bool moves = session.pictures().isMoving();
  for (auto& [page, face] : faces_) {
    if (!face.isStale && now < face.next) continue;
    face.next = now + interval;
    const bool changed = face.model.update(session.editor(), viewOf(page), moves, now);
    if (std::exchange(face.isStale, false) || changed) show(page, face);
    tell(page, face, "history", edit::historyText(session.editor(), face.model.readOnly()));
    tell(page, face, "probes", edit::probesText(probes_));
  }
}

// --- What pages are told ---

EditView Editing::viewOf(uint64_t number) {
  const Page* const page = pages_.find(number);
  const Pilot& pilot = world_.session().viewers().findOrOwn(page ? page->view : 0).pilot;
  return {pilot.camera(), pilot.aspect()};
}

// Opens the editor of a page. Returns false if that cannot be.
bool Editing::open(uint64_t page) {
  if (faces_.contains(page)) return true;
  if (faces_.size() >= size_t(maxEditors)) {
    say(page, fmt::format("the editor is open on {} pages already (maxEditors)", maxEditors), true);
    return false;
  }
  faces_.try_emplace(page);
  return true;
}

void Editing::say(uint64_t page, const std::string& text, bool isError) {
  host_.sendText(page, "", edit::saidText(text, isError));
}

// Sends a message if it differs from the last one of its type.
void Editing::tell(uint64_t page, Face& face, const std::string& type, std::string text) {
  std::string& last = face.told[type];
  if (last == text) return;
  last = text;
  host_.sendText(page, type, std::move(text));
}

void Editing::show(uint64_t page, Face& face) {
  // Everything that is shown at once takes less than half of the numbers.
  if (face.numbers.size() > size_t(maxNodeNumbers) / 2) {
    face.numbers.releaseAll(); // everything that is shown gets new ones
    face.told.clear();
  }
  tell(page, face, "rows", edit::rowsText(face.model, face.numbers, face.first, face.count));
  tell(page, face, "sheet", edit::sheetText(face.model.sheet(), face.numbers));
  tell(page, face, "frames", edit::framesText(face.model));
  if (const int row = face.model.takeScroll(); row >= 0)
    host_.sendText(page, "", edit::revealText(row));
}

// --- The outline and the selection ---

void Editing::perform(uint64_t, Face& face, const edit::ShowRows& rows) {
  face.first = rows.first;
  face.count = rows.count;
}

void Editing::perform(uint64_t, Face& face, const edit::Search& search) {
  face.model.search(search.text);
}

void Editing::perform(uint64_t, Face& face, const edit::Open& open) {
  face.model.setOpen(nodeOf(face.numbers, open.node), open.open);
}

void Editing::perform(uint64_t, Face& face, const edit::Select& select) {
  editor().choose(select.node ? nodeOf(face.numbers, *select.node) : NodeRef(), select.add);
}

void Editing::perform(uint64_t page, Face&, const edit::SelectAt& select) {
  selectAt(editor(), viewOf(page), select.place.x, select.place.y, select.group, select.add);
}

// --- Values ---

// While several pages drag, what they change is one step.
void Editing::perform(uint64_t, Face& face, const edit::Drag& drag) {
  const NodeRef node = nodeOf(face.numbers, drag.node);
  const PropertySheet& sheet = face.model.sheet();
  const PropertyRow* const row = sheet.node == node ? sheet.find(drag.field) : nullptr;
  if (row && !row->isDeclared) {
    Value value = json::readValue(drag.value, *node, *row->field, {});
    face.parameter = {node, drag.field, std::move(value)};
    return;
  }
  const FieldInfo& field = valueField(*node, drag.field);
  Value value = json::readValue(drag.value, *node, field, {});
  if (!std::exchange(face.isDragging, true))
    editor().editor().begin(fmt::format("Set {}.{}", node->type().name, field.name));
  editor().editor().set(*node, field.name, std::move(value));
}

void Editing::perform(uint64_t page, Face& face, const edit::EndDrag&) { endDrag(page, face); }

void Editing::endDrag(uint64_t page, Face& face) {
  if (std::exchange(face.isDragging, false)) editor().editor().end();
  const std::optional<Face::Parameter> parameter = std::exchange(face.parameter, std::nullopt);
  if (!parameter) return;
  try {
    declareParameter(editor(), parameter->shader, parameter->name, parameter->value);
  } catch (const std::exception& error) {
    say(page, error.what(), true);
    face.told.erase("sheet");
  }
}

void Editing::endDrags() {
  for (auto& [page, face] : faces_) endDrag(page, face);
}

void Editing::perform(uint64_t, Face& face, const edit::Reset& reset) {
  const NodeRef node = nodeOf(face.numbers, reset.node);
  const FieldInfo& field = valueField(*node, reset.field);
  // A parameter of a shader has the default of its class.
  const PropertySheet& sheet = face.model.sheet();
  const PropertyRow* const row = sheet.node == node ? sheet.find(field.name) : nullptr;
  const Value value = row ? row->defaultValue : field.defaultValue;
  endDrags();
  editor().step(fmt::format("Reset {}.{}", node->type().name, field.name),
                [&] { editor().editor().set(*node, field.name, value); });
}

// --- Nodes ---

void Editing::perform(uint64_t, Face& face, const json::edits::Step& step) {
  endDrags();
  MFNode made;
  editor().step(step.name, [&] {
    made = json::edits::perform(step, editor(), [&face](const json::NodeName& name) {
      return namedNode(face.numbers, name);
    });
  });
  std::erase(made, NodeRef());
  if (!made.empty()) editor().select(std::move(made));
}

void Editing::perform(uint64_t page, Face&, const edit::Add& add) {
  endDrags();
  if (add.kind == edit::viewpointKind) return addViewpoint(editor(), viewOf(page));
  const auto kinds = newNodes();
  const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                 [&](const NewNode& one) { return add.kind == one.name; });
  if (kind == kinds.end()) throw EditError("there is no such node to be added");
  vv::add(editor(), *kind);
}

void Editing::perform(uint64_t, Face&, const edit::Duplicate&) {
  endDrags();
  duplicateSelected(editor());
}

void Editing::perform(uint64_t, Face&, const edit::Remove&) {
  endDrags();
  removeSelected(editor());
}

void Editing::perform(uint64_t, Face&, const edit::Wrap&) {
  endDrags();
  wrapSelected(editor());
}

// --- History and file ---

void Editing::perform(uint64_t, Face&, const edit::Undo& undo) {
  endDrags();
  undo.again ? editor().redo() : editor().undo();
}

void Editing::perform(uint64_t page, Face&, const edit::Save& save) {
  endDrags();
  if (!editor().isChanged()) return say(page, "there is nothing to save", false);
  if (!save.overwrite && editor().editor().isChangedOnDisk())
    return host_.sendText(page, "", edit::questionText());
  editor().save("", save.overwrite);
  say(page, "saved", false);
}

void Editing::perform(uint64_t, Face&, const edit::Revert&) { world_.revert(); }

void Editing::perform(uint64_t, Face&, const edit::Recover& recover) {
  if (recover.use)
    world_.recover();
  else
    editor().journal().throwLeftAway();
}

// --- Probes ---

// Reads the probes from the still picture of the world as it is, a few times a second.
void Editing::readProbes(Session& session, double now) {
  constexpr double pause = 0.25;
  if (probes_.all().empty()) return;
  if (session.captures().isPending()) return; // other channels would cancel its frame
  const bool outdated = session.viewers().own().isOutdated();
  if (outdated) probes_.expire();
  if (outdated || now < probesRead_ + pause) return;
  session.pictures().wantReadings();
  const uint64_t finished =
      session.pictures().isFinished(session.pilot()) ? session.pictures().number() : 0;
  if (finished != 0 && finished == finishedRead_ && !probes_.isWaiting()) return;
  picture::Picture picture;
  if (!session.pictures().copyStill(picture) || !picture.planes.contains(RT_ERROR)) return;
  probesRead_ = now;
  finishedRead_ = finished;
  probes_.read(session.browser(), picture, {session.pilot().camera(), session.pilot().aspect()});
}

void Editing::perform(uint64_t page, Face&, const edit::PutProbe& put) {
  if (probes_.all().size() >= size_t(maxProbes))
    throw EditError(fmt::format("there are {} probes already (maxProbes)", maxProbes));
  const EditView view = viewOf(page);
  const CameraRay ray = rayThrough(view.camera, view.aspect, put.place.x, put.place.y);
  PickHit hit;
  if (!editor().browser().pick(ray.origin, ray.direction, {.bothSides = true}, hit))
    throw EditError("there is nothing here to be measured");
  probes_.add(hit.point);
}

void Editing::perform(uint64_t, Face&, const edit::KeepProbes&) {
  if (editor().browser().hasChanges()) probes_.expire();
  probes_.keep();
}

void Editing::perform(uint64_t, Face&, const edit::ClearProbes&) { probes_.clear(); }

void Editing::perform(uint64_t page, Face&, const edit::Close&) { leave(page); }

} // namespace vv::server
