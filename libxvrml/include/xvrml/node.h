// node.h: nodes and the constant tables that describe them. nodegen writes one struct and one table
// per node from libxvrml/nodes/*.node. Prototypes and Scripts make their tables at run time. All
// generic code (parser, writer, event engine, PROTO expansion, Python, --list-nodes) works through
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
// Returns the word of ISO/IEC 14772-1 for an access.
constexpr std::string_view accessName(Access access) {
  constexpr std::string_view names[] = {"field", "exposedField", "eventIn", "eventOut"};
  return names[static_cast<size_t>(access)];
}

// The standard that a node type belongs to: none for those of OpenRT, of plug-ins and of worlds.
enum class Standard : uint8_t { none, vrml97, x3d };
// Returns the document of a standard: "ISO/IEC 14772-1"; "" for none.
constexpr std::string_view standardName(Standard standard) {
  constexpr std::string_view names[] = {"", "ISO/IEC 14772-1", "ISO/IEC 19775-1"};
  return names[static_cast<size_t>(standard)];
}

// The kind of scene data that a write to a field invalidates (architecture.md section 2).
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

// A position in a file. `file` is shared by all nodes of a file.
struct SourcePosition {
  std::shared_ptr<const std::string> file;
  uint32_t line = 0, column = 0; // counted from 1; 0: the node was made by a program
};

// The interval that each number must lie in, as the standard prints it: (0,inf), [0,1]. For an
// SFRotation it applies to the axis; the angle is free.
struct FieldRange {
  double minimum = -std::numeric_limits<double>::infinity(),
         maximum = std::numeric_limits<double>::infinity();
  bool minimumOpen = true, maximumOpen = true;
  // A value that is allowed, too, if all numbers have it (bboxSize -1 -1 -1); NaN: none.
  double also = std::numeric_limits<double>::quiet_NaN();

  bool bounded() const {
    return minimum > -std::numeric_limits<double>::infinity() ||
           maximum < std::numeric_limits<double>::infinity();
  }
};

// The fields of a node that few worlds set (`rare` in the .node files). They stand in a block of
// their own, which is made when one of them is set. A node without it has their defaults.
template <class T> class RareFields {
 public:
  const T& get() const {
    static const T defaults;
    return own_ ? *own_ : defaults;
  }
  T& make() {
    if (!own_) own_ = std::make_unique<T>();
    return *own_;
  }
  bool isMade() const { return own_ != nullptr; }

 private:
  std::unique_ptr<T> own_;
};
// The functions of a type's RareFields, for generic code: they return the address of the block.
struct RareAccess {
  const void* (*get)(const void* fields);
  void* (*make)(void* fields);
  bool (*isMade)(const void* fields);
};
template <class T> inline constexpr RareAccess rareAccess = {
    [](const void* fields) -> const void* {
      return &static_cast<const RareFields<T>*>(fields)->get();
    },
    [](void* fields) -> void* { return &static_cast<RareFields<T>*>(fields)->make(); },
    [](const void* fields) { return static_cast<const RareFields<T>*>(fields)->isMade(); }};

struct FieldInfo {
  std::string name;
  FieldType type;
  Access access;
  Change change;
  // The strings of this MFString are URLs, relative to the node's file. Always false in the type of
  // a prototype: use holdsUrls() of world.h for nodes of any type.
  bool holdsUrls : 1 = false;
  // X3D adds the field to a node of VRML97. It works in files of VRML97, too, with a warning.
  bool ofX3d : 1 = false;
  // Static nodes: bytes from the start of the Node. Dynamic nodes and declared fields: index of the
  // value. Events: unused.
  uint32_t offset;
  Value defaultValue; // for fields and exposedFields
  FieldRange range;   // range of each number; finite ends are rounded to float for float fields
  // SFNode and MFNode: accepted abstract or concrete node types, separated by blanks; empty: any.
  std::string nodeTypes;
  std::string text; // one line of documentation
  // The rest is derived from the names when a static type is made, so that events compare none.
  // Index of the field x in NodeType::fields that an eventIn set_x sets; -1: it sets none.
  int sets = -1;
  // The SFNode that X3D gives to every node. It has no effect on its node (ISO/IEC 19775-1 7.3.3).
  bool isMetadata = false;
  // The node declares the field itself, beside those of its built-in type (`declaring` in the .node
  // files: Scripts and shaders).
  bool declared = false;
  // For a rare field, whose `offset` is that of the node's RareFields: how to get at the block, and
  // bytes from its start. Null: any other field.
  const RareAccess* rare = nullptr;
  uint32_t rareOffset = 0;
  // VRML97 has a field here, which `access` calls an exposedField: events change it since this
  // version of X3D. 0: `access` holds for all.
  uint8_t exposedSince = 0;
};
// Returns whether nodes store a value of the field: a field or an exposedField, not an event.
inline bool holdsValue(const FieldInfo& field) {
  return field.access == Access::field || field.access == Access::exposedField;
}

// The description of a node type: one row per field, and how to make a node. Immutable; it lives as
// long as any node of the type.
struct NodeType {
  std::string name;
  // Position in the registry's list of static types. Negative for types that a world declares:
  // ProtoInstance::typeIndex and ScriptNode::typeIndex (world.h).
  int index;
  Standard standard = Standard::none;
  // Roles that the node can take in SFNode and MFNode fields: child, grouping, geometry, appearance
  // ...
  std::vector<std::string> abstract;
  std::string component; // .node file that describes it: grouping, geometry, lighting ...
  std::string text;
  std::vector<FieldInfo> fields;
  // Null for types that a world declares, and for a node's own type.
  Node* (*create)(const NodeType& type);
  std::string clause; // clause of the standard, "6.6"; empty: not a standard node
  // Returns the nodes that a plug-in's node (xvrml/node_plugin.h) or a ParticleSystem stands for.
  // Null: the node itself is rendered.
  NodeRef (*expand)(const Node& node) = nullptr;

  // Returns whether `abstract` contains the name.
  bool is(std::string_view abstractName) const;
  const FieldInfo* find(std::string_view fieldName) const; // finds the exact name
  // Also find set_x and x_changed of an exposedField x (clause 4.7).
  const FieldInfo* findEventIn(std::string_view name) const;
  const FieldInfo* findEventOut(std::string_view name) const;
  // Returns the field x that an eventIn set_x of a static node sets; null: it sets none.
  const FieldInfo* fieldSetBy(const FieldInfo& in) const {
    return in.sets < 0 ? nullptr : &fields[size_t(in.sets)];
  }
};
// Returns false if a number of the value lies outside the field's range, or is NaN and the field
// has a range.
bool inRange(const FieldInfo& field, const Value& value);

using NodeTypePtr = std::shared_ptr<const NodeType>;

// The part of a running world's node data that Node knows (event/live.h). Nodes of worlds that do
// not run have none.
struct LiveBase {
  // Called when a node with such data is destroyed. It is one for all, because worlds have millions
  // of nodes; the event engine sets it.
  static std::atomic<void (*)(LiveBase* live) noexcept> forget;
};

class Node {
 public:
  explicit Node(const NodeType& type) : type_(&type) {}
  virtual ~Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  const NodeType& type() const { return *type_; }
  // Returns the address of a field's or exposedField's value. Its C++ type is the alternative of
  // Value with index field.type. For a rare field only the first function makes the block, so
  // that it is the one to write with.
  virtual void* storage(const FieldInfo& field) {
    char* const at = reinterpret_cast<char*>(this) + field.offset;
    return field.rare ? static_cast<char*>(field.rare->make(at)) + field.rareOffset : at;
  }
  const void* storage(const FieldInfo& field) const {
    if (!field.rare) return const_cast<Node*>(this)->storage(field);
    const char* const at = reinterpret_cast<const char*>(this) + field.offset;
    return static_cast<const char*>(field.rare->get(at)) + field.rareOffset;
  }
  // Returns whether the field is a rare one of a node that has set none of these: it has its
  // default.
  bool isUnset(const FieldInfo& field) const {
    return field.rare && !field.rare->isMade(reinterpret_cast<const char*>(this) + field.offset);
  }
  Value get(const FieldInfo& field) const;
  // Sets a field. Returns false, and changes nothing, if the value's type is not the field's.
  bool set(const FieldInfo& field, Value value);

  // Returns where a node keeps its expansion; null for nodes whose type has no `expand`.
  virtual NodeRef* expansion() { return nullptr; }

  // DEF name, "" if none (not called `name`: nodes may have a field of that name)
  std::string defName;
  SourcePosition source;
  LiveBase* live = nullptr; // set and read by the browser that runs the node's world

 private:
  friend class NodeRef;
  friend class DeclaringNode;
  // Not recursive, so that a deep graph cannot overflow the stack.
  static void destroy(Node* node) noexcept;
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

// Returns the node if it is exactly of the concrete type, else null: nodeCast<nodes::Box>(ref).
// Generated structs, ProtoInstance and ScriptNode have a static `typeIndex`. That of a built-in
// node never changes, because programs have it compiled in (libxvrml/nodes/numbers.txt).
template <class T> T* nodeCast(Node* node) {
  return node && node->type().index == T::typeIndex ? static_cast<T*>(node) : nullptr;
}
template <class T> const T* nodeCast(const Node* node) {
  return nodeCast<T>(const_cast<Node*>(node));
}
template <class T> T* nodeCast(const NodeRef& ref) { return nodeCast<T>(ref.get()); }

// A node whose fields are described at run time: Script nodes and PROTO instances keep the values
// of their interface here.
class DynamicNode : public Node {
 public:
  explicit DynamicNode(NodeTypePtr type);
  void* storage(const FieldInfo& field) override;
  std::vector<Value> values; // indexed by FieldInfo::offset
  const NodeTypePtr typePtr;
};

// A built-in node that can declare fields of its own: the base of the generated structs of type
// `declaring`. Its type is the built-in one until it declares the first field.
class DeclaringNode : public Node {
 public:
  using Node::Node;
  using Node::storage;
  void* storage(const FieldInfo& field) override;
  // Gives the node a type of its own: a copy of its built-in type with declared fields. Each of
  // these has its default. Called once.
  void setOwnType(NodeTypePtr type);
  const NodeTypePtr& ownType() const { return ownType_; } // null: the type is the built-in one
  // Returns where the node declares the field.
  const SourcePosition& placeOf(const FieldInfo& field) const {
    return field.offset < places.size() ? places[field.offset] : source;
  }
  // Values and places of the declared fields, indexed by FieldInfo::offset.
  std::vector<Value> values;
  std::vector<SourcePosition> places;

 private:
  NodeTypePtr ownType_;
};

// Returns the built-in types in the order of their typeIndex, then those of plug-ins as they were
// loaded. A type never changes its place: new built-in types get the next numbers.
std::span<const NodeType* const> nodeTypes();
const NodeType* findNodeType(std::string_view name);

} // namespace xvrml
