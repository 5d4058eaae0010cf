#include "control/keys.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <sys/stat.h>

#include <fmt/format.h>
#include <zmq.h>

#include "options/values.h"

namespace vv::control {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw Failure{exitInput, fmt::format("{}: {}", path, why)};
}

bool isKey(const std::string& text) {
  constexpr size_t length = 40, bytes = 32;
  uint8_t key[bytes];
  return text.size() == length && zmq_z85_decode(key, text.c_str()) != nullptr;
}

std::string readSmall(const std::string& path, bool secret) {
  constexpr off_t longest = 1 << 20;
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) fail(path, std::strerror(errno));
  if (!S_ISREG(info.st_mode)) fail(path, "this is not a file");
  if (secret && (info.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    fail(path, "other users may read or write this key file; chmod 600 it, or make a new key if "
               "somebody may have seen it");
  if (info.st_size > longest) fail(path, "the file is too large for a file of keys");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) fail(path, "it cannot be read");
  return text.str();
}

// Calls take(first word, second word, line number) for each line that is not blank.
template <class Take> void forLines(const std::string& text, const Take& take) {
  std::istringstream lines(text);
  size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string first, second;
    if (words >> first) {
      words >> second;
      take(first, second, number);
    }
  }
}

} // namespace

KeyRing readKeys(const std::string& path, const std::string& allow) {
  KeyRing ring;
  forLines(readSmall(path, true), [&](const std::string& first, const std::string& second, size_t) {
    if (first == "public" && isKey(second)) ring.publicKey = second;
    if (first == "secret" && isKey(second)) ring.secretKey = second;
  });
  char derived[41] = "";
  if (ring.publicKey.empty() || ring.secretKey.empty() ||
      zmq_curve_public(derived, ring.secretKey.c_str()) != 0 || ring.publicKey != derived)
    fail(path, "this is not a key file, as openrt-worker --new-key makes it");
  if (allow.empty()) return ring;
  forLines(readSmall(allow, false),
           [&](const std::string& first, const std::string& second, size_t number) {
             const std::string& key = first == "public" ? second : first;
             if (isKey(key))
               ring.allowed.push_back(key);
             else if (first.front() != '#') // no key begins with #
               fail(allow, fmt::format("line {}: expected a public key (40 characters, then a "
                                       "comment if you like)",
                                       number));
           });
  return ring;
}

} // namespace vv::control
