// text.h: a text in a message. On its way out it is cut to the longest that a message may hold. On
// its way in it is refused if it is longer, before it is copied, and cleaned of everything that
// must not reach a user's terminal. flatc's object API uses it for all texts of messages.fbs. [any]
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace openrt::cluster {

// Reason why a message from the wire is refused. Only decode() and unpack() catch it.
struct BadMessage {
  std::string why;
};
// Throws BadMessage if the message is not good.
void demand(bool good, const char* why);

class Text : public std::string {
 public:
  Text() = default;
  // Takes a text of this process.
  Text(std::string text);
  Text(const char* text) : Text(std::string(text)) {}
  // Takes a text from the wire. Throws BadMessage if it is too long.
  Text(const char* received, size_t size);
};

// Replaces control characters that move the cursor (C0, DEL, C1) and invalid UTF-8.
void clean(std::span<char> text);

} // namespace openrt::cluster
