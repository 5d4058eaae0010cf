// support.h: helpers for tests of the cluster: a scene that uses everything the protocol transfers,
// its pictures as bytes, and worker processes on loopback that can be stopped, killed and
// restarted.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/types.h>

#include "openrt/openrt.h"

namespace cluster_test {

using namespace std::chrono_literals;

// All channels that depend on the frame alone; RT_MOTION depends on the one before, too.
inline constexpr uint32_t allChannels = RT_RGBA | RT_DEPTH | RT_NORMAL | RT_ALBEDO | RT_POSITION |
                                        RT_NAME | RT_SAMPLES | RT_VARIANCE | RT_ERROR | RT_TRUST |
                                        RT_COVERAGE;

struct FrameOptions { // settings of a frame
  int width = 61, height = 45;
  int samples = 4;
  uint32_t channels = allChannels;
  int transport = RT_TRANSPORT_PATH;
  int tile = 0;
  bool progressive = false;
  double targetError = 0;
};

// A context that is current as long as the object lives. The destructor checks that no error is
// pending.
class Context {
 public:
  explicit Context(const std::string& config);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  RTcontext handle = nullptr;
  // Lines the library has logged. Read it only while no frame is in flight.
  std::vector<std::string> log;
  bool said(const std::string& part) const;
};

// Objects of several materials under a lamp, some of them moving, on a floor of many triangles.
class World {
 public:
  World(); // into the current context
  void look(const FrameOptions& look);
  // Makes the edits of an animation: matrices, a parameter, the camera, sometimes geometry.
  void move(double time);
  void slow(int depth); // makes a frame slow: paths of many bounces between mirrors

 private:
  RTid surface_ = 0, lamp_ = 0, ball_ = 0, shape_ = 0;
  std::vector<RTid> places_;
  int color_ = -1;
};

using Picture = std::vector<float>; // all channels of a frame, one after the other
Picture pixels(const FrameOptions& look);
// Renders the frame of a World locally with one thread.
Picture expected(const FrameOptions& look, double time = 0);
// Returns how many values differ; 0: the pictures are identical.
size_t different(const Picture& a, const Picture& b);

RTstats statistics();
std::vector<RTworker> workers();

// An openrt-worker process on a free port of this machine.
class Worker {
 public:
  explicit Worker(std::vector<std::string> options = {}, int threads = 1);
  ~Worker(); // kills the process
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  void signal(int number) const; // SIGKILL, SIGSTOP, SIGCONT
  void kill();                   // kills the process immediately and reaps it
  void start();                  // starts a new process on the same port
  int wait(); // waits for the process's end; returns its exit code, or -1 if it was killed
  pid_t process() const { return pid_; }

 private:
  std::vector<std::string> options_;
  int threads_ = 1, port_ = 0;
  pid_t pid_ = -1;
};
int freePort();
// Returns the context option that lists the addresses of the workers.
template <class Workers> std::string workersOption(const Workers& workers) {
  std::string list;
  for (const auto& worker : workers) list += (list.empty() ? "workers=" : ",") + worker->address();
  return list;
}
// Polls until the condition holds. Returns false on a timeout.
template <class F> bool until(const F& condition, double seconds = 20) {
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
       ;) {
    if (condition()) return true;
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
}

} // namespace cluster_test
