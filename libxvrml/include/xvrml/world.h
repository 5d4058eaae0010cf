// world.h: a loaded VRML world: root nodes, names, routes, prototypes; loading and writing.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/diagnostics.h"
#include "xvrml/file_head.h"
#include "xvrml/limits.h"
#include "xvrml/node.h"

namespace xvrml {

struct Route {
  NodeRef from;
  std::string fromField; // as written
  NodeRef to;
  std::string toField;
  SourcePosition source;
};

struct ProtoDeclaration;
using ProtoPtr = std::shared_ptr<ProtoDeclaration>;

// A connection "field IS interface" inside a prototype's body (clause 4.8.2).
struct IsConnection {
  NodeRef node;
  std::string field;
  std::string interfaceName;
};

// The statements of a file or of a prototype's body. Each scope has a name space of its own
// (clauses 4.4.6, 4.8.4).
struct Scope {
  std::vector<ProtoPtr> prototypes; // in order of declaration
  std::vector<NodeRef> roots;
  std::vector<Route> routes;
  // DEF names; a name that is defined again refers to the last node.
  std::map<std::string, NodeRef, std::less<>> names;
};

struct ProtoDeclaration {
  NodeTypePtr type; // the interface, with defaults
  Scope body;       // empty for an EXTERNPROTO that is not loaded
  std::vector<IsConnection> is;
  bool isExtern = false;
  std::vector<std::string> urls; // urls of an EXTERNPROTO
  std::string baseUrl;           // the file that holds the declaration
  ProtoPtr resolved;             // EXTERNPROTO: the declaration that was found, null if none
  SourcePosition source;
  // Indexed by FieldInfo::offset: the field is connected by IS to a field of the body that holds
  // URLs, also through further prototypes. Set when the first instance is expanded. May be shorter
  // than the field list.
  std::vector<bool> urlFields;

  bool holdsUrls(const FieldInfo& field) const {
    return holdsValue(field) && field.offset < urlFields.size() && urlFields[field.offset];
  }
};

// An instance of a prototype: the values of its interface, and a copy of the body. Instances share
// those body nodes that no IS connection, route or Script reaches (shapes, geometry, appearances,
// and nodes that hold only such).
class ProtoInstance : public DynamicNode {
 public:
  static constexpr int typeIndex = -2; // -1 is that of no type
  ProtoInstance(NodeTypePtr type, ProtoPtr declaration)
      : DynamicNode(std::move(type)), declaration(std::move(declaration)) {}
  const ProtoPtr declaration;
  // body.roots[0] stands for the instance (clause 4.8.3); empty if the expansion failed.
  Scope body;
  std::vector<IsConnection> is; // IS connections of the nodes in `body`
  // Indexed by FieldInfo::offset: the instance sets the field itself instead of using the
  // prototype's default. May be shorter than the field list.
  std::vector<bool> given;

  bool isGiven(const FieldInfo& field) const {
    return field.offset < given.size() && given[field.offset];
  }
  void give(const FieldInfo& field) {
    if (given.size() <= field.offset) given.resize(field.offset + 1);
    given[field.offset] = true;
  }

  // Indexed by FieldInfo::offset: the file that the relative URLs of an MFString count from; null:
  // the instance's own file. Other files are those of an enclosing prototype's instance, which
  // passed the value on, and of the prototype, whose default it is. May be shorter than the field
  // list.
  std::vector<std::shared_ptr<const std::string>> urlBases;

  bool hasOwnUrlBase(const FieldInfo& field) const {
    return field.offset >= urlBases.size() || !urlBases[field.offset];
  }
  // base: null or the instance's own file: the instance's own file
  void setUrlBase(const FieldInfo& field, std::shared_ptr<const std::string> base) {
    if (base && source.file && *base == *source.file) base = nullptr;
    if (!base && urlBases.size() <= field.offset) return;
    if (urlBases.size() <= field.offset) urlBases.resize(field.offset + 1);
    urlBases[field.offset] = std::move(base);
  }
};

// Returns whether the strings of the node's field are URLs, relative to the file urlBase(). Those
// of a prototype instance are known once it has been expanded.
inline bool holdsUrls(const Node& node, const FieldInfo& field) {
  const auto* instance = nodeCast<ProtoInstance>(&node);
  return instance ? instance->declaration->holdsUrls(field) : field.holdsUrls;
}

// Returns the file that relative URLs in a field of the node count from; null if the node is in no
// file.
inline const std::shared_ptr<const std::string>& urlBase(const Node& node, const FieldInfo& field) {
  const auto* instance = nodeCast<ProtoInstance>(&node);
  return !instance || !holdsValue(field) || instance->hasOwnUrlBase(field)
             ? node.source.file
             : instance->urlBases[field.offset];
}

// A Script node: fields url, directOutput and mustEvaluate, and those that it declares.
class ScriptNode : public DynamicNode {
 public:
  static constexpr int typeIndex = -3;
  using DynamicNode::DynamicNode;
  // Line of the file at which each string of url begins. May be shorter than url.
  std::vector<uint32_t> urlLines;
  // Number of Scripts that made one another by createProto before this one; 0: a file holds it.
  uint32_t makers = 0;
};

// Returns the node that is rendered in place of `node`. For a prototype instance it is the first
// node of the body; for a plug-in's node, the node it expands to. Both are followed to any depth.
// May be null.
Node* renderedNode(Node* node);

struct LoadOptions {
  Limits limits;
  bool allowAbsolute = false; // allows absolute paths and file: URLs inside a world
  bool loadInlines = true;
  // STEP models: millimetres between a triangle and the surface that it stands for, at most. 0: a
  // thousandth of the size of each part.
  double stepError = 0;
};

// The target of a URL inside a world: a file to read, or the reason why it is refused.
struct ResolvedUrl {
  std::string path;
  std::string fragment;
  std::string error;
};
ResolvedUrl resolveUrl(std::string_view url, std::string_view baseFile, const LoadOptions& options);
// Returns the relative URL that leads from the file `from` to a file. Files with relative paths are
// in or beside the current directory.
std::string relativeUrl(const std::string& file, const std::string& from);
// Rewrites relative URLs that count from the file `from` so that they lead to the same files when
// they count from the file `to`. URLs with a scheme, absolute paths and "#name" stay as they are.
void rebaseUrls(MFString& urls, const std::string& from, const std::string& to);

class World {
 public:
  World() = default;
  ~World(); // breaks cycles through Script fields
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Scope scope;
  std::string path; // the file, or "-" for standard input
  Diagnostics diagnostics;
  // Seconds: the parse of this file; the loading of Inlines and prototypes.
  LoadOptions options;
  struct Times {
    double parse = 0, load = 0;
  } times;
  uint64_t nodeCount = 0; // nodes made, expansions included
  // Scripts and prototype instances whose fields may hold a node that they are part of.
  std::vector<NodeRef> cyclic;
  FileHead head; // the head of the world's own file
  // Nodes have changed since the world was drawn, so figures and particles are brought up to date
  // when it is drawn next. setField() sets it; a program that stores into nodes or roots itself
  // sets it, too. It has no meaning for a world that runs.
  mutable bool edited = false;
};

// Returns the version of the standard that the node's file follows; VRML97 for a node that is in no
// file.
FileVersion versionOf(const Node& node);

// Thrown if nothing of a file can be used: missing, unreadable, not VRML97, or VRML 1.0.
struct LoadError {
  Diagnostic diagnostic;
};

// Loads a world from a file (plain or gzipped) or from memory. Errors in the file are reported in
// world.diagnostics: nodes that could not be read are left out, the rest is loaded. Throws
// LoadError if nothing can be used.  [any thread]
std::unique_ptr<World> loadWorld(const std::string& path, const LoadOptions& options = {});
std::unique_ptr<World> loadWorldFromMemory(std::string_view bytes, const std::string& name,
                                           const LoadOptions& options = {});

// Returns the loaded content of an Inline node. Null before loading, and if none of its URLs could
// be loaded.
const Scope* inlineScope(const Node& inlineNode);

// Returns the world as text that parses to an equal graph: as VRML97, as X3D in the ClassicVRML
// encoding, or as X3D in XML or JSON. Each number is the shortest that reads back equal. X3D keeps
// the version, the profile and the statements COMPONENT and META of a world that was read from X3D;
// for another world it is version 3.3 and the profile Immersive. In XML and JSON, bytes of strings
// that are not UTF-8 are taken for ISO 8859-1, and in XML control characters become U+FFFD. path:
// the file that will hold the text: relative URLs lead from there to the same files as before. URLs
// of nodes that are in no file stay as they are; all do if it is empty. Without an encoding, the
// suffix of the path says it. Throws std::length_error if nodes are nested deeper than any file may
// nest them (2500), and std::invalid_argument for an encoding that is only read.
std::string writeWorld(const World& world, const std::string& path, Encoding encoding);
std::string writeWorld(const World& world, const std::string& path);
std::string writeWorld(const World& world);
// Returns what looks different in the file that writeWorld() writes in an encoding, because its
// version gives another meaning to the same nodes: one phrase each, for people.
std::vector<std::string> changesByWriting(const World& world, Encoding encoding);
// Likewise for a file with a path, which may lie in another folder; see writeWorld().
std::vector<std::string> changesByWriting(const World& world, const std::string& path,
                                          Encoding encoding);
// Returns a node of the world with its descendants as text in one of these encodings, without the
// head of a file and without prototypes and routes. URLs stay as they are. Throws as writeWorld().
std::string writeNode(const World& world, Node& node, Encoding encoding);
// Returns the encoding in which a file of this name is written: X3D for .x3dv, .x3d, .x3dj and
// .json, VRML97 for all others.
Encoding writtenEncoding(std::string_view path);

// Returns true if both scopes hold equal graphs: the same nodes, fields, DEF/USE structure,
// prototypes and routes. Writes the first difference to `difference`, if it is not null.
bool equalScopes(const Scope& a, const Scope& b, std::string* difference = nullptr);

} // namespace xvrml
