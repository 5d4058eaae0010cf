// fuzz_mesh.h: reads arbitrary bytes as a mesh, by the reader that the name chooses if the content
// does not. What was read without an error must be written and read again
// as the same text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "xvrml/world.h"

inline int fuzzMesh(const uint8_t* data, size_t size, const char* name) try {
  xvrml::LoadOptions options;
  options.limits.expandedNodes = 100'000;
  options.limits.worldBytes = 64 << 20;
  options.limits.inflateBytes = 4 << 20;
  options.limits.nesting = 200;
  const auto world =
      xvrml::loadWorldFromMemory({reinterpret_cast<const char*>(data), size}, name, options);
  const std::string text = xvrml::writeWorld(*world, "", xvrml::Encoding::x3dClassic);
  const auto again = xvrml::loadWorldFromMemory(text, "fuzz.x3dv", options);
  // Numbers that are not finite cannot be written, so the texts are compared.
  if (world->diagnostics.errors() == 0 && again->diagnostics.errors() == 0 &&
      xvrml::writeWorld(*again, "", xvrml::Encoding::x3dClassic) != text)
    __builtin_trap();
  return 0;
} catch (const xvrml::LoadError&) { return 0; }
