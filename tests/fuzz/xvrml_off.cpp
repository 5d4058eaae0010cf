// xvrml_off.cpp: arbitrary bytes as OFF.
#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzzMesh(data, size, "fuzz.off");
}
