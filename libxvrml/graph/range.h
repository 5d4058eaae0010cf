// range.h: enforces the ranges of field values (the intervals that the standard prints beside each
// field). [any thread that owns the nodes]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "xvrml/node.h"
#include "xvrml/value_text.h"
#include "xvrml/versions.h"

namespace xvrml {

// Brings numbers outside of a field's range back into it. Returns false if a number was outside;
// `fault`, which may be null, describes it.
// - A number beyond a closed end becomes that end.
// - A single number beyond an open end becomes the default.
// - Other values beyond an open end stay, and the renderer handles them.
// - Counts of vertices stay (vertexCount of LineSet), and the geometry leaves their parts out.
// - A number that is a bound, rounded as files do it, is not outside.
struct RangeFault {
  uint64_t count = 0;      // number of values that were outside
  size_t index = 0;        // index of the first one in its list
  std::string given, used; // the first one as it was, and as it is now
  FieldRange range;        // the range that it was outside of
};
// revision: how the version of the file describes the field; null: as FieldInfo does.
bool enforceRange(const FieldInfo& field, const FieldRevision* revision, void* storage,
                  RangeFault* fault = nullptr);
// Returns "SpotLight.cutOffAngle: 1.9 is outside of its range (0,pi/2] and becomes 1.5707964".
std::string describe(const NodeType& type, const FieldInfo& field, const RangeFault& fault);

} // namespace xvrml
