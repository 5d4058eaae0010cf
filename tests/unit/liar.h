// liar.h: a process that decodes files and says what a test wants.
#pragma once

#include <cstdlib>
#include <memory>
#include <span>
#include <string>

#include <sys/socket.h>

#include "decode/decoder.h"

namespace xvrml::test {

class Liar {
 public:
  // Takes the place of the process of a kind.
  Liar(std::shared_ptr<Decoder>& decoder, const DecoderKind& kind) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) std::abort();
    decoder = std::make_shared<Decoder>(ends[0], kind);
    socket_ = ends[1];
    channel_ = std::make_unique<wire::Channel>(socket_);
  }
  Liar& says(decoding::Op op, const decoding::Contents& contents) {
    decoding::send(*channel_, op, contents);
    return *this;
  }
  Liar& says(decoding::Op op, const std::string& text = "") {
    decoding::send(*channel_, op, std::span<const char>(text));
    return *this;
  }
  Liar& ends() {
    ::shutdown(socket_, SHUT_WR);
    return *this;
  }

 private:
  int socket_ = -1;
  std::unique_ptr<wire::Channel> channel_;
};

} // namespace xvrml::test
