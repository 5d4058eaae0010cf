#include "script/scene_text.h"

#include <algorithm>
#include <tuple>
#include <unordered_set>

#include "event/live.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Collects prototypes in the order in which they were found. A prototype that is declared within
// another one belongs to the text of that one.
class Prototypes {
 public:
  // Appends the nodes of the prototype to `open`, because they may be instances themselves.
  void add(const ProtoPtr& declaration, std::vector<Node*>& open) {
    if (!known_.insert(declaration.get()).second) return;
    all_.push_back(declaration);
    appendRoots(declaration->body, open);
    for (const FieldInfo& field : declaration->type->fields) {
      if (const auto* one = std::get_if<SFNode>(&field.defaultValue)) open.push_back(one->get());
      if (const auto* many = std::get_if<MFNode>(&field.defaultValue))
        for (const NodeRef& node : *many) open.push_back(node.get());
    }
    for (const ProtoPtr& inner : declaration->body.prototypes) {
      inner_.insert(inner.get());
      add(inner, open);
    }
  }

  // Returns the outermost ones in an order in which each may use those before it: that of their
  // places, because only prototypes of one file use each other.
  std::vector<ProtoPtr> take() {
    std::erase_if(all_, [&](const ProtoPtr& one) { return inner_.contains(one.get()); });
    std::stable_sort(all_.begin(), all_.end(), [](const ProtoPtr& a, const ProtoPtr& b) {
      return std::tie(a->source.line, a->source.column) <
             std::tie(b->source.line, b->source.column);
    });
    return std::move(all_);
  }

 private:
  std::vector<ProtoPtr> all_;
  std::unordered_set<const ProtoDeclaration*> known_, inner_;
};

std::vector<Route> routesAmong(const std::vector<Node*>& nodes, const SeenNodes& inside) {
  std::vector<Route> routes;
  for (Node* const from : nodes) {
    const Live* const live = liveOf(*from);
    if (!live || !live->part) continue;
    for (const Link& link : live->part->links)
      if (link.kind == Link::Kind::route && link.to && inside.contains(link.to.get()))
        routes.push_back({NodeRef(from), link.out->name, link.to, link.in->name, {}});
  }
  return routes;
}

} // namespace

Scope scopeOf(const MFNode& roots) {
  Scope scene;
  scene.roots = roots;
  std::vector<Node*> nodes, instances;
  SeenNodes inside;
  walk<Node>(rootsOf(scene), inside, [&](Node& node, std::vector<Node*>& open) {
    nodes.push_back(&node);
    if (nodeCast<ProtoInstance>(&node)) instances.push_back(&node);
    appendChildren(node, open);
  });
  scene.routes = routesAmong(nodes, inside);
  Prototypes prototypes;
  walk<Node>(instances, [&](Node& node, std::vector<Node*>& open) {
    if (const auto* instance = nodeCast<ProtoInstance>(&node))
      prototypes.add(instance->declaration, open);
    appendChildren(node, open);
  });
  scene.prototypes = prototypes.take();
  return scene;
}

std::string sceneText(Scope scene, std::shared_ptr<Exchange> exchange, const FileVersion& version,
                      bool asXml) {
  World file;
  file.scope = std::move(scene);
  file.head.version = version;
  setExchange(file, std::move(exchange));
  return writeWorld(file, "", textEncoding(version, asXml));
}

Encoding textEncoding(const FileVersion& version, bool asXml) {
  if (asXml) return Encoding::x3dXml;
  return version.isX3d() ? Encoding::x3dClassic : Encoding::vrml97;
}

} // namespace xvrml
