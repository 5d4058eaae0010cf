// xvrml_vrml.cpp: parses arbitrary bytes as a world; the reader is that of VRML97 unless they say
// otherwise.
#include "fuzz_world.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzzWorld({reinterpret_cast<const char*>(data), size}, "fuzz.wrl");
}
