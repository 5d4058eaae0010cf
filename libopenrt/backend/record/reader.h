// reader.h: reads recordings (format.h) back into commits. The file is not trusted: every size,
// hash, reference and number is checked before a backend sees it. A failed check throws
// BadRecording with its position. One thread.
#pragma once

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "backend/record/validator.h"
#include "scene/commit.h"

namespace openrt {

class BadRecording : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct RecordingLimits {
  uint64_t arrayBytes = uint64_t(1) << 34; // limit for one array
  uint64_t totalBytes = uint64_t(1) << 36; // limit for all arrays and edits together
  uint64_t editBytes = uint64_t(1) << 30;  // limit for the edits of one commit
  uint64_t commits = 10'000'000;
};

class RecordingReader {
 public:
  // Takes ownership of the file, which must be readable from its beginning. shaders: used to check
  // parameters and shader kinds; may be null.
  RecordingReader(std::FILE* file, std::string name, const ShaderRegistry* shaders,
                  const RecordingLimits& limits = {});

  // Returns the next commit, or null at the end of the file.
  std::shared_ptr<const Commit> next();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail(const std::string& what) const;
  bool read(void* out, size_t bytes, bool mayEnd);
  std::vector<uint8_t> readPayload(uint64_t bytes);
  void readArray(uint64_t id, uint64_t bytes, uint64_t stored, uint64_t hash, Commit& commit);
  void readEdits(uint64_t bytes, uint64_t stored, uint64_t hash, Commit& commit);
  void countBytes(uint64_t bytes);

  std::unique_ptr<std::FILE, Close> file_;
  std::string name_;
  RecordingLimits limits_;
  CommitValidator validator_;
  uint64_t offset_ = 0, total_ = 0, commits_ = 0;
};

// Opens a recording; throws BadRecording if it cannot be read.
std::unique_ptr<RecordingReader> openRecording(const std::string& path,
                                               const ShaderRegistry* shaders);

} // namespace openrt
