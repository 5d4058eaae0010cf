// xvrml_ply.cpp: arbitrary bytes as PLY.
#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzzMesh(data, size, "fuzz.ply");
}
