// rotation.h: axes of rotations. SFRotation begins with a normalised axis (ISO/IEC 14772-1 5.8),
// but many files have others, such as 0 1.618 1. Parser, events, Scripts, Python and writer all
// treat them in this one way. [any thread]
#pragma once

#include <algorithm>
#include <cmath>

#include "xvrml/node.h"

namespace xvrml {

// The length of an axis.
inline double axisLength(const Rotation& r) {
  return std::sqrt(double(r.x) * double(r.x) + double(r.y) * double(r.y) +
                   double(r.z) * double(r.z));
}

// Gives an axis length 1. Axes that are so far off as the rounded digits of a file (.577 .577 .577)
// stay as they are written, and so do 0 0 0 (no rotation) and numbers that are not finite. False if
// it has been left alone.
inline bool normalizeAxis(Rotation& r) {
  const double length = axisLength(r);
  if (!(length > 0) || !std::isfinite(length) || std::abs(length - 1) <= 1e-3) return false;
  // An angle about an axis near 0 is kept: the direction is what is meant.
  r.x = float(double(r.x) / length);
  r.y = float(double(r.y) / length);
  r.z = float(double(r.z) / length);
  return true;
}

// Whether the axes of a field are normalised: all rotations of nodes. Fields of Scripts and of
// prototypes' interfaces hold whatever they are given; a node's field that IS one of these
// normalises it.
inline bool hasNormalizedAxes(const FieldInfo& field) {
  return field.range.bounded() &&
         (field.type == FieldType::SFRotation || field.type == FieldType::MFRotation);
}

// Whether a component of an axis is outside of [-1,1], the range of the standard. An axis such as 0
// 1 1 is not: many files mean "between y and z" by it.
inline bool isAxisOutside(const Rotation& r) {
  return std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)}) > 1;
}

// Normalises the axes of a rotation or a list of them. Returns how many were outside of the range;
// first, if not null, gets the first of these as it was.
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
