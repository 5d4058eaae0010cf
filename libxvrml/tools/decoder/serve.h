// serve.h: the life of a program that decodes files in the cage. The library starts it with one end
// of a socket pair as file descriptor 3. It drops its privileges before it reads the first byte of
// a file, and serves until the socket closes. The messages are described in decode/protocol.h. [one
// thread]
#pragma once

#include "tools/decoder/answer.h"

namespace xvrml::decoding {

struct Service {
  const char* usage; // for those who start the program by hand
  // Is called before the cage: makes what needs files, and forbids libraries to start threads.
  void (*prepare)();
  // Decodes a file. Throws std::exception with the reason if that is not possible.
  void (*decode)(const Request& request, std::span<const uint8_t> file, Answer& answer);
};

// Serves with the arguments of main(), and returns its result.
int serveFiles(int argc, char** argv, const Service& service);

} // namespace xvrml::decoding
