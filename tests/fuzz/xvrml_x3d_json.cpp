// xvrml_x3d_json.cpp: parses arbitrary bytes as X3D in JSON. Bytes that are no object are the
// children of a scene, so that every input reaches the reader.
#include "fuzz_world.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  if (size == 0 || text[0] != '{')
    text = "{\"X3D\":{\"@version\":\"3.3\",\"Scene\":{\"-children\":[" + text + "]}}}";
  return fuzzWorld(text, "fuzz.x3dj");
}
