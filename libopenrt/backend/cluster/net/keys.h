// keys.h: reads and writes the key files of masters and workers: a CURVE key pair (curve25519) as
// two lines of text in Z85, mode 0600. [any]
//
// One file for a whole cluster is enough: every process that has it is let in. To be able to
// exclude one worker, give each worker its own file and the master a list of accepted public keys.
#pragma once

#include <string>
#include <vector>

namespace openrt::cluster {

struct KeyRing {
  std::string publicKey, secretKey; // Z85, 40 characters; empty: none
  std::vector<std::string> allowed; // public keys that are accepted besides publicKey
  bool empty() const { return secretKey.empty(); }
};

// Writes a new key file (mode 0600; never overwrites a file). Returns the public key.
std::string makeKeyFile(const std::string& path);
// Reads a key file. allow: a file with one public key per line, each with an optional comment, or
// "". Throws std::runtime_error with a message for the user, also if other users may read the file.
KeyRing readKeys(const std::string& path, const std::string& allow = "");

} // namespace openrt::cluster
