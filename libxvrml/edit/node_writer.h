// node_writer.h: writes the nodes of a document with the text that they have, but for what has been
// edited. A class from it for each syntax says how nodes, fields and references are written.
// Internal; one thread at a time.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "edit/changed_value.h"
#include "edit/list_steps.h"
#include "edit/node_comments.h"
#include "edit/text_copier.h"
#include "edit/unchanged.h"

namespace xvrml {

// A field that nodes are written into; empty: the roots, or a place that says by itself which field
// it is.
struct Holder {
  const Node* parent = nullptr;
  const FieldInfo* field = nullptr;
};

// A list of nodes in a text, up to the byte `end`.
struct ListText {
  const DocumentText& text;
  size_t end;
  std::string outer; // the indentation of the line that ends the list
  std::string inner; // that of the nodes, if none of them begins a line
};

// The new content of a place of a list, or between places (ListStep).
struct ListItem {
  ListStep::Kind kind;
  TextSpan span;              // the place; not for before and behind
  std::function<void()> copy; // keep: writes what stands there
  // replace, before, behind: returns the text with an indentation. inLines: it gets lines of its
  // own.
  std::function<std::string(std::string_view indentation, bool inLines)> make;
  TextSpan outer{}; // remove, replace: the place with the comments that go with its node

  bool hasPlace() const { return kind != ListStep::Kind::before && kind != ListStep::Kind::behind; }
};

// How a file is to be written a second time, after the first has shown what is needed.
struct WritingPlan {
  std::vector<const PrototypeText*> lifted;  // prototypes that stand before all nodes
  std::unordered_set<const Node*> commented; // moved nodes that take their comments along
  bool isEmpty() const { return lifted.empty() && commented.empty(); }
};

class NodeWriter {
 public:
  NodeWriter(const Document& document, WritingPlan plan);
  virtual ~NodeWriter() = default;

  // Return the text of the file, or of a node. Only one of them is called, once. Throw EditError if
  // nodes nest deeper than Parser::maximumNesting.
  std::string file();
  std::string node(const Node& node) { return finished(this->node(&node, "", {})); }
  // Returns what is to be written otherwise. The prototypes that must be lifted, because instances
  // have been written before them, are those that were missing, and those before them, which they
  // may use.
  WritingPlan missing() const;

 protected:
  // Writes the roots and, behind them, the routes that routesToAdd() returns then.
  virtual void writeRoots(const DocumentText& file) = 0;
  // Writes a node at its place in its text. holder: where it stands now; null: where it stood.
  void writeNode(const Node& node, const Holder* holder);
  virtual void writeNodeText(const Node& node, const Holder* holder) = 0;
  // Returns the text of a reference to a node.
  virtual std::string useOf(const Node& node, const Holder& holder) const = 0;
  // Writes a reference that stays at its place.
  virtual void keepUse(const DocumentText& text, const NodePlace& place) = 0;
  // Returns a node with the comments that belong to it.
  virtual CommentedNode commented(std::string_view text, const TextSpan& node) const = 0;
  virtual bool endsLine(std::string_view text, size_t at) const = 0;
  virtual std::string indented(std::string_view text, std::string_view from,
                               std::string_view to) const = 0;
  // Returns a text that has been written, as it is given out.
  virtual std::string finished(std::string text) const { return text; }

  // Returns the text of a node with this indentation, or a reference if it has been written.
  std::string node(const Node* node, std::string_view indentation, const Holder& holder);
  // Does the same for a node that gets lines of its own, with its comments.
  std::string nodeInLines(const Node* node, std::string_view indentation, const Holder& holder);
  // Returns the nodes of an SFNode or MFNode.
  static MFNode nodesOf(const Node& node, const FieldInfo& field);
  // Returns what a list has of the places that a text has for it.
  std::vector<ListItem> itemsOf(const DocumentText& text, const std::vector<NodePlace>& places,
                                const MFNode& nodes, const Holder& holder);
  void writeList(ListText list, const std::vector<ListItem>& items);
  // Writes the nodes of a list that has these places in the text.
  void writeNodeList(const ListText& list, const std::vector<NodePlace>& places,
                     const MFNode& nodes, const Holder& holder);
  // Writes what stays at its place in a field or list.
  void keep(const DocumentText& text, const NodePlace& place, const Holder& holder);
  // Writes the nodes of a field that is not edited itself, because the world has not taken it as it
  // stands. All between them stays.
  void keepNodes(const DocumentText& text, const FieldText& field);
  // Notes that a node is being written.
  void begin(const Node& node) {
    text_.written.insert(&node);
    noteInstance(node);
  }
  // Returns the routes of the document that have not been written with the text.
  std::vector<const Route*> routesToAdd() const;
  // Returns the last text of each field that a node's text gives.
  static std::unordered_map<std::string_view, const FieldText*> lastOf(const NodeText& place);
  // Returns the value that a field had in the file; null if it has not been edited.
  const Value* editedFrom(const Node& node, const FieldInfo& field) const;
  // Returns the blanks at the beginning of a line. Cheap for places that follow each other, also in
  // a text that is a single line.
  std::string_view indentationAt(const DocumentText& text, size_t at) const;
  ValueLines linesAt(const DocumentText& text, size_t at) const {
    return {indentationAt(text, at).size(), feed_};
  }
  // Returns the name of a field or event in the file's standard.
  std::string_view spelled(const Node& node, std::string_view field) const;
  static std::string deeper(std::string_view indentation);
  // Returns the first item of a list that begins a line; null if none does.
  static const ListItem* inLine(std::string_view text, const std::vector<ListItem>& items);

  const Document& document_;
  const std::string feed_;
  TextCopier text_;

 private:
  size_t beginOfRoots() const;
  void insertBefore(const ListText& list, const TextSpan& node, std::string nodes);
  void insertBehind(const ListText& list, const ListItem& item);
  void fill(const ListText& list, std::string nodes);

  bool isGone(const NodePlace& place) const;
  void noteInstance(const Node& node);
  void writeStanding(const DocumentText& text, const Node& node);

  const WritingPlan plan_;
  std::optional<Unchanged> unchanged_;             // while the file is written
  std::unordered_set<const Node*> leavesComments_; // nodes that have been moved without them
  const PrototypeText* last_ = nullptr; // the last prototype of the file that was missing
  // The last place whose line was asked for, and where that line begins.
  mutable const DocumentText* lineText_ = nullptr;
  mutable size_t lineAt_ = 0, line_ = 0;
  uint64_t depth_ = 0; // nodes that are being written
};

// Return the writer of a syntax.
std::unique_ptr<NodeWriter> makeClassicWriter(const Document& document, WritingPlan plan);
std::unique_ptr<NodeWriter> makeElementWriter(const Document& document, WritingPlan plan);
std::unique_ptr<NodeWriter> makeJsonWriter(const Document& document, WritingPlan plan);

} // namespace xvrml
