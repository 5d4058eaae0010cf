#include "libpicture/files/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace picture {

namespace {

// The name of a temporary file, where a signal handler finds it: no lock and no memory of the heap
// may be needed. Each write uses one place; `exists` publishes the name.
struct Place {
  std::atomic<bool> taken{false}, exists{false};
  char name[PATH_MAX] = {};
};
// More writes at a time than this are possible, but a signal leaves the files of the others behind.
constexpr size_t mostPlaces = 64;
Place places[mostPlaces];

std::mutex keptMutex; // guards `kept`
// protected files: device and inode, description
std::map<std::pair<dev_t, ino_t>, std::string> kept;

std::string whyProtected(const std::string& path, const struct stat& info) {
  const std::lock_guard lock(keptMutex);
  const auto found = kept.find({info.st_dev, info.st_ino});
  return found == kept.end()
             ? ""
             : "cannot write " + path + ": it is " + found->second + "; another name is needed";
}

// Lets the file that now has this name inherit the protection of the one that had it before.
void passProtection(const struct stat& before, const std::string& path) {
  struct stat info;
  const std::lock_guard lock(keptMutex);
  auto found = kept.extract({before.st_dev, before.st_ino});
  if (found.empty() || ::stat(path.c_str(), &info) != 0) return;
  found.key() = {info.st_dev, info.st_ino};
  kept.insert(std::move(found));
}

[[noreturn]] void fail(const std::string& path, int reason) {
  throw std::runtime_error("cannot write " + path + ": " + std::strerror(reason));
}

std::string folderOf(const std::string& path) {
  size_t slash = path.rfind('/');
  if (slash == path.npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// Returns whether a path is still a link after followLinks(): the links lead in a circle.
bool isLink(const std::string& path) {
  struct stat info;
  return ::stat(path.c_str(), &info) != 0 && ::lstat(path.c_str(), &info) == 0 &&
         S_ISLNK(info.st_mode);
}

// write(descriptor): writes the content.
template <class Write> void writeDirectly(const std::string& path, const Write& write) {
  int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, errno);
  try {
    write(descriptor);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (::close(descriptor) != 0) fail(path, errno);
}

// A temporary file beside the file that it will replace. Unless it has been moved there, it is
// removed.
class Temporary {
 public:
  // path: the file as the caller calls it, for messages; target: the file that is replaced.
  Temporary(const std::string& path, const std::string& target) : path_(path) {
    const std::string base = folderOf(target) + "/.vv-" + std::to_string(::getpid()) + "-";
    for (int i = 0; i < 1000 && descriptor_ < 0; ++i) {
      name_ = base + std::to_string(i);
      if (name_.size() >= PATH_MAX) fail(path, ENAMETOOLONG);
      descriptor_ = openNew(name_, 0666);
      if (descriptor_ < 0 && errno != EEXIST) fail(path, errno);
    }
    if (descriptor_ < 0) fail(path, EEXIST);
    publish();
  }
  ~Temporary() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!moved_) ::unlink(name_.c_str());
    if (!place_) return;
    place_->exists = false;
    place_->taken = false;
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  int descriptor() const { return descriptor_; }
  // Waits until the bytes are on the disk. Throws std::runtime_error.
  void sync() {
    if (::fsync(descriptor_) != 0) fail(path_, errno);
  }
  // Closes the file and gives it the name of the target. Throws std::runtime_error.
  void moveTo(const std::string& target) {
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(path_, errno);
    if (::rename(name_.c_str(), target.c_str()) != 0) fail(path_, errno);
    moved_ = true;
  }

 private:
  void publish() {
    for (Place& place : places) {
      if (place.taken.exchange(true)) continue;
      place_ = &place;
      std::memcpy(place.name, name_.c_str(), name_.size() + 1);
      place.exists = true;
      return;
    }
  }

  const std::string path_;
  std::string name_;
  int descriptor_ = -1;
  bool moved_ = false;
  Place* place_ = nullptr; // null: all places are taken
};

} // namespace

std::string followLinks(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (const fs::path real = fs::canonical(path, error); !error) return real.string();
  struct stat info;
  if (::stat(path.c_str(), &info) == 0) return path; // a pipe, whose link in /proc leads nowhere
  constexpr int mostLinks = 40;                      // as in Linux
  fs::path at = path;
  for (int i = 0; i < mostLinks && fs::is_symlink(at, error); ++i) {
    const fs::path to = fs::read_symlink(at, error);
    if (error) return path;
    at = at.parent_path() / to; // an absolute one replaces the folder
  }
  return at.string();
}

int openNew(const std::string& path, unsigned rights) {
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, rights);
}

void writeDescriptor(int descriptor, std::string_view bytes, const std::string& name) {
  while (!bytes.empty()) {
    // Linux writes at most 2 GiB in one call.
    ssize_t done = ::write(descriptor, bytes.data(), std::min<size_t>(bytes.size(), 1u << 30));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(name, errno);
    bytes.remove_prefix(size_t(done));
  }
}

namespace {

enum class Targets : uint8_t {
  any,
  regular, // no devices and no pipes
  edited   // regular files, also protected ones
};

template <class Write>
void replaceFile(const std::string& path, const Write& write, Wait wait, Targets targets) {
  const std::string target = followLinks(path);
  struct stat info;
  const bool exists = ::stat(target.c_str(), &info) == 0;
  if (isLink(target)) fail(path, ELOOP);
  if (exists && S_ISDIR(info.st_mode)) fail(path, EISDIR);
  if (exists && !S_ISREG(info.st_mode) && targets != Targets::any)
    throw std::runtime_error(whyNotRegular(path));
  if (exists && !S_ISREG(info.st_mode)) return writeDirectly(path, write);
  if (exists && targets != Targets::edited)
    if (const std::string why = whyProtected(path, info); !why.empty())
      throw std::runtime_error(why);
  if (exists && ::access(target.c_str(), W_OK) != 0) fail(path, errno);

  Temporary temporary(path, target);
  if (exists) (void)!::fchmod(temporary.descriptor(), info.st_mode & 0777);
  write(temporary.descriptor());
  if (wait == Wait::disk) temporary.sync();
  temporary.moveTo(target);
  if (exists && targets == Targets::edited) passProtection(info, target);
}

void replaceFile(const std::string& path, std::string_view bytes, Wait wait, Targets targets) {
  const auto write = [&](int descriptor) { writeDescriptor(descriptor, bytes, path); };
  replaceFile(path, write, wait, targets);
}

} // namespace

void writeFile(const std::string& path, std::string_view bytes, Wait wait) {
  replaceFile(path, bytes, wait, Targets::any);
}

void writeFile(const std::string& path, std::span<const std::string> pieces) {
  const auto write = [&](int descriptor) {
    for (const std::string& piece : pieces) writeDescriptor(descriptor, piece, path);
  };
  replaceFile(path, write, Wait::no, Targets::any);
}

std::string whyNotRegular(const std::string& path) {
  struct stat info;
  if (::stat(path.c_str(), &info) != 0 || S_ISREG(info.st_mode) || S_ISDIR(info.st_mode)) return "";
  return "cannot write " + path + ": it is a pipe or a device; a regular file was expected";
}

void writeRegularFile(const std::string& path, std::string_view bytes, Wait wait) {
  replaceFile(path, bytes, wait, Targets::regular);
}

void writeEditedFile(const std::string& path, std::string_view bytes) {
  replaceFile(path, bytes, Wait::disk, Targets::edited);
}

void protectFile(const std::string& path, const std::string& what) {
  struct stat info;
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return;
  const std::lock_guard lock(keptMutex);
  kept.try_emplace({info.st_dev, info.st_ino}, what);
}

namespace {

std::string whyNot(const std::string& path, Targets targets) {
  const std::string target = followLinks(path);
  struct stat info;
  int reason = 0;
  if (::stat(target.c_str(), &info) == 0) {
    if (S_ISDIR(info.st_mode))
      reason = EISDIR;
    else if (::access(target.c_str(), W_OK) != 0)
      reason = errno;
    if (!reason && !S_ISREG(info.st_mode)) return "";
    if (!reason && targets != Targets::edited)
      if (const std::string why = whyProtected(path, info); !why.empty()) return why;
  }
  if (!reason && isLink(target)) reason = ELOOP;
  const std::string folder = folderOf(target);
  if (!reason && ::stat(folder.c_str(), &info) == 0 && !S_ISDIR(info.st_mode)) reason = ENOTDIR;
  if (!reason && ::access(folder.c_str(), W_OK | X_OK) != 0) reason = errno;
  return reason ? "cannot write " + path + ": " + std::strerror(reason) : "";
}

} // namespace

std::string whyNotWritable(const std::string& path) { return whyNot(path, Targets::any); }
std::string whyNotEditable(const std::string& path) { return whyNot(path, Targets::edited); }

void removeTemporaries() noexcept {
  for (Place& place : places)
    if (place.exists.exchange(false)) ::unlink(place.name);
}

} // namespace picture
