#include "edit/edit_model.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "edit/merged_list.h"
#include "edit/shader_parameters.h"
#include "libpicture/files/atomic_file.h"

namespace vv {

using namespace xvrml;

namespace {

constexpr double refreshInterval = 0.2; // seconds
constexpr size_t mostFound = 1000;      // rows of a search

// Returns the box of a node, or of the Shape or group that it belongs to, in the world.
bool boxOf(Browser& browser, const NodeRef& node, std::array<std::array<double, 3>, 8>& corners) {
  NodePlacement placement;
  if (!browser.locate(*node, placement)) return false;
  while (placement.bounds.empty && placement.path.size() > 1) {
    const NodeRef above = placement.path[placement.path.size() - 2].node;
    if (above->type().is("grouping")) return false; // the box would be that of its neighbours
    if (!browser.locate(*above, placement)) return false;
  }
  if (placement.bounds.empty) return false;
  const size_t depth = placement.path.size();
  for (size_t i = 0; i < corners.size(); ++i) {
    double own[3];
    for (size_t k = 0; k < 3; ++k)
      own[k] = i >> k & 1 ? placement.bounds.maximum[k] : placement.bounds.minimum[k];
    std::copy(std::begin(own), std::end(own), corners[i].begin());
    if (depth < 2) continue; // a root: its parent is the world
    const std::array<double, 16>& m = placement.path[depth - 2].toWorld;
    for (size_t k = 0; k < 3; ++k)
      corners[i][k] = m[k] * own[0] + m[4 + k] * own[1] + m[8 + k] * own[2] + m[12 + k];
  }
  return true;
}

void refuseWithinStep(WorldEditor& editor) {
  if (editor.editor().isInStep())
    throw EditError("end the other edit first: Enter keeps a move, Escape takes it back");
}

} // namespace

bool EditModel::isSelected(const Node& node) const {
  return std::any_of(selection_.begin(), selection_.end(),
                     [&node](const NodeRef& one) { return one.get() == &node; });
}

void EditModel::edit(Command command) {
  finishDrag();
  request([command = std::move(command)](WorldEditor& editor) {
    refuseWithinStep(editor);
    command(editor);
  });
}

void EditModel::drag(const NodeRef& node, const FieldInfo& field, Value value) {
  const Dragged dragged{node, field.name};
  const PropertyRow* const row = sheet_.node == node ? sheet_.find(field.name) : nullptr;
  const bool isDeclared = node->type().find(field.name), isOption = row && row->isOption();
  if (dragged_ != dragged) {
    finishDrag();
    dragged_ = dragged;
    touched_.clear();
    if (isDeclared || isOption) begin(dragged);
  }
  if (isOption)
    return requestValue([this, dragged, value = std::move(value)](WorldEditor& editor) {
      if (!isRefused_) setParameter(editor, dragged.node, dragged.field, value);
    });
  if (!isDeclared) {
    undeclared_ = std::move(value);
    return;
  }
  ChangedList change{row ? row->shown : Value(), std::move(value), {}};
  noteTouched(change.shown, change.wanted, touched_);
  change.touched = touched_;
  requestValue([this, dragged, change = std::move(change)](WorldEditor& editor) {
    if (!isRefused_) setField(editor, dragged, change);
  });
}

void EditModel::setField(WorldEditor& editor, const Dragged& dragged, const ChangedList& change) {
  const Node& node = *dragged.node;
  const FieldInfo& info = *node.type().find(dragged.field);
  const Value now = node.get(info);
  const bool isOwn = set_ == std::pair(dragged, now);
  editor.editor().set(*dragged.node, dragged.field, mergedList(change, now, isOwn, dragged.name()));
  set_ = {dragged, node.get(info)};
}

std::string EditModel::Dragged::name() const {
  return fmt::format("{}.{}", node->type().name, field);
}

void EditModel::begin(const Dragged& dragged) {
  const PropertyRow* const row = sheet_.node == dragged.node ? sheet_.find(dragged.field) : nullptr;
  requestValue(
      [this, dragged, shown = row ? row->edits : 0, isShown = row != nullptr](WorldEditor& editor) {
        isRefused_ = true;
        refuseWithinStep(editor);
        const std::string what = dragged.name();
        const uint64_t edits = editor.editor().editsOf(*dragged.node, dragged.field);
        if (isShown && edits != shown && own_ != std::pair(dragged, edits))
          throw EditError(
              fmt::format("another program has edited {} meanwhile: its value stays", what));
        isRefused_ = false;
        editor.editor().begin("Set " + what);
      });
}

void EditModel::finishDrag() {
  if (!dragged_) return;
  const Dragged dragged = *std::exchange(dragged_, std::nullopt);
  if (std::optional<Value> value = std::exchange(undeclared_, std::nullopt))
    return request([dragged, value = std::move(*value)](WorldEditor& editor) {
      refuseWithinStep(editor);
      setParameter(editor, dragged.node, dragged.field, value);
    });
  requestValue([this, dragged](WorldEditor& editor) {
    if (std::exchange(isRefused_, false)) return;
    editor.editor().end();
    own_ = {dragged, editor.editor().editsOf(*dragged.node, dragged.field)};
  });
}

void EditModel::setActive(bool active) {
  if (std::exchange(isActive_, active) && !active) note(Stale::sheet);
  if (!active) finishDrag();
}

void EditModel::hideSelected() {
  request([this](WorldEditor& editor) { hiding_.hideSelected(editor); });
}

void EditModel::isolateSelected() {
  request([this](WorldEditor& editor) { hiding_.isolateSelected(editor); });
}

void EditModel::showAll() {
  request([this](WorldEditor& editor) { hiding_.showAll(editor); });
}

void EditModel::setOpen(const NodeRef& node, bool open) {
  requestValue([this, node, open](WorldEditor&) {
    outline_.setOpen(node, open);
    changeRowsOf(*node);
  });
}

void EditModel::changeRowsOf(const Node& node) {
  if (stale_ == Stale::rows || !search_.empty()) return;
  if (!outline_.changeRowsOf(node, rows_)) note(Stale::rows);
}

void EditModel::search(std::string text) {
  if (text == search_) return;
  search_ = std::move(text);
  note(Stale::rows);
}

void EditModel::select(const NodeRef& node, bool add) {
  request([node, add](WorldEditor& editor) { editor.choose(node, add); });
}

bool EditModel::update(WorldEditor& editor, const EditView& view, bool moves, double seconds) {
  while (!requests_.empty()) {
    const Request request = std::move(requests_.front());
    requests_.pop_front();
    note(request.stale == Stale::rows ? anyChange() : request.stale);
    try {
      request.command(editor);
    } catch (const std::exception& error) { message_ = error.what(); }
  }
  const uint64_t changes = editor.editor().changes(), nodes = editor.editor().nodeChanges();
  if (std::exchange(changes_, changes) != changes) note(Stale::values);
  if (std::exchange(nodeChanges_, nodes) != nodes) note(Stale::rows);
  if (selection_ != editor.selection()) {
    selection_ = editor.selection();
    note(anyChange());
    if (Node* node = editor.selected()) reveal(editor, *node);
  }
  if (!hasAsked_ && editor.prepare()) {
    hasAsked_ = true;
    note(Stale::sheet);
    unwritable_ = picture::whyNotEditable(editor.browser().world().path);
    readOnly_ = editor.editor().whyReadOnly();
  }
  bool reads = stale_ != Stale::nothing || (moves && seconds >= readAt_ + refreshInterval);
  if (reads) {
    readAt_ = seconds;
    read(editor);
  }
  reads |= thumbnails_.update(editor.browser().world(), sheet_, reads);
  reads |= problems_.update(editor, seconds);
  std::vector<Line> frames = framesOf(editor, view);
  return std::exchange(frames_, frames) != frames || reads;
}

// Opens the nodes above one that is to be shown, and scrolls to it. In a world of a million nodes
// the other rows stay as they are.
void EditModel::reveal(WorldEditor& editor, Node& node) {
  const std::optional<MFNode> opened = outline_.reveal(editor.browser(), node);
  if (!opened) return;
  shown_ = NodeRef(&node);
  for (const NodeRef& one : *opened) changeRowsOf(*one);
}

// Returns what is stale when something other than a value may have changed. Edits of nodes are
// counted; only what Scripts have done to them may be missed, where it takes long to read all rows
// again: if there are many, or if they are searched for in the whole file.
EditModel::Stale EditModel::anyChange() const {
  constexpr size_t mostReread = 10'000; // rows, which take some milliseconds
  return search_.empty() && rows_.size() <= mostReread ? Stale::rows : Stale::sheet;
}

void EditModel::readSheet(WorldEditor& editor) {
  sheet_ = sheetOf(editor, NodeRef(editor.selected()));
  if (sheet_.hasLook && looks_.empty()) looks_ = looksFor(editor);
  if (sheet_.node && hiding_.contains(*sheet_.node))
    sheet_.note +=
        std::string(sheet_.note.empty() ? "" : "; ") + "hidden for now, which is not saved";
}

// A value that is dragged in a world of a million nodes must not cost a walk over all of them: rows
// and places of nodes are read again only if more than values has changed, and rows only if nodes
// have been opened, moved, added or removed.
void EditModel::read(WorldEditor& editor) {
  const World& world = editor.browser().world();
  const Stale stale = std::exchange(stale_, Stale::nothing);
  if (stale == Stale::rows) {
    rows_ = search_.empty() ? outline_.rows(world) : Outline::find(world, search_, mostFound);
    found_ = search_;
  }
  if (stale >= Stale::sheet) {
    if (!isActive_ || sheet_.node.get() != editor.selected()) readSheet(editor);
  } else if (sheet_.node && !isActive_ && !refresh(editor, sheet_)) {
    readSheet(editor);
  }
  if (stale >= Stale::values) {
    undoName_ = editor.editor().undoName();
    redoName_ = editor.editor().redoName();
    unsaved_ = editor.isChanged();
  }
  if (!shown_) return;
  const NodeRef wanted = std::exchange(shown_, NodeRef());
  const auto row = std::find_if(rows_.begin(), rows_.end(),
                                [&](const OutlineRow& one) { return one.node == wanted; });
  if (row != rows_.end()) scroll_ = int(row - rows_.begin());
}

CameraSettings EditModel::cameraAround(WorldEditor& editor, const EditView& view,
                                       const FreePart& free) const {
  double low[3], high[3];
  std::fill(low, low + 3, std::numeric_limits<double>::infinity());
  std::fill(high, high + 3, -std::numeric_limits<double>::infinity());
  std::array<std::array<double, 3>, 8> corners;
  for (const NodeRef& node : selection_) {
    if (!boxOf(editor.browser(), node, corners)) continue;
    for (const std::array<double, 3>& corner : corners)
      for (size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], corner[k]);
        high[k] = std::max(high[k], corner[k]);
      }
  }
  CameraSettings camera = view.camera;
  const double radius = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2;
  if (!std::isfinite(radius)) return camera;
  // A sphere around the box fills nine tenths of the smaller side, in the middle of the free part.
  constexpr double leastFree = 0.2; // part of the picture
  const double part = std::max((free.right - free.left) / 2, leastFree);
  const double half = std::tan(camera.fovy / 2), tangent = half * std::min(1.0, view.aspect * part);
  const double distance =
      std::max(camera.fovy > 0 ? radius / std::sin(std::atan(tangent * .9)) : radius * 2, 1e-6);
  const double across =
      free.middle() * view.aspect * (camera.fovy > 0 ? half * distance : camera.height / 2);
  for (size_t k = 0; k < 3; ++k)
    camera.matrix[12 + k] =
        (low[k] + high[k]) / 2 + camera.matrix[8 + k] * distance - camera.matrix[k] * across;
  return camera;
}

std::vector<EditModel::Line> EditModel::framesOf(WorldEditor& editor, const EditView& view) const {
  std::vector<Line> lines;
  std::array<std::array<double, 3>, 8> corners;
  for (const NodeRef& node : selection_) {
    if (!boxOf(editor.browser(), node, corners)) continue;
    std::array<std::array<double, 2>, 8> places;
    bool inFront = true;
    for (size_t i = 0; i < corners.size() && inFront; ++i)
      inFront =
          projectPoint(view.camera, view.aspect, corners[i].data(), places[i][0], places[i][1]) &&
          std::isfinite(places[i][0]) && std::isfinite(places[i][1]);
    if (!inFront) continue;
    for (size_t i = 0; i < corners.size(); ++i)
      for (size_t k = 0; k < 3; ++k)
        if (const size_t j = i | size_t(1) << k; j != i)
          lines.push_back({places[i][0], places[i][1], places[j][0], places[j][1]});
  }
  return lines;
}

} // namespace vv
