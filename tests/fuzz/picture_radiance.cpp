// picture_radiance.cpp: decodes arbitrary bytes as an HDR picture; the first byte chooses RGBE or
// PFM. libFuzzer calls this on one thread.
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <unistd.h>

#include "fuzz_file.h"
#include "libpicture/files/radiance.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  if (size == 0) return 0;
  const FuzzFile file(data + 1, size - 1);
  // The suffix determines the format, so a link with a suffix is used.
  const std::string link =
      "/dev/shm/openrt-fuzz-" + std::to_string(::getpid()) + (data[0] & 1 ? ".hdr" : ".pfm");
  ::unlink(link.c_str());
  if (::symlink(("/proc/" + std::to_string(::getpid()) + file.path().substr(10)).c_str(),
                link.c_str()) != 0)
    return 0;
  struct Remove {
    const std::string& link;
    ~Remove() { ::unlink(link.c_str()); }
  } remove{link};
  const xvrml::RadianceImage read = picture::readRadiance(link);
  if (read.rgb.size() != size_t(read.width) * size_t(read.height) * 3) __builtin_trap();
  return 0;
} catch (const std::runtime_error&) { return 0; }
