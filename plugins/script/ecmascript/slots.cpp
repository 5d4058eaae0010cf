// slots.cpp: Implements slots: reading, assigning and flushing. The Script's own fields are
// accessors of the global object (C.5.1).
#include "slots.h"

#include <cstring>
#include <new>

namespace ecma {
namespace {

bool isPlain(XsType type) { return !isMf(type) && components(type) > 0; }

// Pushes the entry of the array `values` for the slot.
void pushKept(duk_context* ctx, Interpreter& self, int slot) {
  duk_push_heapptr(ctx, self.values);
  duk_get_prop_index(ctx, -1, duk_uarridx_t(slot));
  duk_remove(ctx, -2);
}
// Pops the value into the array `values`.
void keepValue(duk_context* ctx, Interpreter& self, int slot) {
  duk_push_heapptr(ctx, self.values);
  duk_dup(ctx, -2);
  duk_put_prop_index(ctx, -2, duk_uarridx_t(slot));
  duk_pop_2(ctx);
}

// Detaches the object of the slot's value: it keeps the value, but changes no longer affect the
// field.
void detachKept(duk_context* ctx, Interpreter& self, int slot) {
  pushKept(ctx, self, slot);
  if (MfData* mf = mfData(ctx, -1)) mf->place = {};
  if (SfData* sf = sfData(ctx, -1)) {
    sf->place = {};
    duk_get_prop_heapptr(ctx, -1, self.keyList);
    if (MfData* pixels = mfData(ctx, -1)) pixels->place = {};
    duk_pop(ctx);
  }
  duk_pop(ctx);
}

// Updates an existing MF object with the current values, so that the program gets the same object
// in each call.
bool refresh(duk_context* ctx, Interpreter& self, int slot, const XsValue& value) {
  pushKept(ctx, self, slot);
  MfData* mf = mfData(ctx, -1);
  const size_t bytes = isMf(value.type) ? elementBytes(value.type) : 0;
  const bool same = mf && bytes > 0 && mf->type == value.type && mf->count == value.count;
  if (same && value.count > 0)
    std::memcpy(static_cast<void*>(mf + 1), value.of.data, bytes * value.count);
  duk_pop(ctx);
  return same;
}

bool isLoaded(const Interpreter& self, const Slot& slot) {
  return slot.call == (slot.node ? self.call : 1);
}

duk_ret_t getOwn(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  pushSlot(ctx, self, duk_get_current_magic(ctx));
  return 1;
}
duk_ret_t setOwn(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  assignSlot(ctx, self, duk_get_current_magic(ctx), 0);
  return 0;
}

} // namespace

int makeSlot(Interpreter& self, XsNode node, const XsField& field, bool readable,
             bool writable) noexcept {
  try {
    Slot slot;
    slot.node = node;
    slot.name = field.name;
    slot.type = field.type;
    slot.access = field.access;
    slot.readable = readable;
    slot.writable = writable;
    slot.serial = ++self.nextSerial;
    if (self.freeSlots.empty()) {
      self.slots.push_back(std::move(slot));
      return int(self.slots.size()) - 1;
    }
    const int place = self.freeSlots.back();
    self.slots[size_t(place)] = std::move(slot);
    self.freeSlots.pop_back();
    return place;
  } catch (const std::bad_alloc&) { return -1; }
}

// Called from a finalizer, so it must not use the heap. The slot's kept value is replaced when the
// slot is reused.
void freeSlot(Interpreter& self, int slot) noexcept {
  try {
    self.slots[size_t(slot)] = Slot{};
    self.freeSlots.push_back(slot);
  } catch (const std::bad_alloc&) {} // the slot is never reused
}

Place placeOf(const Interpreter& self, int slot) { return {slot, self.slots[size_t(slot)].serial}; }
void holdNode(duk_context* ctx, Interpreter& self, int slot) {
  const auto found = self.nodes.find(self.slots[size_t(slot)].node);
  if (found != self.nodes.end())
    duk_push_heapptr(ctx, found->second->object);
  else
    duk_push_undefined(ctx);
}
bool isLive(const Interpreter& self, Place place) {
  return place.slot >= 0 && self.slots[size_t(place.slot)].serial == place.serial;
}

void markDirty(duk_context* ctx, Interpreter& self, int slot) {
  Slot& it = self.slots[size_t(slot)];
  if (!it.writable) throwType(ctx, "%s cannot be written", it.name.c_str());
  it.call = it.node ? self.call : 1;
  if (it.dirty) return;
  if (it.node) { // keep the node until the event has been sent
    duk_push_heapptr(ctx, self.held);
    holdNode(ctx, self, slot);
    duk_put_prop_index(ctx, -2, duk_uarridx_t(duk_get_length(ctx, -2)));
    duk_pop(ctx);
  }
  bool full = false;
  try {
    self.dirty.push_back(slot);
  } catch (const std::bad_alloc&) { full = true; }
  if (full) throwRange(ctx, "out of memory");
  it.dirty = true;
}

void loadSlot(duk_context* ctx, Interpreter& self, int slot) {
  Slot* const it = &self.slots[size_t(slot)];
  if (isLoaded(self, *it)) return;
  holdNode(ctx, self, slot);
  if (!it->readable) throwType(ctx, "%s cannot be read", it->name.c_str());
  XsValue value{};
  const XsResult result = self.host->read(self.host, self.self, it->node ? it->node : self.self,
                                          it->name.c_str(), &value);
  if (result != XS_OK) throwHost(ctx, self, result, it->name.c_str());
  if (isPlain(it->type)) {
    pushValue(ctx, self, value);
    toPlain(ctx, -1, it->type, it->plain, it->name.c_str());
    duk_pop(ctx);
  } else if (!refresh(ctx, self, slot, value)) {
    pushValue(ctx, self, value, placeOf(self, slot));
    detachKept(ctx, self, slot);
    keepValue(ctx, self, slot);
  }
  it->call = it->node ? self.call : 1;
  duk_pop(ctx);
}

void pushSlot(duk_context* ctx, Interpreter& self, int slot) {
  loadSlot(ctx, self, slot);
  const Slot& it = self.slots[size_t(slot)];
  switch (it.type) {
  case XS_SFBOOL: return duk_push_boolean(ctx, it.plain[0] != 0);
  case XS_SFINT32:
  case XS_SFDOUBLE:
  case XS_SFFLOAT:
  case XS_SFTIME: return duk_push_number(ctx, it.plain[0]);
  default: break;
  }
  if (isPlain(it.type))
    pushSf(ctx, self, it.type, it.plain)->place = placeOf(self, slot);
  else
    pushKept(ctx, self, slot);
}

void assignSlot(duk_context* ctx, Interpreter& self, int slot, duk_idx_t value) {
  value = duk_normalize_index(ctx, value);
  const char* name = self.slots[size_t(slot)].name.c_str();
  const XsType type = self.slots[size_t(slot)].type;
  double plain[XS_MOST_COMPONENTS];
  if (!self.slots[size_t(slot)].writable) throwType(ctx, "%s cannot be written", name);
  if (isPlain(type)) {
    toPlain(ctx, value, type, plain, name);
    const int count = components(type);
    for (int i = 0; i < count; ++i)
      self.slots[size_t(slot)].plain[i] = count > 1 ? rounded(type, plain[i]) : plain[i];
    return markDirty(ctx, self, slot);
  }
  const Place place = placeOf(self, slot);
  if (isMf(type)) {
    pushMfFrom(ctx, self, value, type, name);
    mfData(ctx, -1)->place = place;
  } else if (type == XS_SFSTRING) {
    pushText(ctx, value, name);
  } else if (type == XS_SFNODE) {
    pushNode(ctx, self, nodeOf(ctx, self, value, name));
  } else {
    pushImageFrom(ctx, self, value, place, name);
  }
  if (isMf(type) || type == XS_SFIMAGE) detachKept(ctx, self, slot);
  keepValue(ctx, self, slot);
  markDirty(ctx, self, slot);
}

duk_ret_t flushSlots(duk_context* ctx, void* data) {
  Interpreter& self = *static_cast<Interpreter*>(data);
  for (size_t i = 0; i < self.dirty.size(); ++i) {
    const int slot = self.dirty[i];
    Slot& it = self.slots[size_t(slot)];
    if (!it.dirty) continue; // its node has been collected
    it.dirty = false;
    XsValue value{};
    slotValue(ctx, self, slot, value);
    const XsHost& host = *self.host;
    const char* name = it.name.c_str();
    const XsResult result = it.node ? host.post(&host, self.self, it.node, name, &value)
                            : it.access == XS_EVENT_OUT
                                ? host.send(&host, self.self, name, &value)
                                : host.write(&host, self.self, name, &value);
    if (result == XS_STOPPED) self.stopped = true;
    // the host has already reported XS_NOT_ALLOWED
    if (result == XS_OK || result == XS_STOPPED || result == XS_NOT_ALLOWED) continue;
    XsString why{"", 0};
    host.lastError(&host, self.self, &why);
    duk_push_lstring(ctx, why.data, why.bytes);
    duk_push_sprintf(ctx, "%s: ", name);
    duk_insert(ctx, -2);
    duk_concat(ctx, 2);
    const XsString text = textForHost(ctx, self, -1);
    logText(self, 3, 0, text.data, text.bytes);
    duk_pop(ctx);
  }
  self.dirty.clear();
  duk_push_heapptr(ctx, self.held);
  duk_set_length(ctx, -1, 0);
  return 0;
}

void renewOwn(Interpreter& self, const char* name) {
  for (Slot& slot : self.slots)
    if (slot.node == 0 && !slot.dirty && slot.name == name) slot.call = 0;
}

void registerFields(duk_context* ctx, Interpreter& self) {
  duk_push_global_object(ctx);
  for (uint32_t i = 0; i < self.info->fieldCount; ++i) {
    const XsField& field = self.info->fields[i];
    if (field.access == XS_EVENT_IN) continue;
    constexpr int most = 32'000; // accessor numbers are 16-bit integers
    const int place = makeSlot(self, 0, field, true, true);
    if (place < 0) throwRange(ctx, "out of memory");
    if (place > most) break;
    putAccessor(ctx, field.name, getOwn, setOwn, place);
    if (field.access != XS_EXPOSED_FIELD) continue;
    duk_push_sprintf(ctx, "%s_changed", field.name);
    duk_insert(ctx, -2);
    putAccessor(ctx, duk_get_string(ctx, -2), getOwn, setOwn, place);
    duk_remove(ctx, -2);
  }
  duk_pop(ctx);
}

} // namespace ecma
