// channel.h: sends and receives whole messages over one end of a socket pair. Used by the browser,
// which waits for a limited time, and by the programs that it starts, which wait for ever. [one
// thread]
#pragma once

#include <chrono>
#include <string_view>
#include <vector>

#include "process/message.h"

namespace xvrml::wire {

using Clock = std::chrono::steady_clock;
constexpr Clock::time_point never = Clock::time_point::max();

class Channel {
 public:
  // patience: how long send() waits while the other end reads nothing.
  explicit Channel(int socket, Clock::duration patience = std::chrono::seconds(1))
      : socket_(socket), patience_(patience) {}
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  // Sends a message. Returns false if the other end is gone or has read nothing for `patience`.
  // Never raises SIGPIPE.
  bool send(std::string_view message);

  enum class Received { message, nothing, closed, bad };
  // Receives the next message. nothing: it has not arrived in time; bad: it is longer than allowed.
  Received receive(Message& message, Clock::time_point until);

 private:
  Received fill(char* to, size_t wanted, Clock::time_point until);
  Received receiveSome(char* to, size_t room, Clock::time_point until, size_t& got);
  int socket_;
  Clock::duration patience_;
  std::vector<char> buffer_; // received but unread bytes: from used_ to filled_
  size_t used_ = 0, filled_ = 0;
  Message partial_; // message of which a part has arrived
  size_t arrived_ = 0;
  bool headed_ = false;
};

} // namespace xvrml::wire
