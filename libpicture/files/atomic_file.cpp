#include "libpicture/files/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace picture {

namespace {

char temporaryName[PATH_MAX];
std::atomic<bool> temporaryExists{false};

// protected files: device and inode, description
std::map<std::pair<dev_t, ino_t>, std::string> kept;

std::string whyProtected(const std::string& path, const struct stat& info) {
  const auto found = kept.find({info.st_dev, info.st_ino});
  return found == kept.end()
             ? ""
             : "cannot write " + path + ": it is " + found->second + "; another name is needed";
}

[[noreturn]] void fail(const std::string& path, int reason) {
  throw std::runtime_error("cannot write " + path + ": " + std::strerror(reason));
}

std::string folderOf(const std::string& path) {
  size_t slash = path.rfind('/');
  if (slash == path.npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// Resolves symbolic links, so that the link stays and its target is replaced.
std::string followLinks(const std::string& path) {
  char* real = ::realpath(path.c_str(), nullptr);
  if (!real) return path;
  std::string result(real);
  std::free(real);
  return result;
}

void writeDirectly(const std::string& path, std::string_view bytes) {
  int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, errno);
  try {
    writeDescriptor(descriptor, bytes, path);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (::close(descriptor) != 0) fail(path, errno);
}

int makeTemporary(const std::string& path, const std::string& target, mode_t mode) {
  const std::string base = folderOf(target) + "/.vv-" + std::to_string(::getpid()) + "-";
  for (int i = 0; i < 1000; ++i) {
    const std::string name = base + std::to_string(i);
    if (name.size() >= sizeof temporaryName) fail(path, ENAMETOOLONG);
    std::memcpy(temporaryName, name.c_str(), name.size() + 1);
    int descriptor = ::open(temporaryName, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor >= 0) {
      temporaryExists = true;
      return descriptor;
    }
    if (errno != EEXIST) fail(path, errno);
  }
  fail(path, EEXIST);
}

} // namespace

void writeDescriptor(int descriptor, std::string_view bytes, const std::string& name) {
  while (!bytes.empty()) {
    // Linux writes at most 2 GiB in one call.
    ssize_t done = ::write(descriptor, bytes.data(), std::min<size_t>(bytes.size(), 1u << 30));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(name, errno);
    bytes.remove_prefix(size_t(done));
  }
}

void writeFile(const std::string& path, std::string_view bytes) {
  const std::string target = followLinks(path);
  struct stat info;
  const bool exists = ::stat(target.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) fail(path, EISDIR);
  if (exists && !S_ISREG(info.st_mode)) return writeDirectly(path, bytes);
  if (exists)
    if (const std::string why = whyProtected(path, info); !why.empty())
      throw std::runtime_error(why);
  if (exists && ::access(target.c_str(), W_OK) != 0) fail(path, errno);

  int descriptor = makeTemporary(path, target, 0666);
  if (exists) (void)!::fchmod(descriptor, info.st_mode & 0777);
  int reason = 0;
  try {
    writeDescriptor(descriptor, bytes, path);
  } catch (...) {
    ::close(descriptor);
    removeTemporary();
    throw;
  }
  if (::close(descriptor) != 0) reason = errno;
  if (!reason && ::rename(temporaryName, target.c_str()) != 0) reason = errno;
  if (reason) {
    removeTemporary();
    fail(path, reason);
  }
  temporaryExists = false;
}

void protectFile(const std::string& path, const std::string& what) {
  struct stat info;
  if (::stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode))
    kept.try_emplace({info.st_dev, info.st_ino}, what);
}

std::string whyNotWritable(const std::string& path) {
  const std::string target = followLinks(path);
  struct stat info;
  int reason = 0;
  if (::stat(target.c_str(), &info) == 0) {
    if (S_ISDIR(info.st_mode))
      reason = EISDIR;
    else if (::access(target.c_str(), W_OK) != 0)
      reason = errno;
    if (!reason && !S_ISREG(info.st_mode)) return "";
    if (const std::string why = whyProtected(path, info); !reason && !why.empty()) return why;
  }
  const std::string folder = folderOf(target);
  if (!reason && ::stat(folder.c_str(), &info) == 0 && !S_ISDIR(info.st_mode)) reason = ENOTDIR;
  if (!reason && ::access(folder.c_str(), W_OK | X_OK) != 0) reason = errno;
  return reason ? "cannot write " + path + ": " + std::strerror(reason) : "";
}

void removeTemporary() noexcept {
  if (temporaryExists.exchange(false)) ::unlink(temporaryName);
}

} // namespace picture
