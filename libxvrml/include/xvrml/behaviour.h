// behaviour.h: how a node type behaves in a running world. A behaviour is a set of functions that
// the event engine calls. Built-in nodes (libxvrml/behaviour, one file per type or family) and node
// plug-ins use the same interface. [the browser's thread]
#pragma once

#include <memory>
#include <string_view>

#include "xvrml/change.h"
#include "xvrml/diagnostics.h"
#include "xvrml/world.h"

namespace xvrml {

class Browser;

// The state that a behaviour keeps for one node while the world runs.
struct NodeState {
  virtual ~NodeState() = default;
};

// The event engine as behaviours see it. There is one per running world.
class Events {
 public:
  // Returns the world's time in seconds. During a cascade it is the cascade's time: all its events
  // have the same timestamp (clause 4.10.3).
  double now() const { return now_; }
  // Sends an event from an eventOut, or from an exposedField that already has its new value. Each
  // eventOut sends at most once per cascade: a second event is dropped, which breaks loops
  // (4.10.4). Returns at once; routes are followed later.
  void send(Node& from, const FieldInfo& out, Value value);
  // Sends by name. Does nothing if there is no such event.
  void send(Node& from, std::string_view out, Value value);
  // Returns whether an eventOut or exposedField has already sent in this cascade, so that send()
  // would drop another event.
  bool hasSent(const Node& from, const FieldInfo& out) const;
  // Sets the value that an eventOut reads as before it first sends. Does nothing afterwards.
  void preset(Node& from, const FieldInfo& out, Value value);
  // Gives a field or exposedField a new value without an event, and reports the change. Returns
  // false if the type does not match. Also returns false, with a diagnostic, if a node would become
  // its own descendant.
  bool store(Node& node, const FieldInfo& field, Value value);
  // Queues an event to an eventIn or exposedField, as if a route had brought it. It is delivered
  // after the events already queued.
  void post(Node& to, const FieldInfo& in, Value value);
  // Reports a change that stores no field value (set_bind).
  void changed(Node& node, const FieldInfo& field);
  // Returns the last value that an eventOut sent; before the first event, the default of its type.
  Value lastSent(const Node& node, const FieldInfo& out) const;
  // Returns the state that Behaviour::begin made; null if it made none.
  NodeState* state(Node& node) const;
  // Turn the calls of Behaviour::tick or Behaviour::look at each tick on or off for a node. Calls
  // come in the order in which the nodes became part of the world.
  void wantTicks(Node& node, bool wanted);
  void wantLooks(Node& node, bool wanted);
  Diagnostics& diagnostics() { return diagnostics_; }
  // Null if no browser runs the world (a bare engine in a test).
  Browser* browser() const { return browser_; }

 protected:
  Events(Diagnostics& diagnostics, Browser* browser)
      : diagnostics_(diagnostics), browser_(browser) {}
  double now_ = 0;
  Diagnostics& diagnostics_;
  Browser* browser_;
};

// The functions of a behaviour. Each may be null.
struct Behaviour {
  // Called when the node has become part of a running world. Its fields and those of its
  // descendants are set.
  std::unique_ptr<NodeState> (*begin)(Events& events, Node& node) = nullptr;
  // Called for an event to an exposedField. If it returns false, nothing is stored or sent.
  bool (*accept)(Events& events, Node& node, const FieldInfo& field, const Value& value) = nullptr;
  // Called for an event that has arrived at an eventIn, or at an exposedField, which then holds the
  // value and has sent it on. An eventIn set_x beside a field x needs no function: it sets the
  // field.
  void (*receive)(Events& events, Node& node, const FieldInfo& in, const Value& value) = nullptr;
  void (*tick)(Events& events, Node& node) = nullptr; // time has advanced to events.now()
  // Called after the cascades of the ticks, when the viewer's position is final.
  void (*look)(Events& events, Node& node) = nullptr;
};

// Sets a type's behaviour, replacing an earlier one. Both arguments are copied.  [any thread,
// before worlds run]
void setBehaviour(const NodeType& type, const Behaviour& behaviour);
const Behaviour* behaviourOf(const NodeType& type); // null: none

// Returns the row of a field, eventIn or eventOut of a built-in type:
// fieldOf<nodes::TimeSensor>("cycleTime"). The name must exist.
template <class T> const FieldInfo& fieldOf(std::string_view name) {
  return *T::nodeType().find(name);
}

} // namespace xvrml
