// describe.h: values and worlds in words, through the field tables alone. [any thread]
#pragma once

#include <map>
#include <string>
#include <vector>

#include "xvrml/world.h"

namespace vv {

std::string version();
// A value as VRML97 text.
std::string valueText(const xvrml::Value& value);
// Without line breaks and tabs.
std::string oneLine(std::string text);

struct WorldCounts {
  std::map<std::string, uint64_t> types; // nodes by type; one that is USEd counts once
  uint64_t routes = 0;
  std::vector<std::string> prototypes, names;
};
WorldCounts countWorld(const xvrml::World& world);

} // namespace vv
