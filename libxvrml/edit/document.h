// document.h: a file that is being edited: its text, where everything stands in it, and the graph
// of the file as it has been edited. The graph does not run: nothing that routes and Scripts do is
// in it. Internal; one thread at a time.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "edit/standing.h"
#include "parse/text_layout.h"

namespace xvrml {

// A text that nodes come from: the file, or one that was given to insert nodes.
struct DocumentText {
  std::string text;
  TextLayout layout;
  std::unique_ptr<World> world;
  std::vector<std::pair<uint64_t, Node*>> byPlace; // sorted by line and column
};

// Wide because the writers, the edits and the facts about the file each ask questions of their own.
class Document {
 public:
  // path: the file's name. text: its text without compression and byte-order mark. Throws
  // LoadError.
  Document(std::string text, const std::string& path, const LoadOptions& options);
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  Scope& scope() { return file().world->scope; }
  const Scope& scope() const { return file().world->scope; }
  const World& world() const { return *file().world; }
  const DocumentText& file() const { return texts_.front(); }
  DocumentText& file() { return texts_.front(); }

  // Reads nodes from a text in the encoding of the file, without a header. Its lines get the ends
  // of the file's. name: for the places of its nodes, different from all others. Throws LoadError.
  const DocumentText& read(const std::string& text, const std::string& name);
  // Forgets the text that was read last, because none of its nodes is put in.
  void forgetLastText();
  // Returns the node that stands at a place in the file or in one of these texts; null if there is
  // none, or it is part of a prototype.
  Node* find(const SourcePosition& place) const;
  // Returns whether several nodes of the file have this name, so that a reference depends on its
  // place.
  bool isRepeated(const std::string& name) const { return repeated_.contains(name); }
  // Returns whether a node comes from the file itself.
  bool isOwn(const Node& node) const { return &textOf(node) == &file(); }
  // Returns whether a node has a text: nodes in the default values of prototypes have none.
  bool hasText(const Node& node) const { return known_.contains(&node); }
  // Returns the text of a field of a node; null if the text does not have it.
  const FieldText* textOf(const Node& node, const FieldInfo& field) const;
  // Returns the name behind a node's DEF, and in references to it, in the text that it comes from.
  const std::string& nameInText(const Node& node) const {
    const auto renamed = renamed_.find(&node);
    return renamed == renamed_.end() ? node.defName : renamed->second;
  }
  bool isXml() const { return encoding() == Encoding::x3dXml; }
  Encoding encoding() const { return world().head.version.encoding; }
  // Returns the text that a node of the document comes from, and where it stands there.
  const DocumentText& textOf(const Node& node) const { return *known_.find(&node)->text; }
  const NodeText& placeOf(const Node& node) const { return *known_.find(&node)->place; }

  // Sets a field that holds no nodes.
  void set(Node& node, const FieldInfo& field, Value value);
  // Returns the value that a field had before it was changed first; null: it has not been changed,
  // or it holds nodes that the text has.
  const Value* originalOf(const Node& node, const FieldInfo& field) const;
  // Calls visit(node, originals) for each node of which fields have been changed; originals has
  // the values before, by the names of the fields; none: nodes that the text has.
  template <class Visit> void forEachChanged(const Visit& visit) const {
    for (const auto& [node, originals] : originals_) visit(*node, originals);
  }
  // Returns whether a node can be put into a parent (null: the roots), so that no node stands in
  // more than mostNested() nodes, itself included.
  bool admits(const Node* parent, Node& node) const {
    return (parent ? standing_.depthOf(*parent) : 0) + heightOf(node) <= mostNested();
  }
  // The limit `nesting`, as far as readers allow it.
  uint64_t mostNested() const;
  // Returns the list that a place is in: an MFNode, or the roots for null.
  const MFNode& listOf(const Node* parent, const FieldInfo* field) const;
  void insert(Node* parent, const FieldInfo* field, size_t index, const NodeRef& node);
  void erase(Node* parent, const FieldInfo* field, size_t index);
  void setNode(Node& parent, const FieldInfo& field, NodeRef child);
  // Gives a node another name, also among the names of the file if it stands there.
  void rename(Node& node, const std::string& name);
  // Returns a name that no node has yet, and that is not in `taken`: `wish`, or the wish with a
  // number behind it.
  std::string freshName(const std::string& wish,
                        const std::set<std::string, std::less<>>& taken = {});
  // Returns whether a node stands anywhere in the file.
  bool stands(const Node& node) const { return standing_.contains(node, scope()); }
  // Returns in how many places it does.
  size_t countPlaces(const Node& node) const { return stands(node) ? standing_.countOf(node) : 0; }
  // Tell whether the name, or a field or the name of a node has been changed since its text was
  // read, also if it is as before now.
  bool isRenamed(const Node& node) const { return renamed_.contains(&node); }
  bool hasChanged(const Node& node) const { return originals_.contains(&node) || isRenamed(node); }
  // Return the nodes that have been put into a place, and those that have been taken out of one.
  const std::unordered_set<const Node*>& putIn() const { return putIn_; }
  const std::unordered_set<const Node*>& takenOut() const { return takenOut_; }

 private:
  struct Known {
    const DocumentText* text = nullptr;
    const NodeText* place = nullptr;
  };

  void index(DocumentText& text);
  void touch(Node& node, const FieldInfo& field);
  Value nodesInText(const Node& node, const FieldInfo& field) const;
  MFNode& listToChange(Node* parent, const FieldInfo* field);

  const LoadOptions options_;
  std::deque<DocumentText> texts_; // the file first; a deque does not move its elements
  std::map<std::string, DocumentText*, std::less<>> byName_;
  std::set<std::string, std::less<>> repeated_;
  NodeMap<Known> known_;                                 // the nodes of all texts
  std::unordered_map<const Node*, std::string> renamed_; // with the names in their texts
  // Values before the first change; empty for nodes that the text gives.
  std::unordered_map<const Node*, std::map<std::string, std::optional<Value>, std::less<>>>
      originals_;
  Standing standing_;
  std::unordered_set<const Node*> putIn_, takenOut_;
};

} // namespace xvrml
