// describe.h: Describes values and worlds in words, using only the field tables. [any thread]
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "xvrml/world.h"

namespace vv {

std::string version();
// Returns a value as VRML97 text.
std::string valueText(const xvrml::Value& value);
// Returns a number with its noun: "1 error", "2 errors".
std::string counted(uint64_t count, const char* noun);
// Replaces line breaks and tabs.
std::string oneLine(std::string text);

struct WorldCounts {
  std::map<std::string, uint64_t> types; // number of nodes by type; a node that is USEd counts once
  uint64_t routes = 0;
  std::vector<std::string> prototypes, names;
  // number of Script nodes by the protocol of their first url
  std::map<std::string, uint64_t> scripts;
  // Script nodes in the bodies of the prototypes that the file declares, by protocol.
  std::map<std::string, uint64_t> declaredScripts;
};
// Visits every node of a world once, including bodies of prototypes and the contents of Inlines.
void forEachNode(const xvrml::World& world,
                 const std::function<void(const xvrml::Node& node)>& visit);
// Visits a node and every node below it, each once.
void forEachNodeBelow(const xvrml::Node& node,
                      const std::function<void(const xvrml::Node& node)>& visit);
// Returns "javascript" for "javascript:..." and for "a.js"; "java" for a .class; "file" for another
// suffix; "none" without any url.
std::string scriptProtocol(const std::vector<std::string>& urls);
WorldCounts countWorld(const xvrml::World& world);
// Returns how a file is written, and what the statements of an X3D file's head say: lines of
// --info.
std::string headText(const xvrml::FileHead& head);

} // namespace vv
