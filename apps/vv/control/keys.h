// keys.h: Reads the key files of the cluster (docs/cluster.md, "Keys"), which also protect the
// control channel. libopenrt reads the same files for its workers, but keeps that to itself.
#pragma once

#include <string>
#include <vector>

namespace vv::control {

struct KeyRing {
  std::string publicKey, secretKey; // Z85, 40 characters; empty: none
  std::vector<std::string> allowed; // public keys that are accepted besides publicKey
  bool empty() const { return secretKey.empty(); }
};

// Reads a key file. allow: a file with one public key per line, or "". Throws Failure, also if
// other users may read the file.
KeyRing readKeys(const std::string& path, const std::string& allow);

} // namespace vv::control
