// metrics_server.h: answers `GET /metrics` over HTTP, for Prometheus. One thread of its own. It
// knows nothing else of HTTP: a request is read up to its empty line and answered, and the
// connection is closed.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace openrt::cluster {

class MetricsServer {
 public:
  // address: ADDRESS[:PORT] to listen at; port 0: any that is free. text: returns the metrics;
  // called on the server's thread. Throws std::runtime_error or std::system_error with a message
  // for the user.
  MetricsServer(const std::string& address, std::function<std::string()> text);
  ~MetricsServer();
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  std::string address() const; // with the port at which it listens

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
