// live.h: the event engine's data for each node of a running world: its parents and its links. It
// is made when the node becomes part of the world and destroyed with the node or the world. Only
// event/ writes to it. [the browser's thread]
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

// A connection from an eventOut to an eventIn of another node, or between a prototype instance and
// its body (clause 4.8.2: IS).
struct Link {
  // mirrorsField carries no events: a field of the instance mirrors the value of the exposedField
  // that IS it, so that a written world contains it.
  enum class Kind : uint8_t { route, intoBody, outOfBody, mirrorsField };
  const FieldInfo* out;
  NodeRef to; // null: deleted, removed after the cascade
  const FieldInfo* in;
  Kind kind = Kind::route;
  // For outOfBody and mirrorsField, instead of `to`: a raw pointer, because the instance owns its
  // body and the body must not own the instance.
  ProtoInstance* instance = nullptr;

  bool isOutgoing() const { return kind == Kind::route || kind == Kind::outOfBody; }
  bool isConnected() const { return to || instance; }
};

using Listener = std::function<void(Node& node, const FieldInfo& out, const Value& value)>;

// A node's state in the event engine, made when it is first needed.
struct Participant {
  struct Out {
    const FieldInfo* field;
    uint64_t cascade = 0; // the last cascade in which it sent
    Value last;           // the last value of an eventOut
  };
  std::vector<Link> links; // links in the order in which they were made
  std::vector<Out> outs;   // outputs that have sent
  // Listeners, each with its number.
  std::vector<std::pair<uint64_t, std::pair<const FieldInfo*, Listener>>> listeners;
  std::vector<std::pair<Change, std::string>> reasons; // reasons for the bits in Live::reach
  std::unique_ptr<NodeState> state;
  // Index of `links`, used only if there are many.
  std::set<std::tuple<const FieldInfo*, const Node*, const FieldInfo*, Link::Kind>> index;

  bool holds(const Link& link) const;
  void add(Link link);
  Out& out(const FieldInfo& field);
  const Out* findOut(const FieldInfo& field) const;
};

// The parents of a node, in the order in which they were added. Most nodes have one, which takes no
// memory of its own.
class Parents {
 public:
  Parents() = default;
  Parents(const Parents&) = delete;
  Parents& operator=(const Parents&) = delete;
  ~Parents();
  size_t size() const { return hasList() ? list()->size() : one_ ? 1 : 0; }
  Node* const* begin() const { return hasList() ? list()->data() : &one_; }
  Node* const* end() const { return begin() + size(); }
  Node* operator[](size_t index) const { return begin()[index]; }
  void push_back(Node* parent);
  void removeLast(const Node* parent); // removes the last entry of this parent, if there is one
  void removeAll(const Node* parent) noexcept;

 private:
  bool hasList() const { return bits_ & 1; }
  std::vector<Node*>* list() const { return reinterpret_cast<std::vector<Node*>*>(bits_ - 1); }
  union {
    Node* one_ = nullptr; // the only parent
    uintptr_t bits_;      // with bit 0: the address of the list of parents, and 1
  };
};

// Its members stand so that a million take as few bytes as they can.
struct Live : LiveBase {
  Engine* engine;
  Node* node;
  // Bit set of the fields already in the list of changes, by index in the type.
  uint64_t changed = 0;
  // Nodes that have it among their children, once for each time. Includes prototype instances and
  // Inlines.
  Parents parents;
  std::unique_ptr<Participant> part;
  uint32_t slot;      // index in Engine's list
  uint32_t order;     // position in the order in which nodes became part of the world
  uint16_t reach = 0; // kinds of change that events may bring (xvrml/change.h)
  bool root = false;  // the node is a root of the world
};

inline Live* liveOf(const Node& node) { return static_cast<Live*>(node.live); }

} // namespace xvrml
