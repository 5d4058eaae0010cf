// xvrml_obj.cpp: arbitrary bytes as OBJ.
#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzzMesh(data, size, "fuzz.obj");
}
