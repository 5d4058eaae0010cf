// xvrml_script_messages.cpp: decodes arbitrary bytes as messages of a script helper process to the
// browser: framing, calls of host functions, values.
#include "../script/looking_host.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr size_t most = 100'000; // fits into the socket's buffer
  if (size > most) return -1;
  xvrml::callThatGets(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
