// mapper_shader_options.cpp: parses arbitrary text as the options of an ORTShader. libFuzzer calls
// this on one thread.
#include <string>
#include <vector>

#include "xvrml/appearance.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> errors;
  xvrml::parseShaderOptions({text}, errors);
  return 0;
}
