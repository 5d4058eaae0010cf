// host_table.cpp: the functions of XsHost, which Scripts call. Arguments are not trusted, and no
// exception crosses the ABI. The interface is in xvrml/xscript.h. [the browser's thread]
#include "script/host_table.h"

#include <new>

#include <fmt/format.h>

#include "graph/field_access.h"
#include "script/host_calls.h"
#include "script/host_scene.h"
#include "xvrml/versions.h"

namespace xvrml {

// Wide because there is one function for each entry of XsHost.
struct HostTable : HostCalls {
  // --- Own fields and events ---

  static XsResult send(Host table, XsNode self, const char* name, const XsValue* value) {
    return act(table, self, [&](ScriptHost& host, Script& script) {
      const FieldInfo* out = name ? script.node->type().findEventOut(name) : nullptr;
      if (!out || !Script::isOwn(*out)) return noField(script, *script.node, "eventOut", name);
      Value taken;
      if (!take(host, script, value, out->type, taken))
        return refuse(script, XS_WRONG_TYPE, fmt::format("{}: {}", name, script.error));
      if (out->access == Access::exposedField) return writeExposed(host, script, *out, taken);
      output(script, *out, std::move(taken));
      return XS_OK;
    });
  }

  // Notes an event from the Script's own node. It leaves when the function returns.
  static void output(Script& script, const FieldInfo& out, Value value) {
    for (Script::Output& output : script.outputs)
      if (!output.to && output.field == &out) {
        output.value = std::move(value);
        return;
      }
    script.outputs.push_back({{}, &out, std::move(value)});
  }

  // Sets an inputOutput field of the Script, which sends NAME_changed (ISO/IEC 19775-1 4.4.2.2).
  static XsResult writeExposed(ScriptHost& host, Script& script, const FieldInfo& field,
                               Value value) {
    if (!host.engine_.store(*script.node, field, std::move(value)))
      return refuse(script, XS_FAILED, "not a value it can have");
    output(script, field, script.node->get(field));
    return XS_OK;
  }

  static XsResult write(Host table, XsNode self, const char* name, const XsValue* value) {
    return act(table, self, [&](ScriptHost& host, Script& script) {
      const FieldInfo* field = name ? script.node->type().find(name) : nullptr;
      const bool own = field && holdsValue(*field) && Script::isOwn(*field);
      if (!own) return noField(script, *script.node, "field that it may write,", name);
      Value taken;
      if (!take(host, script, value, field->type, taken))
        return refuse(script, XS_WRONG_TYPE, fmt::format("{}: {}", name, script.error));
      if (field->access == Access::exposedField)
        return writeExposed(host, script, *field, std::move(taken));
      return host.engine_.store(*script.node, *field, std::move(taken))
                 ? XS_OK
                 : refuse(script, XS_FAILED, "not a value it can have");
    });
  }

  // --- Nodes ---

  static XsResult readOwn(ScriptHost& host, Script& script, const char* name, XsValue* out) {
    const Node& node = *script.node;
    const FieldInfo* field = node.type().find(name);
    if (!field) field = node.type().findEventOut(name);
    if (!field || field->access == Access::eventIn)
      return noField(script, node, "field or eventOut", name);
    Value value = holdsValue(*field) ? node.get(*field) : host.engine_.lastSent(node, *field);
    for (const Script::Output& output : script.outputs)
      if (!output.to && output.field == field) value = output.value;
    *out = script.lent.lend(std::move(value), script.handles);
    return XS_OK;
  }

  static XsResult read(Host table, XsNode self, XsNode number, const char* name, XsValue* out) {
    return enter(table, self, [&](ScriptHost& host, Script& script) {
      return withNode(script, number, [&](Node& node) {
        if (!name || !out) return noField(script, node, "field", name);
        if (&node == script.node) return readOwn(host, script, name, out);
        const FieldInfo* field = findEventOut(node, name);
        if (!field) return noField(script, node, "exposedField or eventOut", name);
        *out = script.lent.lend(host.engine_.lastSent(node, *field), script.handles);
        return XS_OK;
      });
    });
  }

  static XsResult post(Host table, XsNode self, XsNode number, const char* name,
                       const XsValue* value) {
    return act(table, self, [&](ScriptHost& host, Script& script) {
      return withNode(script, number, [&](Node& node) {
        if (&node != script.node && !script.flag(XS_DIRECT_OUTPUT))
          return needsDirectOutput(host, script, "an event to another node");
        const FieldInfo* in = name ? findEventIn(node, name) : nullptr;
        if (!in) return noField(script, node, "eventIn or exposedField", name);
        Value taken;
        if (!take(host, script, value, in->type, taken))
          return refuse(script, XS_WRONG_TYPE, fmt::format("{}: {}", name, script.error));
        if (script.outputs.size() >= host.engine_.maximumEvents)
          return refuse(script, XS_FAILED, "too many events");
        script.outputs.push_back({NodeRef(&node), in, std::move(taken)});
        return XS_OK;
      });
    });
  }

  static XsResult needsDirectOutput(ScriptHost& host, Script& script, const char* what) {
    host.log(script, 2, 0,
             fmt::format("{} needs directOutput TRUE (6.40); ignored, --compat scripts allows it",
                         what));
    return refuse(script, XS_NOT_ALLOWED, fmt::format("{} needs directOutput TRUE", what));
  }

  static XsResult describe(Host table, XsNode self, XsNode number, XsNodeInfo* out) {
    return enter(table, self, [&](ScriptHost&, Script& script) {
      return withNode(script, number, [&](Node& node) {
        if (!out || out->size < sizeof(XsNodeInfo))
          return refuse(script, XS_FAILED, "XsNodeInfo without its size");
        script.lentText = node.defName;
        out->fieldCount = uint32_t(node.type().fields.size());
        out->typeName = node.type().name.c_str();
        out->defName = script.lentText.c_str();
        return XS_OK;
      });
    });
  }

  static XsResult giveField(Script& script, const Node& node, const FieldInfo* field,
                            const char* name, XsField* out) {
    if (!field || !out) return noField(script, node, "field or event", name);
    *out = {fieldName(node, *field).data(), xsType(field->type), xsAccess(field->access)};
    return XS_OK;
  }
  static XsResult field(Host table, XsNode self, XsNode number, uint32_t index, XsField* out) {
    return enter(table, self, [&](ScriptHost&, Script& script) {
      return withNode(script, number, [&](Node& node) {
        const auto& fields = node.type().fields;
        return giveField(script, node, index < fields.size() ? &fields[index] : nullptr,
                         "of that number", out);
      });
    });
  }
  static XsResult otherName(Host table, XsNode self, XsNode number, uint32_t index, XsString* out) {
    return enter(table, self, [&](ScriptHost&, Script& script) {
      return withNode(script, number, [&](Node& node) {
        const auto& fields = node.type().fields;
        const std::string_view other =
            index < fields.size() ? otherFieldName(node, fields[index]) : std::string_view();
        if (other.empty() || !out) return noField(script, node, "other name of field", "");
        return giveText(script, std::string(other), out);
      });
    });
  }
  static XsResult findField(Host table, XsNode self, XsNode number, const char* name,
                            XsField* out) {
    return enter(table, self, [&](ScriptHost&, Script& script) {
      return withNode(script, number, [&](Node& node) {
        const FieldInfo* found = name ? xvrml::findField(node, name) : nullptr;
        if (!found && name) found = findEventIn(node, name);
        if (!found && name) found = findEventOut(node, name);
        return giveField(script, node, found, name, out);
      });
    });
  }

  static XsResult retain(Host table, XsNode self, XsNode number) {
    return enter(table, self, [&](ScriptHost&, Script& script) {
      return script.handles.retain(number)
                 ? XS_OK
                 : refuse(script, XS_NO_NODE, fmt::format("no node {}", number));
    });
  }
  // Releases a handle, also while no function runs: garbage collectors release at any time. The
  // node is dropped at the end of the next call.
  static XsResult release(Host table, XsNode self, XsNode number) {
    Script* script = hostOf(table).find(self);
    try {
      return script && script->handles.release(number) ? XS_OK : XS_NO_NODE;
    } catch (const std::bad_alloc&) { return XS_FAILED; } // the node stays until the Script ends
  }

  // --- The Browser object ---

  static XsResult getName(Host table, XsNode self, XsString* out) {
    return enter(table, self, [&](ScriptHost& host, Script& script) {
      return giveText(script, host.browser_.name(), out);
    });
  }
  static XsResult getVersion(Host table, XsNode self, XsString* out) {
    return enter(table, self, [&](ScriptHost& host, Script& script) {
      return giveText(script, host.browser_.version(), out);
    });
  }
  static double getCurrentSpeed(Host table, XsNode) {
    return hostOf(table).browser_.currentSpeed();
  }
  static double getCurrentFrameRate(Host table, XsNode) {
    return hostOf(table).browser_.currentFrameRate();
  }
  static XsResult getWorldUrl(Host table, XsNode self, XsString* out) {
    return enter(table, self, [&](ScriptHost& host, Script& script) {
      return giveText(script, host.browser_.worldUrl(), out);
    });
  }
  static XsResult setDescription(Host table, XsNode self, XsString description) {
    return act(table, self, [&](ScriptHost& host, Script&) {
      host.browser_.setDescription(text(host, description));
      return XS_OK;
    });
  }

  static XsResult replaceWorld(Host table, XsNode self, uint32_t count, const XsNode* nodes) {
    return act(table, self, [&](ScriptHost& host, Script& script) {
      XsValue value{XS_MFNODE, count, {nullptr}};
      value.of.nodes = nodes;
      Value taken;
      if (!take(host, script, &value, FieldType::MFNode, taken)) return XS_NO_NODE;
      host.browser_.replaceWorld(std::get<MFNode>(taken));
      return XS_OK;
    });
  }
  static XsResult loadUrl(Host table, XsNode self, uint32_t urlCount, const XsString* urls,
                          uint32_t parameterCount, const XsString* parameters) {
    return act(table, self, [&](ScriptHost& host, Script& script) {
      host.browser_.loadUrl(texts(host, urlCount, urls), texts(host, parameterCount, parameters),
                            baseOf(script));
      return XS_OK;
    });
  }
  static XsResult createVrmlFromUrl(Host table, XsNode self, uint32_t urlCount,
                                    const XsString* urls, XsNode number, const char* eventIn) {
    return act(table, self, [&](ScriptHost& host, Script& script) {
      return withNode(script, number, [&](Node& node) {
        const FieldInfo* in = eventIn ? findEventIn(node, eventIn) : nullptr;
        if (!in || in->type != FieldType::MFNode)
          return noField(script, node, "eventIn of type MFNode", eventIn);
        host.browser_.createVrmlFromUrl(texts(host, urlCount, urls), node, eventIn, baseOf(script));
        return XS_OK;
      });
    });
  }
  static XsResult createVrmlFromString(Host table, XsNode self, XsString vrml, XsValue* out) {
    return act(table, self, [&](ScriptHost& host, Script& script) {
      try {
        *out = script.lent.lend(
            host.browser_.createVrmlFromString(text(host, vrml), baseOf(script)), script.handles);
        return XS_OK;
      } catch (const LoadError& error) {
        return refuse(script, XS_FAILED, error.diagnostic.text());
      }
    });
  }

  template <class Change> static XsResult changeRoute(Host table, XsNode self, XsNode from,
                                                      const char* out, XsNode to, const char* in,
                                                      Change&& change) {
    return act(table, self, [&](ScriptHost& host, Script& script) {
      return withNode(script, from, [&](Node& source) {
        return withNode(script, to, [&](Node& target) {
          const bool own = &source == script.node && &target == script.node;
          if (!own && !script.flag(XS_DIRECT_OUTPUT))
            return needsDirectOutput(host, script, "a change of routes");
          if (!out || !findEventOut(source, out)) return noField(script, source, "eventOut", out);
          if (!in || !findEventIn(target, in)) return noField(script, target, "eventIn", in);
          return change(host.browser_, source, target)
                     ? XS_OK
                     : refuse(script, XS_FAILED, "no such route, or types differ");
        });
      });
    });
  }
  static XsResult addRoute(Host table, XsNode self, XsNode from, const char* out, XsNode to,
                           const char* in) {
    return changeRoute(table, self, from, out, to, in,
                       [&](Browser& browser, Node& source, Node& target) {
                         return browser.addRoute(source, out, target, in);
                       });
  }
  static XsResult deleteRoute(Host table, XsNode self, XsNode from, const char* out, XsNode to,
                              const char* in) {
    return changeRoute(table, self, from, out, to, in,
                       [&](Browser& browser, Node& source, Node& target) {
                         return browser.deleteRoute(source, out, target, in);
                       });
  }

  // --- Time, messages ---

  static double now(Host table, XsNode) { return hostOf(table).engine_.now(); }
  static int32_t shouldStop(Host table, XsNode self, uint64_t steps) {
    ScriptHost& host = hostOf(table);
    Script* script = host.find(self);
    return !script || host.running_ != script || host.overBudget(*script, steps) ? 1 : 0;
  }
  static void log(Host table, XsNode self, int32_t severity, uint32_t line, XsString message) {
    try {
      ScriptHost& host = hostOf(table);
      if (Script* script = host.find(self)) host.log(*script, severity, line, text(host, message));
    } catch (const std::exception&) {} // invalid text, or out of memory
  }
  static XsResult lastError(Host table, XsNode self, XsString* out) {
    Script* script = hostOf(table).find(self);
    if (!script || !out) return XS_NO_NODE;
    *out = {script->error.c_str(), script->error.size()};
    return XS_OK;
  }

  // --- The library's own objects ---

  static void* object(Host table, XsNode self, XsNode number) {
    ScriptHost& host = hostOf(table);
    Script* script = host.find(self);
    if (!script || !script->flag(XS_TRUSTED)) return nullptr;
    return number ? static_cast<void*>(script->handles.find(number))
                  : static_cast<void*>(&host.browser_);
  }
  static XsNode number(Host table, XsNode self, void* object) {
    Script* script = hostOf(table).find(self);
    return script && script->flag(XS_TRUSTED) && object
               ? script->handles.handleOf(static_cast<Node*>(object))
               : 0;
  }
};

ScriptHost::Table::Table(ScriptHost& host)
    : XsHost{sizeof(XsHost),
             XS_ABI_MAJOR,
             XS_ABI_MINOR,
             HostTable::send,
             HostTable::write,
             HostTable::read,
             HostTable::post,
             HostTable::describe,
             HostTable::field,
             HostTable::findField,
             HostTable::retain,
             HostTable::release,
             HostTable::getName,
             HostTable::getVersion,
             HostTable::getCurrentSpeed,
             HostTable::getCurrentFrameRate,
             HostTable::getWorldUrl,
             HostTable::setDescription,
             HostTable::replaceWorld,
             HostTable::loadUrl,
             HostTable::createVrmlFromUrl,
             HostTable::createVrmlFromString,
             HostTable::addRoute,
             HostTable::deleteRoute,
             HostTable::now,
             HostTable::shouldStop,
             HostTable::log,
             HostTable::lastError,
             HostTable::object,
             HostTable::number,
             HostScene::namedNode,
             HostScene::rootNodes,
             HostScene::sceneFacts,
             HostScene::createInstance,
             HostScene::nodeWithin,
             HostScene::nodeTypes,
             HostScene::writeNode,
             HostScene::writeScene,
             HostTable::otherName},
      host(host) {}

} // namespace xvrml
