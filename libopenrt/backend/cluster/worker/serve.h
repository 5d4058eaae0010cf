// serve.h: a worker, whole: the wire, the session and the machine that does the jobs, put together.
// In openrt-worker, and in tests. Three kinds of threads: run() is on its caller's, which does
// nothing but move messages, so that heartbeats never wait; the session has one; jobs have theirs.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "backend/backend.h"
#include "backend/cluster/net/wire.h"

namespace openrt::cluster {

struct ServeOptions {
  WireOptions wire;
  BackendOptions backend; // threads, shaders; its log is not used
  size_t cacheBytes = size_t(1) << 30;
  bool once = false;                                           // end with the first master
  std::function<void(int level, const std::string& text)> log; // [any thread], for people
};

class WorkerService {
 public:
  // Throws std::runtime_error as Wire and makeLocalBackend do.
  explicit WorkerService(const ServeOptions& options);
  ~WorkerService();
  WorkerService(const WorkerService&) = delete;
  WorkerService& operator=(const WorkerService&) = delete;

  std::string address() const; // where it listens, with the port
  void run();                  // until stop()
  void stop();                 // [any], also from a signal handler
  bool serving() const;        // [any] a master is there

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
