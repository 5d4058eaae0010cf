// node.h: nodes and the constant tables that describe them. nodegen writes one struct and one table
// per node from libxvrml/nodes/*.node; prototypes and scripts make their tables at run time.
// Everything generic (parser, writer, router, PROTO instancer, Python, --list-nodes) works through
// these tables.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/types.h"

namespace xvrml {

enum class Access : uint8_t { field, exposedField, eventIn, eventOut };

// What a write to a field invalidates (architecture.md section 2).
enum class Change : uint8_t {
  none,
  transform,
  geometry,
  appearance,
  shader,
  children,
  light,
  view,
  time
};

// Where something stands in a file. `file` is shared by all nodes of a file.
struct SourcePosition {
  std::shared_ptr<const std::string> file;
  uint32_t line = 0, column = 0; // from 1; 0: made by a program
};

// The interval a number must lie in, as the standard prints it: (0,inf), [0,1]. SFRotation: of the
// axis; its angle is free.
struct FieldRange {
  double minimum = -std::numeric_limits<double>::infinity(),
         maximum = std::numeric_limits<double>::infinity();
  bool minimumOpen = true, maximumOpen = true;
  double also = std::numeric_limits<double>::quiet_NaN(); // allowed besides when every number has
                                                          // it (bboxSize -1 -1 -1); NaN: none

  bool bounded() const {
    return minimum > -std::numeric_limits<double>::infinity() ||
           maximum < std::numeric_limits<double>::infinity();
  }
};

struct FieldInfo {
  std::string name;
  FieldType type;
  Access access;
  Change change;
  uint32_t offset; // static nodes: bytes from the Node; dynamic nodes: index of the value; events:
                   // unused
  Value defaultValue; // fields and exposedFields
  FieldRange range;   // per number; finite ends are rounded to float for float fields
  std::string
      nodeTypes; // SFNode, MFNode: blank-separated abstract or concrete types accepted; empty: any
  std::string text; // one line of documentation
};

// A table row per field; how to make a node. Immutable and alive as long as any node of the type.
struct NodeType {
  std::string name;
  int index; // position in the registry's list of static types; -1 for prototypes and scripts
  std::vector<std::string> abstract; // what it may stand for: child, grouping, geometry,
                                     // appearance, ... (models of SFNode constraints)
  std::string component;             // file it comes from: grouping, geometry, lighting ...
  std::string text;
  std::vector<FieldInfo> fields;
  Node* (*create)(const NodeType& type);
  std::string clause; // of ISO/IEC 14772-1, "6.6"; empty: not a standard node
  NodeRef (*expand)(const Node& node) =
      nullptr; // what a node of a plug-in stands for (xvrml/node_plugin.h); null: itself

  bool is(std::string_view abstractName) const;            // one of `abstract`
  const FieldInfo* find(std::string_view fieldName) const; // exact name
  // Also finds set_x and x_changed of an exposedField x (clause 4.7); wantInput: looked up as the
  // target of a route.
  const FieldInfo* findEventIn(std::string_view name) const;
  const FieldInfo* findEventOut(std::string_view name) const;
};
// False if a number of the value lies outside the field's range (or is NaN and the field has one).
bool inRange(const FieldInfo& field, const Value& value);

using NodeTypePtr = std::shared_ptr<const NodeType>;

// What a running world knows of a node (event/live.h); plain files have none.
struct LiveBase {
  void (*forget)(LiveBase* live) noexcept; // the node is being destroyed
};

class Node {
 public:
  explicit Node(const NodeType& type) : type_(&type) {}
  virtual ~Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  const NodeType& type() const { return *type_; }
  // Storage of a field or exposedField; its C++ type is the alternative of Value with index
  // field.type.
  virtual void* storage(const FieldInfo& field) {
    return reinterpret_cast<char*>(this) + field.offset;
  }
  const void* storage(const FieldInfo& field) const {
    return const_cast<Node*>(this)->storage(field);
  }
  Value get(const FieldInfo& field) const;
  // The value's type must be the field's; false (and no change) otherwise.
  bool set(const FieldInfo& field, Value value);

  // Where a node that stands for others (NodeType::expand) keeps them; null for all others.
  virtual NodeRef* expansion() { return nullptr; }

  std::string defName; // DEF, empty if none (not `name`: nodes may have a field of that name)
  SourcePosition source;
  LiveBase* live = nullptr; // set and read by the browser that the node lives in

 private:
  friend class NodeRef;
  static void destroy(Node* node) noexcept; // without recursion, however deep the graph below is
  const NodeType* type_;
  std::atomic<uint32_t> references_{0};
};

inline NodeRef::NodeRef(Node* node) : node_(node) {
  if (node_) node_->references_.fetch_add(1, std::memory_order_relaxed);
}
inline NodeRef::NodeRef(const NodeRef& other) : NodeRef(other.node_) {}
inline NodeRef::~NodeRef() {
  if (node_ && node_->references_.fetch_sub(1, std::memory_order_acq_rel) == 1)
    Node::destroy(node_);
}

// The concrete type if node is exactly of it: nodeCast<nodes::Box>(ref). Generated structs have a
// static `typeIndex`.
template <class T> T* nodeCast(Node* node) {
  return node && node->type().index == T::typeIndex ? static_cast<T*>(node) : nullptr;
}
template <class T> T* nodeCast(const NodeRef& ref) { return nodeCast<T>(ref.get()); }

// A node whose fields are described at run time: Script nodes and PROTO instances keep their
// interface's values here.
class DynamicNode : public Node {
 public:
  explicit DynamicNode(NodeTypePtr type);
  void* storage(const FieldInfo& field) override;
  std::vector<Value> values; // by FieldInfo::offset
  const NodeTypePtr typePtr;
};

// Built-in and plug-in types. Iteration order is the order of the .node files and is stable.
std::span<const NodeType* const> nodeTypes();
const NodeType* findNodeType(std::string_view name);

} // namespace xvrml
