// exchange.cpp: finds imported nodes and the events of routes to them. Things that worlds share are
// kept in a registry outside of World, because World is a public class and budgets are kept so,
// too.
#include "graph/exchange.h"

#include <mutex>
#include <unordered_map>

#include <fmt/format.h>

#include "graph/inline_node.h"
#include "printable.h"
#include "xvrml/versions.h"

namespace xvrml {
namespace {

struct Registry {
  std::mutex mutex;
  std::unordered_map<const World*, std::shared_ptr<Exchange>> exchanges;
};

Registry& registry() {
  static auto* const all = new Registry(); // worlds may be destroyed after static objects
  return *all;
}

void reportImport(Exchange::Import& import, Diagnostics& diagnostics) {
  if (std::exchange(import.reported, true)) return;
  const InlineNode* const node = nodeCast<InlineNode>(import.inlineNode);
  std::string exports;
  if (node && node->exchange)
    for (const Exchange::Export& one : node->exchange->exports) {
      if (exports.size() > 200) break;
      exports += (exports.empty() ? "" : ", ") + one.exported;
    }
  diagnostics.warn(
      import.source,
      fmt::format("the file of Inline '{}' exports no node '{}', so routes of '{}' do nothing: {}",
                  printable(import.inlineNode->defName), printable(import.exported),
                  printable(import.local),
                  exports.empty() ? "it has no statement EXPORT"
                                  : "it exports " + printable(exports)));
}

// Returns the node at an end of a route, or null.
Node* nodeOf(Exchange& exchange, const Exchange::End& end, Diagnostics& diagnostics) {
  if (end.node) return end.node.get();
  Exchange::Import& import = exchange.imports[end.import];
  Node* const node = exportedNode(*import.inlineNode, import.exported);
  if (!node && inlineScope(*import.inlineNode)) reportImport(import, diagnostics);
  return node;
}

} // namespace

Node* exportedNode(const Node& inlineNode, std::string_view name) {
  const InlineNode* const node = nodeCast<InlineNode>(&inlineNode);
  if (!node || !node->content || !node->exchange) return nullptr;
  for (const Exchange::Export& one : node->exchange->exports)
    if (one.exported == name) return one.node.get();
  return nullptr;
}

std::vector<ResolvedRoute> resolveImports(Exchange& exchange, const Node* inlineNode,
                                          Diagnostics& diagnostics) {
  std::vector<ResolvedRoute> routes;
  const auto leadsTo = [&](const Exchange::End& end) {
    return !end.node && exchange.imports[end.import].inlineNode.get() == inlineNode;
  };
  for (Exchange::Import& import : exchange.imports)
    if ((!inlineNode || import.inlineNode.get() == inlineNode) && inlineScope(*import.inlineNode) &&
        !exportedNode(*import.inlineNode, import.exported))
      reportImport(import, diagnostics);
  for (Exchange::ImportedRoute& route : exchange.routes) {
    if (inlineNode && !leadsTo(route.from) && !leadsTo(route.to)) continue;
    Node* const from = nodeOf(exchange, route.from, diagnostics);
    Node* const to = nodeOf(exchange, route.to, diagnostics);
    if (!from || !to) continue;
    const FieldInfo* const out = findEventOut(*from, route.from.field);
    const FieldInfo* const in = findEventIn(*to, route.to.field);
    if (out && in && out->type == in->type) {
      routes.push_back({from, to, out, in});
      continue;
    }
    if (std::exchange(route.reported, true)) continue;
    const std::string why =
        !out  ? fmt::format("{} has no outputOnly '{}'", from->type().name,
                            printable(route.from.field))
        : !in ? fmt::format("{} has no inputOnly '{}'", to->type().name, printable(route.to.field))
              : fmt::format("a route joins events of one type: '{}' is {}, '{}' is {}",
                            printable(route.from.field), fieldTypeName(out->type),
                            printable(route.to.field), fieldTypeName(in->type));
    diagnostics.error(route.source, fmt::format("route of an imported node: {}", why));
  }
  return routes;
}

std::shared_ptr<Exchange> exchangeOf(const World& world) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto found = all.exchanges.find(&world);
  return found == all.exchanges.end() ? nullptr : found->second;
}

void setExchange(const World& world, std::shared_ptr<Exchange> exchange) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  if (exchange)
    all.exchanges[&world] = std::move(exchange);
  else
    all.exchanges.erase(&world);
}

void forgetExchange(const World& world) noexcept {
  std::shared_ptr<Exchange> last; // destroyed after the lock
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto found = all.exchanges.find(&world);
  if (found == all.exchanges.end()) return;
  last = std::move(found->second);
  all.exchanges.erase(found);
}

} // namespace xvrml
