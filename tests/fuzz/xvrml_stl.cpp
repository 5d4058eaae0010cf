// xvrml_stl.cpp: arbitrary bytes as STL.
#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzzMesh(data, size, "fuzz.stl");
}
