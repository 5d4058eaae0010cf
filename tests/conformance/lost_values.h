// lost_values.h: tells whether a world has values that an encoding does not allow.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "xvrml/world.h"

namespace xvrml::test {

// Returns whether an encoding cannot hold a value of the world, as the writer says of lights that
// are brighter than a version allows.
inline bool losesValues(const World& world, Encoding encoding) {
  const std::vector<std::string> changes = changesByWriting(world, encoding);
  return std::any_of(changes.begin(), changes.end(), [](const std::string& one) {
    return one.find("will be weaker") != std::string::npos;
  });
}

} // namespace xvrml::test
