// editor.cpp: the editor of a world's file: steps, and the edits that they consist of. Each edit
// changes the document and the live world alike.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "base/rotation.h"
#include "base/visit_storage.h"
#include "edit/document.h"
#include "edit/in_place_writer.h"
#include "edit/live_world.h"
#include "enough_stack.h"
#include "graph/exchange.h"
#include "graph/field_access.h"
#include "graph/node_kinds.h"
#include "graph/range.h"
#include "parse/source.h"
#include "system/files.h"
#include "write/names.h"
#include "xvrml/edit.h"

namespace xvrml {
namespace {

// Stack in bytes for the deepest nesting that a file may have.
constexpr size_t deepestStack = size_t(32) << 20;

// One edit of the document and of the live world.
struct Edit {
  std::function<void()> redo, undo;
  // A value: the node and its field. A later value in the same step takes its place.
  const Node* node = nullptr;
  std::string field{};
};

struct Step {
  std::string name;
  std::vector<Edit> edits;
};

// A node in the live world and in the document.
struct Twin {
  NodeRef live, document;
};

// A place for a node in both of them.
struct Slot {
  Twin parent; // empty: the roots
  const FieldInfo* field = nullptr;
  size_t liveIndex = 0, index = 0;

  bool isSingle() const { return field && field->type == FieldType::SFNode; }
};

// What tells a file that has been written to from one that has not.
struct FileState {
  int64_t seconds = 0, nanoseconds = 0, bytes = 0;
  uint64_t number = 0;
  bool operator==(const FileState&) const = default;
};

FileState stateOf(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  const timespec time = os::modifiedTime(status);
  return {int64_t(time.tv_sec), int64_t(time.tv_nsec), int64_t(status.st_size),
          uint64_t(status.st_ino)};
}

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

bool contains(const Node& root, const Node& searched) {
  return !walk(std::vector<const Node*>{&root}, [&](const Node& node, auto& open) {
    appendChildren(node, open);
    return &node != &searched;
  });
}

} // namespace

struct Editor::Impl {
  std::unique_ptr<LiveWorld> live;
  std::unique_ptr<Document> file; // made at the first edit
  bool packed = false, marked = false;
  FileState onDisk;
  std::vector<Step> steps; // those that have been done first, then those that have been undone
  size_t done = 0;
  size_t savedAt = 0; // value of `done` at which the file was saved; ~0: it cannot be reached again
  Step open;
  size_t depth = 0; // number of begin() without end()
  size_t texts = 0; // number of texts that have been inserted

  World& world() { return live->world(); }
  std::string whyNot();
  Document& document();
  Twin twinOf(Node& node);
  Slot slotOf(const NodeSlot& given, bool holds);
  Node* nodeAt(const Slot& slot);

  void begin(std::string name) {
    if (depth++ == 0) open = {std::move(name), {}};
  }
  void end();
  void rollBack(size_t edits);
  void perform(Edit edit);

  void place(const Slot& slot, const Twin& node);
  Twin take(const Slot& slot);
  void setSingle(const Slot& slot, const Twin& node);
  void nameFreshly(const Twin& root);
  void checkPlace(const Slot& slot, const Node& node);
  void rename(const Twin& node, const std::string& name);
  void ensureName(const Twin& node);
  void dropRoutes();
  std::string text();
};

namespace {

// A step, or a part of one, that is undone unless it is closed.
class OpenStep {
 public:
  template <class Impl> OpenStep(Impl& impl, std::string name)
      : rollBack_([&impl, edits = impl.depth ? impl.open.edits.size() : 0] {
          impl.rollBack(edits);
          --impl.depth;
        }),
        close_([&impl] { impl.end(); }) {
    impl.begin(std::move(name));
  }
  ~OpenStep() {
    if (rollBack_) rollBack_();
  }
  OpenStep(const OpenStep&) = delete;
  OpenStep& operator=(const OpenStep&) = delete;
  void close() {
    rollBack_ = nullptr;
    close_();
  }

 private:
  std::function<void()> rollBack_, close_;
};

} // namespace

// Returns why the file cannot be edited. Reads it if it can.
std::string Editor::Impl::whyNot() {
  if (file) return "";
  const std::string& path = world().path;
  if (path.empty() || path == "-") return "the world does not come from a file";
  const Encoding encoding = world().head.version.encoding;
  if (encoding != Encoding::vrml97 && encoding != Encoding::x3dClassic)
    return fmt::format("{} is {}: VRML97 and X3D ClassicVRML can be edited in place; write it as "
                       "one of these first",
                       path, encodingName(encoding));
  try {
    const FileState state = stateOf(path);
    const Source source = Source::open(path, world().options.limits, nullptr);
    if (source.isUtf16())
      return fmt::format("{} is in UTF-16, which is only read: write it anew first", path);
    packed = source.isPacked();
    marked = source.hasByteOrderMark();
    file = std::make_unique<Document>(std::string(source.text()), path, world().options);
    onDisk = state;
  } catch (const LoadError& error) { return error.diagnostic.text(); }
  return "";
}

Document& Editor::Impl::document() {
  if (const std::string reason = whyNot(); !reason.empty()) throw EditError(reason);
  return *file;
}

Twin Editor::Impl::twinOf(Node& node) {
  Document& document = this->document();
  Node* const found = document.find(node.source);
  const std::string& type = node.type().name;
  if (found && found->type().name == type && found->defName == node.defName)
    return {NodeRef(&node), NodeRef(found)};
  if (found)
    throw EditError(fmt::format("{} has changed since the world was loaded: line {} holds another "
                                "node than this {}",
                                world().path, node.source.line, type));
  if (!node.source.file)
    throw EditError(fmt::format("this {} stands in no file: a program has made it", type));
  if (*node.source.file != world().path)
    throw EditError(fmt::format("this {} stands in {}, not in the world's own file {}", type,
                                *node.source.file, world().path));
  throw EditError(fmt::format("this {} of line {} belongs to the body of a prototype: edit the "
                              "fields of the instance",
                              type, node.source.line));
}

// holds: there must be a node at the place.
Slot Editor::Impl::slotOf(const NodeSlot& given, bool holds) {
  Slot slot;
  if (given.parent) {
    slot.parent = twinOf(*given.parent);
    slot.field = given.parent->type().find(given.field);
    if (!slot.field || !holdsNodes(*slot.field))
      throw EditError(fmt::format("{} has no field '{}' that holds nodes",
                                  given.parent->type().name, given.field));
  }
  if (slot.isSingle()) {
    if (given.index > 0 || (holds && !nodeAt(slot)))
      throw EditError(fmt::format("{} of {} holds {}", slot.field->name, given.parent->type().name,
                                  given.index > 0 ? "one node" : "no node"));
    return slot;
  }
  const MFNode& list = slot.field
                           ? *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field))
                           : world().scope.roots;
  slot.liveIndex = given.index;
  if (given.index + (holds ? 1 : 0) > list.size())
    throw EditError(fmt::format("there is no place {} among {} nodes", given.index, list.size()));
  const MFNode& own = document().listOf(slot.parent.document.get(), slot.field);
  if (holds) {
    const NodeRef& node = list[given.index];
    if (!node) throw EditError("NULL stands there");
    const Twin twin = twinOf(*node);
    auto before = std::count(list.begin(), list.begin() + std::ptrdiff_t(given.index), node);
    const auto found = std::find_if(own.begin(), own.end(), [&](const NodeRef& one) {
      return one == twin.document && before-- == 0;
    });
    if (found == own.end())
      throw EditError(fmt::format("this {} does not stand there in the file", node->type().name));
    slot.index = size_t(found - own.begin());
    return slot;
  }
  // Behind the last node before the place that is in the file.
  for (size_t i = given.index; i-- > 0;) {
    const Node* const known = list[i] ? document().find(list[i]->source) : nullptr;
    const auto found = std::find_if(
        own.begin(), own.end(), [&](const NodeRef& one) { return known && one.get() == known; });
    if (found == own.end()) continue;
    slot.index = size_t(found - own.begin()) + 1;
    break;
  }
  return slot;
}

Node* Editor::Impl::nodeAt(const Slot& slot) {
  if (slot.isSingle())
    return static_cast<const NodeRef*>(slot.parent.live->storage(*slot.field))->get();
  const MFNode& list = slot.field
                           ? *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field))
                           : world().scope.roots;
  return slot.liveIndex < list.size() ? list[slot.liveIndex].get() : nullptr;
}

void Editor::Impl::end() {
  if (depth == 0 || --depth > 0 || open.edits.empty()) return;
  if (savedAt > done) savedAt = ~size_t(0);
  steps.resize(done);
  steps.push_back(std::exchange(open, {}));
  ++done;
}

void Editor::Impl::rollBack(size_t edits) {
  while (open.edits.size() > edits) {
    open.edits.back().undo();
    open.edits.pop_back();
  }
}

void Editor::Impl::perform(Edit edit) {
  edit.redo();
  const auto earlier = std::find_if(open.edits.begin(), open.edits.end(), [&](const Edit& one) {
    return edit.node && one.node == edit.node && one.field == edit.field;
  });
  if (earlier != open.edits.end())
    earlier->redo = std::move(edit.redo);
  else
    open.edits.push_back(std::move(edit));
}

namespace {

void insertAt(MFNode& list, size_t index, const NodeRef& node) {
  list.insert(list.begin() + std::ptrdiff_t(std::min(index, list.size())), node);
}

void eraseAt(MFNode& list, size_t index) {
  if (index < list.size()) list.erase(list.begin() + std::ptrdiff_t(index));
}

// Puts a node into a list of the live world, or takes it out.
void insertLive(LiveWorld& live, const Slot& slot, const NodeRef& node) {
  if (!slot.field) return live.addRoot(node, slot.liveIndex);
  MFNode list = *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field));
  insertAt(list, slot.liveIndex, node);
  live.set(*slot.parent.live, slot.field->name, std::move(list));
}

void eraseLive(LiveWorld& live, const Slot& slot, const NodeRef& node) {
  if (!slot.field) return live.removeRoot(*node);
  MFNode list = *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field));
  size_t index = slot.liveIndex;
  if (index >= list.size() || list[index] != node) // Scripts may have moved it
    index = size_t(std::find(list.begin(), list.end(), node) - list.begin());
  eraseAt(list, index);
  live.set(*slot.parent.live, slot.field->name, std::move(list));
}

} // namespace

void Editor::Impl::setSingle(const Slot& slot, const Twin& node) {
  const FieldInfo& own = *slot.parent.document->type().find(slot.field->name);
  const Twin before{*static_cast<const NodeRef*>(slot.parent.live->storage(*slot.field)),
                    *static_cast<const NodeRef*>(slot.parent.document->storage(own))};
  const auto put = [this, slot, &own](const Twin& twin) {
    live->set(*slot.parent.live, slot.field->name, twin.live);
    file->setNode(*slot.parent.document, own, twin.document);
  };
  perform({[put, node] { put(node); }, [put, before] { put(before); }});
}

// Puts a node at a place.
void Editor::Impl::place(const Slot& slot, const Twin& node) {
  if (slot.isSingle()) return setSingle(slot, node);
  perform({[this, slot, node] {
             insertLive(*live, slot, node.live);
             file->insert(slot.parent.document.get(), slot.field, slot.index, node.document);
           },
           [this, slot, node] {
             eraseLive(*live, slot, node.live);
             file->erase(slot.parent.document.get(), slot.field, slot.index);
           }});
}

// Takes the node at a place out.
Twin Editor::Impl::take(const Slot& slot) {
  Node* const found = nodeAt(slot);
  const Twin node = twinOf(*found);
  if (slot.isSingle()) {
    setSingle(slot, {});
    return node;
  }
  perform({[this, slot, node] {
             eraseLive(*live, slot, node.live);
             file->erase(slot.parent.document.get(), slot.field, slot.index);
           },
           [this, slot, node] {
             insertLive(*live, slot, node.live);
             file->insert(slot.parent.document.get(), slot.field, slot.index, node.document);
           }});
  return node;
}

void Editor::Impl::checkPlace(const Slot& slot, const Node& node) {
  const NodeType* const type = effectiveType(node);
  const std::string_view accepted =
      slot.field ? std::string_view(slot.field->nodeTypes) : std::string_view("child");
  if (type && !accepted.empty() && !typeAccepted(accepted, *type))
    throw EditError(slot.field ? fmt::format("{} cannot be in field {} of {}: expected {}",
                                             node.type().name, slot.field->name,
                                             slot.parent.live->type().name, accepted)
                               : fmt::format("{} cannot stand at the root of a file: expected a "
                                             "child node",
                                             node.type().name));
  if (slot.parent.live && contains(node, *slot.parent.live))
    throw EditError(fmt::format("this {} would become a part of itself", node.type().name));
}

// Gives the nodes of a text that has been read names that no other node has.
void Editor::Impl::nameFreshly(const Twin& root) {
  std::vector<Twin> named;
  walk(std::vector<Node*>{root.live.get()}, [&](Node& node, std::vector<Node*>& open) {
    appendChildren(node, open);
    Node* const own = file->find(node.source);
    if (own && !node.defName.empty()) named.push_back({NodeRef(&node), NodeRef(own)});
  });
  std::set<std::string, std::less<>> taken;
  for (const Twin& one : named) taken.insert(one.live->defName);
  for (const Twin& one : named) {
    if (!file->names().contains(one.live->defName)) continue;
    one.live->defName = file->freshName(one.live->defName, taken);
    file->rename(*one.document, one.live->defName);
    taken.insert(one.live->defName);
  }
}

void Editor::Impl::rename(const Twin& node, const std::string& name) {
  const auto give = [this, node](const std::string& from, const std::string& to) {
    auto& names = world().scope.names;
    if (const auto found = names.find(from); found != names.end() && found->second == node.live)
      names.erase(found);
    node.live->defName = to;
    file->rename(*node.document, to);
    if (!to.empty()) names[to] = node.live;
  };
  perform({[give, before = node.live->defName, name] { give(before, name); },
           [give, before = node.live->defName, name] { give(name, before); }});
}

void Editor::Impl::ensureName(const Twin& node) {
  if (node.live->defName.empty()) rename(node, file->freshName(node.live->type().name));
}

// Removes the routes whose nodes do not stand in the file any more.
void Editor::Impl::dropRoutes() {
  const SeenNodes standing = file->standing();
  std::vector<Route>& routes = file->scope().routes;
  std::vector<std::pair<size_t, Route>> gone;
  for (size_t i = 0; i < routes.size(); ++i)
    if (!standing.contains(routes[i].from.get()) || !standing.contains(routes[i].to.get()))
      gone.emplace_back(i, routes[i]);
  if (gone.empty()) return;
  perform({[&routes, gone] {
             for (size_t i = gone.size(); i-- > 0;)
               routes.erase(routes.begin() + std::ptrdiff_t(gone[i].first));
           },
           [&routes, gone] {
             for (const auto& [index, route] : gone)
               routes.insert(routes.begin() + std::ptrdiff_t(index), route);
           }});
}

std::string Editor::Impl::text() {
  Document& document = this->document();
  document.names();
  if (const auto exchange = exchangeOf(document.world())) {
    const SeenNodes standing = document.standing();
    for (const Exchange::Export& one : exchange->exports)
      if (!standing.contains(one.node.get()))
        throw EditError(
            fmt::format("{} has been removed, but the file exports it", one.node->defName));
  }
  return onStackOf(deepestStack, [&]() -> std::string {
    std::string written = writeInPlace(document);
    LoadOptions options = world().options;
    options.loadInlines = false;
    std::string difference;
    try {
      const std::unique_ptr<World> read = loadWorldFromMemory(written, world().path, options);
      if (equalScopes(document.scope(), read->scope, &difference)) return written;
    } catch (const LoadError& error) { difference = error.diagnostic.text(); }
    throw EditError(fmt::format("{} cannot be edited in place, because its text would not give the "
                                "edited world ({}): write the world anew",
                                world().path, difference));
  });
}

Editor::Editor(Browser& browser) : impl_(std::make_unique<Impl>()) {
  impl_->live = makeLiveWorld(browser);
}
Editor::Editor(World& world) : impl_(std::make_unique<Impl>()) {
  impl_->live = makeLiveWorld(world);
}
Editor::~Editor() = default;

void Editor::run(Browser& browser) { impl_->live = makeLiveWorld(browser); }

std::vector<NodeSlot> Editor::placesOf(const Node& node) {
  std::vector<NodeSlot> places;
  const MFNode& roots = impl_->world().scope.roots;
  for (size_t i = 0; i < roots.size(); ++i)
    if (roots[i].get() == &node) places.push_back({nullptr, "", i});
  walk(rootsOf(impl_->world().scope), [&](Node& parent, std::vector<Node*>& open) {
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

void Editor::begin(std::string name) { impl_->begin(std::move(name)); }
void Editor::end() { impl_->end(); }

void Editor::cancel() {
  impl_->rollBack(0);
  impl_->depth = 0;
}

bool Editor::undo() {
  if (impl_->depth > 0 || impl_->done == 0) return false;
  Step& step = impl_->steps[--impl_->done];
  for (size_t i = step.edits.size(); i-- > 0;) step.edits[i].undo();
  return true;
}

bool Editor::redo() {
  if (impl_->depth > 0 || impl_->done == impl_->steps.size()) return false;
  for (Edit& edit : impl_->steps[impl_->done++].edits) edit.redo();
  return true;
}

std::string Editor::undoName() const {
  return impl_->done > 0 ? impl_->steps[impl_->done - 1].name : "";
}
std::string Editor::redoName() const {
  return impl_->done < impl_->steps.size() ? impl_->steps[impl_->done].name : "";
}

void Editor::set(Node& node, std::string_view field, Value value) {
  const Twin twin = impl_->twinOf(node);
  const std::string what = fmt::format("{}.{}", node.type().name, field);
  const FieldInfo* const info = node.type().find(field);
  if (!info || !holdsValue(*info)) throw EditError(fmt::format("there is no field {}", what));
  if (holdsNodes(*info))
    throw EditError(fmt::format("{} holds nodes: insert or remove them", what));
  if (value.index() != size_t(info->type))
    throw EditError(fmt::format("{} is {}", what, fieldTypeName(info->type)));
  if (!isFinite(*info, value))
    throw EditError(fmt::format("{}: a number is not finite, which no file can say", what));
  if (info->range.bounded() && info->type != FieldType::SFRotation && !inRange(*info, value))
    throw EditError(fmt::format("{}: a number is outside of {}", what, describe(info->range)));
  if (hasNormalizedAxes(*info))
    normalizeAxes(info->type, std::visit([](auto& v) -> void* { return &v; }, value));
  const FieldInfo& own = *twin.document->type().find(field);
  const auto put = [this, twin, &own](const Value& live, const Value& inFile) {
    impl_->live->set(*twin.live, own.name, live);
    impl_->file->set(*twin.document, own, inFile);
  };
  OpenStep step(*impl_, fmt::format("Set {}", what));
  impl_->perform(
      {[put, value] { put(value, value); },
       [put, live = node.get(*info), inFile = twin.document->get(own)] { put(live, inFile); },
       &node, std::string(field)});
  step.close();
}

NodeRef Editor::insert(const NodeSlot& given, std::string_view text) {
  const Slot slot = impl_->slotOf(given, false);
  Document& file = impl_->document();
  const std::string name = fmt::format("{} (edit {})", impl_->world().path, ++impl_->texts);
  const DocumentText* read = nullptr;
  try {
    read = &file.read(std::string(text), impl_->live->placeName(name));
  } catch (const LoadError& error) { throw EditError(error.diagnostic.text()); }
  const Scope& scope = read->world->scope;
  for (const Diagnostic& one : read->world->diagnostics.list())
    if (one.severity == Severity::error) throw EditError(one.text());
  if (scope.roots.size() != 1 || !scope.routes.empty() || !scope.prototypes.empty())
    throw EditError("the text must be that of one node, without routes and prototypes");
  impl_->checkPlace(slot, *scope.roots[0]);
  const MFNode made = impl_->live->read(std::string(text), name);
  if (made.size() != 1) throw EditError("the text could not be read a second time");
  const Twin node{made[0], scope.roots[0]};
  impl_->nameFreshly(node);
  OpenStep step(*impl_, fmt::format("Insert {}", node.live->type().name));
  impl_->place(slot, node);
  step.close();
  return node.live;
}

void Editor::use(const NodeSlot& given, Node& node) {
  const Twin twin = impl_->twinOf(node);
  const Slot slot = impl_->slotOf(given, false);
  impl_->checkPlace(slot, node);
  OpenStep step(*impl_, fmt::format("Use {}", node.type().name));
  impl_->ensureName(twin);
  impl_->place(slot, twin);
  step.close();
}

void Editor::remove(const NodeSlot& given) {
  const Slot slot = impl_->slotOf(given, true);
  OpenStep step(*impl_, fmt::format("Remove {}", impl_->nodeAt(slot)->type().name));
  impl_->take(slot);
  impl_->dropRoutes();
  step.close();
}

void Editor::move(const NodeSlot& from, const NodeSlot& to) {
  const Slot source = impl_->slotOf(from, true);
  const NodeRef node(impl_->nodeAt(source));
  OpenStep step(*impl_, fmt::format("Move {}", node->type().name));
  const Twin twin = impl_->take(source);
  const Slot target = impl_->slotOf(to, false);
  impl_->checkPlace(target, *node);
  impl_->place(target, twin);
  step.close();
}

NodeRef Editor::duplicate(const NodeSlot& given) {
  const Slot slot = impl_->slotOf(given, true);
  if (slot.isSingle())
    throw EditError(fmt::format("{} holds one node: there is no place for a copy", given.field));
  const Twin twin = impl_->twinOf(*impl_->nodeAt(slot));
  const std::string text =
      onStackOf(deepestStack, [&] { return writeNode(impl_->document(), *twin.document); });
  OpenStep step(*impl_, fmt::format("Duplicate {}", twin.live->type().name));
  NodeRef copy = insert({given.parent, given.field, given.index + 1}, text);
  step.close();
  return copy;
}

NodeRef Editor::wrap(const NodeSlot& given, std::string_view type) {
  const Slot slot = impl_->slotOf(given, true);
  OpenStep step(*impl_, fmt::format("Wrap {}", impl_->nodeAt(slot)->type().name));
  const Twin inner = impl_->take(slot);
  const NodeRef outer = insert(given, fmt::format("{} {{\n  children [\n  ]\n}}", type));
  const Slot within = impl_->slotOf({outer.get(), "children", 0}, false);
  impl_->checkPlace(within, *inner.live);
  impl_->place(within, inner);
  step.close();
  return outer;
}

void Editor::rename(Node& node, const std::string& name) {
  const Twin twin = impl_->twinOf(node);
  Document& file = impl_->document();
  if (nameText(name) != name) throw EditError(fmt::format("'{}' is no name for a node", name));
  if (name == node.defName) return;
  if (file.names().contains(name)) throw EditError(fmt::format("another node is named {}", name));
  if (!node.defName.empty() && file.names().at(node.defName) != twin.document)
    throw EditError(fmt::format("several nodes are named {}: what refers to it depends on the "
                                "order of the file",
                                node.defName));
  if (const auto exchange = exchangeOf(file.world()))
    for (const Exchange::Export& one : exchange->exports)
      if (one.node == twin.document)
        throw EditError(
            fmt::format("the file exports {}: other files may use its name", node.defName));
  OpenStep step(*impl_, fmt::format("Rename {}", node.type().name));
  impl_->rename(twin, name);
  step.close();
}

void Editor::addRoute(Node& from, std::string_view out, Node& to, std::string_view in) {
  const Twin source = impl_->twinOf(from), target = impl_->twinOf(to);
  const FieldInfo *sent = from.type().findEventOut(out), *received = to.type().findEventIn(in);
  if (!sent) throw EditError(fmt::format("{} has no eventOut '{}'", from.type().name, out));
  if (!received) throw EditError(fmt::format("{} has no eventIn '{}'", to.type().name, in));
  if (sent->type != received->type)
    throw EditError(fmt::format("a route joins events of one type: {} is {}, {} is {}", out,
                                fieldTypeName(sent->type), in, fieldTypeName(received->type)));
  const Route route{source.document, std::string(out), target.document, std::string(in), {}};
  std::vector<Route>& routes = impl_->document().scope().routes;
  const auto same = [route](const Route& one) {
    return one.from == route.from && one.to == route.to && one.fromField == route.fromField &&
           one.toField == route.toField;
  };
  if (std::any_of(routes.begin(), routes.end(), same)) throw EditError("the file has this route");
  OpenStep step(*impl_, "Add route");
  impl_->ensureName(source);
  impl_->ensureName(target);
  LiveWorld& live = *impl_->live;
  impl_->perform({[&live, &routes, route, source, target] {
                    live.addRoute(*source.live, route.fromField, *target.live, route.toField);
                    routes.push_back(route);
                  },
                  [&live, &routes, route, source, target, same] {
                    live.removeRoute(*source.live, route.fromField, *target.live, route.toField);
                    routes.erase(std::find_if(routes.begin(), routes.end(), same));
                  }});
  step.close();
}

void Editor::removeRoute(Node& from, std::string_view out, Node& to, std::string_view in) {
  const Twin source = impl_->twinOf(from), target = impl_->twinOf(to);
  std::vector<Route>& routes = impl_->document().scope().routes;
  const auto found = std::find_if(routes.begin(), routes.end(), [&](const Route& one) {
    return one.from == source.document && one.to == target.document && one.fromField == out &&
           one.toField == in;
  });
  if (found == routes.end()) throw EditError("the file has no such route");
  OpenStep step(*impl_, "Remove route");
  LiveWorld& live = *impl_->live;
  const auto index = found - routes.begin();
  impl_->perform({[&live, &routes, index, source, target, route = *found] {
                    live.removeRoute(*source.live, route.fromField, *target.live, route.toField);
                    routes.erase(routes.begin() + index);
                  },
                  [&live, &routes, index, source, target, route = *found] {
                    live.addRoute(*source.live, route.fromField, *target.live, route.toField);
                    routes.insert(routes.begin() + index, route);
                  }});
  step.close();
}

std::string Editor::whyReadOnly() { return impl_->whyNot(); }
std::string Editor::text() { return impl_->text(); }

std::string Editor::bytes() {
  std::string text = impl_->text();
  if (impl_->marked) text.insert(0, "\xef\xbb\xbf");
  return impl_->packed ? packed(text) : text;
}

bool Editor::isChanged() const {
  return impl_->done != impl_->savedAt || (impl_->depth > 0 && !impl_->open.edits.empty());
}

bool Editor::isChangedOnDisk() const {
  return impl_->file && stateOf(impl_->live->world().path) != impl_->onDisk;
}

void Editor::saved() {
  impl_->savedAt = impl_->done;
  impl_->onDisk = stateOf(impl_->live->world().path);
}

} // namespace xvrml
