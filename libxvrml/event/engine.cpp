// engine.cpp: the queue of events and how one is worked off. See engine.h.
#include "event/engine.h"

#include <fmt/format.h>

#include "base/rotation.h"
#include "graph/field_access.h"

namespace xvrml {

Engine::Engine(Diagnostics& diagnostics, const MakeObserver& makeObserver, Browser* browser)
    : Events(diagnostics, browser), observer(makeObserver(*this)) {}

// An eventOut sends once in a cascade (4.10.3, 4.10.4). Without anybody to receive it only its last
// value is kept.
void Events::send(Node& from, const FieldInfo& out, Value value) {
  auto& engine = static_cast<Engine&>(*this);
  if (value.index() != size_t(out.type)) return;
  Participant& part = engine.part(from);
  Participant::Out& state = part.out(out);
  if (state.cascade == engine.cascade_) return;
  state.cascade = engine.cascade_;
  if (!part.links.empty() || !part.listeners.empty())
    engine.queue_.push_back({NodeRef(&from), &out, std::move(value), false});
  else if (out.access == Access::eventOut)
    state.last = std::move(value);
}

void Events::preset(Node& from, const FieldInfo& out, Value value) {
  if (value.index() != size_t(out.type) || out.access != Access::eventOut) return;
  Participant::Out& state = static_cast<Engine&>(*this).part(from).out(out);
  if (state.cascade == 0) state.last = std::move(value);
}

bool Events::hasSent(const Node& from, const FieldInfo& out) const {
  const Participant* part = from.live ? liveOf(from)->part.get() : nullptr;
  const Participant::Out* state = part ? part->findOut(out) : nullptr;
  return state && state->cascade == static_cast<const Engine&>(*this).cascade_;
}

void Events::send(Node& from, std::string_view out, Value value) {
  if (const FieldInfo* field = from.type().findEventOut(out)) send(from, *field, std::move(value));
}

void Events::post(Node& to, const FieldInfo& in, Value value) {
  if (value.index() != size_t(in.type)) return;
  auto& engine = static_cast<Engine&>(*this);
  engine.adopt(to);
  engine.queue_.push_back({NodeRef(&to), &in, std::move(value), true});
}

Value Events::lastSent(const Node& node, const FieldInfo& out) const {
  if (out.access != Access::eventOut) return node.get(out);
  const Participant* part = node.live ? liveOf(node)->part.get() : nullptr;
  const Participant::Out* state = part ? part->findOut(out) : nullptr;
  return state ? state->last : defaultValue(out.type);
}

NodeState* Events::state(Node& node) const {
  return node.live && liveOf(node)->part ? liveOf(node)->part->state.get() : nullptr;
}

void Events::wantTicks(Node& node, bool wanted) {
  auto& engine = static_cast<Engine&>(*this);
  engine.adopt(node);
  if (wanted)
    engine.ticking_[liveOf(node)->order] = &node;
  else
    engine.ticking_.erase(liveOf(node)->order);
}

void Events::wantLooks(Node& node, bool wanted) {
  auto& engine = static_cast<Engine&>(*this);
  engine.adopt(node);
  if (wanted)
    engine.looking_[liveOf(node)->order] = &node;
  else
    engine.looking_.erase(liveOf(node)->order);
}

void Engine::beginCascade(double time) {
  now_ = time;
  ++cascade_;
  inCascade_ = 0;
  overflow_ = false;
}

void Engine::settle() {
  if (settling_) return;
  settling_ = true;
  do {
    while (scriptsBegin_ || !queue_.empty()) {
      if (++inCascade_ > maximumEvents) {
        if (!overflow_)
          diagnostics_.warn({}, fmt::format("more than {} events at time {}: the rest is dropped",
                                            maximumEvents, now_));
        overflow_ = true;
        queue_.clear();
        if (scripts) scripts->drop();
        break;
      }
      if (scriptsBegin_ && (scriptsBegin_ = scripts && scripts->initializeNext())) continue;
      if (queue_.empty()) break;
      Event event = std::move(queue_.front());
      queue_.pop_front();
      if (event.arriving)
        arrive(*event.node, *event.field, event.value);
      else
        leave(event);
    }
  } while (!overflow_ && ((scripts && scripts->eventsProcessed()) || observer->settled()));
  settling_ = false;
  renewExpansions();
  sweep();
  if (scripts) scripts->finish();
}

// Follows the links of an eventOut. Routes added meanwhile are not followed, deleted ones neither.
void Engine::leave(Event& event) {
  Node& node = *event.node;
  const size_t count = part(node).links.size();
  for (size_t i = 0; i < count; ++i) {
    const Link link = part(node).links[i];
    if (link.out != event.field || !link.carriesOut() || !link.leads()) continue;
    const NodeRef keep(link.instance);
    if (link.instance) // that a field has changed the instance knows already: see mirror()
      relay(*link.instance, *link.in, event.value, event.field->access == Access::eventOut);
    else
      arrive(*link.to, *link.in, event.value);
  }
  if (!part(node).listeners.empty()) {
    const auto listeners = part(node).listeners; // one may remove itself
    for (const auto& [number, listener] : listeners)
      if (listener.first == event.field) listener.second(node, *event.field, event.value);
  }
  if (event.field->access == Access::eventOut)
    part(node).out(*event.field).last = std::move(event.value);
}

void Engine::arrive(Node& node, const FieldInfo& in, const Value& value) {
  ++delivered_;
  if (node.type().index >= 0) return arriveAtStatic(node, in, value);
  if (auto* instance = dynamic_cast<ProtoInstance*>(&node))
    return arriveAtInstance(*instance, in, value);
  auto& script = static_cast<ScriptNode&>(node);
  if (in.access == Access::exposedField && store(node, in, value)) send(node, in, value);
  if (scripts) scripts->receive(script, in, value);
}

// Clause 4.7: an exposedField takes the value and sends it on.
void Engine::arriveAtStatic(Node& node, const FieldInfo& in, const Value& value) {
  const Behaviour* behaviour = behaviourOf(node.type());
  if (in.access == Access::exposedField) {
    if (behaviour && behaviour->accept && !behaviour->accept(*this, node, in, value)) return;
    if (!store(node, in, value)) return;
    send(node, in, holdsNodes(in) || hasNormalizedAxes(in) ? node.get(in) : value);
  } else if (in.name.starts_with("set_")) {
    if (const FieldInfo* field = node.type().find(std::string_view(in.name).substr(4));
        field && field->type == in.type)
      store(node, *field, value);
  }
  if (behaviour && behaviour->receive) behaviour->receive(*this, node, in, value);
}

// Into the body; an exposedField that no exposedField in the body IS keeps its value itself.
void Engine::arriveAtInstance(ProtoInstance& instance, const FieldInfo& in, const Value& value) {
  bool kept = false;
  for (const Link& link : part(instance).links) {
    if (link.kind != Link::Kind::intoBody || link.out != &in || !link.to) continue;
    for (const Link& back : part(*link.to).links) // it will send the value back
      kept |= back.instance == &instance && back.in == &in && back.out == link.in &&
              link.in->access == Access::exposedField;
    queue_.push_back({link.to, link.in, value, true});
  }
  if (!kept && in.access == Access::exposedField) relay(instance, in, value, true);
}

// Out of the body: the instance's eventOut or exposedField sends what the node in it has sent.
void Engine::relay(ProtoInstance& instance, const FieldInfo& out, const Value& value, bool keeps) {
  if (keeps && out.access == Access::exposedField) store(instance, out, value);
  send(instance, out, value);
}

bool Engine::dispatch(Node& to, std::string_view in, Value value) {
  const FieldInfo* field = to.type().findEventIn(in);
  if (!field || value.index() != size_t(field->type)) return false;
  if (!settling_) beginCascade(now_);
  post(to, *field, std::move(value));
  if (!settling_) settle();
  return true;
}

// Nodes may end, and others begin, while the functions run: those there were at the beginning and
// still are get called.
void Engine::callAll(const Watchers& watchers, void (*Behaviour::*function)(Events&, Node&)) {
  std::vector<NodeRef> nodes;
  nodes.reserve(watchers.size());
  for (const auto& [order, node] : watchers) nodes.emplace_back(node);
  for (const NodeRef& node : nodes) {
    const Behaviour* behaviour = behaviourOf(node->type());
    if (node->live && behaviour && behaviour->*function) (behaviour->*function)(*this, *node);
  }
}

void Engine::tick(double time) {
  if (settling_) return; // a listener or a Script must not move time
  beginCascade(std::max(time, now_));
  observer->ticked();
  settling_ = true; // what their functions do waits for its turn
  if (scripts) scripts->tick();
  settling_ = false;
  callAll(ticking_, &Behaviour::tick);
  settle();
  beginCascade(now_);
  callAll(looking_, &Behaviour::look);
  settle();
}

} // namespace xvrml
