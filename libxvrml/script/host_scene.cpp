#include "script/host_scene.h"

#include <algorithm>

#include "event/hierarchy.h"
#include "graph/expander.h"
#include "script/abstract_types.h"
#include "script/scene_text.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Returns a scene's encoding by the names of ISO/IEC 19775-2 (7.3.4, encoding).
std::string encodingText(Encoding encoding) {
  switch (encoding) {
  case Encoding::vrml97:
  case Encoding::x3dClassic:
  case Encoding::vrml1: return "VRML";
  case Encoding::x3dXml: return "XML";
  case Encoding::x3dJson: return "JSON";
  default: return "SCRIPTED";
  }
}

// Returns the newest declaration of a name; null: there is none that can be used.
ProtoPtr declared(const Scope& scene, const std::string& name) {
  for (size_t i = scene.prototypes.size(); i-- > 0;)
    if (scene.prototypes[i]->type->name == name) return scene.prototypes[i];
  return nullptr;
}

// Returns the innermost Inline with content above a Script; null: there is none.
Node* inlineAbove(const Node& script) {
  const std::vector<Path> paths = pathsTo(script, 1);
  if (paths.empty()) return nullptr;
  const auto found = std::find_if(paths[0].rbegin(), paths[0].rend(),
                                  [](const Node* node) { return inlineScope(*node); });
  return found == paths[0].rend() ? nullptr : *found;
}

// The content of an Inline, and nodes that a program has made, have no head of their own; the file
// of the first node says which version they follow. Nodes of no file follow the world's.
FileVersion versionOfNodes(const World& world, const MFNode& nodes) {
  const auto first = std::find_if(nodes.begin(), nodes.end(),
                                  [](const NodeRef& node) { return node && node->source.file; });
  return first == nodes.end() ? world.head.version : versionOf(**first);
}

// Returns whether XML is asked for; throws if it is neither XML nor VRML.
bool wantsXml(const std::string& encoding) {
  if (encoding != "XML" && encoding != "VRML")
    throw std::runtime_error(fmt::format("'{}' is no encoding: expected XML or VRML", encoding));
  return encoding == "XML";
}

} // namespace

// Returns the scene that the Script stands in: the content of the innermost Inline above it, else
// the world's. Bodies of prototypes have no scenes of their own here.
const Scope& HostScene::sceneOf(ScriptHost& host, const Node& script) {
  const Node* const above = inlineAbove(script);
  return above ? *inlineScope(*above) : host.world_.scope;
}

XsResult HostScene::namedNode(Host table, XsNode self, XsString name, XsValue* out) {
  return enter(table, self, [&](ScriptHost& host, Script& script) {
    const std::string wanted = text(host, name);
    const auto& names = sceneOf(host, *script.node).names;
    const auto found = names.find(wanted);
    if (!out || found == names.end() || !found->second)
      return refuse(script, XS_NO_NODE, fmt::format("the scene has no node '{}'", wanted));
    *out = script.lent.lend(SFNode(found->second), script.handles);
    return XS_OK;
  });
}

XsResult HostScene::rootNodes(Host table, XsNode self, XsValue* out) {
  return enter(table, self, [&](ScriptHost& host, Script& script) {
    if (!out) return refuse(script, XS_FAILED, "no place for the answer");
    MFNode roots;
    for (const NodeRef& root : sceneOf(host, *script.node).roots)
      if (root) roots.push_back(root);
    *out = script.lent.lend(std::move(roots), script.handles);
    return XS_OK;
  });
}

XsResult HostScene::sceneFacts(Host table, XsNode self, XsValue* out) {
  return enter(table, self, [&](ScriptHost& host, Script& script) {
    if (!out) return refuse(script, XS_FAILED, "no place for the answer");
    const Scope& scene = sceneOf(host, *script.node);
    const bool isWorld = &scene == &host.world_.scope;
    const FileVersion version =
        isWorld ? host.world_.head.version : versionOfNodes(host.world_, scene.roots);
    std::string file = host.browser_.worldUrl();
    if (const Node* first = isWorld || scene.roots.empty() ? nullptr : scene.roots[0].get();
        first && first->source.file)
      file = *first->source.file;
    MFString facts{fmt::format("{}.{}", version.major, version.minor),
                   encodingText(version.encoding), std::move(file)};
    *out = script.lent.lend(std::move(facts), script.handles);
    return XS_OK;
  });
}

XsResult HostScene::createInstance(Host table, XsNode self, XsString prototype, XsValue* out) {
  return act(table, self, [&](ScriptHost& host, Script& script) {
    const std::string wanted = text(host, prototype);
    const ProtoPtr found = declared(sceneOf(host, *script.node), wanted);
    if (!out || !found)
      return refuse(script, XS_NO_NODE, fmt::format("the scene has no prototype '{}'", wanted));
    try {
      *out = script.lent.lend(SFNode(host.browser_.createInstance(found, baseOf(script))),
                              script.handles);
      return XS_OK;
    } catch (const LoadError& error) { return refuse(script, XS_FAILED, error.diagnostic.text()); }
  });
}

XsResult HostScene::nodeWithin(Host table, XsNode self, XsNode number, XsString name,
                               XsValue* out) {
  return enter(table, self, [&](ScriptHost& host, Script& script) {
    return withNode(script, number, [&](Node& top) {
      const std::string wanted = text(host, name);
      Node* found = nullptr;
      walk<Node>({&top}, [&](Node& node, std::vector<Node*>& open) {
        if (node.defName == wanted) found = &node;
        appendChildren(node, open);
        return !found;
      });
      if (!out || !found)
        return refuse(script, XS_NO_NODE, fmt::format("no node '{}' in the scene", wanted));
      *out = script.lent.lend(SFNode(found), script.handles);
      return XS_OK;
    });
  });
}

XsResult HostScene::nodeTypes(Host table, XsNode self, XsNode number, XsValue* out) {
  return enter(table, self, [&](ScriptHost&, Script& script) {
    return withNode(script, number, [&](Node& node) {
      if (!out) return refuse(script, XS_FAILED, "no place for the answer");
      *out = script.lent.lend(abstractTypesOf(node.type()), script.handles);
      return XS_OK;
    });
  });
}

XsResult HostScene::writeNode(Host table, XsNode self, XsNode number, XsString encoding,
                              XsString* out) {
  return enter(table, self, [&](ScriptHost& host, Script& script) {
    if (!out) return refuse(script, XS_FAILED, "no place for the answer");
    const World& world = host.world_;
    const bool xml = wantsXml(text(host, encoding));
    if (number != 0)
      return withNode(script, number, [&](Node& node) {
        const FileVersion version = versionOfNodes(world, {NodeRef(&node)});
        return giveText(script, xvrml::writeNode(world, node, textEncoding(version, xml)), out);
      });
    auto* const above = nodeCast<InlineNode>(inlineAbove(*script.node));
    if (!above)
      return giveText(script, writeWorld(world, "", textEncoding(world.head.version, xml)), out);
    const FileVersion version = versionOfNodes(world, above->content->roots);
    return giveText(script, sceneText(*above->content, above->exchange, version, xml), out);
  });
}

XsResult HostScene::writeScene(Host table, XsNode self, uint32_t count, const XsNode* numbers,
                               XsString encoding, XsString* out) {
  return enter(table, self, [&](ScriptHost& host, Script& script) {
    if (!out || (count > 0 && !numbers)) return refuse(script, XS_FAILED, "no nodes, or no place");
    const bool xml = wantsXml(text(host, encoding));
    MFNode roots;
    for (uint32_t i = 0; i < count; ++i) {
      if (numbers[i] == 0) continue;
      Node* const node = script.handles.find(numbers[i]);
      if (!node)
        return refuse(script, XS_NO_NODE,
                      fmt::format("the Script does not know a node {}", numbers[i]));
      roots.push_back(NodeRef(node));
    }
    const FileVersion version = versionOfNodes(host.world_, roots);
    return giveText(script, sceneText(scopeOf(roots), nullptr, version, xml), out);
  });
}

} // namespace xvrml
