// xvrml_gltf.cpp: arbitrary bytes as glTF, text or binary.
#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzzMesh(data, size, "fuzz.gltf");
}
