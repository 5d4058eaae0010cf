// rotation.h: normalises the axes of rotations. The axis of an SFRotation has length 1 (ISO/IEC
// 14772-1 5.8), but many files have others, such as 0 1.618 1. Parser, events, Scripts, Python and
// writer all use these functions. [any thread]
#pragma once

#include <algorithm>
#include <cmath>

#include "xvrml/node.h"

namespace xvrml {

// Returns the length of a rotation's axis.
inline double axisLength(const Rotation& r) {
  return std::sqrt(double(r.x) * double(r.x) + double(r.y) * double(r.y) +
                   double(r.z) * double(r.z));
}

// Scales an axis to length 1. Returns false if it leaves the axis unchanged:
// - the length is 1 within the rounded digits of a file (.577 .577 .577);
// - the axis is 0 0 0 (no rotation);
// - a number is not finite.
inline bool normalizeAxis(Rotation& r) {
  const double length = axisLength(r);
  if (!(length > 0) || !std::isfinite(length) || std::abs(length - 1) <= 1e-3) return false;
  // Even a very short axis gives a direction, so the angle is kept.
  r.x = float(double(r.x) / length);
  r.y = float(double(r.y) / length);
  r.z = float(double(r.z) / length);
  return true;
}

// Returns whether the axes of a field are normalised, which holds for all rotations of nodes.
// Fields of Scripts and prototype interfaces keep the value they are given; a node's field
// connected to them by IS normalises it.
inline bool hasNormalizedAxes(const FieldInfo& field) {
  return field.range.bounded() &&
         (field.type == FieldType::SFRotation || field.type == FieldType::MFRotation);
}

// Returns whether a component of an axis is outside of [-1,1], the range of the standard. An axis
// such as 0 1 1 is inside: many files write it for "between y and z".
inline bool isAxisOutside(const Rotation& r) {
  return std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)}) > 1;
}

// Normalises the axes of a rotation or of a list of rotations. Returns how many were outside of the
// range. `first`, if not null, receives the first of these as it was before.
inline size_t normalizeAxes(FieldType type, void* storage, Rotation* first = nullptr) {
  size_t outside = 0;
  const auto each = [&](Rotation& r) {
    const Rotation before = r;
    if (normalizeAxis(r) && isAxisOutside(before) && outside++ == 0 && first) *first = before;
  };
  if (type == FieldType::SFRotation) each(*static_cast<SFRotation*>(storage));
  if (type == FieldType::MFRotation)
    for (Rotation& r : *static_cast<MFRotation*>(storage)) each(r);
  return outside;
}

} // namespace xvrml
