// describe.h: values and worlds in words, through the field tables alone. [any thread]
#pragma once

#include <functional>
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
  std::map<std::string, uint64_t> scripts; // Script nodes by the protocol of their first url
  std::map<std::string, uint64_t>
      declaredScripts; // those in the bodies of the prototypes that the file declares
};
// Every node of a world once: bodies of prototypes and what Inlines loaded too.
void forEachNode(const xvrml::World& world,
                 const std::function<void(const xvrml::Node& node)>& visit);
// A node and every node below it, once.
void forEachNodeBelow(const xvrml::Node& node,
                      const std::function<void(const xvrml::Node& node)>& visit);
// "javascript" of "javascript:...", of "a.js" too; "java" of a .class; "file" for another suffix,
// "none" without any url.
std::string scriptProtocol(const std::vector<std::string>& urls);
WorldCounts countWorld(const xvrml::World& world);

} // namespace vv
