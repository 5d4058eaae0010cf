// rules.h: the rules of the debug layer. Each rule examines what was committed and reports misuse.
// A rule is a function in a table (rules_scene.cpp, rules_shaders.cpp, rules_geometry.cpp); a new
// rule needs one more line there. Called by DebugBackend when a frame starts, on the application's
// thread.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>

#include "openrt/openrts.h"
#include "scene/scene.h"

namespace openrt::debug {

struct ObjectHistory { // definitions of one object
  uint64_t definitions = 0;
  bool hinted = false; // dynamic at its first definition
};

struct UsageHistory { // everything that was used in any frame so far
  std::set<uint32_t> placed, shaders;
};

struct RuleContext {
  const Scene& scene;
  // Returns null if there is no such shader or its class is unknown.
  std::function<const RtsClass*(uint32_t shader)> classOf;
  const std::map<uint32_t, ObjectHistory>& histories; // definitions by object
  UsageHistory& memory;
};

// Reports a problem of the thing with this id (0: of the frame). A rule reports each id only once.
using Report = std::function<void(uint32_t id, const std::string& text)>;

struct Rule {
  const char* name;
  void (*check)(const RuleContext& facts, const Report& report);
};

std::span<const Rule> sceneRules();  // contents and use of the scene
std::span<const Rule> shaderRules(); // shaders, parameters, textures and lights
// A rule about one object, checked once per definition.
struct ObjectRule {
  const char* name;
  void (*check)(uint32_t id, const Object& object, const RuleContext& facts, const Report& report);
};
std::span<const ObjectRule> objectRules();

// Formats a name like "object 7" or "shader 3 (Glass)".
std::string nameOf(const char* kind, uint32_t id);
std::string nameOfShader(const RuleContext& facts, uint32_t id);

} // namespace openrt::debug
