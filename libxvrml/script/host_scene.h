// host_scene.h: the functions of XsHost about the scene that a Script stands in and what X3D's
// nodes say of themselves (ISO/IEC 19777-1); see xvrml/xscript.h. [the browser's thread]
#pragma once

#include "script/host_calls.h"

namespace xvrml {

struct HostScene : HostCalls {
  static XsResult namedNode(Host table, XsNode self, XsString name, XsValue* out);
  static XsResult rootNodes(Host table, XsNode self, XsValue* out);
  static XsResult sceneFacts(Host table, XsNode self, XsValue* out);
  static XsResult createInstance(Host table, XsNode self, XsString prototype, XsValue* out);
  static XsResult nodeWithin(Host table, XsNode self, XsNode number, XsString name, XsValue* out);
  static XsResult nodeTypes(Host table, XsNode self, XsNode number, XsValue* out);
  static XsResult writeNode(Host table, XsNode self, XsNode number, XsString encoding,
                            XsString* out);
  static XsResult writeScene(Host table, XsNode self, uint32_t count, const XsNode* nodes,
                             XsString encoding, XsString* out);

 private:
  static const Scope& sceneOf(ScriptHost& host, const Node& script);
};

} // namespace xvrml
