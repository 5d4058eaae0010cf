#include "behaviour/inline.h"

#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "event/hierarchy.h"
#include "graph/inline_node.h"
#include "parse/loader.h"
#include "xvrml/browser.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Returns the files around an Inline, outermost first. None of them may be loaded into it again.
std::vector<std::string> enclosingFiles(const Node& node) {
  std::vector<std::string> files;
  const std::vector<Path> paths = pathsTo(node, 1);
  if (paths.empty()) return {node.source.file ? *node.source.file : std::string()};
  for (const Node* step : paths[0])
    if (step->type().index == nodes::Inline::typeIndex)
      files.push_back(step->source.file ? *step->source.file : std::string());
  return files;
}

} // namespace

// A field `load` FALSE takes the content away (ISO/IEC 19775-1 9.4.2).
bool loadInlineContent(Engine& engine, Node& node) {
  auto* inlineNode = nodeCast<InlineNode>(&node);
  if (!inlineNode || !engine.browser()) return false;
  if (!inlineNode->load && !inlineNode->content) return false;
  World& world = engine.browser()->world();
  engine.contentUnloading(node);
  // The old content is destroyed here unless something else refers to it.
  const std::shared_ptr<const Scope> old = std::exchange(inlineNode->content, nullptr);
  inlineNode->exchange = nullptr;
  inlineNode->share.clear();
  inlineNode->tried = false;
  const BudgetPtr budget = budgetOf(world);
  const uint64_t before = budget->used();
  Loader(world, world.options).loadDeferredInline(*inlineNode, enclosingFiles(node));
  if (const uint64_t after = budget->used(); after > before)
    inlineNode->share.adopt(budget, after - before);
  engine.contentLoaded(node);
  engine.changed(node, *fieldNamed<"url">(node));
  return inlineNode->content != nullptr;
}

uint64_t loadInlinesBelow(Engine& engine, const Scope& scope) {
  uint64_t loaded = 0;
  walk(rootsOf(scope), [&](Node& node, std::vector<Node*>& open) {
    const auto* inlineNode = nodeCast<InlineNode>(&node);
    if (inlineNode && inlineNode->load && !inlineNode->content && !inlineNode->url.empty())
      loaded += loadInlineContent(engine, node);
    childrenInHierarchy(node, open);
  });
  return loaded;
}

namespace {

// load TRUE of an Inline that has its content, or FALSE of one that has none, changes nothing.
void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  const bool loads = isField<"load">(node, in) &&
                     static_cast<nodes::Inline&>(node).load != (inlineScope(node) != nullptr);
  if (isField<"url">(node, in) || loads) loadInlineContent(Engine::of(events), node);
}

} // namespace

void addInlineBehaviours(const AddBehaviour& add) {
  add(nodes::Inline::nodeType(), {.receive = receive});
}

} // namespace xvrml
