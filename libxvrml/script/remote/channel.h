// channel.h: whole messages over one end of a socket pair. Used by the browser, which never waits
// longer than it wants to, and by xvrml-script-host, which waits for ever. [one thread]
#pragma once

#include <chrono>

#include "script/remote/wire.h"

namespace xvrml::wire {

using Clock = std::chrono::steady_clock;
constexpr Clock::time_point never = Clock::time_point::max();

class Channel {
 public:
  // patience: how long send() waits while the other end takes nothing.
  explicit Channel(int socket, Clock::duration patience = std::chrono::seconds(1))
      : socket_(socket), patience_(patience) {}
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  // False if the other end is gone, or has taken nothing for the time of `patience`. Never raises
  // SIGPIPE.
  bool send(std::string_view message);

  enum class Got { message, nothing, closed, bad };
  // The next message; `nothing` if it is not there in time. bad: longer than messages may be.
  Got receive(Message& message, Clock::time_point until);

 private:
  Got fill(char* to, size_t wanted, Clock::time_point until);
  Got some(char* to, size_t room, Clock::time_point until, size_t& got);
  int socket_;
  Clock::duration patience_;
  std::vector<char> ahead_; // from used_ to filled_: has arrived, is not used
  size_t used_ = 0, filled_ = 0;
  Message partial_; // of which a part has arrived
  size_t arrived_ = 0;
  bool headed_ = false;
};

} // namespace xvrml::wire
