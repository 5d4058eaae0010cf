// model.h: node specifications in memory. The reader of .node files fills the Model, check()
// completes it and the writers print it. One Model per run of nodegen, on one thread.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/diagnostics.h"
#include "xvrml/node.h"

namespace xvrml::nodegen {

// A name used in a specification, and its position.
struct Reference {
  std::string name;
  SourcePosition source;
};

struct FieldSpec {
  std::string name;
  FieldType type = FieldType::SFBool;
  Access access = Access::field;
  SourcePosition source;
  Value value;           // default value, if the access kind has one
  std::string valueText; // default value as written
  SourcePosition valueSource;
  std::optional<FieldRange> range;
  std::string rangeText;
  std::optional<Change> change;
  SourcePosition changeSource;
  std::vector<Reference> accepts;
  bool urls = false;         // the strings are URLs
  SourcePosition urlsSource; // where the field says so; an inherited `urls` has none
  bool rare = false;         // few worlds set the field: it has no room in every node
  SourcePosition rareSource;
  bool ofX3d = false; // X3D adds the field to a node of VRML97
  SourcePosition ofX3dSource;
  std::string text;

  bool hasStorage() const { return access == Access::field || access == Access::exposedField; }
};

// A node or an abstract type. An abstract type is a role of nodes, with the meaning of the fields
// that belong to it.
struct TypeSpec {
  bool isAbstract = false;
  std::string name;
  std::string clause;
  std::string container; // the field that holds the node where X3D's XML does not say it, or ""
  std::string lacks;     // what of the node is not done, or ""
  std::string text;
  std::vector<Reference> parents; // abstract types, as written
  std::vector<FieldSpec> fields;
  std::string component; // the file's name without folder and extension
  bool ofX3d = false;    // the component is one of ISO/IEC 19775-1
  SourcePosition source;
  std::vector<std::string> roles; // all abstract types of the node, nearest first; set by check()
  int number = -1;                // typeIndex of a node; set by readNumbers() or numberInOrder()
};

// Says where a version of X3D differs from the stanza of a node: a statement `since`.
struct Revision {
  Reference node;
  int major = 0, minor = 0; // the first version of X3D that says so
  std::string clause;       // ISO/IEC 19775-1, in the edition of that version
  std::vector<FieldSpec> fields;
};

// A node of X3D, or of one browser, that has no stanza, because the library does not have it: a
// line of a statement `absent`.
struct AbsentNode {
  Reference node;
  std::string origin; // the browser that has it; empty: it is X3D's
  std::string clause; // empty: it is a browser's
  std::string kind;   // geometry, sensor, ...
  std::string loss;   // a clause of a message: "shapes with it are not drawn"
};

// Holds the contents of one .node file.
struct Component {
  std::string name; // the file's name without folder and extension
  std::string title;
  bool ofX3d = false;    // `standard X3D`: its nodes are those of ISO/IEC 19775-1
  bool imported = false; // read only for its abstract types: nothing is written for it
  std::vector<TypeSpec> types;
  std::vector<Revision> revisions;
  std::vector<AbsentNode> absent;
};

struct Model {
  std::vector<Component> components;        // in the order of the command line
  std::map<std::string, std::string> texts; // file contents by path, for messages
  Diagnostics diagnostics;

  // Reports an error with its source line.
  void error(const SourcePosition& source, std::string message);
  const TypeSpec* find(std::string_view name) const;
};

std::string_view changeName(Change change);
// Returns the document that describes the node, with the clause: "ISO/IEC 14772-1 clause 6.7". ""
// for a node of no standard.
std::string clauseText(const TypeSpec& type);
bool accessFromName(std::string_view name, Access& access);
bool changeFromName(std::string_view name, Change& change);

// Reads a file into a new component of the model. Returns false if it cannot be read. Errors in the
// file are reported in model.diagnostics.
bool readSpecification(const std::string& path, bool imported, Model& model);

// Resolves the abstract types, completes the fields from them, and reports inconsistencies.
void check(Model& model);

// Number the nodes that are not imported: by a list (docs/nodegen.md), or in the order of the
// files. readNumbers returns false if the list cannot be read. Where the list and the nodes
// disagree, it reports errors in model.diagnostics.
bool readNumbers(const std::string& path, Model& model);
void numberInOrder(Model& model);

} // namespace xvrml::nodegen
