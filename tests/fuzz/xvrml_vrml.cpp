// xvrml_vrml.cpp: parses arbitrary bytes as a world, which is loaded, written and loaded again.
// libFuzzer calls this on one thread.
#include "xvrml/world.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  xvrml::LoadOptions options;
  options.limits.expandedNodes = 100'000;
  options.limits.worldBytes = 32 << 20;
  options.limits.inflateBytes = 4 << 20;
  const auto world =
      xvrml::loadWorldFromMemory({reinterpret_cast<const char*>(data), size}, "fuzz.wrl", options);
  const std::string text = xvrml::writeWorld(*world);
  const auto again = xvrml::loadWorldFromMemory(text, "fuzz.wrl", options);
  if (world->diagnostics.errors() == 0 && !xvrml::equalScopes(world->scope, again->scope))
    __builtin_trap();
  return 0;
} catch (const xvrml::LoadError&) { return 0; }
