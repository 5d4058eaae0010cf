#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "behaviour/viewer/interaction.h"
#include "browser/state.h"
#include "geometry/edited.h"
#include "graph/crossing.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "xvrml/versions.h"

namespace xvrml {

Browser::Browser(std::unique_ptr<World> world, BrowserOptions options, double start)
    : Browser(std::move(world), std::move(options), start, RunOptions()) {}

Browser::Browser(std::unique_ptr<World> world, BrowserOptions options, double start,
                 const RunOptions& run)
    : impl_(std::make_unique<Impl>(*this, std::move(world), options, run)) {
  impl_->time = start;
  setScriptPatience(impl_->options.scriptPatience);
  followEdits(*impl_->world);
  impl_->engine->beginCascade(impl_->run.epoch + start);
  impl_->engine->adoptScope(impl_->world->scope, true);
  impl_->engine->settle();
  impl_->runJobs();
}

Browser::~Browser() = default;

World& Browser::world() { return *impl_->world; }
Events& Browser::events() { return *impl_->engine; }
double Browser::now() const { return impl_->time; }
double Browser::epoch() const { return impl_->run.epoch; }
void Browser::tick(double time) {
  if (impl_->engine->settling()) return;     // a listener or a Script must not advance time
  impl_->time = std::max(time, impl_->time); // keeps the caller's value; epoch + time may round
  impl_->engine->tick(impl_->run.epoch + impl_->time);
  impl_->runJobs();
}
FieldChanges Browser::takeChanges() { return impl_->engine->takeChanges(); }
bool Browser::hasChanges() const { return impl_->engine->hasChanges(); }
ScriptCounts Browser::scripts() const {
  return impl_->scripts ? impl_->scripts->counts() : ScriptCounts{};
}
void Browser::setScriptPatience(double seconds) {
  impl_->options.scriptPatience = seconds > 0 ? seconds : 0;
  interactionOf(*impl_->engine).picker.setLagging(seconds > 0);
}
uint64_t Browser::generation() const { return impl_->generation; }

NodeRef Browser::node(std::string_view name) const {
  const auto& names = impl_->world->scope.names;
  const auto found = names.find(name);
  return found == names.end() ? NodeRef() : found->second;
}

// Stores a field. For a prototype instance it also stores the connected fields in the body, and
// posts an event to connected exposedFields.
static bool storeField(Engine& engine, Node& node, const FieldInfo& field, Value value) {
  assignUrlBase(node, field, value);
  if (!engine.store(node, field, std::move(value))) return false;
  std::vector<std::pair<ProtoInstance*, const FieldInfo*>> open;
  const auto add = [&](Node& one, const FieldInfo& its) {
    if (auto* instance = nodeCast<ProtoInstance>(&one)) open.emplace_back(instance, &its);
  };
  add(node, field);
  while (!open.empty()) {
    const auto [instance, from] = open.back();
    open.pop_back();
    for (const IsConnection& connection : instance->is) {
      const FieldInfo* to = connection.node->type().find(connection.field);
      if (connection.interfaceName != from->name || !to || !holdsValue(*to) ||
          to->type != from->type)
        continue;
      Value passed = instance->get(*from);
      const auto& base = urlBase(*instance, *from);
      if (to->access == Access::exposedField) {
        engine.adopt(*connection.node);
        engine.postIntoBody(*instance, *from, connection.node, *to, std::move(passed), base);
        continue;
      }
      if (auto* urls = std::get_if<MFString>(&passed)) {
        passUrls({*instance, *from, *connection.node, *to, base}, *urls);
        if (auto* inner = nodeCast<ProtoInstance>(connection.node)) inner->setUrlBase(*to, base);
      }
      if (engine.store(*connection.node, *to, std::move(passed))) add(*connection.node, *to);
    }
  }
  return true;
}

bool Browser::set(Node& node, std::string_view field, Value value) {
  const FieldInfo* plain = findField(node, field);
  if (plain && plain->access == Access::field) {
    const bool stored = storeField(*impl_->engine, node, *plain, std::move(value));
    impl_->settle();
    return stored;
  }
  const bool sent = impl_->engine->dispatch(node, ownName(node, field), std::move(value));
  impl_->runJobs();
  return sent;
}

Value Browser::get(const Node& node, std::string_view field) const {
  if (const FieldInfo* plain = findField(node, field); plain && holdsValue(*plain))
    return node.get(*plain);
  if (const FieldInfo* out = findEventOut(node, field)) return impl_->engine->lastSent(node, *out);
  throw std::invalid_argument(
      fmt::format("{} has no field or eventOut '{}'", node.type().name, field));
}

uint64_t Browser::listen(Node& node, std::string_view out, Callback callback) {
  const FieldInfo* field = findEventOut(node, out);
  return field ? impl_->engine->listen(node, *field, std::move(callback)) : 0;
}

void Browser::unlisten(Node& node, uint64_t number) { impl_->engine->unlisten(node, number); }

NodeRef Browser::createNode(std::string_view name) {
  const NodeType* type = findNodeType(name);
  if (!type || type->name == "Script")
    throw std::invalid_argument(fmt::format("'{}' is not a node type that can be made", name));
  NodeRef node = makeStaticNode(*type);
  impl_->engine->adopt(*node);
  return node;
}

void Browser::addRoot(NodeRef node) {
  auto& roots = impl_->world->scope.roots;
  if (!node || std::find(roots.begin(), roots.end(), node) != roots.end()) return;
  roots.push_back(node);
  impl_->engine->addRoot(*node);
  impl_->settle();
}

void Browser::removeRoot(Node& node) {
  const NodeRef keep(&node);
  if (std::erase(impl_->world->scope.roots, keep) > 0) impl_->engine->removeRoot(node);
}

bool Browser::addRoute(Node& from, std::string_view out, Node& to, std::string_view in) {
  return impl_->engine->addRoute(from, ownName(from, out), to, ownName(to, in));
}

bool Browser::deleteRoute(Node& from, std::string_view out, Node& to, std::string_view in) {
  return impl_->engine->deleteRoute(from, ownName(from, out), to, ownName(to, in));
}

} // namespace xvrml
