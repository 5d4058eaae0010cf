// browser.cpp: Defines the Browser object (C.6.3), print, and the constants TRUE and FALSE. The
// additions of X3D (ISO/IEC 19777-1) are in scene.cpp.
#include <cstring>

#include "slots.h"

namespace ecma {
namespace {

using GetText = XsResult (*XsHost::*)(const XsHost*, XsNode, XsString*);

Interpreter& begin(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  return self;
}

duk_ret_t giveText(duk_context* ctx, GetText function, const char* name) {
  Interpreter& self = begin(ctx);
  XsString text{"", 0};
  const XsResult result = (self.host->*function)(self.host, self.self, &text);
  if (result != XS_OK) throwHost(ctx, self, result, name);
  pushString(ctx, text);
  return 1;
}

duk_ret_t getName(duk_context* ctx) { return giveText(ctx, &XsHost::getName, "Browser.getName"); }
duk_ret_t getVersion(duk_context* ctx) {
  return giveText(ctx, &XsHost::getVersion, "Browser.getVersion");
}
duk_ret_t getWorldUrl(duk_context* ctx) {
  return giveText(ctx, &XsHost::getWorldUrl, "Browser.getWorldURL");
}
duk_ret_t getCurrentSpeed(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  duk_push_number(ctx, self.host->getCurrentSpeed(self.host, self.self));
  return 1;
}
duk_ret_t getCurrentFrameRate(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  duk_push_number(ctx, self.host->getCurrentFrameRate(self.host, self.self));
  return 1;
}

void check(duk_context* ctx, Interpreter& self, XsResult result, const char* name) {
  // The host has already reported a missing directOutput. The program continues, as in other
  // browsers.
  if (result != XS_OK && result != XS_NOT_ALLOWED) throwHost(ctx, self, result, name);
}

duk_ret_t setDescription(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  pushText(ctx, 0, "Browser.setDescription");
  check(ctx, self, self.host->setDescription(self.host, self.self, textForHost(ctx, self, -1)),
        "Browser.setDescription");
  return 0;
}

duk_ret_t replaceWorld(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  nodesForHost(ctx, self, 0, "Browser.replaceWorld");
  const uint32_t count = mfData(ctx, 0)->count;
  check(ctx, self, self.host->replaceWorld(self.host, self.self, count, self.handles.data()),
        "Browser.replaceWorld");
  return 0;
}

duk_ret_t loadUrl(duk_context* ctx) { // arguments: urls, parameters
  Interpreter& self = begin(ctx);
  if (duk_is_null_or_undefined(ctx, 1)) {
    pushMf(ctx, self, XS_MFSTRING, 0);
    duk_replace(ctx, 1);
  }
  textsForHost(ctx, self, 1, "Browser.loadURL");
  const auto parameterCount = uint32_t(self.strings.size());
  const size_t bytes = parameterCount * sizeof(XsString);
  // a copy, because the interpreter's list is reused below
  auto* parameters = static_cast<XsString*>(duk_push_fixed_buffer(ctx, bytes + 1));
  if (bytes > 0) std::memcpy(parameters, self.strings.data(), bytes);
  textsForHost(ctx, self, 0, "Browser.loadURL");
  check(ctx, self,
        self.host->loadUrl(self.host, self.self, uint32_t(self.strings.size()), self.strings.data(),
                           parameterCount, parameters),
        "Browser.loadURL");
  return 0;
}

void pushMadeNodes(duk_context* ctx, Interpreter& self, const char* name) {
  pushText(ctx, 0, name);
  XsValue made{};
  const XsResult result =
      self.host->createVrmlFromString(self.host, self.self, textForHost(ctx, self, -1), &made);
  if (result != XS_OK) throwHost(ctx, self, result, name);
  pushValue(ctx, self, made);
}
duk_ret_t createVrmlFromString(duk_context* ctx) {
  pushMadeNodes(ctx, begin(ctx), "Browser.createVrmlFromString");
  return 1;
}
duk_ret_t createX3dFromString(duk_context* ctx) {
  Interpreter& self = begin(ctx);
  pushMadeNodes(ctx, self, "Browser.createX3DFromString");
  wrapScene(ctx, self);
  return 1;
}

duk_ret_t createVrmlFromUrl(duk_context* ctx) { // arguments: urls, node, event
  Interpreter& self = begin(ctx);
  constexpr const char* name = "Browser.createVrmlFromURL";
  const XsNode node = nodeOf(ctx, self, 1, name);
  pushText(ctx, 2, name);
  textsForHost(ctx, self, 0, name);
  const char* event = duk_get_string(ctx, -1);
  check(ctx, self,
        self.host->createVrmlFromUrl(self.host, self.self, uint32_t(self.strings.size()),
                                     self.strings.data(), node, event),
        name);
  return 0;
}

using ChangeRoute = XsResult (*XsHost::*)(const XsHost*, XsNode, XsNode, const char*, XsNode,
                                          const char*);

// Arguments of the script's call: node, eventOut, node, eventIn.
duk_ret_t changeRoute(duk_context* ctx, ChangeRoute function, const char* name) {
  Interpreter& self = begin(ctx);
  const XsNode from = nodeOf(ctx, self, 0, name), to = nodeOf(ctx, self, 2, name);
  pushText(ctx, 1, name);
  pushText(ctx, 3, name);
  const XsResult result = (self.host->*function)(
      self.host, self.self, from, duk_get_string(ctx, -2), to, duk_get_string(ctx, -1));
  // XS_FAILED: the route existed already, or did not exist
  if (result != XS_FAILED) check(ctx, self, result, name);
  return 0;
}
duk_ret_t addRoute(duk_context* ctx) {
  return changeRoute(ctx, &XsHost::addRoute, "Browser.addRoute");
}
duk_ret_t deleteRoute(duk_context* ctx) {
  return changeRoute(ctx, &XsHost::deleteRoute, "Browser.deleteRoute");
}

// Copies the value of a field, an eventOut or an element (C.6.2); calls are inserted by
// assignments.cpp.
duk_ret_t copyOf(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  if (SfData* sf = sfData(ctx, 0)) {
    if (sf->type == XS_SFIMAGE && isLive(self, sf->place)) {
      duk_get_prop_heapptr(ctx, 0, self.keyList);
      pushImage(ctx, self, sf->v, {});
      return 1;
    }
    if (sf->type != XS_SFIMAGE) { // the object was created for this access: detach it
      sf->place = {};
      sf->hasParent = 0;
    }
  } else if (const MfData* mf = mfData(ctx, 0); mf && isLive(self, mf->place)) {
    pushMfFrom(ctx, self, 0, mf->type, "assignment");
    return 1;
  }
  duk_dup(ctx, 0);
  return 1;
}

duk_ret_t print(duk_context* ctx) { // any number of values
  Interpreter& self = begin(ctx);
  duk_push_string(ctx, " ");
  duk_insert(ctx, 0);
  for (duk_idx_t i = 1; i < duk_get_top(ctx); ++i) {
    if (duk_is_object(ctx, i)) duk_to_string(ctx, i);
    if (!duk_is_string(ctx, i)) duk_safe_to_string(ctx, i);
  }
  duk_join(ctx, duk_get_top(ctx) - 1);
  const XsString text = textForHost(ctx, self, -1);
  logText(self, 0, 0, text.data, text.bytes);
  return 0;
}

// Options and properties of the SAI (ISO/IEC 19775-2) and of other browsers: this one has none that
// a world may ask for or change.
duk_ret_t noOption(duk_context* ctx) {
  duk_push_null(ctx);
  return 1;
}
duk_ret_t setOption(duk_context* ctx) {
  constexpr const char* said = DUK_HIDDEN_SYMBOL("optionSaid");
  Interpreter& self = begin(ctx);
  duk_push_global_stash(ctx);
  if (!duk_has_prop_string(ctx, -1, said)) {
    duk_push_true(ctx);
    duk_put_prop_string(ctx, -2, said);
    duk_safe_to_string(ctx, 0);
    const std::string text = std::string("Browser.setBrowserOption does nothing: there are no "
                                         "options that a world may change ('") +
                             std::string(duk_get_string(ctx, 0)).substr(0, 40) + "')";
    logText(self, 2, 0, text.data(), text.size());
  }
  return 0;
}

void putConstant(duk_context* ctx, const char* name, bool value) {
  duk_push_boolean(ctx, value);
  duk_put_global_string(ctx, name);
}

// Makes the object of other environments that most programs of today write messages with.
void putConsole(duk_context* ctx) {
  static constexpr Method methods[] = {{"log", print, DUK_VARARGS},
                                       {"info", print, DUK_VARARGS},
                                       {"debug", print, DUK_VARARGS},
                                       {"warn", print, DUK_VARARGS},
                                       {"error", print, DUK_VARARGS}};
  duk_push_object(ctx);
  putMethods(ctx, methods, std::size(methods));
  duk_put_global_string(ctx, "console");
}

} // namespace

void registerBrowser(duk_context* ctx, Interpreter& self) {
  static constexpr Method methods[] = {{"getName", getName, 0},
                                       {"getVersion", getVersion, 0},
                                       {"getCurrentSpeed", getCurrentSpeed, 0},
                                       {"getCurrentFrameRate", getCurrentFrameRate, 0},
                                       {"getWorldURL", getWorldUrl, 0},
                                       {"setDescription", setDescription, 1},
                                       {"replaceWorld", replaceWorld, 1},
                                       {"loadURL", loadUrl, 2},
                                       {"createVrmlFromString", createVrmlFromString, 1},
                                       {"createVrmlFromURL", createVrmlFromUrl, 3},
                                       {"createX3DFromString", createX3dFromString, 1},
                                       {"createX3DFromURL", createVrmlFromUrl, 3},
                                       {"addRoute", addRoute, 4},
                                       {"deleteRoute", deleteRoute, 4},
                                       {"getBrowserOption", noOption, 1},
                                       {"getBrowserProperty", noOption, 1},
                                       {"getRenderingProperty", noOption, 1},
                                       {"setBrowserOption", setOption, 2},
                                       {"print", print, DUK_VARARGS},
                                       {"println", print, DUK_VARARGS}};
  // Functions of other browsers that worlds use.
  static constexpr Method globals[] = {
      {"print", print, DUK_VARARGS}, {"println", print, DUK_VARARGS}, {"trace", print, DUK_VARARGS},
      {"addRoute", addRoute, 4},     {"deleteRoute", deleteRoute, 4}, {"__xvrmlCopy", copyOf, 1}};
  duk_push_object(ctx);
  putMethods(ctx, methods, std::size(methods));
  putX3d(ctx, self);
  duk_put_global_string(ctx, "Browser");
  putConsole(ctx);
  duk_push_global_object(ctx);
  putMethods(ctx, globals, std::size(globals));
  duk_pop(ctx);
  putConstant(ctx, "TRUE", true);
  putConstant(ctx, "FALSE", false);
  duk_push_null(ctx);
  duk_put_global_string(ctx, "NULL");
}

} // namespace ecma
