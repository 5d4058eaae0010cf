// behaviour.h: how a node type behaves in a running world: functions by type, called by the event
// engine. Built-in nodes (libxvrml/behaviour, one file a type or family) and node plug-ins use the
// same. [the browser's thread]
#pragma once

#include <memory>
#include <string_view>

#include "xvrml/change.h"
#include "xvrml/diagnostics.h"
#include "xvrml/world.h"

namespace xvrml {

class Browser;

// What a behaviour keeps for one node while the world runs.
struct NodeState {
  virtual ~NodeState() = default;
};

// What a behaviour may ask for and do. One per running world.
class Events {
 public:
  // The world's time in seconds: of the cascade that is being worked off (clause 4.10.3: all its
  // events have this time).
  double now() const { return now_; }
  // An event from an eventOut, or from an exposedField that has its new value already. At most one
  // per eventOut and cascade: a second one is dropped, which is what breaks loops (4.10.4). Returns
  // at once; routes are followed later.
  void send(Node& from, const FieldInfo& out, Value value);
  void send(Node& from, std::string_view out,
            Value value); // by name; nothing happens if there is no such event
  // Whether an eventOut or exposedField has sent in this cascade already, so that send() would drop
  // another event.
  bool hasSent(const Node& from, const FieldInfo& out) const;
  // What an eventOut reads as until it has sent for the first time; nothing happens afterwards.
  void preset(Node& from, const FieldInfo& out, Value value);
  // Gives a field or exposedField a new value without an event, and reports the change. False if
  // the type does not match, or nodes would become their own descendants (said in the diagnostics).
  bool store(Node& node, const FieldInfo& field, Value value);
  // An event to an eventIn or exposedField, as if a route had brought it; delivered after those
  // that wait already.
  void post(Node& to, const FieldInfo& in, Value value);
  // A change without a field (set_bind).
  void changed(Node& node, const FieldInfo& field);
  // The last value an eventOut sent; the field's default value type if it never did.
  Value lastSent(const Node& node, const FieldInfo& out) const;
  // The state that Behaviour::begin made; null if it made none.
  NodeState* state(Node& node) const;
  // From now on Behaviour::tick (or look) is called each tick, until it is turned off. Calls come
  // in the order in which the nodes became part of the world.
  void wantTicks(Node& node, bool wanted);
  void wantLooks(Node& node, bool wanted);
  Diagnostics& diagnostics() { return diagnostics_; }
  // Null while no browser runs the world (a bare engine in a test).
  Browser* browser() const { return browser_; }

 protected:
  Events(Diagnostics& diagnostics, Browser* browser)
      : diagnostics_(diagnostics), browser_(browser) {}
  double now_ = 0;
  Diagnostics& diagnostics_;
  Browser* browser_;
};

// Every function may be null.
struct Behaviour {
  // The node has become part of a running world; its fields and those of nodes below are set.
  std::unique_ptr<NodeState> (*begin)(Events& events, Node& node) = nullptr;
  // An event for an exposedField: false refuses it, and nothing is stored or sent.
  bool (*accept)(Events& events, Node& node, const FieldInfo& field, const Value& value) = nullptr;
  // An event has arrived at an eventIn, or at an exposedField, which then holds the value and has
  // sent it on. An eventIn set_x beside a field x needs no function: it replaces the field.
  void (*receive)(Events& events, Node& node, const FieldInfo& in, const Value& value) = nullptr;
  void (*tick)(Events& events, Node& node) = nullptr; // time has come to events.now()
  void (*look)(Events& events,
               Node& node) = nullptr; // after the cascades of the ticks: where is the viewer now?
};

// By node type index; both copy. A type has one behaviour: a later one replaces it.  [any thread,
// before worlds run]
void setBehaviour(const NodeType& type, const Behaviour& behaviour);
const Behaviour* behaviourOf(const NodeType& type); // null: none

// The row of a field, eventIn or eventOut of a built-in type:
// fieldOf<nodes::TimeSensor>("cycleTime"). It must be there.
template <class T> const FieldInfo& fieldOf(std::string_view name) {
  return *T::nodeType().find(name);
}

} // namespace xvrml
