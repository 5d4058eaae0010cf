// model.h: node specifications in memory: what the reader of .node files fills, the checks complete
// and the writers print. One Model per run of nodegen, on one thread.
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

// A name used in a specification, and where.
struct Reference {
  std::string name;
  SourcePosition source;
};

struct FieldSpec {
  std::string name;
  FieldType type = FieldType::SFBool;
  Access access = Access::field;
  SourcePosition source;
  Value value;           // default, if the access has one
  std::string valueText; // as written
  SourcePosition valueSource;
  std::optional<FieldRange> range;
  std::string rangeText;
  std::optional<Change> change;
  SourcePosition changeSource;
  std::vector<Reference> accepts;
  std::string text;

  bool hasStorage() const { return access == Access::field || access == Access::exposedField; }
};

// A node, or an abstract type: a role that nodes play, and what the fields that belong to it mean.
struct TypeSpec {
  bool isAbstract = false;
  std::string name;
  std::string clause;
  std::string text;
  std::vector<Reference> parents; // abstract types, as written
  std::vector<FieldSpec> fields;
  std::string component; // the file's name without folder and extension
  SourcePosition source;
  std::vector<std::string> roles; // all abstract types it is of, nearest first; set by check()
};

// A .node file.
struct Component {
  std::string name; // the file's name without folder and extension
  std::string title;
  bool imported = false; // read for its abstract types alone: nothing is written for it
  std::vector<TypeSpec> types;
};

struct Model {
  std::vector<Component> components;        // in the order of the command line
  std::map<std::string, std::string> texts; // of the files, by path, for messages
  Diagnostics diagnostics;

  // Reports with the line it speaks of.
  void error(const SourcePosition& source, std::string message);
  const TypeSpec* find(std::string_view name) const;
};

std::string_view accessName(Access access);
std::string_view changeName(Change change);
bool accessFromName(std::string_view name, Access& access);
bool changeFromName(std::string_view name, Change& change);

// Reads a file into a new component of the model. False if it cannot be read; what is wrong inside
// is in model.diagnostics.
bool readSpecification(const std::string& path, bool imported, Model& model);

// Resolves abstract types and completes the fields from them; reports what does not fit together.
void check(Model& model);

} // namespace xvrml::nodegen
