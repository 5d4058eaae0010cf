// node_methods.cpp: Implements what nodes of X3D say of themselves (ISO/IEC 19777-1, SFNode): type,
// name, fields, and text. The numbers of types are those of X3DConstants.
#include <cstddef>
#include <cstring>
#include <iterator>

#include "slots.h"

namespace ecma {
namespace {

XsNode receiver(duk_context* ctx, Interpreter& self, const char* what) {
  step(self);
  duk_push_this(ctx);
  const XsNode node = nodeOf(ctx, self, -1, what);
  if (node == 0) throwType(ctx, "%s: the node is NULL", what);
  return node;
}

XsNodeInfo described(duk_context* ctx, Interpreter& self, XsNode node, const char* what) {
  XsNodeInfo info{sizeof(XsNodeInfo), 0, nullptr, nullptr};
  const XsResult result = self.host->describe(self.host, self.self, node, &info);
  if (result != XS_OK) throwHost(ctx, self, result, what);
  return info;
}

duk_ret_t getNodeTypeName(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  constexpr const char* what = "getNodeTypeName";
  duk_push_string(ctx, described(ctx, self, receiver(ctx, self, what), what).typeName);
  return 1;
}

duk_ret_t getNodeName(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  constexpr const char* what = "getNodeName";
  duk_push_string(ctx, described(ctx, self, receiver(ctx, self, what), what).defName);
  return 1;
}

// Returns the abstract types of the node as an Array of the numbers of X3DConstants.
duk_ret_t getNodeType(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  constexpr const char* what = "getNodeType";
  const XsNode node = receiver(ctx, self, what);
  if (!hasX3dNodes(self)) throwType(ctx, "%s: this browser does not tell the types", what);
  XsValue types{};
  const XsResult result = self.host->nodeTypes(self.host, self.self, node, &types);
  if (result != XS_OK) throwHost(ctx, self, result, what);
  const duk_idx_t list = duk_push_array(ctx);
  duk_uarridx_t count = 0;
  for (uint32_t i = 0; i < types.count; ++i) {
    const int number = nodeTypeNumber(types.of.strings[i].data);
    if (number == 0) continue; // a newer host may know more types
    duk_push_int(ctx, number);
    duk_put_prop_index(ctx, list, count++);
  }
  return 1;
}

// Returns an Array of objects { accessType, dataType, name }, in the order of the fields.
duk_ret_t getFieldDefinitions(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  constexpr const char* what = "getFieldDefinitions";
  const XsNode node = receiver(ctx, self, what);
  const uint32_t count = described(ctx, self, node, what).fieldCount;
  const duk_idx_t list = duk_push_array(ctx);
  for (uint32_t i = 0; i < count; ++i) {
    XsField field{};
    const XsResult result = self.host->field(self.host, self.self, node, i, &field);
    if (result != XS_OK) throwHost(ctx, self, result, what);
    duk_push_object(ctx);
    duk_push_int(ctx, accessNumber(field.access));
    duk_put_prop_string(ctx, -2, "accessType");
    duk_push_int(ctx, field.type);
    duk_put_prop_string(ctx, -2, "dataType");
    duk_push_string(ctx, field.name);
    duk_put_prop_string(ctx, -2, "name");
    duk_put_prop_index(ctx, list, i);
  }
  return 1;
}

duk_ret_t toVrmlString(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  pushWritten(ctx, self, receiver(ctx, self, "toVRMLString"), "VRML");
  return 1;
}
duk_ret_t toXmlString(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  pushWritten(ctx, self, receiver(ctx, self, "toXMLString"), "XML");
  return 1;
}

} // namespace

bool hasX3dNodes(const Interpreter& self) {
  return self.host->size >= offsetof(XsHost, writeNode) + sizeof(self.host->writeNode) &&
         self.host->writeNode;
}

void pushWritten(duk_context* ctx, Interpreter& self, XsNode node, const char* encoding) {
  if (!hasX3dNodes(self)) throwType(ctx, "this browser does not write nodes");
  XsString text{"", 0};
  const XsResult result =
      self.host->writeNode(self.host, self.self, node, {encoding, std::strlen(encoding)}, &text);
  if (result != XS_OK) throwHost(ctx, self, result, encoding);
  pushString(ctx, text);
}

void putNodeMethods(duk_context* ctx) {
  static constexpr Method methods[] = {
      {"getNodeTypeName", getNodeTypeName, 0}, {"getNodeName", getNodeName, 0},
      {"getNodeType", getNodeType, 0},         {"getFieldDefinitions", getFieldDefinitions, 0},
      {"toVRMLString", toVrmlString, 0},       {"toXMLString", toXmlString, 0}};
  putMethods(ctx, methods, std::size(methods));
}

} // namespace ecma
