// scene.cpp: Makes what X3D's Browser object has besides functions (ISO/IEC 19777-1 6): name,
// version, currentSpeed, currentFrameRate, description, and currentScene with its nodes and routes.
// The scene is the world, or the Inline that the Script stands in.
#include <cstddef>

#include "slots.h"

namespace ecma {
namespace {

Interpreter& begin(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  return self;
}

bool hasScene(const Interpreter& self) { return self.host->namedNode && self.host->rootNodes; }

// A name that the scene does not have is an error, as in X3D.
duk_ret_t getNamedNode(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  constexpr const char* name = "getNamedNode";
  if (!hasScene(self)) throwType(ctx, "%s: this browser has no scenes", name);
  pushText(ctx, 0, name);
  XsValue found{};
  const XsResult result =
      self.host->namedNode(self.host, self.self, textForHost(ctx, self, -1), &found);
  if (result != XS_OK) throwHost(ctx, self, result, name);
  pushValue(ctx, self, found);
  return 1;
}

duk_ret_t getRootNodes(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  constexpr const char* name = "rootNodes";
  if (!hasScene(self)) throwType(ctx, "%s: this browser has no scenes", name);
  XsValue roots{};
  const XsResult result = self.host->rootNodes(self.host, self.self, &roots);
  if (result != XS_OK) throwHost(ctx, self, result, name);
  pushValue(ctx, self, roots);
  return 1;
}

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

void putX3d(duk_context* ctx) {
  for (size_t i = 0; i < std::size(properties); ++i)
    putAccessor(ctx, properties[i].name, getProperty, readOnly, int(i));
  putAccessor(ctx, "description", getDescription, setDescription, 0);
  static constexpr Method methods[] = {{"getNamedNode", getNamedNode, 1}};
  duk_push_object(ctx);
  putMethods(ctx, methods, std::size(methods));
  putAccessor(ctx, "rootNodes", getRootNodes, readOnly, 0);
  for (const char* shared :
       {"addRoute", "deleteRoute", "createVrmlFromString", "createX3DFromString"}) {
    duk_get_prop_string(ctx, -2, shared);
    duk_put_prop_string(ctx, -2, shared);
  }
  duk_put_prop_string(ctx, -2, "currentScene");
}

} // namespace ecma
