// scene.cpp: Makes what X3D's Browser object has besides functions (ISO/IEC 19777-1 6): name,
// version, currentSpeed, currentFrameRate, description, and scenes (X3DScene) with their nodes and
// routes. Browser.currentScene is the world, or the Inline that the Script stands in. Other scenes
// come from createX3DFromString; they hold their nodes in a hidden property.
#include <cstddef>
#include <cstring>
#include <iterator>
#include <string>

#include "slots.h"

namespace ecma {
namespace {

Interpreter& begin(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  return self;
}

bool hasScene(const Interpreter& self) { return self.host->namedNode && self.host->rootNodes; }

constexpr const char* madeKey = DUK_HIDDEN_SYMBOL("made");

// Pushes the MFNode of the receiver, if it is a scene that was made from text; otherwise undefined.
// Returns whether it is one.
bool pushMade(duk_context* ctx) {
  duk_push_this(ctx);
  const bool made = pushSceneNodes(ctx, -1);
  if (!made) duk_push_undefined(ctx);
  duk_remove(ctx, -2);
  return made;
}

// Finds a node of a made scene. stack: the MFNode on top.
duk_ret_t namedWithin(duk_context* ctx, Interpreter& self, const char* name) {
  if (!hasX3dNodes(self)) throwType(ctx, "%s: this browser does not search nodes", name);
  const duk_idx_t roots = duk_get_top_index(ctx);
  const uint32_t count = mfData(ctx, roots)->count;
  for (uint32_t i = 0; i < count; ++i) {
    pushElement(ctx, self, roots, i);
    const XsNode node = nodeOf(ctx, self, -1, name);
    XsValue found{};
    const XsResult result =
        self.host->nodeWithin(self.host, self.self, node, textForHost(ctx, self, 0), &found);
    if (result == XS_OK) {
      pushValue(ctx, self, found);
      return 1;
    }
    if (result != XS_NO_NODE) throwHost(ctx, self, result, name);
    duk_pop(ctx);
  }
  throwType(ctx, "%s: the scene has no node '%s'", name, duk_get_string(ctx, 0));
}

// A name that the scene does not have is an error, as in X3D.
duk_ret_t getNamedNode(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  constexpr const char* name = "getNamedNode";
  if (!hasScene(self)) throwType(ctx, "%s: this browser has no scenes", name);
  pushText(ctx, 0, name);
  duk_replace(ctx, 0);
  if (pushMade(ctx)) return namedWithin(ctx, self, name);
  XsValue found{};
  const XsResult result =
      self.host->namedNode(self.host, self.self, textForHost(ctx, self, 0), &found);
  if (result != XS_OK) throwHost(ctx, self, result, name);
  pushValue(ctx, self, found);
  return 1;
}

duk_ret_t getRootNodes(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  constexpr const char* name = "rootNodes";
  if (!hasScene(self)) throwType(ctx, "%s: this browser has no scenes", name);
  if (pushMade(ctx)) return 1;
  XsValue roots{};
  const XsResult result = self.host->rootNodes(self.host, self.self, &roots);
  if (result != XS_OK) throwHost(ctx, self, result, name);
  pushValue(ctx, self, roots);
  return 1;
}

// specificationVersion, encoding and worldURL, by their places in what the host tells. A made scene
// follows the version of the world, and comes from a script.
duk_ret_t getFact(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  const auto fact = uint32_t(duk_get_current_magic(ctx));
  constexpr uint32_t encoding = 1;
  if (!hasX3dNodes(self)) throwType(ctx, "this browser tells nothing of scenes");
  if (pushMade(ctx) && fact == encoding) {
    duk_push_string(ctx, "SCRIPTED");
    return 1;
  }
  XsValue facts{};
  const XsResult result = self.host->sceneFacts(self.host, self.self, &facts);
  if (result != XS_OK) throwHost(ctx, self, result, "the scene");
  if (fact >= facts.count) return 0;
  pushString(ctx, facts.of.strings[fact]);
  return 1;
}

bool isWord(const char* text) {
  for (; *text; ++text) {
    const bool letter = (*text >= 'a' && *text <= 'z') || (*text >= 'A' && *text <= 'Z');
    if (!letter && !(*text >= '0' && *text <= '9') && *text != '_') return false;
  }
  return true;
}

// Makes a node of a type of the standard: what the text "TYPE { }" says in a file of its own.
duk_ret_t createNode(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  constexpr const char* name = "createNode";
  pushText(ctx, 0, name);
  const char* type = duk_get_string(ctx, -1);
  if (!*type || !isWord(type)) throwType(ctx, "%s: '%s' is no name of a node type", name, type);
  duk_push_sprintf(ctx, "%s { }", type);
  XsValue made{};
  const XsResult result =
      self.host->createVrmlFromString(self.host, self.self, textForHost(ctx, self, -1), &made);
  if (result != XS_OK) throwHost(ctx, self, result, name);
  if (made.count == 0) throwType(ctx, "%s: there is no node type '%s'", name, type);
  pushNode(ctx, self, made.of.nodes[0]);
  return 1;
}

duk_ret_t createProto(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  constexpr const char* name = "createProto";
  if (!hasX3dNodes(self)) throwType(ctx, "%s: this browser has no prototypes for scripts", name);
  pushText(ctx, 0, name);
  XsValue made{};
  const XsResult result =
      self.host->createInstance(self.host, self.self, textForHost(ctx, self, -1), &made);
  if (result != XS_OK) throwHost(ctx, self, result, name);
  pushValue(ctx, self, made);
  return 1;
}

// Writes the scene that the Script stands in, or a made one.
duk_ret_t written(duk_context* ctx, const char* encoding) {
  Interpreter& self = begin(ctx);
  if (!pushMade(ctx)) {
    pushWritten(ctx, self, 0, encoding);
    return 1;
  }
  if (self.host->size < offsetof(XsHost, writeScene) + sizeof(self.host->writeScene))
    throwType(ctx, "this browser does not write scenes");
  nodesForHost(ctx, self, -1, encoding);
  const uint32_t count = mfData(ctx, -1)->count;
  XsString text{"", 0};
  const XsResult result = self.host->writeScene(self.host, self.self, count, self.handles.data(),
                                                {encoding, std::strlen(encoding)}, &text);
  if (result != XS_OK) throwHost(ctx, self, result, encoding);
  pushString(ctx, text);
  return 1;
}
duk_ret_t toVrmlString(duk_context* ctx) { return written(ctx, "VRML"); }
duk_ret_t toXmlString(duk_context* ctx) { return written(ctx, "XML"); }

// A property of the Browser is what one of its functions returns.
struct Property {
  const char *name, *function;
};
constexpr Property properties[] = {{"name", "getName"},
                                   {"version", "getVersion"},
                                   {"currentSpeed", "getCurrentSpeed"},
                                   {"currentFrameRate", "getCurrentFrameRate"}};

duk_ret_t getProperty(duk_context* ctx) {
  duk_push_this(ctx);
  duk_push_string(ctx, properties[duk_get_current_magic(ctx)].function);
  duk_call_prop(ctx, -2, 0);
  return 1;
}

duk_ret_t readOnly(duk_context*) { return 0; }

duk_ret_t getDescription(duk_context* ctx) {
  duk_push_this(ctx);
  duk_get_prop_string(ctx, -1, DUK_HIDDEN_SYMBOL("description"));
  if (duk_is_undefined(ctx, -1)) duk_push_string(ctx, "");
  return 1;
}
duk_ret_t setDescription(duk_context* ctx) {
  duk_push_this(ctx);
  duk_push_string(ctx, "setDescription");
  duk_dup(ctx, 0);
  duk_call_prop(ctx, 1, 1);
  duk_dup(ctx, 0);
  duk_put_prop_string(ctx, 1, DUK_HIDDEN_SYMBOL("description"));
  return 0;
}

} // namespace

bool pushSceneNodes(duk_context* ctx, duk_idx_t index) {
  if (!duk_is_object(ctx, index)) return false;
  if (duk_get_prop_string(ctx, index, madeKey)) return true;
  duk_pop(ctx);
  return false;
}

void wrapScene(duk_context* ctx, Interpreter& self) {
  duk_push_bare_object(ctx);
  duk_push_heapptr(ctx, self.scenePrototype);
  duk_set_prototype(ctx, -2);
  duk_insert(ctx, -2);
  duk_put_prop_string(ctx, -2, madeKey);
}

void putX3d(duk_context* ctx, Interpreter& self) {
  for (size_t i = 0; i < std::size(properties); ++i)
    putAccessor(ctx, properties[i].name, getProperty, readOnly, int(i));
  putAccessor(ctx, "description", getDescription, setDescription, 0);
  static constexpr Method methods[] = {{"getNamedNode", getNamedNode, 1},
                                       {"createNode", createNode, 1},
                                       {"createProto", createProto, 1},
                                       {"toVRMLString", toVrmlString, 0},
                                       {"toXMLString", toXmlString, 0}};
  duk_push_object(ctx);
  putMethods(ctx, methods, std::size(methods));
  putAccessor(ctx, "rootNodes", getRootNodes, readOnly, 0);
  static constexpr const char* facts[] = {"specificationVersion", "encoding", "worldURL"};
  for (int i = 0; i < int(std::size(facts)); ++i) putAccessor(ctx, facts[i], getFact, readOnly, i);
  for (const char* shared :
       {"addRoute", "deleteRoute", "createVrmlFromString", "createX3DFromString"}) {
    duk_get_prop_string(ctx, -2, shared);
    duk_put_prop_string(ctx, -2, shared);
  }
  duk_push_bare_object(ctx); // the current scene holds no nodes itself
  duk_dup(ctx, -2);
  duk_set_prototype(ctx, -2);
  duk_put_prop_string(ctx, -3, "currentScene");
  self.scenePrototype = keep(ctx);
}

} // namespace ecma
