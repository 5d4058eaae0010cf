// limits.h: Names what a client of the control channel may cost. docs/limits.md lists the numbers.
#pragma once

#include <cstddef>

#include "as_json/json_line.h"

namespace vv::control {

using namespace json; // commands and answers are JSON

struct Limits : LineLimits {
  size_t waitingBytes = size_t(64) << 20; // lines that wait for the world; then nothing is read
  size_t unreadBytes = size_t(64) << 20;  // answers and events that a client has not read
  size_t clients = 32;                    // clients at a time
  size_t nodes = 100'000;                 // numbers of nodes that a client has not released
  size_t subscriptions = 10'000;          // subscriptions of a client
  size_t edits = 10'000;                  // edits of one step
  size_t pixels = size_t(64) << 20;       // pixels of one picture
  int side = 65'536;                      // pixels of a picture's side
  int samples = 65'536;                   // samples of each pixel
  double skip = 86'400;                   // seconds that one command lets the world run
};

inline constexpr Limits limits;

} // namespace vv::control
