// editor.cpp: the edits that programs ask for.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/lexer.h"
#include "base/rotation.h"
#include "edit/declaration.h"
#include "edit/in_place_writer.h"
#include "edit/node_edits.h"
#include "enough_stack.h"
#include "graph/exchange.h"
#include "graph/field_access.h"
#include "graph/range.h"
#include "xvrml/edit.h"
#include "xvrml/versions.h"
#include "xvrml/visit_storage.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

bool isFinite(const FieldInfo& field, Value& value) {
  return visitStorage(field.type, std::visit([](auto& v) -> void* { return &v; }, value),
                      [](auto& stored) {
                        using T = std::remove_reference_t<decltype(stored)>;
                        const auto finite = [](const auto& element) {
                          using E = std::remove_cvref_t<decltype(element)>;
                          bool good = true;
                          if constexpr (Numeric<E>) {
                            for (int i = 0; i < numberCount<E>; ++i)
                              good = good && std::isfinite(double(numbersOf(element)[i]));
                          }
                          return good;
                        };
                        if constexpr (isNumberList<T>)
                          return std::all_of(stored.begin(), stored.end(), finite);
                        else
                          return finite(stored);
                      });
}

// Returns whether a value is, or has, a text with a zero byte.
bool hasZeroByte(const Value& value) {
  const auto has = [](const std::string& text) { return text.find('\0') != text.npos; };
  if (const auto* const one = std::get_if<SFString>(&value)) return has(*one);
  const auto* const list = std::get_if<MFString>(&value);
  return list && std::any_of(list->begin(), list->end(), has);
}

// Returns whether a file may have a name for a node or a field (Annex A.3).
bool isName(const std::string& name) {
  constexpr std::string_view keywords[] = {"DEF",     "EXTERNPROTO", "FALSE", "IS",          "NULL",
                                           "PROTO",   "ROUTE",       "TO",    "TRUE",        "USE",
                                           "eventIn", "eventOut",    "field", "exposedField"};
  return isIdentifier(name) &&
         std::find(std::begin(keywords), std::end(keywords), name) == std::end(keywords);
}

} // namespace

struct Editor::Impl {
  explicit Impl(std::unique_ptr<LiveWorld> live) : file(std::move(live)) {}

  EditedFile file;
  History history{[this] {
    file.world().diagnostics.warn(
        {}, fmt::format("undo takes more than {} MB of memory: its oldest steps are forgotten",
                        history.mostBytes() >> 20));
  }};
  NodeEdits nodes{file, history};
  size_t texts = 0; // number of texts that have been inserted
};

Editor::Editor(Browser& browser) : impl_(std::make_unique<Impl>(makeLiveWorld(browser))) {}
Editor::Editor(World& world) : impl_(std::make_unique<Impl>(makeLiveWorld(world))) {}
Editor::~Editor() = default;

void Editor::run(Browser& browser) { impl_->file.setLive(makeLiveWorld(browser)); }

std::vector<NodeSlot> Editor::placesOf(const Node& node) {
  std::vector<NodeSlot> places;
  const MFNode& roots = impl_->file.world().scope.roots;
  for (size_t i = 0; i < roots.size(); ++i)
    if (roots[i].get() == &node) places.push_back({nullptr, "", i});
  walk(rootsOf(impl_->file.world().scope), [&](Node& parent, std::vector<Node*>& open) {
    appendChildren(parent, open);
    for (const FieldInfo& field : parent.type().fields) {
      if (!holdsNodes(field)) continue;
      if (field.type == FieldType::SFNode) {
        if (static_cast<const NodeRef*>(parent.storage(field))->get() == &node)
          places.push_back({&parent, field.name, 0});
        continue;
      }
      const MFNode& list = *static_cast<const MFNode*>(parent.storage(field));
      for (size_t i = 0; i < list.size(); ++i)
        if (list[i].get() == &node) places.push_back({&parent, field.name, i});
    }
  });
  return places;
}

bool Editor::stands(const Node& node) const { return countPlaces(node) > 0; }
size_t Editor::countPlaces(const Node& node) const { return impl_->file.countPlaces(node); }

std::vector<NodeRef> Editor::nodesAt(std::span<const SourcePosition> places) {
  return impl_->file.nodesAt(places);
}
std::vector<ChangedField> Editor::changedFields() const { return impl_->file.changedFields(); }

void Editor::setUndoBytes(uint64_t bytes) { impl_->history.setMostBytes(bytes); }
void Editor::begin(std::string name) { impl_->history.begin(std::move(name)); }
void Editor::end() { impl_->history.end(); }
void Editor::cancel() { impl_->history.cancel(); }

bool Editor::undo() {
  if (undoName().empty()) return false;
  impl_->file.document(); // throws if there is another world
  return impl_->history.undo();
}

bool Editor::redo() {
  if (redoName().empty()) return false;
  impl_->file.document();
  return impl_->history.redo();
}

std::string Editor::undoName() const { return impl_->history.undoName(); }
std::string Editor::redoName() const { return impl_->history.redoName(); }
uint64_t Editor::changes() const { return impl_->history.changes(); }
uint64_t Editor::nodeChanges() const { return impl_->history.nodeChanges(); }
uint64_t Editor::editsOf(const Node& node, std::string_view field) const {
  return impl_->history.editsOf(node, field);
}

void Editor::set(Node& node, std::string_view field, Value value) {
  const Twin twin = impl_->file.standingTwinOf(node);
  const std::string what = fmt::format("{}.{}", node.type().name, field);
  const FieldInfo* const info = findField(node, field);
  if (!info || !holdsValue(*info)) throw EditError(fmt::format("there is no field {}", what));
  if (holdsNodes(*info))
    throw EditError(fmt::format("{} holds nodes: insert or remove them", what));
  if (value.index() != size_t(info->type))
    throw EditError(fmt::format("{} is {}", what, fieldTypeName(info->type)));
  if (!isFinite(*info, value))
    throw EditError(fmt::format("{}: a number is not finite, which no file can say", what));
  if (hasZeroByte(value))
    throw EditError(fmt::format("{}: a text has a zero byte, which no file can say", what));
  if (info->type != FieldType::SFRotation && !inRange(node, *info, value))
    throw EditError(
        fmt::format("{}: a number is outside of {}", what, describe(rangeIn(node, *info))));
  if (hasNormalizedAxes(*info))
    normalizeAxes(info->type, std::visit([](auto& v) -> void* { return &v; }, value));
  const FieldInfo& own = *twin.document->type().find(info->name);
  impl_->file.checkReadable(*twin.document, own);
  const auto put = [this, twin, &own](const Value& live, const Value& inFile) {
    if (!impl_->file.live().set(*twin.live, own.name, live))
      throw EditError(
          fmt::format("the running world keeps its {}.{}: as it is now, it does not take "
                      "another value",
                      twin.live->type().name, own.name));
    impl_->file.opened().set(*twin.document, own, inFile);
  };
  const Value live = node.get(*info), inFile = twin.document->get(own);
  OpenStep step(impl_->history, fmt::format("Set {}", what));
  impl_->history.perform({[put, value] { put(value, value); },
                          [put, live, inFile] { put(live, inFile); }, &node, info->name,
                          2 * bytesOf(value) + bytesOf(live) + bytesOf(inFile)});
  step.close();
}

NodeRef Editor::insert(const NodeSlot& given, std::string_view text) {
  impl_->file.checkStands(given.parent);
  const Slot slot = impl_->file.slotOf(given, false);
  Document& file = impl_->file.document();
  const std::string name = fmt::format("{} (edit {})", impl_->file.world().path, ++impl_->texts);
  const DocumentText* read = nullptr;
  try {
    read = &file.read(std::string(text), impl_->file.live().placeName(name));
  } catch (const LoadError& error) { throw EditError(error.diagnostic.text()); }
  // A text whose nodes do not get their place is not kept.
  struct Reading {
    Document& file;
    const MFNode& roots;
    ~Reading() {
      if (std::none_of(roots.begin(), roots.end(),
                       [this](const NodeRef& root) { return root && file.stands(*root); }))
        file.forgetLastText();
    }
  } const reading{file, read->world->scope.roots};
  if (const std::string& reason = read->layout.whyNot; !reason.empty())
    throw EditError("the text " + reason);
  const Scope& scope = read->world->scope;
  for (const Diagnostic& one : read->world->diagnostics.list())
    if (one.severity == Severity::error) throw EditError(one.text());
  if (scope.roots.size() != 1 || !scope.routes.empty() || !scope.prototypes.empty())
    throw EditError("the text must be that of one node, without routes and prototypes");
  impl_->nodes.checkPlace(slot, {scope.roots[0], scope.roots[0]});
  MFNode made;
  try {
    made = impl_->file.live().read(read->text, name);
  } catch (const LoadError& error) { throw EditError(error.diagnostic.text()); }
  if (made.size() != 1) throw EditError("the text could not be read a second time");
  const Twin node{made[0], scope.roots[0]};
  impl_->nodes.nameFreshly(node);
  OpenStep step(impl_->history, fmt::format("Insert {}", node.live->type().name));
  impl_->nodes.place(slot, node);
  step.close();
  return node.live;
}

void Editor::use(const NodeSlot& given, Node& node) {
  impl_->file.checkStands(given.parent);
  const Twin twin = impl_->file.standingTwinOf(node);
  const Slot slot = impl_->file.slotOf(given, false);
  impl_->nodes.checkPlace(slot, twin);
  if (impl_->file.document().isRepeated(node.defName))
    throw EditError(
        fmt::format("several nodes are named {}: give this one another name", node.defName));
  OpenStep step(impl_->history, fmt::format("Use {}", node.type().name));
  impl_->nodes.ensureName(twin);
  impl_->nodes.place(slot, twin);
  step.close();
}

void Editor::remove(const NodeSlot& given) {
  impl_->file.checkStands(given.parent);
  const Slot slot = impl_->file.slotOf(given, true);
  OpenStep step(impl_->history, fmt::format("Remove {}", impl_->file.nodeAt(slot)->type().name));
  impl_->nodes.take(slot);
  impl_->nodes.dropRoutes();
  step.close();
}

void Editor::move(const NodeSlot& from, const NodeSlot& to) {
  impl_->file.checkStands(from.parent);
  impl_->file.checkStands(to.parent);
  const Slot source = impl_->file.slotOf(from, true);
  const NodeRef node(impl_->file.nodeAt(source)), parent(to.parent); // Scripts may let them go
  OpenStep step(impl_->history, fmt::format("Move {}", node->type().name));
  const Twin twin = impl_->nodes.take(source);
  const Slot target = impl_->file.slotOf(to, false);
  impl_->nodes.checkPlace(target, twin);
  impl_->nodes.place(target, twin);
  step.close();
}

NodeRef Editor::duplicate(const NodeSlot& given) {
  impl_->file.checkStands(given.parent);
  const Slot slot = impl_->file.slotOf(given, true);
  if (slot.isSingle())
    throw EditError(fmt::format("{} holds one node: there is no place for a copy", given.field));
  const Twin twin = impl_->file.twinOf(*impl_->file.nodeAt(slot));
  const std::string text =
      onStackOf(deepestStack, [&] { return writeNode(impl_->file.document(), *twin.document); });
  OpenStep step(impl_->history, fmt::format("Duplicate {}", twin.live->type().name));
  NodeRef copy = insert({given.parent, given.field, given.index + 1}, text);
  step.close();
  return copy;
}

NodeRef Editor::separate(const NodeSlot& given) {
  impl_->file.checkStands(given.parent);
  const Slot slot = impl_->file.slotOf(given, true);
  const Twin twin = impl_->file.twinOf(*impl_->file.nodeAt(slot));
  const std::string& type = twin.live->type().name;
  if (placesOf(*twin.live).size() < 2)
    throw EditError(fmt::format("this {} stands only here", type));
  const std::string text =
      onStackOf(deepestStack, [&] { return writeNode(impl_->file.document(), *twin.document); });
  OpenStep step(impl_->history, fmt::format("Separate {}", type));
  if (!slot.isSingle()) remove(given);
  NodeRef copy = insert(given, text);
  step.close();
  return copy;
}

NodeRef Editor::wrap(const NodeSlot& given, std::string_view type) {
  impl_->file.checkStands(given.parent);
  const Slot slot = impl_->file.slotOf(given, true);
  const NodeType* const known = findNodeType(type);
  const FieldInfo* const children = known ? known->find("children") : nullptr;
  if (!children || children->type != FieldType::MFNode || !holdsValue(*children))
    throw EditError(fmt::format("'{}' is no node with children", type));
  OpenStep step(impl_->history, fmt::format("Wrap {}", impl_->file.nodeAt(slot)->type().name));
  const Twin inner = impl_->nodes.take(slot);
  const NodeRef outer = insert(given, emptyNode(impl_->file.document(), type));
  const Slot within = impl_->file.slotOf({outer.get(), "children", 0}, false);
  impl_->nodes.checkPlace(within, inner);
  impl_->nodes.place(within, inner);
  step.close();
  return outer;
}

void Editor::rename(Node& node, const std::string& name) {
  const Twin twin = impl_->file.twinOf(node);
  Scope& scope = impl_->file.document().scope();
  if (!isName(name)) throw EditError(fmt::format("'{}' is no name for a node", name));
  if (name == node.defName) return;
  impl_->file.checkStands(&node);
  if (scope.names.contains(name)) throw EditError(fmt::format("another node is named {}", name));
  if (impl_->file.document().isRepeated(node.defName))
    throw EditError(fmt::format("several nodes are named {}: which one a USE means depends on its "
                                "place",
                                node.defName));
  if (const auto exchange = exchangeOf(impl_->file.document().world())) {
    if (!exchange->imports.empty())
      throw EditError("the file imports nodes: only values can be edited there");
    for (const Exchange::Export& one : exchange->exports)
      if (one.node == twin.document)
        throw EditError(
            fmt::format("the file exports {}: other files may use its name", node.defName));
  }
  OpenStep step(impl_->history, fmt::format("Rename {}", node.type().name));
  impl_->nodes.rename(twin, name);
  step.close();
}

NodeRef Editor::declare(Node& node, std::string_view field, const Value& value) {
  const Twin twin = impl_->file.twinOf(node);
  Document& document = impl_->file.document();
  const std::string what = fmt::format("{}.{}", node.type().name, field);
  if (!dynamic_cast<const DeclaringNode*>(&node))
    throw EditError(fmt::format("{} has no fields of its own", node.type().name));
  if (!isName(std::string(field)))
    throw EditError(fmt::format("'{}' is no name for a field", field));
  if (node.type().find(field)) throw EditError(fmt::format("there is a field {} already", what));
  if (document.world().head.version.encoding == Encoding::x3dJson)
    throw EditError(
        fmt::format("{} cannot be declared in JSON: write the field into the file", what));
  const std::vector<NodeSlot> places = placesOf(node);
  if (places.empty()) throw EditError(fmt::format("this {} is not in the file", node.type().name));
  MFNode parents; // Scripts that an edit runs may let them go
  for (const NodeSlot& place : places) parents.emplace_back(place.parent);
  const std::string text =
      withDeclaration(onStackOf(deepestStack, [&] { return writeNode(document, *twin.document); }),
                      document.world().head.version, field, value);
  // A route leads between nodes with names, by which they are found in the live world.
  struct Link {
    Route route;
    NodeRef from, to;
  };
  std::vector<Link> links;
  const auto liveOf = [&](const NodeRef& own) {
    const auto& names = impl_->file.world().scope.names;
    const auto found = names.find(own->defName);
    if (found == names.end() || document.find(found->second->source) != own.get())
      throw EditError(fmt::format("{} cannot be declared: a route leads to or from a node whose "
                                  "name is not its own",
                                  what));
    return found->second;
  };
  for (const Route& route : document.scope().routes)
    if (route.from == twin.document || route.to == twin.document)
      links.push_back({route, liveOf(route.from), liveOf(route.to)});
  OpenStep step(impl_->history, fmt::format("Set {}", what));
  NodeRef made;
  for (const NodeSlot& place : places) {
    const FieldInfo* const holder = place.parent ? place.parent->type().find(place.field) : nullptr;
    if (!holder || holder->type == FieldType::MFNode) remove(place);
    if (made)
      use(place, *made);
    else
      made = insert(place, text);
  }
  if (!node.defName.empty() && made->defName != node.defName) rename(*made, node.defName);
  for (const Link& one : links)
    addRoute(one.from == twin.live ? *made : *one.from, one.route.fromField,
             one.to == twin.live ? *made : *one.to, one.route.toField);
  step.close();
  return made;
}

void Editor::addRoute(Node& from, std::string_view out, Node& to, std::string_view in) {
  const Twin source = impl_->file.standingTwinOf(from), target = impl_->file.standingTwinOf(to);
  const FieldInfo *sent = findEventOut(from, out), *received = findEventIn(to, in);
  if (!sent) throw EditError(fmt::format("{} has no eventOut '{}'", from.type().name, out));
  if (!received) throw EditError(fmt::format("{} has no eventIn '{}'", to.type().name, in));
  if (sent->type != received->type)
    throw EditError(fmt::format("a route joins events of one type: {} is {}, {} is {}", out,
                                fieldTypeName(sent->type), in, fieldTypeName(received->type)));
  const Route route{source.document,
                    std::string(ownName(from, out)),
                    target.document,
                    std::string(ownName(to, in)),
                    {}};
  std::vector<Route>& routes = impl_->file.document().scope().routes;
  const auto same = [route](const Route& one) {
    return one.from == route.from && one.to == route.to && one.fromField == route.fromField &&
           one.toField == route.toField;
  };
  if (std::any_of(routes.begin(), routes.end(), same)) throw EditError("the file has this route");
  OpenStep step(impl_->history, "Add route");
  impl_->nodes.ensureName(source);
  impl_->nodes.ensureName(target);
  EditedFile& file = impl_->file;
  impl_->history.perform(
      {[&file, &routes, route, source, target] {
         file.live().addRoute(*source.live, route.fromField, *target.live, route.toField);
         routes.push_back(route);
       },
       [&file, &routes, route, source, target, same] {
         file.live().removeRoute(*source.live, route.fromField, *target.live, route.toField);
         routes.erase(std::find_if(routes.begin(), routes.end(), same));
       }});
  step.close();
}

void Editor::removeRoute(Node& from, std::string_view out, Node& to, std::string_view in) {
  const Twin source = impl_->file.twinOf(from), target = impl_->file.twinOf(to);
  std::vector<Route>& routes = impl_->file.document().scope().routes;
  const auto found = std::find_if(routes.begin(), routes.end(), [&](const Route& one) {
    return one.from == source.document && one.to == target.document &&
           one.fromField == ownName(from, out) && one.toField == ownName(to, in);
  });
  if (found == routes.end()) throw EditError("the file has no such route");
  OpenStep step(impl_->history, "Remove route");
  EditedFile& file = impl_->file;
  const auto index = found - routes.begin();
  impl_->history.perform(
      {[&file, &routes, index, source, target, route = *found] {
         file.live().removeRoute(*source.live, route.fromField, *target.live, route.toField);
         routes.erase(routes.begin() + index);
       },
       [&file, &routes, index, source, target, route = *found] {
         file.live().addRoute(*source.live, route.fromField, *target.live, route.toField);
         routes.insert(routes.begin() + index, route);
       }});
  step.close();
}

std::function<void()> Editor::preparation() { return impl_->file.preparation(); }
bool Editor::isPreparing() const { return impl_->file.isPreparing(); }
std::string Editor::whyReadOnly() { return impl_->file.whyNot(); }
std::string Editor::text() { return impl_->file.text(); }
bool Editor::isInStep() const { return impl_->history.isOpen(); }

std::string Editor::bytes() {
  if (isInStep()) throw EditError("an edit is under way: end it before the file is saved");
  return impl_->file.bytes();
}
bool Editor::isChanged() const { return impl_->history.isChanged(); }
bool Editor::isChangedOnDisk() const { return impl_->file.isChangedOnDisk(); }

void Editor::saved() {
  impl_->history.saved();
  impl_->file.saved();
}

std::string Editor::draft() { return impl_->file.draft(); }
std::string Editor::textOnDisk() { return impl_->file.textOnDisk(); }

void Editor::adopt(std::string text) {
  impl_->file.adopt(std::move(text));
  impl_->history.neverSaved();
}

} // namespace xvrml
