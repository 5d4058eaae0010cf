// host.h: Serves the page and its WebSocket on one port with libwebsockets, on a thread of its own.
// It checks who may connect, reads messages and limits them; what they mean is up to the server.
// The only file that knows libwebsockets is host.cpp. [functions: any thread]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/message.h"

namespace vv::server {

struct HostOptions {
  // IP addresses to listen at. The first one must work; others are left out if they do not.
  std::vector<std::string> addresses;
  int port = 0;          // 0: any free port
  std::string token;     // empty: none, for loopback addresses
  std::string editToken; // opens the page for those who may edit; empty: nobody may
};

struct HostEvent {
  enum class Kind : uint8_t { joined, message, left };
  Kind kind;
  uint64_t page; // number of the connection; never used again
  Message message;
  Rights rights = Rights::view; // what the page may do
};

// Tells whether a text is an IP address in numbers. [any thread]
bool isIpAddress(const std::string& text);

class Host {
 public:
  // wake: is called on the host's thread when there are events. Throws Failure if nobody can listen
  // at the first address.
  Host(const HostOptions& options, std::function<void()> wake);
  ~Host(); // closes all connections
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  int port() const;
  // Returns the events since the last call, in their order.
  std::vector<HostEvent> takeEvents();

  // Sends a text to a page. A later text with the same name takes the place of one that waits, so
  // that a slow page costs no memory; texts without a name wait in a short queue.
  void sendText(uint64_t page, const std::string& name, std::string text);
  // Sends a binary message. The page must have acknowledged the previous one.
  void sendPicture(uint64_t page, std::string bytes);
  // Ends the connection of a page that cannot be served; the page tries again.
  void close(uint64_t page);
  // Keeps a file for a minute. Returns its path, relative to the page.
  std::string offerDownload(std::string name, std::string type, std::string content);
  // Keeps a picture for pages that may edit, until it is dropped. Returns its path, relative to the
  // page.
  std::string keepImage(std::string png);
  void dropImage(const std::string& path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vv::server
