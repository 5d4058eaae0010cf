// openrt_keys.cpp: parses arbitrary bytes as a key file and as a list of admitted keys. libFuzzer
// calls this on one thread.
#include <stdexcept>

#include "backend/cluster/net/keys.h"
#include "fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const FuzzFile file(data, size);
  for (const bool asList : {false, true}) {
    try {
      const openrt::cluster::KeyRing keys =
          openrt::cluster::readKeys(file.path(), asList ? file.path() : "");
      if (keys.empty() || keys.publicKey.size() != 40 || keys.secretKey.size() != 40)
        __builtin_trap();
      for (const std::string& key : keys.allowed)
        if (key.size() != 40) __builtin_trap();
    } catch (const std::runtime_error&) {} // damaged, as expected
  }
  return 0;
}
