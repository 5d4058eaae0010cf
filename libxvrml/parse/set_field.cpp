// set_field.cpp: sets a field and forwards the value through IS connections into prototype bodies.
#include "xvrml/set_field.h"

#include "base/budget.h"
#include "graph/crossing.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "parse/loader.h"
#include "xvrml/versions.h"
#include "xvrml/viewed.h"

namespace xvrml {
namespace {

// Loads the content of an Inline whose url or load has changed.
void loadAgain(World& world, InlineNode& node) {
  if (!world.options.loadInlines) return;
  // Destroyed here if nothing else refers to it.
  const std::shared_ptr<const Scope> old = std::exchange(node.content, nullptr);
  node.exchange = nullptr;
  node.share.clear();
  node.tried = false;
  const BudgetPtr budget = budgetOf(world);
  const uint64_t before = budget->used();
  Loader(world, world.options)
      .loadDeferredInline(node, {node.source.file ? *node.source.file : world.path});
  if (const uint64_t after = budget->used(); after > before)
    node.share.adopt(budget, after - before);
}

} // namespace

bool setField(World& world, Node& node, std::string_view name, Value value) {
  const FieldInfo* field = findField(node, name);
  if (!field || value.index() != size_t(field->type)) return false;
  assignUrlBase(node, *field, value);
  if (!node.set(*field, std::move(value))) return false;
  world.edited = true;
  std::vector<std::pair<Node*, const FieldInfo*>> open{{&node, field}};
  while (!open.empty()) {
    const auto [one, from] = open.back();
    open.pop_back();
    if (auto* inlineNode = nodeCast<InlineNode>(one);
        inlineNode && (from->name == "url" || from->name == "load"))
      loadAgain(world, *inlineNode);
    auto* instance = nodeCast<ProtoInstance>(one);
    if (!instance) continue;
    instance->give(*from);
    for (const IsConnection& connection : instance->is) {
      const FieldInfo* to = connection.node->type().find(connection.field);
      if (connection.interfaceName != from->name || !to || !holdsValue(*to) ||
          to->type != from->type)
        continue;
      if (isMultiple(to->type)) leaveToViews(*connection.node, *to);
      assignThroughIs({*instance, *from, *connection.node, *to, urlBase(*instance, *from), true},
                      instance->get(*from), world.diagnostics);
      // The expansion is made again on demand.
      if (NodeRef* standsFor = connection.node->expansion()) *standsFor = {};
      open.emplace_back(connection.node.get(), to);
    }
  }
  return true;
}

} // namespace xvrml
