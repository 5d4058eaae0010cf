// edited_file.h: the file of a live world that is edited, and how places and nodes of the two
// belong together. Internal; the thread that owns the world.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "edit/document.h"
#include "edit/live_world.h"
#include "parse/source.h"
#include "xvrml/edit.h"

namespace xvrml {

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

class EditedFile {
 public:
  explicit EditedFile(std::unique_ptr<LiveWorld> live) : live_(std::move(live)) {}
  void setLive(std::unique_ptr<LiveWorld> live) { live_ = std::move(live); }
  LiveWorld& live() { return *live_; }
  World& world() { return live_->world(); }

  // Returns why the file cannot be edited. Reads it if it can.
  std::string whyNot();
  // See Editor.
  std::function<void()> preparation();
  bool isPreparing() const;
  // Throws EditError if the file cannot be edited, or another world has taken its place.
  Document& document();
  // Returns the document that has been read, for edits that have begun: another world may take the
  // place of the edited one meanwhile. The document then still takes them, and gives them up as a
  // whole if their step is cancelled.
  Document& opened() { return *document_; }
  // Returns the scope of the world that is edited; null if another world has taken its place.
  Scope* liveScope() { return live_->isReplaced() ? nullptr : &world().scope; }
  // Returns the node with its counterpart in the document. Throws EditError if it has none.
  Twin twinOf(Node& node);
  // Does the same for a node that stands in the file now. Throws EditError if it was removed.
  Twin standingTwinOf(Node& node);
  // See Editor.
  size_t countPlaces(const Node& node) const;
  // Throws EditError if a node does not stand in the file now; null: the roots.
  void checkStands(Node* node);
  // holds: there must be a node at the place.
  Slot slotOf(const NodeSlot& given, bool holds);
  Node* nodeAt(const Slot& slot);
  // Throws EditError if the text of a field could not be read.
  void checkReadable(const Node& node, const FieldInfo& field);

  // See Editor.
  std::vector<NodeRef> nodesAt(std::span<const SourcePosition> places);
  std::vector<ChangedField> changedFields() const;

  std::string text();
  std::string bytes();
  bool isChangedOnDisk();
  void saved();
  // See Editor.
  std::string draft();
  std::string textOnDisk();
  void adopt(std::string text);

 private:
  // A file that has been read for editing.
  struct Opened {
    std::unique_ptr<Document> document;
    std::string whyNot; // empty: it can be edited
    bool isPacked = false, isMarked = false;
    FileStamp onDisk;
  };
  std::string whyNotKind();
  static Opened open(const std::string& path, const LoadOptions& options,
                     const std::optional<std::string>& adopted);
  Opened takePrepared();
  const MFNode& liveList(const Slot& slot);
  // Throws EditError if a node of the file was loaded from another text than the document's.
  void checkUnchanged(const Node& node) const;
  // Finds the nodes of the live world that begin at places of its file, given by placeKey().
  std::unordered_map<uint64_t, NodeRef> liveNodesAt(const std::unordered_set<uint64_t>& places);

  std::unique_ptr<LiveWorld> live_;
  std::unique_ptr<Document> document_; // read at the first edit
  std::future<Opened> prepared_;       // what preparation() reads
  std::optional<std::string> adopted_; // is read instead of the text of the file
  std::string refusal_;                // why the file cannot be edited, once it has been read
  bool packed_ = false, marked_ = false;
  FileStamp read_, onDisk_; // the file when it was read, and when it was read or saved
};

} // namespace xvrml
