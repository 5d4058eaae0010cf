// names.h: chooses names for glGenLists and glGenTextures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "gl/failure.h"

namespace rtgl {

// A context has at most so many lists, and so many textures.
inline constexpr size_t maxNames = size_t(1) << 20;

// Returns the first of `count` names in a row that a map lacks: those behind its last name, else
// those of its first gap that is wide enough. count is above 0.
template <class Map> GLuint unusedNames(const Map& map, GLuint count) {
  if (map.size() + count > maxNames)
    fail(GL_OUT_OF_MEMORY, "there are at most " + std::to_string(maxNames) + " names");
  constexpr uint64_t end = uint64_t(1) << 32;
  uint64_t first = map.empty() ? 1 : uint64_t(map.rbegin()->first) + 1;
  if (first + count > end) {
    first = 1;
    for (const auto& entry : map) {
      if (entry.first >= first + count) break;
      first = uint64_t(entry.first) + 1;
    }
    if (first + count > end) fail(GL_OUT_OF_MEMORY, "no names in a row are unused");
  }
  return static_cast<GLuint>(first);
}

} // namespace rtgl
