// connection.h: Splits what a socket brings into lines, and hands out what is to be sent to it.
// Owned by a SocketListener, on its thread.
#pragma once

#include <string>

#include "control/mailbox.h"

namespace vv::control {

class Connection {
 public:
  // Takes over the file descriptor.
  Connection(int fd, ClientId client, Mailbox& mailbox)
      : fd_(fd), client_(client), mailbox_(mailbox) {}
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  int fd() const { return fd_; }
  bool wantsToRead() const;
  bool wantsToWrite() const { return sent_ < output_.size(); }
  // Reads what has arrived and delivers the lines.
  void read();
  // Delivers lines that had to wait, takes output from the mailbox, and sends what the socket
  // accepts.
  void work();
  // Notes that the client sends no more than what has arrived.
  void noteEnd() { endSeen_ = true; }
  // Tells whether no further commands can come.
  bool isEnding() const { return isCut_ || endSeen_; }
  // Tells whether the connection has ended and can be destroyed. now: seconds of any clock.
  bool hasEnded(double now);

 private:
  void deliverLines();
  void send();

  int fd_;
  ClientId client_;
  Mailbox& mailbox_;
  std::string input_;   // from the last line feed on
  size_t searched_ = 0; // bytes of input_ in which there is no line feed
  std::string output_;
  size_t sent_ = 0;         // bytes of output_
  bool endSeen_ = false;    // the client sends no more
  bool inputEnded_ = false; // and all that it has sent is read
  bool isBroken_ = false;   // nothing can be sent
  bool isCut_ = false;      // what arrives is thrown away
  bool isShut_ = false;     // we send no more
  size_t thrownAway_ = 0;   // bytes that arrived after the cut
  double giveUp_ = 0;       // time at which a connection that was cut is closed; 0: none
};

} // namespace vv::control
