// nodes.cpp: Implements SFNode (C.6.6). Each node that the program holds has one wrapper, so that
// == compares identity. Fields and events are accessors of one prototype per node type (C.5.2).
#include <cstddef>
#include <cstring>
#include <new>

#include "slots.h"

namespace ecma {
namespace {

NodeRecord* recordOf(duk_context* ctx, Interpreter& self, duk_idx_t index) {
  if (!duk_is_object(ctx, index)) return nullptr;
  duk_get_prop_heapptr(ctx, index, self.keyNode);
  const auto* number = static_cast<const XsNode*>(duk_get_buffer(ctx, -1, nullptr));
  duk_pop(ctx);
  if (!number) return nullptr;
  const auto found = self.nodes.find(*number);
  return found == self.nodes.end() ? nullptr : found->second;
}

int ownSlot(const Interpreter& self, const char* name) {
  for (size_t i = 0; i < self.slots.size(); ++i)
    if (self.slots[i].node == 0 && self.slots[i].name == name) return int(i);
  return -1;
}

bool remember(NodeRecord& record, int name, int slot) noexcept {
  try {
    record.slots.emplace_back(name, slot);
    return true;
  } catch (const std::bad_alloc&) { return false; }
}

// Returns the slot of a field under any of its names (exposedField x, set_x and x_changed share
// one); -1 if there is none.
int slotFor(duk_context* ctx, Interpreter& self, NodeRecord& record, int name) {
  for (const auto& [known, slot] : record.slots)
    if (known == name) return slot;
  const char* text = self.names[size_t(name)].c_str();
  XsField field{};
  const XsResult result = self.host->findField(self.host, self.self, record.node, text, &field);
  if (result == XS_NO_FIELD) return -1;
  if (result != XS_OK) throwHost(ctx, self, result, text);
  if (field.access == XS_FIELD && record.node != self.self) {
    // coordIndex of an IndexedFaceSet is a field that only set_coordIndex can change; programs use
    // it like an exposedField.
    duk_push_sprintf(ctx, "set_%s", text);
    XsField in{};
    if (self.host->findField(self.host, self.self, record.node, duk_get_string(ctx, -1), &in) ==
            XS_OK &&
        in.access == XS_EVENT_IN)
      field = in;
    // the lent name was invalidated
    else
      self.host->findField(self.host, self.self, record.node, text, &field);
    duk_pop(ctx);
  }
  int slot = -1;
  if (record.node == self.self && field.access != XS_EVENT_IN) slot = ownSlot(self, field.name);
  for (const auto& [known, other] : record.slots)
    if (slot < 0 && self.slots[size_t(other)].name == field.name) slot = other;
  if (slot < 0) {
    const bool exposed = field.access == XS_EXPOSED_FIELD;
    slot = makeSlot(self, record.node, field, exposed || field.access == XS_EVENT_OUT,
                    exposed || field.access == XS_EVENT_IN);
  }
  if (slot < 0 || !remember(record, name, slot)) throwRange(ctx, "out of memory");
  return slot;
}

duk_ret_t getField(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  duk_push_this(ctx);
  NodeRecord* record = recordOf(ctx, self, -1);
  const int slot = record ? slotFor(ctx, self, *record, duk_get_current_magic(ctx)) : -1;
  if (slot < 0 || !self.slots[size_t(slot)].readable) return 0;
  pushSlot(ctx, self, slot);
  return 1;
}

duk_ret_t setField(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  duk_push_this(ctx);
  NodeRecord* record = recordOf(ctx, self, -1);
  if (!record) throwType(ctx, "not an SFNode");
  const int slot = slotFor(ctx, self, *record, duk_get_current_magic(ctx));
  if (slot < 0)
    throwType(ctx, "the node has no '%s'", self.names[size_t(duk_get_current_magic(ctx))].c_str());
  assignSlot(ctx, self, slot, 0);
  return 0;
}

// Returns the number of a name for accessors; -1 if there are too many, -2 if there is no memory.
int nameNumber(Interpreter& self, const char* name) noexcept {
  constexpr size_t most = 32'000;
  for (size_t i = 0; i < self.names.size(); ++i)
    if (self.names[i] == name) return int(i);
  if (self.names.size() >= most) return -1;
  try {
    self.names.emplace_back(name);
  } catch (const std::bad_alloc&) { return -2; }
  return int(self.names.size()) - 1;
}

// Throws if there is no memory, because an incomplete prototype would be kept for the type.
void putField(duk_context* ctx, Interpreter& self, const char* name) {
  const int number = nameNumber(self, name);
  if (number == -2) throwRange(ctx, "out of memory");
  if (number >= 0) putAccessor(ctx, name, getField, setField, number);
}

// Adds the names of a field to the prototype on top.
void putFieldNames(duk_context* ctx, Interpreter& self, const char* field, bool exposed) {
  const duk_idx_t type = duk_get_top_index(ctx);
  duk_push_string(ctx, field); // host calls invalidate the lent name
  if (exposed) {
    duk_push_sprintf(ctx, "set_%s", duk_get_string(ctx, type + 1));
    duk_push_sprintf(ctx, "%s_changed", duk_get_string(ctx, type + 1));
  }
  for (duk_idx_t form = type + 1, end = duk_get_top(ctx); form < end; ++form) {
    duk_dup(ctx, type);
    putField(ctx, self, duk_get_string(ctx, form));
    duk_pop(ctx);
  }
  duk_set_top(ctx, type + 1);
}

bool tellsOtherNames(const XsHost& host) {
  return host.size >= offsetof(XsHost, otherName) + sizeof(host.otherName) && host.otherName;
}

// Pushes the prototype of a node's type; it is created on first use. Types with the same interface
// share a prototype, because the field is looked up in each node. So a prototype has the names of
// VRML97 and of X3D, and the version of a node's file says which of them the node has.
void pushType(duk_context* ctx, Interpreter& self, XsNode node) {
  XsNodeInfo info{sizeof(XsNodeInfo), 0, nullptr, nullptr};
  XsResult result = self.host->describe(self.host, self.self, node, &info);
  if (result != XS_OK) throwHost(ctx, self, result, "SFNode");
  XsField field{};
  duk_push_heapptr(ctx, self.types);
  duk_push_sprintf(ctx, "%u ", info.fieldCount);
  duk_push_string(ctx, info.typeName);
  for (const uint32_t at : {0u, info.fieldCount - 1}) {
    duk_push_string(ctx, " ");
    result = info.fieldCount > 0 ? self.host->field(self.host, self.self, node, at, &field)
                                 : XS_NO_FIELD;
    duk_push_string(ctx, result == XS_OK ? field.name : "");
  }
  duk_concat(ctx, 6);
  duk_dup(ctx, -1);
  if (duk_get_prop(ctx, -3)) {
    duk_remove(ctx, -2);
    return duk_remove(ctx, -2);
  }
  duk_pop(ctx);
  duk_push_bare_object(ctx);
  duk_push_heapptr(ctx, self.nodePrototype);
  duk_set_prototype(ctx, -2);
  for (uint32_t i = 0; i < info.fieldCount; ++i) {
    result = self.host->field(self.host, self.self, node, i, &field);
    if (result == XS_FAILED || result == XS_STOPPED) throwHost(ctx, self, result, "SFNode");
    if (result != XS_OK) continue;
    const bool exposed = field.access == XS_EXPOSED_FIELD;
    putFieldNames(ctx, self, field.name, exposed);
    XsString other{"", 0};
    if (tellsOtherNames(*self.host) &&
        self.host->otherName(self.host, self.self, node, i, &other) == XS_OK)
      putFieldNames(ctx, self, other.data, exposed);
  }
  duk_insert(ctx, -3); // stack: type, types, key
  duk_dup(ctx, -3);
  duk_put_prop(ctx, -3);
  duk_pop(ctx);
}

// Called for every object with the node's number: the wrapper, and objects that the program derived
// from it.
duk_ret_t finalize(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  NodeRecord* record = recordOf(ctx, self, 0);
  if (!record || record->object != duk_get_heapptr(ctx, 0)) return 0;
  for (const auto& [name, slot] : record->slots)
    if (self.slots[size_t(slot)].node == record->node) freeSlot(self, slot);
  self.nodes.erase(record->node);
  if (!self.ending) self.host->release(self.host, self.self, record->node);
  delete record;
  return 0;
}

NodeRecord* makeRecord(Interpreter& self, XsNode node, void* object) noexcept {
  auto* record = new (std::nothrow) NodeRecord;
  if (!record) return nullptr;
  record->node = node;
  record->object = object;
  try {
    self.nodes.emplace(node, record);
  } catch (const std::bad_alloc&) {
    delete record;
    return nullptr;
  }
  return record;
}

// Handles new SFNode("VRML text") and new SFNode(node).
duk_ret_t construct(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  if (duk_get_top(ctx) == 0) {
    duk_push_null(ctx);
    return 1;
  }
  if (!duk_is_string(ctx, 0)) {
    pushNode(ctx, self, nodeOf(ctx, self, 0, "SFNode"));
    return 1;
  }
  XsValue made{};
  const XsResult result =
      self.host->createVrmlFromString(self.host, self.self, textForHost(ctx, self, 0), &made);
  if (result != XS_OK) throwHost(ctx, self, result, "SFNode");
  pushValue(ctx, self, made);
  pushElement(ctx, self, -1, 0);
  if (duk_is_undefined(ctx, -1)) duk_push_null(ctx);
  return 1;
}

} // namespace

void pushNode(duk_context* ctx, Interpreter& self, XsNode node) {
  if (node == 0) return duk_push_null(ctx);
  if (const auto found = self.nodes.find(node); found != self.nodes.end()) {
    duk_push_heapptr(ctx, found->second->object);
    return;
  }
  pushType(ctx, self, node);
  duk_push_bare_object(ctx);
  auto* number = static_cast<XsNode*>(duk_push_fixed_buffer(ctx, sizeof(XsNode)));
  *number = node;
  duk_put_prop_heapptr(ctx, -2, self.keyNode);
  const XsResult result = self.host->retain(self.host, self.self, node);
  if (result != XS_OK) throwHost(ctx, self, result, "SFNode");
  if (!makeRecord(self, node, duk_get_heapptr(ctx, -1))) {
    self.host->release(self.host, self.self, node);
    throwRange(ctx, "out of memory");
  }
  duk_insert(ctx, -2);
  duk_set_prototype(ctx, -2); // from here on the object has its own finalizer
}

bool isNode(duk_context* ctx, Interpreter& self, duk_idx_t index) {
  return recordOf(ctx, self, index) != nullptr;
}

// Returns whether the value is the result of `new SFNode()`; a constructor cannot return null.
bool isNull(duk_context* ctx, Interpreter& self, duk_idx_t index) {
  if (!duk_is_object(ctx, index)) return duk_is_null(ctx, index);
  duk_get_prototype(ctx, index);
  const bool null = duk_get_heapptr(ctx, -1) == self.nodePrototype;
  duk_pop(ctx);
  return null;
}

XsNode nodeOf(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what) {
  if (isNull(ctx, self, index)) return 0;
  if (const NodeRecord* record = recordOf(ctx, self, index)) return record->node;
  index = duk_normalize_index(ctx, index);
  // An MFNode is the result of createVrmlFromString.
  if (const MfData* mf = mfData(ctx, index); mf && mf->type == XS_MFNODE && mf->count > 0) {
    pushElement(ctx, self, index, 0);
    const NodeRecord* record = recordOf(ctx, self, -1);
    duk_pop(ctx);
    return record ? record->node : 0;
  }
  throwType(ctx, "%s: expected SFNode, got %s", what, describe(ctx, index));
}

void registerNodes(duk_context* ctx, Interpreter& self) {
  static constexpr Method methods[] = {{"toString", notationMethod, 0}};
  duk_push_object(ctx);
  putMethods(ctx, methods, 1);
  putNodeMethods(ctx);
  duk_push_c_function(ctx, finalize, 2);
  duk_set_finalizer(ctx, -2);
  duk_dup(ctx, -1);
  self.nodePrototype = keep(ctx);
  putConstructor(ctx, "SFNode", construct, 0);
}

} // namespace ecma
