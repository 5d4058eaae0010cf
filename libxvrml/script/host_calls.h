// host_calls.h: what the functions of XsHost share: they find the Script that calls, check its
// budget and its arguments, and say why they refuse. Arguments are not trusted, and no exception
// crosses the ABI. Used by host_table.cpp and host_scene.cpp. [the browser's thread]
#pragma once

#include <new>

#include <fmt/format.h>

#include "script/host_table.h"

namespace xvrml {

struct HostCalls {
  using Host = const XsHost*;
  static constexpr uint64_t stepsOfCall = 100;

  static ScriptHost& hostOf(Host host) { return static_cast<const ScriptHost::Table*>(host)->host; }
  static XsResult refuse(Script& script, XsResult why, std::string text) {
    script.error = std::move(text);
    return why;
  }

  // Finds the Script whose function is running, checks its budget and runs `body`.
  template <class Body> static XsResult enter(Host table, XsNode self, Body&& body) {
    try {
      ScriptHost& host = hostOf(table);
      Script* script = host.find(self);
      if (!script) return XS_NO_NODE;
      if (host.running_ != script)
        return refuse(*script, XS_NOT_ALLOWED, "no function of this Script is running");
      if (host.overBudget(*script, stepsOfCall))
        return refuse(*script, XS_STOPPED, "the Script's time is up");
      return body(host, *script);
    } catch (const std::exception& error) {
      Script* script = hostOf(table).find(self);
      return script ? refuse(*script, XS_FAILED, error.what()) : XS_FAILED;
    }
  }
  // Does the same for functions that change something. They are refused while the Script ends.
  template <class Body> static XsResult act(Host table, XsNode self, Body&& body) {
    return enter(table, self, [&](ScriptHost& host, Script& script) {
      if (host.ending_ || script.nodeCopy)
        return refuse(script, XS_NOT_ALLOWED, "the Script is being shut down");
      return body(host, script);
    });
  }
  template <class Body> static XsResult withNode(Script& script, XsNode number, Body&& body) {
    Node* node = script.handles.find(number);
    if (!node)
      return refuse(script, XS_NO_NODE,
                    number ? fmt::format("the Script does not know a node {}", number) : "NULL");
    return body(*node);
  }
  static XsResult noField(Script& script, const Node& node, const char* what, const char* name) {
    return refuse(script, XS_NO_FIELD,
                  fmt::format("{} has no {} '{}'", node.type().name, what, name ? name : ""));
  }
  static XsResult giveText(Script& script, std::string text, XsString* out) {
    script.lentText = std::move(text);
    *out = {script.lentText.c_str(), script.lentText.size()};
    return XS_OK;
  }
  static bool take(ScriptHost& host, Script& script, const XsValue* value, FieldType type,
                   Value& out) {
    return takeValue(value, type, script.handles, host.world_.options.limits, out, script.error);
  }
  static std::string text(ScriptHost& host, const XsString& from) {
    std::string out, why;
    if (!takeText(from, host.world_.options.limits, out, why)) throw std::runtime_error(why);
    return out;
  }
  static std::vector<std::string> texts(ScriptHost& host, uint32_t count, const XsString* from) {
    constexpr uint32_t most = 10'000;
    if (count > most || (count > 0 && !from))
      throw std::runtime_error(fmt::format("a list of {} texts", count));
    std::vector<std::string> out;
    for (uint32_t i = 0; i < count; ++i) out.push_back(text(host, from[i]));
    return out;
  }
  // Returns the file that contains the Script's program (4.5.3).
  static std::string baseOf(const Script& script) {
    const auto& file = script.start.file ? script.start.file : script.node->source.file;
    return file ? *file : std::string();
  }
};

} // namespace xvrml
