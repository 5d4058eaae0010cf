// array_folder.h: a folder in which workers keep the arrays that they have been sent, so that they
// need not be sent again after a restart, nor to other workers that use the same folder. A file is
// an array as packed for sending (zstd), named by the array's hash; `zstd -t` accepts it. Several
// processes and machines may use a folder at once: a file appears complete, by a rename, and is
// checked by its hash when it is read. [any]
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "backend/cluster/messages/messages.h"

namespace openrt::cluster {

// An open file; the destructor closes it.
class FileHandle {
 public:
  explicit FileHandle(int fd = -1) : fd_(fd) {}
  FileHandle(FileHandle&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileHandle& operator=(FileHandle&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileHandle();
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

class ArrayFolder {
 public:
  // Opens the folder, or makes it with rights for this user alone. bytes: about how many the files
  // may have together. log: receives warnings, on any thread; may be empty. Throws
  // std::runtime_error with a message for the user: among others if another user owns the folder or
  // may write there. One in which this user may not write gives what it has, after a warning.
  ArrayFolder(const std::string& path, uint64_t bytes,
              std::function<void(int level, const std::string& text)> log);
  ArrayFolder(const ArrayFolder&) = delete;
  ArrayFolder& operator=(const ArrayFolder&) = delete;

  // Returns the array; null if the folder does not have it. A file with other contents is removed.
  ArrayPtr load(const Hash& hash, uint64_t bytes);

  // A file to be sent to another worker, which checks it.
  struct Stored {
    FileHandle file;
    uint64_t stored = 0; // bytes of the file
    // Reads the piece at an offset. Returns false if the file no longer has these bytes.
    bool read(uint64_t offset, std::vector<std::byte>& piece) const;
  };
  // Returns the file of an array; nothing if there is none that can be one of this size. The size
  // may come from a stranger: only an empty file is removed.
  std::optional<Stored> open(const Hash& hash, uint64_t bytes);
  // Counts and removes a file whose contents are wrong.
  void discard(const Hash& hash);

  // A file that is being written. It has no name that anybody looks for until keep() is called.
  class Writer {
   public:
    Writer(ArrayFolder& folder, const Hash& hash, uint64_t stored);
    ~Writer(); // removes the file unless it was kept
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    // Appends bytes. After an error, for example of a full disk, the rest is ignored.
    void write(std::span<const std::byte> bytes);
    void keep(); // call it when the contents have been checked

   private:
    void fail(int error);
    ArrayFolder& folder_;
    Hash hash_;
    uint64_t stored_;
    std::string name_; // the unfinished file's; empty: none
    FileHandle file_;
  };

  uint64_t limit() const { return limit_; }
  uint64_t damaged() const { return damaged_; } // files whose contents were wrong

 private:
  std::optional<Stored> find(const Hash& hash) const;
  bool remove(const std::string& name) const;
  void added(uint64_t bytes);
  void shrink(); // removes the files that were not used for longest
  void warnOnce(const std::string& text);

  std::string path_;
  uint64_t limit_;
  std::function<void(int level, const std::string& text)> log_;
  FileHandle folder_;
  std::atomic<uint64_t> damaged_{0};
  std::mutex mutex_;       // guards the members below
  uint64_t sinceLook_ = 0; // bytes written since shrink() looked last
  bool warned_ = false;
};

} // namespace openrt::cluster
