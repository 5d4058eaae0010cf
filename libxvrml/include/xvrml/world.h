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

// "field IS interface" inside a prototype's body (clause 4.8.2).
struct IsConnection {
  NodeRef node;
  std::string field;
  std::string interfaceName;
};

// The statements of a file or of a prototype's body: a name space of its own
// (clauses 4.4.6, 4.8.4).
struct Scope {
  std::vector<ProtoPtr> prototypes; // in order of declaration
  std::vector<NodeRef> roots;
  std::vector<Route> routes;
  std::map<std::string, NodeRef, std::less<>>
      names; // DEF; a name defined again names the last node
};

struct ProtoDeclaration {
  NodeTypePtr type; // its interface, with defaults
  Scope body;       // empty for an EXTERNPROTO that is not loaded
  std::vector<IsConnection> is;
  bool isExtern = false;
  std::vector<std::string> urls; // EXTERNPROTO
  std::string baseUrl;           // file that holds the declaration
  ProtoPtr resolved;             // EXTERNPROTO: the declaration found, null if none
  SourcePosition source;
};

// An instance of a prototype: the interface's values, and a copy of the body made for it. Nodes of
// the body that neither a connection, a route nor a Script reaches (shapes, geometry, appearances
// and what holds only such) are one for all instances.
class ProtoInstance : public DynamicNode {
 public:
  ProtoInstance(NodeTypePtr type, ProtoPtr declaration)
      : DynamicNode(std::move(type)), declaration(std::move(declaration)) {}
  const ProtoPtr declaration;
  Scope body; // body.roots[0] stands for the instance (clause 4.8.3); empty if it could not be
              // expanded
  std::vector<IsConnection> is; // in terms of body's nodes
  std::vector<bool> given;      // by FieldInfo::offset: has a value of its own, not the prototype's
                                // default; may be short

  bool isGiven(const FieldInfo& field) const {
    return field.offset < given.size() && given[field.offset];
  }
  void give(const FieldInfo& field) {
    if (given.size() <= field.offset) given.resize(field.offset + 1);
    given[field.offset] = true;
  }
};

// A Script node: fields url, directOutput, mustEvaluate and those it declares.
class ScriptNode : public DynamicNode {
 public:
  using DynamicNode::DynamicNode;
  std::vector<uint32_t> urlLines; // of the file, where the strings of url begin; may be short
};

// The node that is rendered for `node`: itself, for a prototype instance its first body node, for a
// node of a plug-in what it stands for (however deep); may be null.
Node* renderedNode(Node* node);

struct LoadOptions {
  Limits limits;
  bool allowAbsolute = false; // absolute paths and file: URLs named inside a world
  bool loadInlines = true;
};

// Where a URL inside a world leads: a file to read, or why not.
struct ResolvedUrl {
  std::string path;
  std::string fragment;
  std::string error;
};
ResolvedUrl resolveUrl(std::string_view url, std::string_view baseFile, const LoadOptions& options);

class World {
 public:
  World() = default;
  ~World(); // breaks cycles through Script fields
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Scope scope;
  std::string path; // the file, or "-"
  Diagnostics diagnostics;
  LoadOptions options;
  struct Times {
    double parse = 0, load = 0;
  } times;                // seconds: this file's parse; Inlines, prototypes
  uint64_t nodeCount = 0; // nodes made, expansions included
  std::vector<NodeRef>
      cyclic; // Scripts and prototype instances whose fields may hold a node they are part of
};

// Thrown when nothing of a file can be used: missing, unreadable, not VRML97, VRML 1.0.
struct LoadError {
  Diagnostic diagnostic;
};

// Loads a world from a file (plain or gzipped) or from memory. What is wrong inside is in
// world.diagnostics; nodes that could not be read are lost, the rest is there. Throws LoadError if
// nothing can be.  [any thread]
std::unique_ptr<World> loadWorld(const std::string& path, const LoadOptions& options = {});
std::unique_ptr<World> loadWorldFromMemory(std::string_view bytes, const std::string& name,
                                           const LoadOptions& options = {});

// An Inline node's loaded content: null before loading and when none of its URLs could be loaded.
const Scope* inlineScope(const Node& inlineNode);

// VRML97 text of a world that parses to an equal graph. Numbers are the shortest that read back
// equal.
std::string writeWorld(const World& world);

// True if both scopes hold equal graphs: same nodes, fields, DEF/USE structure, prototypes, routes.
// difference, if not null, says where not.
bool equalScopes(const Scope& a, const Scope& b, std::string* difference = nullptr);

} // namespace xvrml
