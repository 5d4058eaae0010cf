// keys.h: key files of masters and workers: a CURVE key pair (curve25519) as two lines of text in
// Z85, mode 0600. [any]
//
// One file for a whole cluster is enough: everybody who has it is let in. Files of one's own for
// each worker, and a list of the public keys that are let in, are for those who want to be able to
// shut one out.
#pragma once

#include <string>
#include <vector>

namespace openrt::cluster {

struct KeyRing {
  std::string publicKey, secretKey; // Z85, 40 characters; empty: none
  std::vector<std::string> allowed; // public keys that are let in besides one's own
  bool empty() const { return secretKey.empty(); }
};

// Makes FILE (mode 0600, never over an existing one) and returns the public key.
std::string makeKeyFile(const std::string& path);
// Reads FILE; allow: a file of public keys, a line each with a comment, or "". Throws
// std::runtime_error, for people: also if others may read it.
KeyRing readKeys(const std::string& path, const std::string& allow = "");

} // namespace openrt::cluster
