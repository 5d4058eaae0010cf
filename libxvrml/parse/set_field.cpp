#include "xvrml/set_field.h"

#include "base/budget.h"
#include "graph/crossing.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "parse/loader.h"
#include "xvrml/viewed.h"

namespace xvrml {
namespace {

// An Inline has got another url.
void loadAgain(World& world, InlineNode& node) {
  if (!world.options.loadInlines) return;
  const std::shared_ptr<const Scope> old =
      std::exchange(node.content, nullptr); // ends when nothing refers to it here
  node.share.clear();
  const BudgetPtr budget = budgetOf(world);
  const uint64_t before = budget->used();
  Loader(world, world.options).loadLate(node, {node.source.file ? *node.source.file : world.path});
  if (const uint64_t after = budget->used(); after > before)
    node.share.adopt(budget, after - before);
}

} // namespace

bool setField(World& world, Node& node, std::string_view name, Value value) {
  const FieldInfo* field = node.type().find(name);
  if (!field || !node.set(*field, std::move(value))) return false;
  std::vector<std::pair<Node*, const FieldInfo*>> open{{&node, field}};
  while (!open.empty()) {
    const auto [one, from] = open.back();
    open.pop_back();
    if (auto* inlineNode = dynamic_cast<InlineNode*>(one); inlineNode && from->name == "url")
      loadAgain(world, *inlineNode);
    auto* instance = dynamic_cast<ProtoInstance*>(one);
    if (!instance) continue;
    instance->give(*from);
    for (const IsConnection& connection : instance->is) {
      const FieldInfo* to = connection.node->type().find(connection.field);
      if (connection.interfaceName != from->name || !to || !holdsValue(*to) ||
          to->type != from->type)
        continue;
      if (isMultiple(to->type)) leaveToViews(*connection.node, *to);
      giveAcross({*instance, *from, *connection.node, *to, true}, instance->get(*from),
                 world.diagnostics);
      if (NodeRef* standsFor = connection.node->expansion()) *standsFor = {}; // it is asked again
      open.emplace_back(connection.node.get(), to);
    }
  }
  return true;
}

} // namespace xvrml
