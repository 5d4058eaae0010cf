// xvrml_script_messages.cpp: what a helper process for Scripts may say to the browser, from bytes:
// framing, calls of the host's functions, values.
#include "../script/looking_host.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr size_t most = 100'000; // fits into the socket
  if (size > most) return -1;
  xvrml::callThatGets(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
