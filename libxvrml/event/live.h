// live.h: what a running world knows of a node: where it hangs, and its part in the events. Made
// when the node becomes part of the world, gone with the node or the world. Only event/ writes
// here. [the browser's thread]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "xvrml/behaviour.h"

namespace xvrml {

class Engine;

// From an eventOut to an eventIn of another node, or across a prototype's border (clause 4.8.2:
// IS).
struct Link {
  // keepsField: no events: a field of the instance has the value of the exposedField that IS it,
  // for whoever writes the world.
  enum class Kind : uint8_t { route, intoBody, outOfBody, keepsField };
  const FieldInfo* out;
  NodeRef to; // null: deleted, swept after the cascade
  const FieldInfo* in;
  Kind kind = Kind::route;
  ProtoInstance* instance =
      nullptr; // outOfBody, keepsField: instead of `to`: it holds its body, which must not hold it

  bool carriesOut() const { return kind == Kind::route || kind == Kind::outOfBody; }
  bool leads() const { return to || instance; }
};

using Listener = std::function<void(Node& node, const FieldInfo& out, const Value& value)>;

struct Participant {
  struct Out {
    const FieldInfo* field;
    uint64_t cascade = 0; // the last one it sent in
    Value last;           // of an eventOut
  };
  std::vector<Link> links; // by their order of making
  std::vector<Out> outs;   // those that have sent
  std::vector<std::pair<uint64_t, std::pair<const FieldInfo*, Listener>>> listeners; // by number
  std::vector<std::pair<Change, std::string>> reasons; // of the bits in Live::reach
  std::unique_ptr<NodeState> state;
  std::set<std::tuple<const FieldInfo*, const Node*, const FieldInfo*, Link::Kind>>
      index; // of links, if there are many

  bool holds(const Link& link) const;
  void add(Link link);
  Out& out(const FieldInfo& field);
  const Out* findOut(const FieldInfo& field) const;
};

struct Live : LiveBase {
  Engine* engine;
  Node* node;
  size_t slot;                // in Engine's list
  uint32_t order;             // in which nodes became part of the world
  uint16_t reach = 0;         // see xvrml/change.h
  bool root = false;          // of the world
  uint64_t changed = 0;       // fields already in the list of changes, by index in the type
  std::vector<Node*> parents; // nodes that have it among their children, once for each time; bodies
                              // and Inlines included
  std::unique_ptr<Participant> part;
};

inline Live* liveOf(const Node& node) { return static_cast<Live*>(node.live); }

} // namespace xvrml
