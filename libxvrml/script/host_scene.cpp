#include "script/host_scene.h"

#include "event/hierarchy.h"
#include "graph/expander.h"
#include "script/abstract_types.h"
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

} // namespace

// Returns the scene that the Script stands in: the content of the innermost Inline above it, else
// the world's. Bodies of prototypes have no scenes of their own here.
const Scope& HostScene::sceneOf(ScriptHost& host, const Node& script) {
  const std::vector<Path> paths = pathsTo(script, 1);
  if (!paths.empty())
    for (size_t i = paths[0].size(); i-- > 0;)
      if (const Scope* content = inlineScope(*paths[0][i])) return *content;
  return host.world_.scope;
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

// The content of an Inline has no head of its own; the file of its first node says what it is.
XsResult HostScene::sceneFacts(Host table, XsNode self, XsValue* out) {
  return enter(table, self, [&](ScriptHost& host, Script& script) {
    if (!out) return refuse(script, XS_FAILED, "no place for the answer");
    const Scope& scene = sceneOf(host, *script.node);
    FileVersion version = host.world_.head.version;
    std::string file = host.browser_.worldUrl();
    const Node* const first =
        &scene == &host.world_.scope || scene.roots.empty() ? nullptr : scene.roots[0].get();
    if (first) {
      version = versionOf(*first);
      file = first->source.file ? *first->source.file : file;
    }
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
    const std::string wanted = text(host, encoding);
    if (wanted != "XML" && wanted != "VRML")
      return refuse(script, XS_FAILED,
                    fmt::format("'{}' is no encoding: expected XML or VRML", wanted));
    const Encoding as = wanted == "XML"              ? Encoding::x3dXml
                        : world.head.version.isX3d() ? Encoding::x3dClassic
                                                     : Encoding::vrml97;
    if (number == 0) return giveText(script, writeWorld(world, "", as), out);
    return withNode(script, number, [&](Node& node) {
      return giveText(script, xvrml::writeNode(world, node, as), out);
    });
  });
}

} // namespace xvrml
