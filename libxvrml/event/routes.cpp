// routes.cpp: links between nodes: ROUTEs, IS connections of prototypes, listeners; and the
// analysis of which changes events can cause.
#include <algorithm>

#include <fmt/format.h>

#include "event/engine.h"
#include "graph/crossing.h"
#include "graph/expansion.h"
#include "graph/field_access.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

std::string nameOf(const Node& node) {
  return node.defName.empty() ? node.type().name : node.defName;
}

bool isSame(const Link& a, const Link& b) {
  return a.out == b.out && a.to == b.to && a.in == b.in && a.kind == b.kind &&
         a.instance == b.instance;
}

// From this number of links on they are indexed. A linear search would make a wide fan-out
// quadratic.
constexpr size_t indexThreshold = 64;
auto keyOf(const Link& l) {
  return std::make_tuple(l.out, static_cast<const Node*>(l.to.get()), l.in, l.kind);
}

} // namespace

bool Participant::holds(const Link& link) const {
  if (!index.empty()) return index.contains(keyOf(link));
  return std::any_of(links.begin(), links.end(), [&](const Link& l) { return isSame(l, link); });
}

void Participant::add(Link link) {
  links.push_back(std::move(link));
  if (!index.empty())
    index.insert(keyOf(links.back()));
  else if (links.size() >= indexThreshold)
    for (const Link& l : links) index.insert(keyOf(l));
}

Participant::Out& Participant::out(const FieldInfo& field) {
  for (Out& o : outs)
    if (o.field == &field) return o;
  return outs.emplace_back(Out{&field, 0, defaultValue(field.type)});
}

const Participant::Out* Participant::findOut(const FieldInfo& field) const {
  for (const Out& o : outs)
    if (o.field == &field) return &o;
  return nullptr;
}

Participant& Engine::part(Node& node) {
  adopt(node);
  Live& live = *liveOf(node);
  if (!live.part) live.part = std::make_unique<Participant>();
  return *live.part;
}

void Engine::addLink(Node& from, Link link) { part(from).add(std::move(link)); }

bool Engine::addRoute(Node& from, std::string_view out, Node& to, std::string_view in) {
  const FieldInfo* source = from.type().findEventOut(out);
  const FieldInfo* target = to.type().findEventIn(in);
  if (!source || !target || source->type != target->type) {
    const std::string why = !source ? fmt::format("{} has no eventOut '{}'", from.type().name, out)
                            : !target ? fmt::format("{} has no eventIn '{}'", to.type().name, in)
                                      : fmt::format("{} is not {}", fieldTypeName(source->type),
                                                    fieldTypeName(target->type));
    diagnostics_.warn(from.source, fmt::format("no route from {}.{} to {}.{}: {}", nameOf(from),
                                               out, nameOf(to), in, why));
    return false;
  }
  const Link link{source, NodeRef(&to), target, Link::Kind::route};
  adopt(to);
  if (part(from).holds(link)) return true;
  part(from).add(link);
  ++routes_;
  markReach(to, *target, fmt::format("ROUTE from {}.{}", nameOf(from), source->name));
  return true;
}

bool Engine::deleteRoute(Node& from, std::string_view out, Node& to, std::string_view in) {
  const FieldInfo* source = from.type().findEventOut(out);
  const FieldInfo* target = to.type().findEventIn(in);
  if (!source || !target || !from.live || !liveOf(from)->part) return false;
  for (Link& link : liveOf(from)->part->links) {
    if (!isSame(link, {source, NodeRef(&to), target, Link::Kind::route})) continue;
    liveOf(from)->part->index.erase(keyOf(link));
    link.to = {}; // the engine may be following its links
    swept_.emplace_back(&from);
    --routes_;
    if (!settling_) sweep();
    return true;
  }
  return false;
}

void Engine::sweep() {
  for (const NodeRef& node : std::exchange(swept_, {}))
    if (node->live && liveOf(*node)->part)
      std::erase_if(liveOf(*node)->part->links, [](const Link& l) { return !l.isConnected(); });
}

// Returns whether no other connection uses the same interface field, which cannot have two values.
static bool isOnlyConnection(const ProtoInstance& instance, const IsConnection& connection) {
  return std::none_of(instance.is.begin(), instance.is.end(), [&](const IsConnection& other) {
    return &other != &connection && other.interfaceName == connection.interfaceName;
  });
}

// Copies a stored value from a node in a body to the instance's field or exposedField that it IS,
// and on to enclosing instances. No events are sent: an eventOut sends one per cascade (4.10.3),
// but a field may be stored more often.
void Engine::mirror(Node& first, const FieldInfo& stored) {
  std::vector<std::pair<Node*, const FieldInfo*>> open{{&first, &stored}};
  while (!open.empty()) {
    const auto [node, field] = open.back();
    open.pop_back();
    if (!node->live || !liveOf(*node)->part) continue;
    for (const Link& link : liveOf(*node)->part->links) {
      if (!link.instance || link.out != field || !holdsValue(*link.in)) continue;
      Value value = node->get(*field);
      bool kept = false;
      if (auto* urls = std::get_if<MFString>(&value)) {
        ReturnedUrls adapted = returnUrls(*node, *field, *link.instance, *link.in, *urls);
        *urls = std::move(adapted.urls);
        kept = adapted.kept;
        if (!kept) link.instance->setUrlBase(*link.in, nullptr);
      } else if (link.instance->get(*link.in) == value) {
        continue;
      }
      if (!kept) {
        link.instance->set(*link.in, std::move(value));
        link.instance->give(*link.in);
      }
      open.emplace_back(link.instance, link.in); // an enclosing instance may hold other strings
    }
  }
}

// Links an instance with its body where an event of the interface IS an event of a node in it
// (clause 4.8.2).
void Engine::connectBody(ProtoInstance& instance) {
  for (const IsConnection& c : instance.is) {
    const FieldInfo* interface = instance.type().find(c.interfaceName);
    if (!interface || !c.node->live) continue;
    if (interface->access == Access::field) {
      const FieldInfo* of = c.node->type().find(c.field);
      if (of && of->type == interface->type && of->access == Access::exposedField &&
          isOnlyConnection(instance, c))
        addLink(*c.node, {of, {}, interface, Link::Kind::mirrorsField, &instance});
      continue;
    }
    if (interface->access != Access::eventOut)
      if (const FieldInfo* in = c.node->type().findEventIn(c.field);
          in && in->type == interface->type)
        addLink(instance, {interface, c.node, in, Link::Kind::intoBody});
    if (interface->access != Access::eventIn)
      if (const FieldInfo* out = c.node->type().findEventOut(c.field);
          out && out->type == interface->type)
        addLink(*c.node, {out, {}, interface, Link::Kind::outOfBody, &instance});
  }
}

// Called when the instance is being destroyed. Nodes of its body may live on.
void Engine::disconnectBody(ProtoInstance& instance) {
  for (const IsConnection& c : instance.is) {
    if (!c.node->live || !liveOf(*c.node)->part) continue;
    Participant& part = *liveOf(*c.node)->part;
    for (Link& link : part.links) {
      if (link.instance != &instance) continue;
      part.index.erase(keyOf(link));
      link.instance = nullptr;
    }
    if (!settling_) {
      std::erase_if(part.links, [](const Link& l) { return !l.isConnected(); });
      continue;
    }
    try { // the engine may be following its links
      swept_.push_back(c.node);
    } catch (const std::bad_alloc&) {} // if this fails, unconnected links stay
  }
}

void Engine::markReach(Node& first, const FieldInfo& firstIn, const std::string& reason) {
  std::vector<std::pair<Node*, const FieldInfo*>> open{{&first, &firstIn}};
  SeenNodes expansions;
  while (!open.empty()) {
    const auto [node, in] = open.back();
    open.pop_back();
    if (!node->live) continue;
    Live& live = *liveOf(*node);
    if (nodeCast<ProtoInstance>(node)) {
      if (!live.part) continue;
      for (const Link& link : live.part->links)
        if (link.kind == Link::Kind::intoBody && link.out == in && link.to)
          open.emplace_back(link.to.get(), link.in);
    } else if (in->change != Change::none && !(live.reach >> int(in->change) & 1)) {
      live.reach |= uint16_t(1 << int(in->change));
      part(*node).reasons.emplace_back(in->change, reason);
    }
    // If a plug-in's node can change, its expansion can become anything.
    if (Node* standsFor = node->type().expand ? expansionOf(*node) : nullptr) {
      walk(std::vector<Node*>{standsFor}, expansions, [&](Node& one, std::vector<Node*>& made) {
        if (!isMadeByPlugin(one) || !one.live) return;
        for (const FieldInfo& field : one.type().fields)
          if (holdsValue(field) && field.change != Change::none) open.emplace_back(&one, &field);
        appendChildren(one, made);
      });
    }
  }
}

uint16_t reachOf(const Node& node) { return node.live ? liveOf(node)->reach : uint16_t(0); }

std::string reachReason(const Node& node, Change kind) {
  if (!node.live || !liveOf(node)->part) return {};
  for (const auto& [change, reason] : liveOf(node)->part->reasons)
    if (change == kind) return reason;
  return {};
}

uint64_t Engine::listen(Node& node, const FieldInfo& out, Listener listener) {
  part(node).listeners.push_back({++listeners_, {&out, std::move(listener)}});
  return listeners_;
}

void Engine::unlisten(Node& node, uint64_t number) {
  if (node.live && liveOf(node)->part)
    std::erase_if(liveOf(node)->part->listeners, [&](const auto& l) { return l.first == number; });
}

} // namespace xvrml
