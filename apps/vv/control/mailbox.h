// mailbox.h: Carries commands from the threads that read sockets to the thread of the browser, and
// answers and events back. Nobody waits for the other side: what a client has not read is kept up
// to a limit, and beyond it the client is cut off; a client whose lines wait for the world up to a
// limit is not read meanwhile. [any thread, except where noted]
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "control/command.h"

namespace vv::control {

using ClientId = uint64_t;

// Lists what the browser's thread finds in the mailbox.
struct Letter {
  enum class Kind : uint8_t { command, left } kind = Kind::command;
  ClientId client = 0;
  Line line;        // command
  size_t bytes = 0; // the size of the line; processed() gives them back
};

class Mailbox {
 public:
  // --- For the threads that read sockets ---
  //
  // Registers a client. wake: called on any thread when there is something to be sent to it, or
  // when it may be read again. Returns 0 if there are too many clients; `why` says so.
  ClientId join(std::function<void()> wake, std::string& why);
  void leave(ClientId client);
  // Reads a line and delivers what it holds. Returns false if the client must be cut off, because
  // its first line is no JSON object: another protocol, perhaps a page in somebody's browser.
  bool deliver(ClientId client, std::string_view line);
  // Cuts the client off after a last message.
  void cut(ClientId client, std::string_view code, const std::string& why);
  // Tells whether so many of its lines wait that nothing more may be read from it.
  bool isFull(ClientId client) const;
  // Tells whether all its commands are done and all its output is taken.
  bool isIdle(ClientId client) const;
  // Moves the lines for a client, each with its line feed, to `out`. Returns false if it has been
  // cut off: the connection ends when the rest is sent.
  bool takeOutput(ClientId client, std::string& out);
  // Tells the mailbox how many of the taken bytes the client has not read yet.
  void setUnsent(ClientId client, size_t bytes);

  // --- For the browser's thread ---
  std::optional<Letter> take();
  size_t waiting() const; // number of letters
  // Notes that a command has been done.
  void processed(ClientId client, size_t bytes);
  // Sends a line, without its line feed.
  void send(ClientId client, std::string_view line);
  // Waits for a letter, at most these seconds.
  void wait(double seconds);

 private:
  struct Client {
    std::function<void()> wake;
    std::string output;
    size_t unsent = 0;       // bytes that were taken and not sent
    size_t waitingBytes = 0; // the size of lines that are not done yet
    bool isKnown = false;    // it has sent a JSON object
    bool isCut = false;
  };
  void append(Client& client, std::string_view line); // the caller holds the mutex
  void cut(Client& client, std::string_view code, const std::string& why);

  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::map<ClientId, Client> clients_;
  std::deque<Letter> letters_;
  ClientId last_ = 0;
};

} // namespace vv::control
