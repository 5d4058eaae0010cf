#include "edit/edited_file.h"

#include <algorithm>

#include <fmt/format.h>
#include <sys/stat.h>

#include "edit/in_place_writer.h"
#include "enough_stack.h"
#include "graph/exchange.h"
#include "graph/field_access.h"
#include "parse/source.h"
#include "system/files.h"

namespace xvrml {

EditedFile::FileState EditedFile::stateOf(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  const timespec time = os::modifiedTime(status);
  return {int64_t(time.tv_sec), int64_t(time.tv_nsec), int64_t(status.st_size),
          uint64_t(status.st_ino)};
}

std::string EditedFile::whyNot() {
  if (document_) return "";
  const std::string& path = world().path;
  const FileState state = stateOf(path);
  if (state == FileState{}) return "the world does not come from a file";
  const Encoding encoding = world().head.version.encoding;
  if (encoding != Encoding::vrml97 && encoding != Encoding::x3dClassic)
    return fmt::format("{} is {}: VRML97 and X3D ClassicVRML can be edited in place; write it as "
                       "one of these first",
                       path, encodingName(encoding));
  try {
    const Source source = Source::open(path, world().options.limits, nullptr);
    if (source.isUtf16())
      return fmt::format("{} is in UTF-16, which is only read: write it anew first", path);
    packed_ = source.isPacked();
    marked_ = source.hasByteOrderMark();
    document_ = std::make_unique<Document>(std::string(source.text()), path, world().options);
    onDisk_ = state;
  } catch (const LoadError& error) { return error.diagnostic.text(); }
  return "";
}

Document& EditedFile::document() {
  if (const std::string reason = whyNot(); !reason.empty()) throw EditError(reason);
  return *document_;
}

Twin EditedFile::twinOf(Node& node) {
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

Slot EditedFile::slotOf(const NodeSlot& given, bool holds) {
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
  for (const NodeRef& node : own)
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

Node* EditedFile::nodeAt(const Slot& slot) {
  if (slot.isSingle())
    return static_cast<const NodeRef*>(slot.parent.live->storage(*slot.field))->get();
  const MFNode& list = slot.field
                           ? *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field))
                           : world().scope.roots;
  return slot.liveIndex < list.size() ? list[slot.liveIndex].get() : nullptr;
}

std::string EditedFile::text() {
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

std::string EditedFile::bytes() {
  std::string text = this->text();
  if (marked_) text.insert(0, "\xef\xbb\xbf");
  return packed_ ? packed(text) : text;
}

bool EditedFile::isChangedOnDisk() { return document_ && !(stateOf(world().path) == onDisk_); }
void EditedFile::saved() { onDisk_ = stateOf(world().path); }

const MFNode& EditedFile::liveList(const Slot& slot) {
  return slot.field ? *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field))
                    : world().scope.roots;
}

} // namespace xvrml
