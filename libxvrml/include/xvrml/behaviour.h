// behaviour.h: how a node type behaves in a running world. A behaviour is a set of functions that
// the event engine calls. Built-in nodes (libxvrml/behaviour, one file per type or family) and node
// plug-ins use the same interface. [the browser's thread]
#pragma once

#include <memory>
#include <string_view>
#include <utility>

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
  virtual double now() const = 0;
  // Sends an event from an eventOut, or from an exposedField that already has its new value. Each
  // eventOut sends at most once per cascade: a second event is dropped, which breaks loops
  // (4.10.4). Returns at once; routes are followed later.
  virtual void send(Node& from, const FieldInfo& out, Value value) = 0;
  // Sends by name. Does nothing if there is no such event.
  void send(Node& from, std::string_view out, Value value) {
    if (const FieldInfo* field = from.type().findEventOut(out))
      send(from, *field, std::move(value));
  }
  // Returns whether an eventOut or exposedField has already sent in this cascade, so that send()
  // would drop another event.
  virtual bool hasSent(const Node& from, const FieldInfo& out) const = 0;
  // Sets the value that an eventOut reads as before it first sends. Does nothing afterwards.
  virtual void preset(Node& from, const FieldInfo& out, Value value) = 0;
  // Gives a field or exposedField a new value without an event, and reports the change. Returns
  // false if the type does not match. Also returns false, with a diagnostic, if a node would become
  // its own descendant.
  virtual bool store(Node& node, const FieldInfo& field, Value value) = 0;
  // Queues an event to an eventIn or exposedField, as if a route had brought it. It is delivered
  // after the events already queued.
  virtual void post(Node& to, const FieldInfo& in, Value value) = 0;
  // Reports a change that stores no field value (set_bind).
  virtual void changed(Node& node, const FieldInfo& field) = 0;
  // Returns the last value that an eventOut sent; before the first event, the default of its type.
  virtual Value lastSent(const Node& node, const FieldInfo& out) const = 0;
  // Returns the state that Behaviour::begin made; null if it made none.
  virtual NodeState* state(Node& node) const = 0;
  // Turn the calls of Behaviour::tick or Behaviour::look at each tick on or off for a node. Calls
  // come in the order in which the nodes became part of the world.
  virtual void wantTicks(Node& node, bool wanted) = 0;
  virtual void wantLooks(Node& node, bool wanted) = 0;
  virtual Diagnostics& diagnostics() = 0;
  // Null if no browser runs the world (a bare engine in a test).
  virtual Browser* browser() const = 0;

 protected:
  ~Events() = default;
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
