// regular_file.cpp: opens with O_NONBLOCK, so that the open of a pipe returns at once. The flag has
// no effect on regular files.
#include "base/regular_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system/files.h"

namespace xvrml {
namespace {

[[noreturn]] void fail(int reason) { throw std::runtime_error(std::strerror(reason)); }

} // namespace

RegularFile::RegularFile(const std::string& path)
    : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
  if (descriptor_ < 0) fail(errno);
  struct stat status {};
  const bool known = fstat(descriptor_, &status) == 0;
  const int reason = errno;
  if (!known || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    if (!known) fail(reason);
    throw std::runtime_error(S_ISDIR(status.st_mode) ? "a folder, not a file"
                                                     : "not a regular file");
  }
  size_ = uint64_t(std::max<off_t>(status.st_size, 0));
  const timespec modified = os::modifiedTime(status);
  modified_ = int64_t(modified.tv_sec) * 1'000'000'000 + modified.tv_nsec;
}

RegularFile::~RegularFile() { ::close(descriptor_); }

size_t RegularFile::read(uint64_t at, void* to, size_t count) const {
  size_t done = 0;
  while (done < count) {
    constexpr size_t most = 1 << 30; // Linux reads at most 2 GiB at once
    const ssize_t got = ::pread(descriptor_, static_cast<char*>(to) + done,
                                std::min(count - done, most), off_t(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(errno);
    if (got == 0) break;
    done += size_t(got);
  }
  return done;
}

} // namespace xvrml
