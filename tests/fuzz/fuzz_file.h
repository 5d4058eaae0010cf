// fuzz_file.h: makes the fuzzer's bytes available under a file path, for readers that open files
// themselves. The file lies in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

class FuzzFile {
 public:
  FuzzFile(const uint8_t* data, size_t size) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    if (descriptor_ < 0) std::abort();
    ::fchmod(descriptor_, 0600); // key files that others may read are refused
    while (size > 0) {
      const ssize_t done = ::write(descriptor_, data, size);
      if (done <= 0) std::abort();
      data += done;
      size -= size_t(done);
    }
  }
  ~FuzzFile() { ::close(descriptor_); }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};
