// definitions.h: Implements -D DEF.field=value, which changes fields of a loaded world. [main
// thread]
#pragma once

#include <string>
#include <vector>

#include "xvrml/browser.h"

namespace vv {

struct Definition {
  xvrml::NodeRef node;
  const xvrml::FieldInfo* field;
  xvrml::Value value;
  // false: the field gets the value as if the file contained it. true: the value is sent as an
  // event at time 0, because only a running world can apply it (an event, a prototype's interface,
  // an Inline's url).
  bool asEvent;
};

// Throws Failure (usage) that says what was expected: the nearest DEF or field name, or the syntax
// of the value.
std::vector<Definition> readDefinitions(const std::vector<std::string>& texts,
                                        const xvrml::World& world);

} // namespace vv
