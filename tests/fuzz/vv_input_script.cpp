// vv_input_script.cpp: parses arbitrary text as a script of --input. Accepted scripts can be
// written and read again. libFuzzer calls this on one thread.
#include <cstdint>
#include <string>

#include "options/values.h"
#include "session/input/input_script.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  const vv::InputScript script =
      vv::parseInputScript({reinterpret_cast<const char*>(data), size}, "fuzz");
  std::string again;
  for (const vv::TimedInput& one : script.events) again += vv::inputLine(one.time, one.event);
  if (vv::parseInputScript(again, "again").events.size() != script.events.size()) __builtin_trap();
  return 0;
} catch (const vv::UsageError&) { return 0; }
