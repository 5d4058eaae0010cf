// xvrml_x3d_xml.cpp: parses arbitrary bytes as X3D in XML. Bytes that do not begin as XML are the
// content of a scene, so that every input reaches the reader.
#include "fuzz_world.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  const bool whole = size > 1 && (text[0] == '<' || (data[0] >= 0xfe && data[1] >= 0xfe));
  if (!whole) text = "<X3D version='3.3'><Scene>" + text + "</Scene></X3D>";
  return fuzzWorld(text, "fuzz.x3d");
}
