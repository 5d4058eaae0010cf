// serve.h: a complete worker: the wire, the session (Worker) and the jobs (WorkerCore). Used by
// openrt-worker and by tests. Three kinds of threads: the caller of run() only moves messages, so
// that heartbeats are never delayed; the session has one thread; jobs have their own.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "backend/backend.h"
#include "backend/cluster/net/wire.h"

namespace openrt::cluster {

struct ServeOptions {
  WireOptions wire;
  BackendOptions backend; // threads and shaders; its log is not used
  size_t cacheBytes = size_t(1) << 30;
  std::string folder;       // keeps arrays on a disk; empty: none
  uint64_t folderBytes = 0; // about how many its files may have together
  std::string share;        // ADDRESS[:PORT] at which other workers may ask; empty: none
  bool once = false;        // stop after the first master
  std::function<void(int level, const std::string& text)> log; // [any thread] messages for the user
};

class WorkerService {
 public:
  // Throws std::runtime_error like Wire and makeLocalBackend.
  explicit WorkerService(const ServeOptions& options);
  ~WorkerService();
  WorkerService(const WorkerService&) = delete;
  WorkerService& operator=(const WorkerService&) = delete;

  std::string address() const; // returns the listening address with its port
  void run();                  // returns after stop()
  void stop();                 // [any], also from a signal handler
  bool serving() const;        // [any] returns true while a master is connected
  std::string metrics() const; // [any] returns what it has done, as text for Prometheus

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
