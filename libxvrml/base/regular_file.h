// regular_file.h: opens the files that worlds name: pictures, sounds, films, texts. Only regular
// files are opened, because the open or the read of a pipe or a device may wait for ever. [one
// thread at a time]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace xvrml {

class RegularFile {
 public:
  // Opens a file for reading. Throws std::runtime_error that says why it cannot be read: "No such
  // file or directory", "not a regular file". The check is made on what was opened, so that nobody
  // can exchange the file in between.
  explicit RegularFile(const std::string& path);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  // Returns the size in bytes that the file had when it was opened.
  uint64_t size() const { return size_; }
  // Returns the time of the last change in nanoseconds since 1970.
  int64_t modified() const { return modified_; }
  // Reads up to `count` bytes from `at` on. Returns how many came, which is less at the end of the
  // file. Throws std::runtime_error if the file cannot be read.
  size_t read(uint64_t at, void* to, size_t count) const;

 private:
  int descriptor_ = -1;
  uint64_t size_ = 0;
  int64_t modified_ = 0;
};

} // namespace xvrml
