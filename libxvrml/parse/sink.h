// sink.h: the interface between the readers of files and the builder. A reader knows only how a
// file is written: tokens and productions, elements and attributes. The builder, which is one sink,
// knows node types, names and prototypes. Calls nest like the text. Every open call is followed by
// its close call, also after errors. The texts of names must live as long as the sink.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/locator.h"
#include "xvrml/node.h"

namespace xvrml {

// The destination of a field's value. Values other than nodes are read straight into the storage.
struct FieldTarget {
  bool known = false;
  FieldType type = FieldType::SFBool;
  void* storage = nullptr; // null for SFNode and MFNode
  // Not null: the reader puts the line of each string of the value here. They are used in messages
  // about programs in these strings.
  std::vector<uint32_t>* stringLines = nullptr;
};

class ParseSink {
 public:
  virtual ~ParseSink() = default;

  // Says where the value of the open field, the body of the open node, or the open prototype from
  // its name on stands in the text: from its first byte to the one behind its last. The readers of
  // VRML97 and of X3D ClassicVRML call it before they close one of these.
  virtual void placed(const char* begin, const char* end) { (void)begin, (void)end; }

  // node ::= nodeTypeId { nodeBody }
  // openNode: `def` is the DEF name or null. It returns false if the type is unknown; then the body
  // is skipped and the node is not closed. closeNode: `good` is false if the body could not be
  // read.
  virtual bool openNode(const Name& type, const Name* def) = 0;
  virtual void closeNode(bool good) = 0;
  virtual SourcePosition openNodePlace() const = 0; // where the innermost open node begins
  // Returns the interface of a node type that is known here: a prototype's or the standard's. Null
  // if there is no type of that name.
  virtual const NodeType* typeNamed(std::string_view name) const = 0;
  // nodeTarget() returns a number for the place that holds the next complete node (a file, a body,
  // a field), valid until that place ends. wouldAccept() returns whether the place would accept a
  // node of the named type or, with `use`, the node with that DEF name.
  virtual size_t nodeTarget() const = 0;
  virtual bool wouldAccept(size_t nodeTarget, std::string_view name, bool use) const = 0;
  // Returns whether the open node may declare fields (scriptBodyElements).
  virtual bool declaresFields() const = 0;
  virtual void useNode(const Name& name) = 0;
  virtual void nullNode(const Name& token) = 0;
  // Reports the DEF name of a node that was left out.
  virtual void lostName(const Name& name) = 0;

  // fieldId fieldValue in the open node
  virtual FieldTarget openField(const Name& name) = 0;
  // Goes on with a list of nodes or strings after its closeField(): what follows is appended. A
  // field that has no value yet is opened.
  virtual FieldTarget resumeField(const Name& name) = 0;
  virtual bool hasField(std::string_view name) const = 0;
  // Returns the field of the open node that takes a node of the named type, or the node with that
  // DEF name (`use`), where the file does not say which. Empty if there is no such type or name;
  // the sink then adds nothing.
  virtual std::string_view fieldFor(std::string_view name, bool use) const = 0;
  // Closes the field. `good` is false if its value could not be read; it then has its default.
  virtual void closeField(bool good) = 0;
  // id IS interfaceId in the open node
  virtual void connect(const Name& field, const Name& interfaceName) = 0;

  // A declaration in the interface of the open PROTO or EXTERNPROTO, or in a node that declares
  // fields. With hasValue, a value follows as after openField.
  virtual FieldTarget openDeclaration(Access access, FieldType type, const Name& name,
                                      bool hasValue) = 0;
  virtual void closeDeclaration(bool good) = 0;

  virtual void openProto(const Name& name) = 0;
  virtual void openProtoBody() = 0;
  virtual void closeProto(bool good) = 0;
  virtual void openExternProto(const Name& name) = 0;
  virtual std::vector<std::string>& externUrls() = 0;
  virtual void closeExternProto(bool good) = 0;

  struct RouteNames {
    Name from, fromField, to, toField;
  };
  virtual void route(const Name& keyword, const RouteNames& names) = 0;

  // The statements of X3D (ISO/IEC 19775-1 7.2.5). A unit of a category is `factor` of the
  // standard's. IMPORT inlineName.exported AS local. EXPORT node AS exported; the node may be
  // defined further down.
  virtual void version(int major, int minor) = 0; // version of X3D, where the reader finds it
  virtual void profile(const Name& name) = 0;
  virtual void component(const Name& name, int32_t level) = 0;
  virtual void meta(const Name& keyword, std::string name, std::string content) = 0;
  virtual void unit(const Name& category, const Name& name, double factor) = 0;
  struct ImportNames {
    Name inlineName, exported, local;
  };
  virtual void importNode(const Name& keyword, const ImportNames& names) = 0;
  virtual void exportNode(const Name& node, const Name& exported) = 0;
};

} // namespace xvrml
