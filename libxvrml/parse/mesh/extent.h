// extent.h: where the points of a mesh lie, to tell whether single precision can hold its shape.
// [the thread that loads]
#pragma once

#include <span>

#include "base/locator.h"
#include "xvrml/types.h"

namespace xvrml {

class MeshExtent {
 public:
  void add(std::span<const Vec3f> points);
  // Warns if floats as far from the origin as these points have steps that are larger than a
  // 10,000th of the size of the model.
  void report(Locator& locator) const;

 private:
  bool isEmpty_ = true;
  float low_[3] = {}, high_[3] = {};
};

} // namespace xvrml
