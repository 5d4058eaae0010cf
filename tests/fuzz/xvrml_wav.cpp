// xvrml_wav.cpp: decodes arbitrary bytes as a sound. The header must agree with the samples that
// come out. libFuzzer calls this on one thread.
#include <stdexcept>

#include "behaviour/wav.h"
#include "fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  const FuzzFile file(data, size);
  const xvrml::WavInfo info = xvrml::readWavInfo(file.path());
  if (!(info.duration >= 0) || !(info.rate > 0) || info.channels < 1) __builtin_trap();
  xvrml::readWav(file.path());
  return 0;
} catch (const std::runtime_error&) { return 0; }
