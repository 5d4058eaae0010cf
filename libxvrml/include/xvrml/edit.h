// edit.h: edits the file of a world: each edit changes the world at once, can be undone, and is
// written back into the text of the file, which otherwise stays as it is.
//
// An edit belongs to the file, and not to what routes and Scripts have made of the world since it
// began: of a field that an interpolator moves, only a value that was edited is written. Undo
// restores what the edit has changed, and nothing else.
//
// Files of VRML97 and X3D (ClassicVRML, XML and JSON) can be edited, also packed with gzip. Nodes
// that stand in the world's own file can be edited, and what has been inserted there; nodes in the
// bodies of prototypes, of Inlines and of Scripts cannot.
//
// All functions are for the thread that owns the world. A function that throws EditError has
// changed nothing.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/browser.h"

namespace xvrml {

// Says in one sentence why an edit is not possible.
struct EditError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A field of a node of the file that edits have changed since the file was read.
struct ChangedField {
  uint32_t line = 0; // where the node begins in the file as it was read; 0: the roots of the file
  std::string type, name; // the node's type, and its name behind DEF as it is now
  std::string field;      // "DEF": the name of the node
  // Values as VRML97 writes them, cut to a readable length. For nodes these say how many there are.
  std::string before, now;
};

// A place for a node: in a field of a node or, without a parent, among the roots of the file.
struct NodeSlot {
  Node* parent = nullptr;
  std::string field; // an SFNode or MFNode; empty for the roots
  size_t index = 0;  // in an MFNode or among the roots; one past the last appends
};

// Memory in bytes that the steps of an editor take at most, as far as nothing else is said.
inline constexpr uint64_t defaultUndoBytes = 512'000'000;

// Wide because each kind of edit is a function, and so is each question about the file.
class Editor {
 public:
  // Edit a world that runs, or one that does not. The world must outlive the editor, and must not
  // be replaced by another one (loadUrl, replaceWorld). The file is read at the first edit.
  explicit Editor(Browser& browser);
  explicit Editor(World& world);
  // To be called when a browser has taken the world over, which then runs.
  void run(Browser& browser);
  ~Editor();
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;

  // --- Steps ---
  // Edits from begin() to end() are one step, which is undone as a whole; other edits are a step
  // each. Values of a field that follow each other within a step are one edit. begin() and end()
  // may nest; the outermost name counts. cancel() undoes and ends what the innermost begin() has
  // begun. It throws EditError if a Script has changed the world so that this cannot be; what is
  // left stays as a step.
  void begin(std::string name);
  void end();
  void cancel();
  // Tells whether a step is open.
  bool isInStep() const;
  // Undo the last step, or do again the one that was undone last. Return false if there is none.
  // An edit after undo() forgets the steps that could be done again.
  bool undo();
  bool redo();
  // Bounds the estimated memory of all steps. When more is needed, the oldest ones are forgotten,
  // but never the last one; the first time a warning in World::diagnostics says so.
  void setUndoBytes(uint64_t bytes);
  // Return the names of these steps; empty if there is none.
  std::string undoName() const;
  std::string redoName() const;

  // Grows with each edit, undo and redo, so that who shows the world knows when to look again.
  uint64_t changes() const;
  // Grows as changes() does, but not with those that only set fields without nodes.
  uint64_t nodeChanges() const;

  // Returns how many edits of those that are not undone have set a field. Edits of one step that
  // follow each other are one.
  uint64_t editsOf(const Node& node, std::string_view field) const;

  // Returns the places where a node stands in the world now: once where it is defined, and once for
  // each USE. Places in Inlines and in the bodies of prototypes are left out.
  std::vector<NodeSlot> placesOf(const Node& node);

  // Returns whether a node stands anywhere in the file as it is edited; false before the first
  // edit. Unlike placesOf() it does not look through the world.
  bool stands(const Node& node) const;
  // Returns in how many places of the file it does.
  size_t countPlaces(const Node& node) const;

  // Returns for each place in the world's file, as it was read, the innermost node whose text holds
  // it, as the messages about the file have places; null if there is none, or it is not in the
  // world any more. In a file that cannot be edited only a node that begins there is found.
  std::vector<NodeRef> nodesAt(std::span<const SourcePosition> places);
  // Returns the fields that differ from the file as it was read, in the order of the file. Fields
  // of nodes that have been inserted are not listed: the field that holds them is. Routes are not,
  // either.
  std::vector<ChangedField> changedFields() const;

  // --- Edits ---
  // Sets a field that holds no nodes. Throws EditError for a value of another type, out of the
  // field's range, or with a number that is not finite.
  void set(Node& node, std::string_view field, Value value);
  // Inserts a node that is given as text in the encoding of the file, with all that is in it: in
  // XML as one element, in JSON as an object with one member.
  // Returns the node. In an SFNode it takes the place of the present one. Names that the file has
  // already get a number behind them. Throws EditError if the text cannot be read as one node
  // without routes and prototypes, or the node cannot stand there.
  NodeRef insert(const NodeSlot& slot, std::string_view text);
  // Lets a node of the file stand at a further place (USE). A node without a name gets one.
  void use(const NodeSlot& slot, Node& node);
  // Removes the node at a place. A node that also stands elsewhere stays there. Routes to and from
  // nodes that are nowhere any more go with them.
  void remove(const NodeSlot& slot);
  // Moves a node. The index of the second slot is counted after the node has been taken out.
  void move(const NodeSlot& from, const NodeSlot& to);
  // Inserts a copy of the node at a place behind it (in an MFNode or among the roots), with names
  // of its own, as the file has it: not as it has moved since the world began.
  NodeRef duplicate(const NodeSlot& slot);
  // Puts a copy of the node at a place there, with names of its own. Returns the copy, which can be
  // edited without the other places of the node. Throws EditError if there are none.
  NodeRef separate(const NodeSlot& slot);
  // Puts a new grouping node of this type around the node at a place. Returns the new node.
  NodeRef wrap(const NodeSlot& slot, std::string_view type = "Transform");
  // Gives a node a DEF name, or another one, in all of its references. Throws EditError for a name
  // that is none or that another node has.
  void rename(Node& node, const std::string& name);
  // Declares an exposedField of a node that can have fields of its own (ORTShader), with this
  // value. Another node takes its place, or all of its places, with its name and its routes.
  // Returns that node. Throws EditError for nodes that declare nothing, and for a field that the
  // node has.
  NodeRef declare(Node& node, std::string_view field, const Value& value);
  // Add or remove a route between nodes of the file. Nodes without names get some.
  void addRoute(Node& from, std::string_view out, Node& to, std::string_view in);
  void removeRoute(Node& from, std::string_view out, Node& to, std::string_view in);

  // --- The file ---
  // Returns what reads the file for editing, so that the first edit need not wait for it: it is to
  // be called once, on any thread, also after the end of the editor. null: nothing is to be read.
  // isPreparing() tells whether it has not ended yet; edits wait for that.
  std::function<void()> preparation();
  bool isPreparing() const;
  // Returns why the world's file cannot be edited; empty if it can.
  std::string whyReadOnly();
  // Returns the text of the file with all edits. It has been read back, and gives the edited world.
  // Throws EditError if it does not.
  std::string text();
  // Returns the bytes of the file with this text, to be saved: with its byte-order mark, packed as
  // it was. Throws EditError within a step, which may still be taken back.
  std::string bytes();
  // Returns whether there are edits that have not been saved.
  bool isChanged() const;
  // Returns whether another program has written to the file since it was read or saved.
  bool isChangedOnDisk() const;
  // To be called when bytes() has been written to the file.
  void saved();

  // --- Edits that outlive the program ---
  // Returns the text of the file with all edits so far, also within a step and after another world
  // has taken the place of this one. It is not read back, and meant to be kept beside the file.
  // Throws EditError if nothing has been edited.
  std::string draft();
  // Returns the text of the file that is on the disk now, unpacked. Throws EditError if it cannot
  // be read.
  std::string textOnDisk();
  // Says that the world was loaded from this text (loadWorldFromMemory with the file's path), which
  // draft() gave an earlier program: it counts as edits that have not been saved, which undo()
  // cannot take back. To be called before any edit. Throws EditError if the file cannot be edited.
  void adopt(std::string text);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace xvrml
