// sink.h: what the grammar says to whoever listens. The parser knows tokens and productions only;
// the builder (one sink) knows node types, names and prototypes. Calls nest as the text does; every
// open is followed by its close, also after errors.
#pragma once

#include "base/lexer.h"
#include "xvrml/node.h"

namespace xvrml {

// Where a field's value goes. Values other than nodes are read straight into the storage.
struct FieldTarget {
  bool known = false;
  FieldType type = FieldType::SFBool;
  void* storage = nullptr; // not for SFNode and MFNode
};

class ParseSink {
 public:
  virtual ~ParseSink() = default;

  // node ::= nodeTypeId { nodeBody }. def: its DEF name or null. False: the type is not known, the
  // body will be skipped and the node is not closed. good: false if the body could not be read.
  virtual bool openNode(const Token& type, const Token* def) = 0;
  virtual void closeNode(bool good) = 0;
  virtual SourcePosition openNodePlace() const = 0; // where the innermost open node begins
  // The interface of a node type that is known here: a prototype's or the standard's; null: there
  // is none of that name.
  virtual const NodeType* typeNamed(std::string_view name) const = 0;
  // A number for what takes complete nodes now (a file, a body, a field), good until it ends; and
  // whether it would take a node of the named type, or with `use` the node that is DEFined by that
  // name.
  virtual size_t receiver() const = 0;
  virtual bool wouldTake(size_t receiver, std::string_view name, bool use) const = 0;
  virtual bool isScript() const = 0; // the open node takes scriptBodyElements
  virtual void useNode(const Token& name) = 0;
  virtual void nullNode(const Token& token) = 0;
  // A node that was left out; names DEFined within are reported by lostName.
  virtual void lostName(const Token& name) = 0;

  // fieldId fieldValue in the open node.
  virtual FieldTarget openField(const Token& name) = 0;
  virtual bool hasField(std::string_view name) const = 0;
  virtual void closeField(bool good) = 0;
  // id IS interfaceId in the open node.
  virtual void connect(const Token& field, const Token& interfaceName) = 0;

  // An interface declaration of the open PROTO, EXTERNPROTO or Script. With hasValue a value
  // follows, as in openField.
  virtual FieldTarget openDeclaration(Access access, FieldType type, const Token& name,
                                      bool hasValue) = 0;
  virtual void closeDeclaration(bool good) = 0;

  virtual void openProto(const Token& name) = 0;
  virtual void openProtoBody() = 0;
  virtual void closeProto(bool good) = 0;
  virtual void openExternProto(const Token& name) = 0;
  virtual std::vector<std::string>& externUrls() = 0;
  virtual void closeExternProto(bool good) = 0;

  struct RouteNames {
    Token from, fromField, to, toField;
  };
  virtual void route(const Token& keyword, const RouteNames& names) = 0;
};

} // namespace xvrml
