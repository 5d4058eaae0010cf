#include "edit/journal_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "libpicture/files/atomic_file.h"

namespace vv {

namespace fs = std::filesystem;

namespace {

constexpr int mostJournals = 9; // beside one file
constexpr std::string_view firstLine = "vv edits 1\n";
constexpr size_t longestHead = 200;
constexpr const char* freshSuffix = ".new"; // names the file that takes its place

// A descriptor that is closed with this object.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

[[noreturn]] void fail(const char* what, const std::string& path, int reason) {
  throw std::runtime_error(fmt::format("cannot {} {}: {}", what, path, std::strerror(reason)));
}

[[noreturn]] void refuse(const std::string& path, const char* why) {
  throw std::runtime_error(fmt::format("{} is not used: {}", path, why));
}

// The file itself is edited, and not a link to it.
std::string pathOf(const std::string& world, int number) {
  const std::string target = picture::followLinks(world);
  const size_t name = target.rfind('/') + 1; // 0 without a slash
  const std::string suffix = number == 1 ? "" : fmt::format("-{}", number);
  return target.substr(0, name) + "." + target.substr(name) + ".vv-edits" + suffix;
}

bool exists(const std::string& path) {
  struct stat info;
  return ::lstat(path.c_str(), &info) == 0;
}

// Returns whether an open file still has this name.
bool isAt(int descriptor, const std::string& path) {
  struct stat own, there;
  return ::fstat(descriptor, &own) == 0 && ::lstat(path.c_str(), &there) == 0 &&
         own.st_dev == there.st_dev && own.st_ino == there.st_ino;
}

// A file system without locks has one program at a time.
bool lock(int descriptor) {
  return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

std::string head(const TextStamp& base, std::string_view text) {
  const TextStamp own = stampOf(text);
  return fmt::format("{}base {} {:016x}\ntext {} {:016x}\n\n", firstLine, base.bytes, base.hash,
                     own.bytes, own.hash);
}

// Takes a word from the front of a text, and a number.
bool take(std::string_view& rest, std::string_view word) {
  if (!rest.starts_with(word)) return false;
  rest.remove_prefix(word.size());
  return true;
}
bool takeNumber(std::string_view& rest, int radix, uint64_t& number) {
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number, radix);
  if (error != std::errc()) return false;
  rest.remove_prefix(size_t(end - rest.data()));
  return true;
}

struct Head {
  TextStamp base, text;
  size_t bytes = 0; // size of the head itself
};
bool readHead(std::string_view start, Head& head) {
  std::string_view rest = start;
  const auto stamp = [&rest](std::string_view word, TextStamp& read) {
    return take(rest, word) && takeNumber(rest, 10, read.bytes) && take(rest, " ") &&
           takeNumber(rest, 16, read.hash) && take(rest, "\n");
  };
  if (!take(rest, firstLine) || !stamp("base ", head.base) || !stamp("text ", head.text) ||
      !take(rest, "\n"))
    return false;
  head.bytes = start.size() - rest.size();
  return true;
}

// Reads bytes from the present place of a file, fewer at its end.
std::string readBytes(int descriptor, size_t bytes, const std::string& path) {
  std::string read(bytes, '\0');
  size_t size = 0;
  while (size < bytes) {
    const ssize_t done = ::read(descriptor, read.data() + size, bytes - size);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail("read", path, errno);
    if (done == 0) break;
    size += size_t(done);
  }
  read.resize(size);
  return read;
}

// Opens a regular file of this user. Never waits: a pipe could wait for ever.
int openOwn(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file.get() < 0 && errno == ELOOP) refuse(path, "it is a symbolic link");
  if (file.get() < 0) fail("read", path, errno);
  struct stat info;
  if (::fstat(file.get(), &info) != 0) fail("read", path, errno);
  if (!S_ISREG(info.st_mode)) refuse(path, "it is no regular file");
  if (info.st_uid != ::geteuid()) refuse(path, "it belongs to another user");
  return file.release();
}

// Opens a journal that no running program uses, locks it, and reads its head. isBusy: as for
// JournalFile::open().
int openJournal(const std::string& path, Head& head, bool* isBusy) {
  Descriptor file(openOwn(path));
  // The program that uses it may have replaced it since.
  if (!lock(file.get()) || !isAt(file.get(), path)) {
    if (isBusy) *isBusy = true;
    refuse(path, "a vv that runs uses it");
  }
  struct stat info;
  if (::fstat(file.get(), &info) != 0) fail("read", path, errno);
  if (!readHead(readBytes(file.get(), longestHead, path), head))
    refuse(path, "it is damaged, or not a file of vv");
  if (uint64_t(info.st_size) - head.bytes != head.text.bytes) refuse(path, "it is not complete");
  constexpr uint64_t mostBytes = uint64_t(4) << 30; // as of a world's file: fileBytes
  if (head.text.bytes > mostBytes) refuse(path, "it is larger than the file of a world may be");
  return file.release();
}

void unlinkJournal(const std::string& path) {
  ::unlink((path + freshSuffix).c_str());
  ::unlink(path.c_str());
}

// Removes a journal that is empty and that no program uses: the vv that made it has been killed, or
// the machine, before anything was written. Returns whether it has.
bool removeEmpty(const std::string& path) {
  try {
    const Descriptor file(openOwn(path));
    struct stat info;
    return lock(file.get()) && isAt(file.get(), path) && ::fstat(file.get(), &info) == 0 &&
           info.st_size == 0 && ::unlink(path.c_str()) == 0;
  } catch (const std::runtime_error&) { return false; }
}

// The name of a file is on the disk when its folder is.
void syncFolderOf(const std::string& path) {
  const size_t slash = path.rfind('/');
  const std::string folder = slash == path.npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
  const Descriptor open(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (open.get() >= 0) (void)!::fsync(open.get());
}

} // namespace

TextStamp stampOf(std::string_view text) {
  return {text.size(), XXH3_64bits(text.data(), text.size())};
}

JournalFile JournalFile::make(const std::string& world) {
  for (int number = 1; number <= mostJournals; ++number) {
    std::string path = pathOf(world, number);
    const int flags = O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    Descriptor file(::open(path.c_str(), flags, 0600));
    const int reason = errno;
    if (file.get() < 0 && exists(path)) continue; // a link, a folder, a file of somebody else
    if (file.get() < 0) fail("write", path, reason);
    // An empty one is left if a program was killed as it began; others keep edits.
    struct stat info;
    if (::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode) || info.st_size != 0 ||
        info.st_uid != ::geteuid() || !lock(file.get()) || !isAt(file.get(), path))
      continue;
    return {std::move(path), file.release()};
  }
  throw std::runtime_error(fmt::format("cannot write {}: there are {} such files already",
                                       pathOf(world, 1), mostJournals));
}

JournalFile JournalFile::open(const std::string& path, JournalContent& content, bool* isBusy) {
  Head head;
  Descriptor file(openJournal(path, head, isBusy));
  if (::lseek(file.get(), off_t(head.bytes), SEEK_SET) < 0) fail("read", path, errno);
  content.base = head.base;
  content.text = readBytes(file.get(), head.text.bytes, path);
  if (stampOf(content.text) != head.text) refuse(path, "it is damaged");
  return {path, file.release()};
}

JournalFile& JournalFile::operator=(JournalFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

JournalFile::~JournalFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool JournalFile::isInPlace() const { return descriptor_ >= 0 && isAt(descriptor_, path_); }

void JournalFile::write(const TextStamp& base, std::string_view text) {
  // The lock makes this name ours, too: what stands there is left from a program that was killed.
  const std::string fresh = path_ + freshSuffix;
  ::unlink(fresh.c_str());
  Descriptor file(picture::openNew(fresh, 0600));
  if (file.get() < 0) fail("write", path_, errno);
  try {
    lock(file.get());
    picture::writeDescriptor(file.get(), head(base, text), path_);
    picture::writeDescriptor(file.get(), text, path_);
    if (::fsync(file.get()) != 0) fail("write", path_, errno);
    if (::rename(fresh.c_str(), path_.c_str()) != 0) fail("write", path_, errno);
  } catch (...) {
    ::unlink(fresh.c_str());
    throw;
  }
  ::close(descriptor_);
  descriptor_ = file.release();
  syncFolderOf(path_);
}

void JournalFile::remove() {
  if (isInPlace()) unlinkJournal(path_);
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

FoundJournal findJournal(const std::string& world, const std::function<std::string()>& readText,
                         std::string& refused) {
  std::vector<FoundJournal> usable;
  std::optional<TextStamp> onDisk;
  // Calls use() for a journal, and keeps the text of what it throws first.
  const auto tryToUse = [&refused](const auto& use) {
    bool isBusy = false;
    try {
      use(isBusy);
      return true;
    } catch (const std::exception& error) {
      if (!isBusy && refused.empty()) refused = error.what();
      return false;
    }
  };
  for (int number = 1; number <= mostJournals; ++number) {
    const std::string path = pathOf(world, number);
    struct stat info;
    if (::lstat(path.c_str(), &info) != 0) continue;
    if (S_ISREG(info.st_mode) && info.st_size == 0) {
      if (removeEmpty(path) && refused.empty())
        refused = fmt::format("{} was empty, and has been removed: the vv that made it had ended "
                              "before it kept any edits",
                              path);
      continue;
    }
    tryToUse([&](bool& isBusy) {
      Head head;
      const Descriptor file(openJournal(path, head, &isBusy));
      if (!onDisk) onDisk = stampOf(readText());
      // A program was killed between saving the file and removing the journal.
      if (head.text == *onDisk) return unlinkJournal(path);
      if (head.base != *onDisk)
        throw std::runtime_error(
            fmt::format("{} is not used: {} has changed since; the edited text stands in it from "
                        "line 5 on. Remove it when you do not need it",
                        path, world));
      usable.push_back({path, info.st_mtime});
    });
  }
  std::stable_sort(usable.begin(), usable.end(), [](const FoundJournal& a, const FoundJournal& b) {
    return a.written > b.written;
  });
  for (const FoundJournal& one : usable) {
    const auto read = [&one](bool& isBusy) {
      JournalContent content;
      JournalFile::open(one.path, content, &isBusy);
    };
    if (tryToUse(read)) return one;
  }
  return {};
}

bool isJournalOf(const std::string& world, const std::string& path) {
  const auto placeOf = [](const std::string& name) {
    std::error_code none;
    return fs::weakly_canonical(fs::absolute(picture::followLinks(name), none), none);
  };
  const fs::path place = placeOf(path);
  for (int number = 1; number <= mostJournals; ++number) {
    const std::string journal = pathOf(world, number);
    if (place == placeOf(journal) || place == placeOf(journal + freshSuffix)) return true;
  }
  return false;
}

std::string journalBeside(const std::string& world) {
  const std::string path = pathOf(world, 1);
  struct stat info;
  return ::lstat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0 ? path : "";
}

} // namespace vv
