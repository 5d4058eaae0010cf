// engine.cpp: the event queue and the processing of one event.
#include "event/engine.h"

#include <fmt/format.h>

#include "base/rotation.h"
#include "graph/crossing.h"
#include "graph/field_access.h"

namespace xvrml {

Engine::Engine(Diagnostics& diagnostics, const MakeObserver& makeObserver, Browser* browser)
    : observer(makeObserver(*this)), diagnostics_(diagnostics), browser_(browser) {
  LiveBase::forget.store(forget, std::memory_order_relaxed);
}

// An eventOut sends once per cascade (4.10.3, 4.10.4). If nothing receives the event, only its last
// value is stored.
void Engine::send(Node& from, const FieldInfo& out, Value value) {
  if (value.index() != size_t(out.type)) return;
  Participant& sender = part(from);
  Participant::Out& state = sender.out(out);
  if (state.cascade == cascade_) return;
  state.cascade = cascade_;
  if (!sender.links.empty() || !sender.listeners.empty())
    queue_.push_back({NodeRef(&from), &out, std::move(value), false});
  else if (out.access == Access::eventOut)
    state.last = std::move(value);
}

// Returns whether a route, a listener or the field of a prototype instance hears of an output.
bool Engine::isHeard(Node& node, const FieldInfo& out) {
  const Participant& sender = part(node);
  return !sender.listeners.empty() ||
         std::any_of(sender.links.begin(), sender.links.end(),
                     [&](const Link& link) { return link.out == &out && link.isOutgoing(); });
}

void Engine::preset(Node& from, const FieldInfo& out, Value value) {
  if (value.index() != size_t(out.type) || out.access != Access::eventOut) return;
  Participant::Out& state = part(from).out(out);
  if (state.cascade == 0) state.last = std::move(value);
}

bool Engine::hasSent(const Node& from, const FieldInfo& out) const {
  const Participant* part = from.live ? liveOf(from)->part.get() : nullptr;
  const Participant::Out* state = part ? part->findOut(out) : nullptr;
  return state && state->cascade == cascade_;
}

void Engine::post(Node& to, const FieldInfo& in, Value value) {
  if (value.index() != size_t(in.type)) return;
  adopt(to);
  queue_.push_back({NodeRef(&to), &in, std::move(value), true});
}

Value Engine::lastSent(const Node& node, const FieldInfo& out) const {
  if (out.access != Access::eventOut) return node.get(out);
  const Participant* part = node.live ? liveOf(node)->part.get() : nullptr;
  const Participant::Out* state = part ? part->findOut(out) : nullptr;
  return state ? state->last : defaultValue(out.type);
}

NodeState* Engine::state(Node& node) const {
  return node.live && liveOf(node)->part ? liveOf(node)->part->state.get() : nullptr;
}

void Engine::wantTicks(Node& node, bool wanted) {
  adopt(node);
  if (wanted)
    ticking_[liveOf(node)->order] = &node;
  else
    ticking_.erase(liveOf(node)->order);
}

void Engine::wantLooks(Node& node, bool wanted) {
  adopt(node);
  if (wanted)
    looking_[liveOf(node)->order] = &node;
  else
    looking_.erase(liveOf(node)->order);
}

void Engine::beginCascade(double time) {
  now_ = time;
  ++cascade_;
  inCascade_ = 0;
  overflow_ = false;
}

void Engine::settle() {
  if (settling_) return;
  deliverAll();
  renewExpansions();
  moveFigures();
  sweep();
  if (scripts) scripts->finish();
}

void Engine::deliverAll() {
  const Settling settling(*this);
  do {
    while (scriptsToStart_ || !queue_.empty()) {
      if (++inCascade_ > maximumEvents) {
        if (!overflow_)
          diagnostics_.warn({}, fmt::format("more than {} events at time {}: the rest is dropped",
                                            maximumEvents, now_));
        overflow_ = true;
        queue_.clear();
        if (scripts) scripts->drop();
        break;
      }
      if (scriptsToStart_ && (scriptsToStart_ = scripts && scripts->initializeNext())) continue;
      if (queue_.empty()) break;
      Event event = std::move(queue_.front());
      queue_.pop_front();
      if (event.isArriving)
        deliver(*event.node, *event.field, event.value, event.urlBase);
      else
        followLinks(event);
    }
  } while (!overflow_ && ((scripts && scripts->eventsProcessed()) || observer->settled()));
}

// Returns the value of a node in the body as the instance sends it: URLs are adapted.
static Value returned(const Node& node, const FieldInfo& out, const Link& link,
                      const Value& value) {
  const auto* urls = std::get_if<MFString>(&value);
  if (!urls) return value;
  return returnUrls(node, out, *link.instance, *link.in, *urls).urls;
}

// Follows the links of an eventOut. Routes added or deleted meanwhile are not followed.
void Engine::followLinks(Event& event) {
  Node& node = *event.node;
  const size_t count = part(node).links.size();
  for (size_t i = 0; i < count; ++i) {
    const Link link = part(node).links[i];
    if (link.out != event.field || !link.isOutgoing() || !link.isConnected()) continue;
    const NodeRef keep(link.instance);
    if (link.instance) // a field's change has already reached the instance through mirror()
      sendFromInstance(*link.instance, *link.in, returned(node, *event.field, link, event.value),
                       event.field->access == Access::eventOut);
    else
      deliver(*link.to, *link.in, event.value);
  }
  if (!part(node).listeners.empty()) {
    const auto listeners = part(node).listeners; // a copy, because a listener may remove itself
    for (const auto& [number, listener] : listeners)
      if (listener.first == event.field) listener.second(node, *event.field, event.value);
  }
  if (event.field->access == Access::eventOut)
    part(node).out(*event.field).last = std::move(event.value);
}

void Engine::deliver(Node& node, const FieldInfo& in, const Value& value, const FileName& urlBase) {
  ++delivered_;
  if (auto* instance = nodeCast<ProtoInstance>(&node))
    deliverToInstance(*instance, in, value, urlBase);
  else if (auto* script = nodeCast<ScriptNode>(&node))
    deliverToScript(*script, in, value);
  else
    deliverToStatic(node, in, value);
}

void Engine::deliverToScript(ScriptNode& script, const FieldInfo& in, const Value& value) {
  if (in.access == Access::exposedField && store(script, in, value)) send(script, in, value);
  if (scripts) scripts->receive(script, in, value);
}

// Delivers an event to a built-in node. An exposedField stores the value and sends it on (clause
// 4.7).
void Engine::deliverToStatic(Node& node, const FieldInfo& in, const Value& value) {
  const Behaviour* behaviour = behaviourOf(node.type());
  if (in.access == Access::exposedField) {
    if (behaviour && behaviour->accept && !behaviour->accept(*this, node, in, value)) return;
    if (!store(node, in, value)) return;
    if (isHeard(node, in)) // values may be large, so they are copied only for somebody
      send(node, in, holdsNodes(in) || hasNormalizedAxes(in) ? node.get(in) : value);
    else
      part(node).out(in).cascade = cascade_;
  } else if (const FieldInfo* field = node.type().fieldSetBy(in)) {
    store(node, *field, value);
  }
  if (behaviour && behaviour->receive && !in.isMetadata) behaviour->receive(*this, node, in, value);
}

// Forwards an event into the body. An exposedField stores its value itself, unless an exposedField
// in the body IS it.
void Engine::deliverToInstance(ProtoInstance& instance, const FieldInfo& in, const Value& value,
                               FileName urlBase) {
  bool kept = false;
  if (in.type == FieldType::MFString) {
    if (urlBase && holdsValue(in))
      instance.setUrlBase(in, urlBase);
    else if (!urlBase)
      assignUrlBase(instance, in, value);
    if (!urlBase) urlBase = xvrml::urlBase(instance, in);
    // The instance keeps the strings as they are. The node in the body gets, and sends back, URLs
    // relative to its own file.
    if (holdsUrls(instance, in)) {
      instance.set(in, value);
      instance.give(in);
    }
  }
  for (const Link& link : part(instance).links) {
    if (link.kind != Link::Kind::intoBody || link.out != &in || !link.to) continue;
    for (const Link& back : part(*link.to).links) // this one will send the value back
      kept |= back.instance == &instance && back.in == &in && back.out == link.in &&
              link.in->access == Access::exposedField;
    postIntoBody(instance, in, link.to, *link.in, value, urlBase);
  }
  if (!kept && in.access == Access::exposedField) sendFromInstance(instance, in, value, true);
}

void Engine::postIntoBody(const ProtoInstance& instance, const FieldInfo& from, const NodeRef& to,
                          const FieldInfo& in, Value value, const FileName& urlBase) {
  if (auto* urls = std::get_if<MFString>(&value))
    passUrls({instance, from, *to, in, urlBase}, *urls);
  queue_.push_back({to, &in, std::move(value), true, urlBase});
}

// Sends an event out of the body: the instance's eventOut or exposedField sends what the node in
// the body has sent.
void Engine::sendFromInstance(ProtoInstance& instance, const FieldInfo& out, const Value& value,
                              bool keeps) {
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

// Calls a function of all watchers. Nodes may be destroyed or added meanwhile: only nodes that
// existed at the beginning and still exist are called.
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
  if (settling_) return; // listeners and Scripts cannot advance time
  beginCascade(std::max(time, now_));
  observer->ticked();
  if (scripts) {
    const Settling settling(*this); // events of these functions wait in the queue
    scripts->tick();
  }
  callAll(ticking_, &Behaviour::tick);
  settle();
  beginCascade(now_);
  callAll(looking_, &Behaviour::look);
  settle();
}

} // namespace xvrml
