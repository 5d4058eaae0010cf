// definitions.h: -D DEF.field=value: other values for fields of a loaded world. [main thread]
#pragma once

#include <string>
#include <vector>

#include "xvrml/browser.h"

namespace vv {

struct Definition {
  xvrml::NodeRef node;
  const xvrml::FieldInfo* field;
  xvrml::Value value;
  // Fields get the value as if the file had it; what only a running world can do (an event, a
  // prototype's interface, an Inline's url) is sent as an event at time 0.
  bool asEvent;
};

// Throws Failure (usage) naming what was expected: the nearest DEF or field name, or the value's
// syntax.
std::vector<Definition> readDefinitions(const std::vector<std::string>& texts,
                                        const xvrml::World& world);

} // namespace vv
