// regular_file.h: opens the files that worlds refer to: pictures, sounds, films, texts. Only
// regular files are opened, because opening or reading a pipe or a device may block for ever. [one
// thread at a time]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace xvrml {

class RegularFile {
 public:
  // Opens a file for reading. Throws std::runtime_error with the reason if it cannot be read: "No
  // such file or directory", "not a regular file". The check uses the opened descriptor, so that
  // the file cannot be exchanged in between.
  explicit RegularFile(const std::string& path);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  // Returns the size in bytes at the time of opening.
  uint64_t size() const { return size_; }
  // Returns the time of the last modification in nanoseconds since 1970.
  int64_t modified() const { return modified_; }
  // Reads up to `count` bytes from offset `at`. Returns the number of bytes read, which is smaller
  // at the end of the file. Throws std::runtime_error if the file cannot be read.
  size_t read(uint64_t at, void* to, size_t count) const;

 private:
  int descriptor_ = -1;
  uint64_t size_ = 0;
  int64_t modified_ = 0;
};

} // namespace xvrml
