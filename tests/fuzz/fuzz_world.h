// fuzz_world.h: what the targets of all readers of worlds do with a file: it is loaded, written and
// loaded again. libFuzzer calls this on one thread.
#pragma once

#include <string>
#include <string_view>

#include "xvrml/world.h"

// Returns limits that keep a run short.
inline xvrml::LoadOptions fuzzOptions() {
  xvrml::LoadOptions options;
  options.limits.expandedNodes = 100'000;
  options.limits.worldBytes = 32 << 20;
  options.limits.inflateBytes = 4 << 20;
  return options;
}

// name: chooses the reader where the bytes do not say what they are.
inline int fuzzWorld(std::string_view bytes, const std::string& name) try {
  const xvrml::LoadOptions options = fuzzOptions();
  const auto world = xvrml::loadWorldFromMemory(bytes, name, options);
  const std::string text = xvrml::writeWorld(*world);
  const auto again = xvrml::loadWorldFromMemory(text, name, options);
  if (world->diagnostics.errors() == 0 && !xvrml::equalScopes(world->scope, again->scope))
    __builtin_trap();
  return 0;
} catch (const xvrml::LoadError&) { return 0; }
