// record.cpp: the backend that writes commits to a file, alone or in front of a rendering backend.
// Application thread; cancel, progress and snapshot from any.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

#include "backend/forwarding.h"
#include "backend/record/edits_bytes.h"
#include "backend/record/format.h"

namespace openrt {
namespace {

using namespace recording;

// Writes the file. Every failure throws a std::system_error that names the file.
// * The file is written under a temporary name and renamed after the first commit. So an earlier
//   file survives a full disk, and a program ended by a signal leaves a recording.
// * A device or a pipe is written to directly.
// * After a failure the file ends with the last whole commit.
class RecordingWriter {
 public:
  explicit RecordingWriter(std::string path) : path_(std::move(path)) {
    struct stat status {};
    const bool direct = stat(path_.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
    if (!direct) temporary_ = path_ + ".partial-" + std::to_string(getpid());
    file_ = std::fopen((direct ? path_ : temporary_).c_str(), "wbe");
    if (!file_) failed("cannot be made");
    try {
      FileHeader header{};
      std::memcpy(header.magic, magic, sizeof(magic));
      header.version = version;
      writeBytes(&header, sizeof(header));
      commit();
    } catch (...) {
      end();
      throw;
    }
  }
  ~RecordingWriter() { end(); }
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  void write(const Commit& commit) {
    std::vector<ArrayId> ids; // sorted, so that equal scenes make equal files
    for (const auto& [id, array] : commit.arrays) ids.push_back(id);
    std::sort(ids.begin(), ids.end());
    for (ArrayId id : ids) writeArray(id, *commit.arrays.at(id));
    writeEdits(commit.edits);
    this->commit();
    if (!temporary_.empty() && !name()) failed("cannot be renamed");
  }

  // Closes the file under its final name. No write may follow.
  void finish() {
    // A recording without commits is valid.
    if (!temporary_.empty() && !name()) failed("cannot be renamed");
    if (std::fclose(std::exchange(file_, nullptr)) != 0) failed("cannot be written");
  }

 private:
  void writeArray(ArrayId id, const Array& array) {
    constexpr int fastest = 1;
    packed_.resize(ZSTD_compressBound(array.size()));
    const size_t stored =
        ZSTD_compress(packed_.data(), packed_.size(), array.data(), array.size(), fastest);
    if (ZSTD_isError(stored))
      throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(stored));
    const ChunkHeader header{ChunkKind::Array, 0,      id,
                             array.size(),     stored, XXH3_64bits(array.data(), array.size())};
    writeBytes(&header, sizeof(header));
    writeBytes(packed_.data(), stored);
  }

  void writeEdits(const edit::EditsT& edits) {
    const std::vector<std::byte> packed = packEdits(edits);
    const size_t bytes = packed.size();
    const ChunkHeader header{
        ChunkKind::Edits, 0, 0, bytes, bytes, XXH3_64bits(packed.data(), bytes)};
    writeBytes(&header, sizeof(header));
    writeBytes(packed.data(), bytes);
  }

  void writeBytes(const void* data, size_t bytes) {
    if (bytes > 0 && std::fwrite(data, 1, bytes, file_) != bytes) failed("cannot be written");
  }
  // Flushes everything written so far to the file.
  void commit() {
    if (std::fflush(file_) != 0) failed("cannot be written");
    completeBytes_ = ftello(file_);
  }
  bool name() {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) return false;
    temporary_.clear();
    return true;
  }
  // Closes the file if it is open. Cuts off an incomplete commit and removes a file that was not
  // renamed.
  void end() {
    if (file_) {
      const int descriptor = good_ ? -1 : dup(fileno(file_));
      // Either an error was reported before, or finish() was not called.
      std::fclose(std::exchange(file_, nullptr));
      if (descriptor >= 0) {
        (void)!ftruncate(descriptor, completeBytes_); // has no effect on devices
        close(descriptor);
      }
    }
    if (!temporary_.empty()) std::remove(temporary_.c_str());
  }
  [[noreturn]] void failed(const char* what) {
    good_ = false;
    throw std::system_error(errno, std::generic_category(), "recording " + path_ + " " + what);
  }

  std::string path_, temporary_; // temporary_ is empty once the file is renamed
  std::FILE* file_ = nullptr;
  off_t completeBytes_ = 0; // file size at the end of the last commit
  bool good_ = true;
  std::vector<char> packed_;
};

// Records commits. The backend behind it gets the same calls as without recording.
class RecordBackend final : public ForwardingBackend {
 public:
  // renders: the backend behind it makes pictures, so that it goes on where a write fails.
  RecordBackend(const BackendOptions& options, std::unique_ptr<Backend> to, bool renders)
      : ForwardingBackend(std::move(to)), writer_(std::make_unique<RecordingWriter>(options.file)),
        renders_(renders) {}

  // A failed write ends the recording.
  void apply(std::shared_ptr<const Commit> commit) override {
    if (writer_) {
      try {
        writer_->write(*commit);
      } catch (...) {
        writer_.reset();
        throw;
      }
    } else if (!renders_) {
      throw std::system_error(std::make_error_code(std::errc::io_error),
                              "the recording has ended with an error");
    }
    ForwardingBackend::apply(std::move(commit));
  }

  void finish() override {
    const std::unique_ptr<RecordingWriter> writer = std::move(writer_);
    if (writer) writer->finish();
    ForwardingBackend::finish();
  }

 private:
  std::unique_ptr<RecordingWriter> writer_;
  bool renders_;
};

} // namespace

std::unique_ptr<Backend> makeRecordBackend(const BackendOptions& options) {
  return std::make_unique<RecordBackend>(options, makeNullBackend(options), false);
}

std::unique_ptr<Backend> makeTeeBackend(const BackendOptions& options,
                                        std::unique_ptr<Backend> renderer) {
  return std::make_unique<RecordBackend>(options, std::move(renderer), true);
}

} // namespace openrt
