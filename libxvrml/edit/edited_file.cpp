#include "edit/edited_file.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "edit/gzip.h"
#include "edit/in_place_writer.h"
#include "enough_stack.h"
#include "graph/exchange.h"
#include "graph/field_access.h"
#include "parse/source.h"
#include "xvrml/versions.h"

namespace xvrml {

// Returns why a file of this kind cannot be edited, whatever is in it.
std::string EditedFile::whyNotKind() {
  const std::string& path = world().path;
  if (stampOf(path) == FileStamp()) return "the world does not come from a file";
  const Encoding encoding = world().head.version.encoding;
  if (encoding != Encoding::vrml97 && encoding != Encoding::x3dClassic &&
      encoding != Encoding::x3dXml && encoding != Encoding::x3dJson)
    return fmt::format("{} is {}: VRML97 and X3D can be edited in place; write it as one of these "
                       "first",
                       path, encodingName(encoding));
  for (const FileHead::Unit& unit : world().head.units)
    if (unit.category == "angle")
      return fmt::format("{} has a unit of its own for angles, which is only read", path);
  return "";
}

// Reads a file. adopted: is read instead of its text. [any thread]
EditedFile::Opened EditedFile::open(const std::string& path, const LoadOptions& options,
                                    const std::optional<std::string>& adopted) {
  Opened opened;
  try {
    const Source source = Source::open(path, options.limits, nullptr);
    if (source.isUtf16()) {
      opened.whyNot = fmt::format("{} is in UTF-16, which is only read: write it anew first", path);
      return opened;
    }
    opened.isPacked = source.isPacked();
    opened.isMarked = source.hasByteOrderMark();
    opened.onDisk = source.stamp();
    opened.document =
        std::make_unique<Document>(adopted ? *adopted : std::string(source.text()), path, options);
    if (const std::string& reason = opened.document->file().layout.whyNot; !reason.empty())
      opened.whyNot = fmt::format("{} {}", path, reason);
  } catch (const LoadError& error) { opened.whyNot = error.diagnostic.text(); }
  return opened;
}

std::string EditedFile::whyNot() {
  if (document_) return "";
  if (!refusal_.empty()) return refusal_;
  if (std::string reason = whyNotKind(); !reason.empty()) return reason;
  Opened opened = takePrepared();
  if (!opened.whyNot.empty()) return refusal_ = opened.whyNot;
  document_ = std::move(opened.document);
  packed_ = opened.isPacked;
  marked_ = opened.isMarked;
  onDisk_ = opened.onDisk;
  read_ = adopted_ ? FileStamp() : onDisk_; // a text in memory has no stamp
  return "";
}

// Returns what the thread has read that prepares the edits, or reads it.
EditedFile::Opened EditedFile::takePrepared() {
  if (prepared_.valid()) {
    try {
      return prepared_.get();
    } catch (const std::future_error&) {} // there was no thread for it
  }
  return open(world().path, world().options, adopted_);
}

std::function<void()> EditedFile::preparation() {
  if (document_ || prepared_.valid() || !whyNotKind().empty()) return {};
  const auto task = std::make_shared<std::packaged_task<Opened()>>(
      [path = world().path, options = world().options] { return open(path, options, {}); });
  prepared_ = task->get_future();
  return [task] { (*task)(); };
}

bool EditedFile::isPreparing() const {
  return prepared_.valid() &&
         prepared_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

Document& EditedFile::document() {
  if (live_->isReplaced())
    throw EditError("another world has taken the place of the one that was edited");
  if (const std::string reason = whyNot(); !reason.empty()) throw EditError(reason);
  return *document_;
}

Twin EditedFile::twinOf(Node& node) {
  Document& document = this->document();
  Node* const found = document.find(node.source);
  const std::string& type = node.type().name;
  if (found && document.isOwn(*found)) checkUnchanged(node);
  if (found && found->type().name == type) return {NodeRef(&node), NodeRef(found)};
  if (!node.source.file)
    throw EditError(fmt::format("this {} stands in no file: a program has made it", type));
  if (*node.source.file != world().path)
    throw EditError(fmt::format("this {} stands in {}, not in the world's own file {}", type,
                                *node.source.file, world().path));
  throw EditError(fmt::format("this {} of line {} belongs to the body of a prototype: edit the "
                              "fields of the instance",
                              type, node.source.line));
}

void EditedFile::checkUnchanged(const Node& node) const {
  if (fileStamp(node.source.file) != read_)
    throw EditError(fmt::format("{} has been written to since the world was loaded: load it again",
                                *node.source.file));
}

Twin EditedFile::standingTwinOf(Node& node) {
  Twin twin = twinOf(node);
  if (!document().stands(*twin.document))
    throw EditError(fmt::format("this {} has been removed from the file", node.type().name));
  return twin;
}

size_t EditedFile::countPlaces(const Node& node) const {
  const Node* const found = document_ ? document_->find(node.source) : nullptr;
  return found && found->type().name == node.type().name ? document_->countPlaces(*found) : 0;
}

void EditedFile::checkStands(Node* node) {
  if (node) standingTwinOf(*node);
}

Slot EditedFile::slotOf(const NodeSlot& given, bool holds) {
  document(); // reads the file
  Slot slot;
  if (given.parent) {
    slot.parent = twinOf(*given.parent);
    slot.field = findField(*given.parent, given.field);
    if (!slot.field || !holdsNodes(*slot.field))
      throw EditError(fmt::format("{} has no field '{}' that holds nodes",
                                  given.parent->type().name, given.field));
  } else {
    const MFNode& roots = world().scope.roots;
    const auto own = std::find_if(roots.begin(), roots.end(), [this](const NodeRef& root) {
      return root && root->source.file && *root->source.file == world().path;
    });
    if (own != roots.end()) checkUnchanged(**own);
  }
  if (const auto exchange = exchangeOf(document().world()); exchange && !exchange->imports.empty())
    throw EditError(fmt::format("{} imports nodes: only values can be edited there", world().path));
  if (slot.field) checkReadable(*slot.parent.document, *slot.field);
  if (slot.isSingle()) {
    if (given.index > 0 || (holds && !nodeAt(slot)))
      throw EditError(fmt::format("{} of {} holds {}", slot.field->name, given.parent->type().name,
                                  given.index > 0 ? "one node" : "no node"));
    return slot;
  }
  const MFNode& list = liveList(slot);
  slot.liveIndex = given.index;
  if (given.index > list.size() || (holds && given.index == list.size()))
    throw EditError(fmt::format("there is no place {} among {} nodes", given.index, list.size()));
  const MFNode& own = document().listOf(slot.parent.document.get(), slot.field);
  // Only the fields of instances have nodes without a text.
  const bool isInstance = given.parent && nodeCast<ProtoInstance>(given.parent);
  for (const NodeRef& node : isInstance ? own : MFNode())
    if (node && !document().hasText(*node))
      throw EditError(fmt::format("{} of this {} has the nodes of its prototype, which cannot be "
                                  "edited here",
                                  given.field, given.parent->type().name));
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
  // Behind the last node before the place that is in the file, as often as it stands before it.
  for (size_t i = given.index; i-- > 0;) {
    const Node* const known = list[i] ? document().find(list[i]->source) : nullptr;
    if (!known) continue;
    auto before = std::count(list.begin(), list.begin() + std::ptrdiff_t(i), list[i]);
    const auto found = std::find_if(own.begin(), own.end(), [&](const NodeRef& one) {
      return one.get() == known && before-- == 0;
    });
    if (found == own.end()) continue;
    slot.index = size_t(found - own.begin()) + 1;
    break;
  }
  return slot;
}

void EditedFile::checkReadable(const Node& node, const FieldInfo& field) {
  const FieldText* const text = document().textOf(node, field);
  if (!text || text->faithful) return;
  if (text->form == FieldForm::program)
    throw EditError(fmt::format("the program of this Script of line {} stands between its tags: "
                                "edit it there",
                                node.source.line));
  throw EditError(fmt::format("a part of the field {} of line {} could not be read: mend it first",
                              field.name, node.source.line));
}

Node* EditedFile::nodeAt(const Slot& slot) {
  if (slot.isSingle())
    return static_cast<const NodeRef*>(slot.parent.live->storage(*slot.field))->get();
  const MFNode& list = liveList(slot);
  return slot.liveIndex < list.size() ? list[slot.liveIndex].get() : nullptr;
}

std::string EditedFile::text() {
  Document& document = this->document();
  if (const auto exchange = exchangeOf(document.world()))
    for (const Exchange::Export& one : exchange->exports)
      if (!document.stands(*one.node))
        throw EditError(
            fmt::format("{} has been removed, but the file exports it", one.node->defName));
  return onStackOf(deepestStack, [&]() -> std::string {
    std::string written = writeInPlace(document);
    if (written == document.file().text) return written;
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

std::string EditedFile::bytes() {
  std::string text = this->text();
  if (marked_) text.insert(0, "\xef\xbb\xbf");
  return packed_ ? packed(text) : text;
}

bool EditedFile::isChangedOnDisk() { return document_ && stampOf(world().path) != onDisk_; }
void EditedFile::saved() { onDisk_ = stampOf(world().path); }

std::string EditedFile::draft() {
  if (!document_) throw EditError("nothing has been edited");
  return onStackOf(deepestStack, [&] { return writeInPlace(*document_); });
}

std::string EditedFile::textOnDisk() {
  try {
    return std::string(Source::open(world().path, world().options.limits, nullptr).text());
  } catch (const LoadError& error) { throw EditError(error.diagnostic.text()); }
}

void EditedFile::adopt(std::string text) {
  if (document_) throw EditError("the file has been read for editing already");
  prepared_ = {};
  refusal_.clear();
  adopted_ = std::move(text);
  const std::string reason = whyNot();
  adopted_.reset();
  if (!reason.empty()) throw EditError(reason);
}

const MFNode& EditedFile::liveList(const Slot& slot) {
  return slot.field ? *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field))
                    : world().scope.roots;
}

} // namespace xvrml
