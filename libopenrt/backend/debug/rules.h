// rules.h: the rules of the debug layer: each looks at what was committed and says what is odd
// about it. A rule is a function in a table (rules_scene.cpp, rules_geometry.cpp); to add one is to
// add a line there. Called by DebugBackend when a frame starts, on the application's thread.
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

struct History { // of one object
  uint64_t definitions = 0;
  bool hinted = false; // dynamic with its first definition
};

struct Memory { // what was in use in any frame
  std::set<uint32_t> placed, shaders;
};

struct Facts {
  const Scene& scene;
  std::function<const RtsClass*(uint32_t shader)>
      classOf;                                  // null: no such shader, or an unknown class
  const std::map<uint32_t, History>& histories; // by object
  Memory& memory;
};

// Says something about the thing with this id (0: about the frame); the same rule says it once for
// each id.
using Report = std::function<void(uint32_t id, const std::string& text)>;

struct Rule {
  const char* name;
  void (*check)(const Facts& facts, const Report& report);
};

std::span<const Rule> sceneRules();  // what is there and what is used
std::span<const Rule> shaderRules(); // shaders, parameters, textures, lights
// About one object, once for each definition.
struct ObjectRule {
  const char* name;
  void (*check)(uint32_t id, const Object& object, const Facts& facts, const Report& report);
};
std::span<const ObjectRule> objectRules();

// "object 7", "shader 3 (Glass)".
std::string nameOf(const char* kind, uint32_t id);
std::string nameOfShader(const Facts& facts, uint32_t id);

} // namespace openrt::debug
