// viewed.h: lists of numbers that are looked at from outside, where they lie. What was viewed stays
// where it is and as it was for as long as the view lives: a field that gets another value leaves
// the old one to its views. For bindings of languages whose arrays share memory. [make a view while
// the node does not change; let it end on any thread, before the node]
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
  size_t size() const { return size_; } // elements: colours, vectors, numbers

 private:
  friend void leaveToViews(Node& node, const FieldInfo& field);
  const void* storage_;
  const void* data_ = nullptr;
  size_t size_ = 0;
  Value kept_; // what the field held, once it holds something else
};

// The field's value now, of a type of MFColor, MFFloat, MFInt32, MFRotation, MFTime, MFVec2f,
// MFVec3f; null for others. Two calls give one view if nothing has changed between them.
std::shared_ptr<const ViewedField> viewField(Node& node, const FieldInfo& field);

// The field is about to get another value: called by Node::set.
void leaveToViews(Node& node, const FieldInfo& field);

} // namespace xvrml
