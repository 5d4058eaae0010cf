// writer.h: writes a world as a file. Writer walks through the world and decides what is written,
// and in which order; an encoding is a class from it that decides how. Content of other files stays
// a reference to them. Prototype declarations are written, the bodies of instances are not. A pure
// function of the world. [the thread that owns the world]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "write/names.h"
#include "xvrml/file_head.h"
#include "xvrml/world.h"

namespace xvrml {

class Writer {
 public:
  // target: the file that will hold the text; empty: relative URLs stay as they are. version: what
  // the text follows.
  Writer(const World& world, std::string target, const FileVersion& version);
  virtual ~Writer() = default;
  // Returns the text. Throws std::length_error if nodes are nested too deep. Called once.
  std::string write();
  // Returns the text of one node with its descendants, without a head. Called once.
  std::string writeAlone(Node& root);

 protected:
  // A field of a node, an argument of an instance, or a field that a node or prototype declares.
  struct Field {
    const FieldInfo* info = nullptr;
    bool declared = false;       // the node declares the field: access and type belong to the text
    const void* value = nullptr; // null: no value is written
    std::shared_ptr<Value> changed;      // owns the value where it is not the node's own
    std::vector<std::string> interfaces; // names of the prototype's interface that it is IS to
  };
  // A node that is written in full. `events` are connections such as "set_x IS y" that do not use
  // a field's own name.
  struct Content {
    Node* node = nullptr;
    const std::string* name = nullptr; // DEF name or null
    std::vector<Field> fields;
    std::vector<std::pair<std::string, std::string>> events;
  };

  virtual void writeHead() = 0;
  virtual void writeEnd() = 0;
  // place: the field that holds the node; empty for the roots of a file or of a prototype's body.
  virtual void writeNode(const Content& content, std::string_view place) = 0;
  virtual void writeUse(const Node& node, const std::string& name, std::string_view place) = 0;
  virtual void writeNull() = 0;
  struct RouteText {
    std::string from, fromField, to, toField;
  };
  virtual void writeRoute(const RouteText& route) = 0;
  // The statements of X3D that share nodes with other files. Not called for VRML97.
  virtual void writeImport(const std::string& inlineName, const std::string& exported,
                           const std::string& local) = 0;
  virtual void writeExport(const std::string& node, const std::string& exported) = 0;
  // The calls for a prototype: its interface, then for a PROTO (urls is null) the body, and the
  // end.
  virtual void openPrototype(const std::string& name, const MFString* urls) = 0;
  virtual void writeDeclaration(const Field& field) = 0;
  virtual void openBody() = 0;
  virtual void closePrototype(const MFString* urls) = 0;

  // Returns what is written of a node, but for the events of a prototype.
  Content contentOf(Node& node, const std::string* name) const;
  // Writes a node at its place: in full, as a USE, or as NULL.
  void node(Node* node, std::string_view place);
  // Returns the name of a field or event in the encoding.
  std::string_view spelled(const NodeType& type, std::string_view field) const;
  void line(); // begins a line
  bool isX3d() const { return version_.isX3d(); }

  const World& world_;
  const FileVersion version_;
  std::string text_;
  size_t indent_ = 0;

 private:
  using Connections = std::unordered_map<const Node*, std::vector<const IsConnection*>>;

  void scope(const Scope& scope);
  bool route(const Route& route);
  void exchange();
  void prototype(const ProtoDeclaration& declaration);
  void declaration(const ProtoDeclaration& declaration, const FieldInfo& info);
  Field fieldOf(Node& node, const FieldInfo& info) const;
  void setUrls(Field& field, MFString urls, const std::string& base) const;
  std::span<const IsConnection* const> connectionsOf(const Node& node) const;

  const std::string target_;
  Names* names_ = nullptr;                   // names in the scope that is being written
  const Connections* connections_ = nullptr; // IS of the prototype that is written; null: none
  size_t depth_ = 0;                         // number of nodes around the one that is being written
};

// The encodings. [the thread that owns the world]
std::unique_ptr<Writer> makeVrmlWriter(const World& world, const std::string& target,
                                       const FileVersion& version); // VRML97, X3D ClassicVRML
std::unique_ptr<Writer> makeXmlWriter(const World& world, const std::string& target,
                                      const FileVersion& version);
std::unique_ptr<Writer> makeJsonWriter(const World& world, const std::string& target,
                                       const FileVersion& version);

// Returns the version that a file of the world in an encoding follows.
FileVersion writtenVersion(const World& world, Encoding encoding);
// Returns the units that a file of X3D names: those of the world's own file, but for angles, which
// are written in radians.
std::vector<FileHead::Unit> unitsOf(const FileHead& head);
// Returns the profile that a file of X3D names; Immersive, which has most nodes of VRML97, if the
// world has none.
std::string profileOf(const FileHead& head);
// Returns the comments at the top of the world's file line by line, without the marks of comments
// and without the first line of a file of X3D. They name the program that wrote the file, which can
// decide the up axis. `header` gets what stands behind the header of VRML97.
std::vector<std::string> commentsOf(const World& world, std::string& header);

} // namespace xvrml
