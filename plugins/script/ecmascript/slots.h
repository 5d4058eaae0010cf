// slots.h: Manages fields and events as the program sees them: read once per call, assigned with
// conversion, and passed to the host when the function has returned. [the browser's thread]
#pragma once

#include "values.h"

namespace ecma {

// Creates a slot; returns -1 if there is no memory.
int makeSlot(Interpreter& self, XsNode node, const XsField& field, bool readable,
             bool writable) noexcept;
void freeSlot(Interpreter& self, int slot) noexcept;
Place placeOf(const Interpreter& self, int slot);
// Pushes the node that has the field, which keeps it alive, or undefined.
void holdNode(duk_context* ctx, Interpreter& self, int slot);
bool isLive(const Interpreter& self, Place place);

void pushSlot(duk_context* ctx, Interpreter& self, int slot);
void assignSlot(duk_context* ctx, Interpreter& self, int slot, duk_idx_t value);
// Reads the value if necessary; throws if it cannot be read.
void loadSlot(duk_context* ctx, Interpreter& self, int slot);
void markDirty(duk_context* ctx, Interpreter& self, int slot);
// Passes all assigned values to the host. Must run in a protected call.
duk_ret_t flushSlots(duk_context* ctx, void* self);
void registerFields(duk_context* ctx, Interpreter& self);
// Makes the next read of an own field ask the host, because an event has changed the field.
void renewOwn(Interpreter& self, const char* name);

// scene.cpp: Adds what X3D's Browser object has to the object on top: properties, and the scene.
void putX3d(duk_context* ctx, Interpreter& self);
// Replaces the MFNode on top by a scene (X3DScene) that holds these nodes.
void wrapScene(duk_context* ctx, Interpreter& self);
// Pushes the MFNode of such a scene and returns true. Pushes nothing for other values.
bool pushSceneNodes(duk_context* ctx, duk_idx_t index);

// constants.cpp: Defines the global X3DConstants.
void registerConstants(duk_context* ctx);
// Return the numbers of X3DConstants; 0 for an unknown name.
int nodeTypeNumber(const char* name);
int accessNumber(XsAccess access);

// node_methods.cpp: Adds the methods of X3D's nodes to the object on top.
void putNodeMethods(duk_context* ctx);
// Pushes the text of a node, or of the world for node 0. encoding: "VRML" or "XML".
void pushWritten(duk_context* ctx, Interpreter& self, XsNode node, const char* encoding);
// Returns whether the host has the functions of version 1.3.
bool hasX3dNodes(const Interpreter& self);

// from_host.cpp: Pushes a text of the host.
void pushString(duk_context* ctx, const XsString& text);
// Pushes the program's form of a value.
void pushValue(duk_context* ctx, Interpreter& self, const XsValue& value, Place place = {});
// to_host.cpp: Converts the object on top, or a slot's plain numbers, for the host; valid until the
// next call.
void slotValue(duk_context* ctx, Interpreter& self, int slot, XsValue& out);
// index: must be a string
XsString textForHost(duk_context* ctx, Interpreter& self, duk_idx_t index);
// Converts an MFString or a single string at `index` to a list.
void textsForHost(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what);
void nodesForHost(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what);

} // namespace ecma
