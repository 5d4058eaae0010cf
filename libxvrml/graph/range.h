// range.h: ranges of field values (the intervals that the standard prints beside each field). [any
// thread that owns the nodes]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "xvrml/node.h"

namespace xvrml {

// Brings numbers outside of a field's range back: to a closed end of the range; a single number
// beyond an open end to the default. Other values beyond an open end stay for those who draw them.
// Numbers that are a bound as files round it are not outside. False if something was outside;
// fault, which may be null, says what.
struct RangeFault {
  uint64_t count = 0;      // values that were outside
  size_t index = 0;        // of the first one in its list
  std::string given, used; // the first one as it was, and as it is now
};
bool enforceRange(const FieldInfo& field, void* storage, RangeFault* fault = nullptr);
std::string describe(const FieldRange& range); // "[0,1]", "(0,inf) or -1", "(0,pi/2]"
// "SpotLight.cutOffAngle: 1.9 is outside of its range (0,pi/2] and becomes 1.5707964"
std::string describe(const NodeType& type, const FieldInfo& field, const RangeFault& fault);

} // namespace xvrml
