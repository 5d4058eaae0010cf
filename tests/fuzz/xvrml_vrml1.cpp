// xvrml_vrml1.cpp: reads arbitrary bytes as the text of a world in VRML 1.0, writes the graph as
// VRML97 and reads that. libFuzzer calls this on one thread.
#include <string>

#include "xvrml/world.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  xvrml::LoadOptions options;
  options.limits.expandedNodes = 100'000;
  options.limits.worldBytes = 32 << 20;
  options.limits.inflateBytes = 4 << 20;
  const std::string bytes =
      "#VRML V1.0 ascii\n" + std::string(reinterpret_cast<const char*>(data), size);
  const auto world = xvrml::loadWorldFromMemory(bytes, "fuzz.wrl", options);
  const std::string text = xvrml::writeWorld(*world);
  if (!world->scope.roots.empty() &&
      xvrml::loadWorldFromMemory(text, "fuzz.wrl", options)->scope.roots.empty())
    __builtin_trap(); // what is written can be read
  return 0;
} catch (const xvrml::LoadError&) { return 0; }
