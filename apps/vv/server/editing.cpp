#include "server/editing.h"

#include <utility>

#include <fmt/format.h>

#include "edit/actions.h"
#include "edit/region.h"
#include "edit/shader_parameters.h"
#include "server/edit_nodes.h"
#include "server/edit_texts.h"
#include "server/light_texts.h"
#include "server/texts.h"

namespace vv::server {

using namespace xvrml;

namespace {

constexpr double interval = 0.05; // seconds between two looks at what has changed

// Tells whether a command edits the world, or begins to.
bool isEdit(const edit::Command& command) {
  if (const auto* const light = std::get_if<edit::LightCommand>(&command))
    return std::holds_alternative<edit::KeepInWorld>(*light);
  return std::holds_alternative<edit::Drag>(command) ||
         std::holds_alternative<edit::Undo>(command) ||
         std::holds_alternative<edit::Save>(command) ||
         std::holds_alternative<edit::NodeCommand>(command) ||
         std::holds_alternative<edit::ToolCommand>(command) ||
         std::holds_alternative<edit::FileCommand>(command);
}

} // namespace

void Editing::join(uint64_t page) { host_.sendText(page, "", editorText()); }

void Editing::leave(uint64_t page) {
  const auto found = faces_.find(page);
  if (found == faces_.end()) return;
  endDrag(page, found->second);
  faces_.erase(found);
  light_.leave(page);
  looks_.setChoosing(page, false);
}

void Editing::take(uint64_t page, const edit::Command& command) {
  if (std::holds_alternative<edit::ShowRows>(command) && !open(page)) return;
  const auto found = faces_.find(page);
  if (found == faces_.end()) return; // its editor is closed
  Face& face = found->second;
  face.isStale = true;
  try {
    if (world_.isReverting() && isEdit(command))
      throw EditError("the file is being read again: what is edited now would be lost");
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
    // A message on its way may name a node by its number: no number is given out again.
    fresh.numbers = std::move(face.numbers);
    fresh.numbers.releaseAll();
    face = std::move(fresh);
  }
  hiding_ = {};
  light_.beginAnew();
}

void Editing::update(double now) {
  if (faces_.empty()) return;
  Session& session = world_.session();
  light_.update(now);
  for (const auto& [reader, text] : light_.takeMessages())
    for (const auto& [page, face] : faces_)
      if (reader == 0 || reader == page) say(page, text, false);
  const bool moves = session.pictures().isMoving();
  for (auto& [page, face] : faces_) {
    if (!face.isStale && now < face.next) continue;
    face.next = now + interval;
    const EditView view = viewOf(page);
    const bool changed = face.model.update(session.editor(), view, moves, now);
    face.tool.place(session.editor(), view, face.model.readOnly().empty());
    if (!face.model.looks().empty()) looks_.update(session, face.model.looks());
    if (!looks_.text().empty()) tell(page, face, "looks", looks_.text());
    if (std::exchange(face.isStale, false) || changed) show(page, face);
    tell(page, face, "handles", edit::handlesText(face.tool.gizmo()));
    tell(page, face, "tool", edit::toolText(face.tool.text()));
    tell(page, face, "history",
         edit::historyText(session.editor(), face.model.readOnly(), hiding_.count()));
    showLight(page, face);
  }
}

// --- What pages are told ---

EditView Editing::viewOf(uint64_t number) {
  const Page* const page = pages_.find(number);
  const Pilot& pilot = world_.session().viewers().findOrOwn(page ? page->view : 0).pilot;
  return {pilot.camera(), pilot.aspect()};
}

bool Editing::showsLeadersView(uint64_t number) {
  const Page* const page = pages_.find(number);
  return page && page->view == 0;
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
  host_.sendText(page, "said", edit::saidText(text, isError));
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
  // Their pictures are encoded only when there are others.
  const TextureThumbnails& thumbnails = face.model.thumbnails();
  if (!face.told.contains("thumbnails") || thumbnails.count() != face.thumbnails)
    tell(page, face, "thumbnails", edit::thumbnailsText(thumbnails, face.numbers));
  face.thumbnails = thumbnails.count();
  tell(page, face, "problems", edit::problemsText(face.model.problems(), face.numbers));
  tell(page, face, "frames", edit::framesText(face.model));
  if (const int row = face.model.takeScroll(); row >= 0)
    host_.sendText(page, "reveal", edit::revealText(row));
}

void Editing::showLight(uint64_t page, Face& face) {
  const bool isLeaders = showsLeadersView(page);
  tell(page, face, "probes", edit::probesText(light_.probes()));
  tell(page, face, "marks", edit::marksText(light_.probes(), viewOf(page)));
  tell(page, face, "comparison", light_.comparisonText(page, isLeaders));
  tell(page, face, "pointer", light_.pointerText(page, isLeaders));
  tell(page, face, "progress", edit::progressText(light_.progress(page)));
  if (!isLeaders) return;
  const uint64_t cover = light_.cover();
  if (cover != 0 && std::exchange(face.cover, cover) != cover)
    host_.sendText(page, "cover", light_.coverText());
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

void Editing::perform(uint64_t page, Face&, const edit::SelectIn& select) {
  selectIn(editor(), viewOf(page),
           regionBetween(select.from.x, select.from.y, select.to.x, select.to.y), select.add);
}

void Editing::perform(uint64_t, Face&, const edit::SelectSameLook&) { selectSameLook(editor()); }

void Editing::perform(uint64_t page, Face& face, const edit::AskChoices& ask) {
  const NodeRef node = nodeOf(face.numbers, ask.node);
  const PropertySheet& sheet = face.model.sheet();
  const PropertyRow* const row = sheet.node == node ? sheet.find(ask.field) : nullptr;
  if (!row) throw EditError("this field is not shown any more");
  host_.sendText(page, "choices", edit::choicesText(ask.node, *row, face.numbers));
}

void Editing::perform(uint64_t page, Face& face, const edit::ShowList& show) {
  if (show.what == edit::ShowList::What::problems)
    face.model.problems().setOpen(show.open);
  else
    looks_.setChoosing(page, show.open);
}

// Nodes are hidden for all pages, also for those that do not edit.
void Editing::perform(uint64_t, Face&, const edit::Hide& hide) {
  using What = edit::Hide::What;
  if (hide.what == What::selected)
    hiding_.hideSelected(editor());
  else if (hide.what == What::others)
    hiding_.isolateSelected(editor());
  else
    hiding_.showAll(editor());
}

void Editing::perform(uint64_t number, Face& face, const edit::Frame&) {
  const Page* const page = pages_.find(number);
  if (!page || page->role == Page::Role::follower)
    throw EditError("this page follows: take an own view to move it");
  Pilot& pilot = world_.session().viewers().findOrOwn(page->view).pilot;
  pilot.putAt(face.model.cameraAround(editor(), viewOf(number)));
}

void Editing::perform(uint64_t page, Face&, const edit::Close&) { leave(page); }

// --- Values ---

// While several pages drag, what they change is one step.
void Editing::perform(uint64_t, Face& face, const edit::Drag& drag) {
  const NodeRef node = nodeOf(face.numbers, drag.node);
  const PropertySheet& sheet = face.model.sheet();
  const PropertyRow* const row = sheet.node == node ? sheet.find(drag.field) : nullptr;
  const auto begin = [&](std::string_view name) {
    endTools(); // their steps can be taken back
    if (!std::exchange(face.isDragging, true))
      editor().editor().begin(fmt::format("Set {}.{}", node->type().name, name));
  };
  if (row && row->isOption()) {
    const Value value = draggedValue(drag, *node, *row->field, row->value);
    begin(drag.field);
    return setParameter(editor(), node, drag.field, value);
  }
  if (row && !row->isDeclared) {
    const auto& last = face.parameter;
    const bool isSame = last && last->shader == node && last->name == drag.field;
    Value value = draggedValue(drag, *node, *row->field, isSame ? last->value : row->value);
    face.parameter = {node, drag.field, std::move(value)};
    return;
  }
  const FieldInfo& field = valueField(*node, drag.field);
  Value value = draggedValue(drag, *node, field, node->get(field));
  begin(field.name);
  editor().editor().set(*node, field.name, std::move(value));
}

void Editing::perform(uint64_t page, Face& face, const edit::EndDrag&) { endDrag(page, face); }

void Editing::endDrag(uint64_t page, Face& face) {
  if (std::exchange(face.isDragging, false)) editor().editor().end();
  face.tool.accept(editor());
  const std::optional<Face::Parameter> parameter = std::exchange(face.parameter, std::nullopt);
  if (!parameter) return;
  try {
    setParameter(editor(), parameter->shader, parameter->name, parameter->value);
  } catch (const std::exception& error) {
    say(page, error.what(), true);
    face.told.erase("sheet");
  }
}

void Editing::endDrags() {
  for (auto& [page, face] : faces_) endDrag(page, face);
}

void Editing::endTools() {
  for (auto& [page, face] : faces_) face.tool.accept(editor());
}

// --- Edits of nodes, tools and light ---

void Editing::perform(uint64_t page, Face& face, const edit::NodeCommand& command) {
  endDrags();
  server::perform(command, editor(), face.model, face.numbers, viewOf(page),
                  [this](uint64_t number) -> const Look& { return looks_.find(number); });
}

void Editing::perform(uint64_t page, Face& face, const edit::ToolCommand& command) {
  if (std::holds_alternative<edit::BeginTool>(command)) endDrags();
  face.tool.take(command, editor(), viewOf(page));
}

void Editing::perform(uint64_t page, Face&, const edit::LightCommand& command) {
  if (std::holds_alternative<edit::KeepInWorld>(command)) endDrags(); // it is an edit
  light_.take(page, viewOf(page), showsLeadersView(page), command);
}

// A page sends the next parts of a file when it knows which have come.
void Editing::perform(uint64_t page, Face& face, const edit::FileCommand& command) {
  const auto tell = [&] {
    host_.sendText(page, "import", edit::importText(face.upload.received(), face.upload.size()));
  };
  try {
    face.upload.take(command, editor());
    if (face.upload.isComplete()) {
      endDrags();
      say(page, fmt::format("{} has been written", face.upload.finish(editor())), false);
    }
  } catch (...) {
    tell();
    throw;
  }
  tell();
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
    return host_.sendText(page, "question", edit::questionText());
  editor().save("", save.overwrite);
  say(page, "saved", false);
}

void Editing::perform(uint64_t, Face&, const edit::Revert&) {
  endDrags();
  world_.revert();
}

void Editing::perform(uint64_t, Face&, const edit::Recover& recover) {
  if (recover.use)
    world_.recover();
  else
    editor().journal().throwLeftAway();
}

} // namespace vv::server
