// node.cpp: generic access to nodes through their tables, for code that does not know a node's
// struct: parser, writer, event engine, prototypes, bindings. [one thread at a time per node]
#include "xvrml/node.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/rotation.h"
#include "xvrml/viewed.h"
#include "xvrml/visit_storage.h"

namespace xvrml {
namespace {

bool hasStorage(const FieldInfo& field) {
  return field.access == Access::field || field.access == Access::exposedField;
}

const FieldInfo* findWith(const NodeType& type, std::string_view name, Access access) {
  const FieldInfo* field = type.find(name);
  return field && field->access == access ? field : nullptr;
}

// Checks numbers against a range. Float fields compare with the ends of the range as floats, so
// that 1.5707964 is within pi/2.
class RangeCheck {
 public:
  explicit RangeCheck(const FieldRange& range) : range_(range) {}

  template <class T> bool operator()(const T& value) const {
    if constexpr (std::is_same_v<T, Rotation>) // the angle may be any
      return all(numbersOf(value), 3);
    else if constexpr (Numeric<T>)
      return numberCount<T> == 1 ? contains(*numbersOf(value))
                                 : all(numbersOf(value), numberCount<T>);
    else if constexpr (isNumberList<T>)
      return std::all_of(value.begin(), value.end(),
                         [this](const auto& element) { return (*this)(element); });
    else
      return true;
  }

 private:
  bool contains(int32_t number) const { return contains(double(number)); }
  template <class T> bool contains(T number) const {
    const T minimum = T(range_.minimum), maximum = T(range_.maximum);
    const bool above = range_.minimumOpen ? number > minimum : number >= minimum;
    const bool below = range_.maximumOpen ? number < maximum : number <= maximum;
    return (above && below) || number == T(range_.also);
  }
  // The exceptional number is allowed only if all numbers have it: bboxSize -1 -1 -1.
  template <class T> bool all(const T* numbers, int count) const {
    const auto exceptional = [this](T number) { return number == T(range_.also); };
    if (std::any_of(numbers, numbers + count, exceptional))
      return std::all_of(numbers, numbers + count, exceptional);
    return std::all_of(numbers, numbers + count, [this](T number) { return contains(number); });
  }

  const FieldRange& range_;
};

constexpr std::string_view setPrefix = "set_", changedSuffix = "_changed";

} // namespace

bool inRange(const FieldInfo& field, const Value& value) {
  return !field.range.bounded() || std::visit(RangeCheck(field.range), value);
}

bool NodeType::is(std::string_view abstractName) const {
  return std::find(abstract.begin(), abstract.end(), abstractName) != abstract.end();
}

const FieldInfo* NodeType::find(std::string_view fieldName) const {
  for (const FieldInfo& field : fields)
    if (field.name == fieldName) return &field;
  return nullptr;
}

// An exposedField x receives events as x and as set_x (clause 4.7). In a route, the set_ of an
// eventIn may be left out (clause 4.10.2). The exact name has priority, so a node may have both `x`
// and `set_x`.
const FieldInfo* NodeType::findEventIn(std::string_view eventName) const {
  if (const FieldInfo* field = findWith(*this, eventName, Access::eventIn)) return field;
  if (const FieldInfo* field = findWith(*this, eventName, Access::exposedField)) return field;
  if (eventName.starts_with(setPrefix))
    return findWith(*this, eventName.substr(setPrefix.size()), Access::exposedField);
  return findWith(*this, std::string(setPrefix).append(eventName), Access::eventIn);
}

const FieldInfo* NodeType::findEventOut(std::string_view eventName) const {
  if (const FieldInfo* field = findWith(*this, eventName, Access::eventOut)) return field;
  if (const FieldInfo* field = findWith(*this, eventName, Access::exposedField)) return field;
  if (eventName.ends_with(changedSuffix))
    return findWith(*this, eventName.substr(0, eventName.size() - changedSuffix.size()),
                    Access::exposedField);
  return findWith(*this, std::string(eventName).append(changedSuffix), Access::eventOut);
}

Value Node::get(const FieldInfo& field) const {
  if (!hasStorage(field)) return xvrml::defaultValue(field.type);
  return visitStorage(field.type, storage(field), [](const auto& value) {
    return Value(std::in_place_type<std::decay_t<decltype(value)>>, value);
  });
}

bool Node::set(const FieldInfo& field, Value value) {
  if (!hasStorage(field) || value.index() != size_t(field.type)) return false;
  if (isMultiple(field.type)) leaveToViews(*this, field);
  visitStorage(field.type, storage(field), [&](auto& target) {
    target = std::get<std::decay_t<decltype(target)>>(std::move(value));
  });
  if (hasNormalizedAxes(field)) normalizeAxes(field.type, storage(field));
  if (!live && type_->expand) // in a running world the event engine renews the expansion
    if (NodeRef* standsFor = expansion()) *standsFor = {};
  return true;
}

std::atomic<void (*)(LiveBase* live) noexcept> LiveBase::forget = nullptr;

// A node's destructor releases its children. Children whose last reference goes meanwhile wait in a
// list until it returns; a chain of a million nodes would otherwise need a million stack frames.
void Node::destroy(Node* node) noexcept {
  if (node->live) LiveBase::forget.load(std::memory_order_relaxed)(node->live); // has its fields
  thread_local std::vector<Node*>* waiting = nullptr;
  if (waiting) {
    try {
      waiting->push_back(node);
    } catch (...) {
      delete node; // no memory for the list: fall back to recursion
    }
    return;
  }
  std::vector<Node*> list;
  waiting = &list;
  delete node;
  while (!list.empty()) {
    Node* next = list.back();
    list.pop_back();
    delete next;
  }
  waiting = nullptr;
}

DynamicNode::DynamicNode(NodeTypePtr type) : Node(*type), typePtr(std::move(type)) {
  for (const FieldInfo& field : typePtr->fields) {
    if (!hasStorage(field)) continue;
    if (values.size() <= field.offset) values.resize(field.offset + 1);
    values[field.offset] = field.defaultValue;
  }
}

void* DynamicNode::storage(const FieldInfo& field) {
  return std::visit([](auto& value) -> void* { return &value; }, values[field.offset]);
}

void* DeclaringNode::storage(const FieldInfo& field) {
  if (!field.declared) return Node::storage(field);
  return std::visit([](auto& value) -> void* { return &value; }, values[field.offset]);
}

void DeclaringNode::setOwnType(NodeTypePtr type) {
  ownType_ = std::move(type);
  type_ = ownType_.get();
  for (const FieldInfo& field : ownType_->fields)
    if (field.declared && hasStorage(field)) values.push_back(field.defaultValue);
}

} // namespace xvrml
