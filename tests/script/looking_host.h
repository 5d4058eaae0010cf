// looking_host.h: a script host that reads every byte a helper process sends, and calls that are
// answered by bytes a test chooses instead of the helper's. Used by the unit tests and the fuzz
// target of the messages.
#pragma once

#include <cstring>
#include <string>

#include <sys/socket.h>
#include <unistd.h>

#include "script/remote/host_functions.h"
#include "script/remote/process.h"

namespace xvrml {

// Host functions that read all their arguments.
struct CheckingHost : XsHost {
  static inline uint64_t sum = 0;
  static void look(const char* text) { sum += text ? std::strlen(text) : 1; }
  static void look(const XsString& text) {
    if (!text.data) return;
    for (uint64_t i = 0; i <= text.bytes; ++i) sum += uint8_t(text.data[i]);
  }
  static void look(const XsValue* value) {
    if (!value || !value->of.data) return;
    const wire::Element element = wire::elementOf(value->type);
    for (uint32_t i = 0; i < value->count; ++i) {
      if (element.kind == wire::Kind::texts) {
        look(value->of.strings[i]);
      } else if (element.kind == wire::Kind::images) {
        const XsImage& image = value->of.images[i];
        const uint64_t bytes = image.pixels ? uint64_t(image.width) * uint64_t(image.height) *
                                                  uint64_t(image.components)
                                            : 0;
        for (uint64_t k = 0; image.width > 0 && image.height > 0 && k < bytes; ++k)
          sum += image.pixels[k];
      } else {
        for (uint32_t k = 0; k < element.bytes; ++k)
          sum += static_cast<const uint8_t*>(value->of.data)[i * element.bytes + k];
      }
    }
  }
  CheckingHost() : XsHost{} {
    send = write = [](const XsHost*, XsNode, const char* n, const XsValue* v) {
      look(n);
      look(v);
      return XS_OK;
    };
    post = [](const XsHost*, XsNode, XsNode, const char* n, const XsValue* v) {
      look(n);
      look(v);
      return XS_OK;
    };
    read = [](const XsHost*, XsNode, XsNode, const char* n, XsValue* v) {
      look(n);
      *v = {XS_MFINT32, 0, {}};
      return XS_OK;
    };
    describe = [](const XsHost*, XsNode, XsNode, XsNodeInfo* i) {
      i->typeName = i->defName = "x";
      return XS_OK;
    };
    field = [](const XsHost*, XsNode, XsNode, uint32_t, XsField*) { return XS_NO_FIELD; };
    findField = [](const XsHost*, XsNode, XsNode, const char* n, XsField*) {
      look(n);
      return XS_NO_FIELD;
    };
    retain = release = [](const XsHost*, XsNode, XsNode) { return XS_OK; };
    getName = getVersion = getWorldUrl = lastError = [](const XsHost*, XsNode, XsString* s) {
      *s = {"x", 1};
      return XS_OK;
    };
    getCurrentSpeed = getCurrentFrameRate = [](const XsHost*, XsNode) { return 1.0; };
    setDescription = [](const XsHost*, XsNode, XsString s) {
      look(s);
      return XS_OK;
    };
    replaceWorld = [](const XsHost*, XsNode, uint32_t count, const XsNode* nodes) {
      for (uint32_t i = 0; nodes && i < count; ++i) sum += nodes[i];
      return XS_OK;
    };
    loadUrl = [](const XsHost*, XsNode, uint32_t n, const XsString* a, uint32_t m,
                 const XsString* b) {
      for (uint32_t i = 0; a && i < n; ++i) look(a[i]);
      for (uint32_t i = 0; b && i < m; ++i) look(b[i]);
      return XS_OK;
    };
    createVrmlFromUrl = [](const XsHost*, XsNode, uint32_t n, const XsString* a, XsNode,
                           const char* in) {
      for (uint32_t i = 0; a && i < n; ++i) look(a[i]);
      look(in);
      return XS_OK;
    };
    createVrmlFromString = [](const XsHost*, XsNode, XsString s, XsValue* v) {
      look(s);
      *v = {XS_MFINT32, 0, {}};
      return XS_OK;
    };
    namedNode = createInstance = createVrmlFromString;
    rootNodes = sceneFacts = [](const XsHost*, XsNode, XsValue* v) {
      *v = {XS_MFINT32, 0, {}};
      return XS_OK;
    };
    nodeWithin = [](const XsHost*, XsNode, XsNode, XsString s, XsValue* v) {
      look(s);
      *v = {XS_MFINT32, 0, {}};
      return XS_OK;
    };
    nodeTypes = [](const XsHost*, XsNode, XsNode, XsValue* v) {
      *v = {XS_MFINT32, 0, {}};
      return XS_OK;
    };
    writeNode = [](const XsHost*, XsNode, XsNode, XsString s, XsString* out) {
      look(s);
      *out = {"x", 1};
      return XS_OK;
    };
    writeScene = [](const XsHost*, XsNode, uint32_t count, const XsNode* nodes, XsString s,
                    XsString* out) {
      for (uint32_t i = 0; nodes && i < count; ++i) sum += nodes[i];
      look(s);
      *out = {"x", 1};
      return XS_OK;
    };
    otherName = [](const XsHost*, XsNode, XsNode, uint32_t, XsString* out) {
      *out = {"x", 1};
      return XS_OK;
    };
    addRoute =
        deleteRoute = [](const XsHost*, XsNode, XsNode, const char* a, XsNode, const char* b) {
          look(a);
          look(b);
          return XS_OK;
        };
    log = [](const XsHost*, XsNode, int32_t, uint32_t, XsString s) { look(s); };
  }
};
// Returns the state of a call when the helper answers with these bytes and closes the socket.
inline ScriptProcess::State callThatGets(const std::string& bytes, std::string* death = nullptr) {
  static const CheckingHost host;
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    return ScriptProcess::State::running;
  ScriptProcess process(ends[0], {"x.so", "x", 1000, 0.05, 0}, host);
  if (write(ends[1], bytes.data(), bytes.size()) != ssize_t(bytes.size()))
    return ScriptProcess::State::running;
  shutdown(ends[1], SHUT_WR);
  wire::Writer call;
  call.begin(wire::Op::tick, 1);
  const bool begun = process.begin(call);
  const auto state =
      begun ? process.serve(1e9, 1e9, wire::never, 0) : ScriptProcess::State::running;
  if (death) *death = process.death();
  close(ends[1]);
  return state;
}

} // namespace xvrml
