#include "backend/cluster/worker/array_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <vector>

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "backend/cluster/worker/array_cache.h"
#include "system/files.h"
#include "system/random.h"

namespace openrt::cluster {
namespace {

constexpr std::string_view suffix = ".zst", unfinished = ".part";
constexpr size_t hexDigits = 32;
constexpr double abandoned = 3600; // age in seconds of an unfinished file that nobody writes

std::string nameOf(const Hash& hash) { return hex(hash) + std::string(suffix); }

// Returns whether a file has a name that this class gives, so that no other file is ever removed.
bool isOurs(std::string_view name, std::string_view ending) {
  return name.size() == hexDigits + ending.size() && name.ends_with(ending) &&
         name.find_first_not_of("0123456789abcdef") == hexDigits;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::runtime_error("the folder of arrays " + path + ": " + why);
}

// Opens the folder itself, not what a link of this name points to.
FileHandle openFolder(const std::string& path) {
  if (::mkdir(path.c_str(), S_IRWXU) != 0 && errno != EEXIST) refuse(path, std::strerror(errno));
  FileHandle folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!folder)
    refuse(path, errno == ELOOP || errno == ENOTDIR ? "it is no folder, or a link"
                                                    : std::strerror(errno));
  struct stat info;
  if (::fstat(folder.get(), &info) != 0) refuse(path, std::strerror(errno));
  if (info.st_uid != ::geteuid()) refuse(path, "it belongs to another user");
  if (info.st_mode & (S_IWGRP | S_IWOTH))
    refuse(path, "other users may write there: chmod go-w " + path);
  if (::faccessat(folder.get(), ".", X_OK, AT_EACCESS) != 0) refuse(path, std::strerror(errno));
  return folder;
}

struct CloseDir {
  void operator()(DIR* dir) const { ::closedir(dir); }
};

struct Found { // a file of the folder
  std::string name;
  uint64_t bytes = 0;
  timespec used{};
  bool operator<(const Found& other) const {
    return std::pair(used.tv_sec, used.tv_nsec) < std::pair(other.used.tv_sec, other.used.tv_nsec);
  }
};

// Returns the files that this class has made. Links and other kinds of files are left alone.
std::vector<Found> filesOf(int folder) {
  std::vector<Found> found;
  const int again = ::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const std::unique_ptr<DIR, CloseDir> dir(again < 0 ? nullptr : ::fdopendir(again));
  if (!dir) {
    if (again >= 0) ::close(again);
    return found;
  }
  while (const dirent* entry = ::readdir(dir.get())) {
    const std::string name = entry->d_name;
    struct stat info;
    if ((!isOurs(name, suffix) && !isOurs(name, unfinished)) ||
        ::fstatat(folder, name.c_str(), &info, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(info.st_mode))
      continue;
    found.push_back({name, uint64_t(info.st_size), os::modifiedTime(info)});
  }
  return found;
}

} // namespace

FileHandle::~FileHandle() {
  if (fd_ >= 0) ::close(fd_);
}

ArrayFolder::ArrayFolder(const std::string& path, uint64_t bytes,
                         std::function<void(int level, const std::string& text)> log)
    : path_(path), limit_(bytes), log_(std::move(log)), folder_(openFolder(path)) {
  if (::faccessat(folder_.get(), ".", W_OK, AT_EACCESS) != 0)
    warnOnce(std::string("what it has is used, and nothing is added: ") + std::strerror(errno));
  else
    shrink();
}

bool ArrayFolder::remove(const std::string& name) const {
  return ::unlinkat(folder_.get(), name.c_str(), 0) == 0;
}

void ArrayFolder::warnOnce(const std::string& text) {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(warned_, true)) return;
  }
  if (log_) log_(2, "the folder of arrays " + path_ + ": " + text);
}

// Returns the file of this user, whatever it holds.
std::optional<ArrayFolder::Stored> ArrayFolder::find(const Hash& hash) const {
  // O_NONBLOCK: a pipe of this name could wait for ever.
  FileHandle file(::openat(folder_.get(), nameOf(hash).c_str(),
                           O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat info;
  if (!file || ::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode) ||
      info.st_uid != ::geteuid())
    return std::nullopt;
  return Stored{std::move(file), uint64_t(info.st_size)};
}

std::optional<ArrayFolder::Stored> ArrayFolder::open(const Hash& hash, uint64_t bytes) {
  std::optional<Stored> found = find(hash);
  if (found && found->stored == 0) discard(hash); // a machine has crashed (Writer::keep)
  if (!found || bytes > limits::arrayBytes || !plausible(bytes, found->stored)) return std::nullopt;
  return found;
}

void ArrayFolder::discard(const Hash& hash) {
  damaged_++;
  const bool removed = remove(nameOf(hash));
  warnOnce(std::string("a file was damaged and ") +
           (removed ? "is removed: " : "cannot be removed: ") + nameOf(hash));
}

bool ArrayFolder::Stored::read(uint64_t offset, std::vector<std::byte>& piece) const {
  piece.resize(size_t(std::min<uint64_t>(pieceBytes, stored - offset)));
  for (size_t done = 0; done < piece.size();) {
    const ssize_t n =
        ::pread(file.get(), piece.data() + done, piece.size() - done, off_t(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false; // somebody has cut the file, or the disk has failed
    done += size_t(n);
  }
  return true;
}

ArrayPtr ArrayFolder::load(const Hash& hash, uint64_t bytes) {
  const std::optional<Stored> found = find(hash);
  if (!found || bytes > limits::arrayBytes) return nullptr;
  if (!plausible(bytes, found->stored)) {
    discard(hash);
    return nullptr;
  }
  ArrayStream stream(hash, bytes);
  message::Piece piece;
  piece.hash = hash;
  piece.bytes = bytes;
  piece.stored = found->stored;
  bool good = true;
  try {
    for (; good && piece.offset < found->stored; piece.offset += pieceBytes)
      good = found->read(piece.offset, piece.data) && stream.put(piece).empty();
  } catch (const std::bad_alloc&) { return nullptr; } // the file is not to blame
  ArrayPtr array = good ? stream.take() : nullptr;
  if (array) {
    ::futimens(found->file.get(), nullptr); // it was used now
    return array;
  }
  discard(hash);
  return nullptr;
}

void ArrayFolder::added(uint64_t bytes) {
  constexpr uint64_t share = 64; // part of the limit after which the folder is looked at again
  {
    const std::lock_guard lock(mutex_);
    sinceLook_ += bytes;
    if (sinceLook_ < limit_ / share) return;
    sinceLook_ = 0;
  }
  shrink();
}

void ArrayFolder::shrink() {
  std::vector<Found> files = filesOf(folder_.get());
  uint64_t sum = 0;
  const time_t now = os::fileClock().tv_sec;
  for (Found& file : files) {
    if (isOurs(file.name, unfinished) && double(now - file.used.tv_sec) > abandoned) {
      remove(file.name);
      file.bytes = 0;
    }
    sum += file.bytes;
  }
  std::sort(files.begin(), files.end());
  for (const Found& file : files) {
    if (sum <= limit_) return;
    if (!isOurs(file.name, suffix)) continue; // somebody writes it
    remove(file.name);
    sum -= file.bytes;
  }
}

ArrayFolder::Writer::Writer(ArrayFolder& folder, const Hash& hash, uint64_t stored)
    : folder_(folder), hash_(hash), stored_(stored) {
  if (stored > folder.limit_) return; // nobody could ever find it again
  Hash random;
  try {
    os::fillRandomly(reinterpret_cast<unsigned char*>(&random), sizeof random);
  } catch (const std::system_error& e) {
    fail(e.code().value());
    return;
  }
  name_ = hex(random) + std::string(unfinished);
  file_ =
      FileHandle(::openat(folder.folder_.get(), name_.c_str(),
                          O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (!file_) {
    name_.clear();
    fail(errno);
  }
}

ArrayFolder::Writer::~Writer() {
  if (!name_.empty()) folder_.remove(name_);
}

void ArrayFolder::Writer::fail(int error) {
  if (!name_.empty()) folder_.remove(std::exchange(name_, {}));
  file_ = FileHandle();
  folder_.warnOnce(std::string("an array cannot be kept: ") + std::strerror(error));
}

void ArrayFolder::Writer::write(std::span<const std::byte> bytes) {
  for (size_t done = 0; file_ && done < bytes.size();) {
    const ssize_t n = ::write(file_.get(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return fail(n < 0 ? errno : ENOSPC);
    done += size_t(n);
  }
}

// A crash of the machine may leave a file with a name and without its contents. Its hash tells.
void ArrayFolder::Writer::keep() {
  if (name_.empty()) return;
  if (::renameat(folder_.folder_.get(), name_.c_str(), folder_.folder_.get(),
                 nameOf(hash_).c_str()) != 0)
    return fail(errno);
  name_.clear();
  file_ = FileHandle();
  folder_.added(stored_);
}

} // namespace openrt::cluster
