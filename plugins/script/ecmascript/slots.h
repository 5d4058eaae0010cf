// slots.h: fields and events as the program sees them: read once a call, assigned with conversion,
// handed to the host when the function has returned. [the browser's thread]
#pragma once

#include "values.h"

namespace ecma {

// A new slot; -1 without memory.
int makeSlot(Interpreter& self, XsNode node, const XsField& field, bool readable,
             bool writable) noexcept;
void freeSlot(Interpreter& self, int slot) noexcept;
Place placeOf(const Interpreter& self, int slot);
// Pushes the node whose field it is, so that it stays, or undefined.
void holdNode(duk_context* ctx, Interpreter& self, int slot);
bool isLive(const Interpreter& self, Place place);

void pushSlot(duk_context* ctx, Interpreter& self, int slot);
void assignSlot(duk_context* ctx, Interpreter& self, int slot, duk_idx_t value);
// Makes sure that the value is there; throws if it cannot be read.
void loadSlot(duk_context* ctx, Interpreter& self, int slot);
void markDirty(duk_context* ctx, Interpreter& self, int slot);
// Hands all that was assigned to the host. In a protected call.
duk_ret_t flushSlots(duk_context* ctx, void* self);
void registerFields(duk_context* ctx, Interpreter& self);

// from_host.cpp: pushes the program's form of a value.
void pushValue(duk_context* ctx, Interpreter& self, const XsValue& value, Place place = {});
// to_host.cpp: the value of the object on top, or of a slot's plain numbers, for the host; good
// until the next call.
void slotValue(duk_context* ctx, Interpreter& self, int slot, XsValue& out);
XsString textForHost(duk_context* ctx, Interpreter& self, duk_idx_t index); // index: a string
// An MFString or one text at `index`, as a list.
void textsForHost(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what);
void nodesForHost(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what);

} // namespace ecma
