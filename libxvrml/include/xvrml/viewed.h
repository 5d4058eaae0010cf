// viewed.h: views of number lists in place, for bindings of languages whose arrays share memory. A
// view is a snapshot: its data stays where it is and as it was for as long as the view lives. When
// the field gets another value, the old one is left to the view. [make a view while the node does
// not change; it may end on any thread, before the node]
#pragma once

#include <cstddef>
#include <memory>

#include "xvrml/node.h"

namespace xvrml {

class ViewedField {
 public:
  ViewedField(Node& node, const FieldInfo& field);
  ~ViewedField();
  ViewedField(const ViewedField&) = delete;
  ViewedField& operator=(const ViewedField&) = delete;
  const void* data() const { return data_; }
  size_t size() const { return size_; } // number of elements: colours, vectors, numbers

 private:
  friend void leaveToViews(Node& node, const FieldInfo& field);
  const void* storage_;
  const void* data_ = nullptr;
  size_t size_ = 0;
  Value kept_; // the former value of the field, once it holds another
};

// Returns a view of the field's present value; null unless its type is MFColor, MFFloat, MFInt32,
// MFRotation, MFTime, MFVec2f or MFVec3f. Two calls return one view if the field has not changed
// between them.
std::shared_ptr<const ViewedField> viewField(Node& node, const FieldInfo& field);

// Leaves the field's present value to its views. Node::set calls it before it sets another value.
void leaveToViews(Node& node, const FieldInfo& field);

} // namespace xvrml
