// keys.cpp: reads, checks and writes key files. [any]
#include "backend/cluster/net/keys.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <zmq.h>

namespace openrt::cluster {
namespace {

constexpr size_t keyLength = 40, keyBytes = 32;
constexpr size_t longestFile = size_t(1) << 20;

[[noreturn]] void failed(const std::string& path, const std::string& why) {
  throw std::runtime_error(path + ": " + why);
}

bool isKey(std::string_view text) {
  uint8_t bytes[keyBytes];
  return text.size() == keyLength && zmq_z85_decode(bytes, std::string(text).c_str()) != nullptr;
}

// Closes its file descriptor.
struct File {
  int fd;
  ~File() {
    if (fd >= 0) close(fd);
  }
};

std::string readSmall(const std::string& path, bool secret) {
  const File file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  struct stat info {};
  if (file.fd < 0 || fstat(file.fd, &info) != 0) failed(path, std::strerror(errno));
  if (!S_ISREG(info.st_mode)) failed(path, "this is not a file");
  if (secret && (info.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    failed(path, "other users may read or write this key file; chmod 600 it, or make a new key if "
                 "somebody may have seen it");
  if (size_t(info.st_size) > longestFile) failed(path, "the file is too large for a file of keys");
  std::string text(size_t(info.st_size), 0);
  size_t got = 0;
  for (ssize_t n;
       got < text.size() && (n = read(file.fd, text.data() + got, text.size() - got)) > 0;)
    got += size_t(n);
  text.resize(got);
  return text;
}

// Calls take(first word, second word, line number) for each line that is not blank.
template <class Take> void forLines(std::string_view text, const Take& take) {
  for (size_t number = 1; !text.empty(); number++) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const auto word = [&line] {
      line.remove_prefix(std::min(line.size(), line.find_first_not_of(" \t\r")));
      const std::string_view w = line.substr(0, line.find_first_of(" \t\r"));
      line.remove_prefix(w.size());
      return w;
    };
    const std::string_view first = word(), second = word();
    if (!first.empty()) take(first, second, number);
  }
}

std::vector<std::string> readAllowed(const std::string& path) {
  std::vector<std::string> keys;
  forLines(
      readSmall(path, false), [&](std::string_view first, std::string_view second, size_t number) {
        if (first == "public") first = second; // the line comes from a key file
        if (isKey(first))
          keys.emplace_back(first);
        else if (first.front() != '#') // no key begins with #
          failed(path, "line " + std::to_string(number) +
                           ": expected a public key (40 characters, then a comment if you like)");
      });
  return keys;
}

} // namespace

std::string makeKeyFile(const std::string& path) {
  char publicKey[keyLength + 1], secretKey[keyLength + 1];
  if (zmq_curve_keypair(publicKey, secretKey) != 0)
    failed(path, "this build of ZeroMQ cannot make keys (it has no CURVE)");
  File file{
      open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR)};
  if (file.fd < 0)
    failed(path, errno == EEXIST ? "the file exists already; choose another name, because a key is "
                                   "never written over a file"
                                 : std::strerror(errno));
  const std::string text = std::string("public ") + publicKey + "\nsecret " + secretKey + "\n";
  size_t written = 0;
  for (ssize_t n; written < text.size() &&
                  (n = write(file.fd, text.data() + written, text.size() - written)) > 0;)
    written += size_t(n);
  if (fchmod(file.fd, S_IRUSR | S_IWUSR) != 0 || written < text.size() || fsync(file.fd) != 0 ||
      close(std::exchange(file.fd, -1)) != 0) {
    const std::string why = std::strerror(errno);
    unlink(path.c_str());
    failed(path, why);
  }
  return publicKey;
}

KeyRing readKeys(const std::string& path, const std::string& allow) {
  KeyRing ring;
  forLines(
      readSmall(path, true), [&](std::string_view first, std::string_view second, size_t number) {
        std::string* place = first == "public"   ? &ring.publicKey
                             : first == "secret" ? &ring.secretKey
                                                 : nullptr;
        if (!place || !place->empty() || !isKey(second))
          failed(path, "line " + std::to_string(number) +
                           ": expected a line of a key file, as openrt-worker --new-key makes it");
        *place = second;
      });
  if (ring.publicKey.empty() || ring.secretKey.empty())
    failed(path, "this is not a key file, as openrt-worker --new-key makes it");
  char publicKey[keyLength + 1];
  if (zmq_curve_public(publicKey, ring.secretKey.c_str()) != 0)
    failed(path, "this build of ZeroMQ has no CURVE");
  if (ring.publicKey != publicKey) failed(path, "the public key does not belong to the secret one");
  if (!allow.empty()) ring.allowed = readAllowed(allow);
  return ring;
}

} // namespace openrt::cluster
