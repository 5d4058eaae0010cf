// process.h: the browser's end of one xvrml-script-host. It calls an engine's functions there, one
// at a time, and serves the host functions that they call. Nothing it receives is trusted; any
// error ends the process. A call can be left running and served later. [the browser's thread]
#pragma once

#include <memory>

#include "process/channel.h"
#include "process/child.h"
#include "script/remote/wire.h"

namespace xvrml {

struct ProcessSettings {
  std::string library, engine; // the plug-in's file and the engine's name in it
  uint64_t steps;
  double seconds;
  uint64_t memory; // limit on the bytes of one Script; 0: no limit
};

class ScriptProcess {
 public:
  // Starts the program without waiting for it. host: the functions that programs may call.
  ScriptProcess(const std::string& program, ProcessSettings settings, const XsHost& host);
  // Uses a socket whose other end is already connected (for tests).
  ScriptProcess(int socket, ProcessSettings settings, const XsHost& host);

  const ProcessSettings& settings() const { return settings_; }
  // Waits until the process is ready. Returns false if it is dead.
  bool ready();
  bool dead() const { return !channel_; }
  // Returns the reason for its end, such as "its process ended by signal 9 (Killed)".
  const std::string& death() const { return death_; }
  pid_t number() const { return child_.number(); }

  // Count the interpreters in the process.
  void add();
  void remove() { --scripts_; }
  uint32_t scripts() const { return scripts_; }

  // Begins a call; no other call may be running. Returns false if the process is dead, or if the
  // message is too long (then dead() is false). With the flag thenInitialize, create is two calls:
  // busy() stays true after the first has succeeded.
  bool begin(wire::Writer& call);
  bool busy() const { return busy_; }
  enum class State { returned, running, tooLong, died };
  // Serves the running call. first, next: seconds to wait for the first message and for further
  // ones, but not beyond `until`. time: the timestamp that programs see.
  State serve(double first, double next, wire::Clock::time_point until, double time);
  // Result of the call that has returned.
  XsResult result() const { return result_; }
  bool stopped() const { return stopped_; }
  void kill(std::string why);
  // Returns the processor time of its programs since the last call of this function, in seconds; 0
  // if the process is dead.
  double takeProcessorTime();

  bool orphaned = false;           // no Script waits for the running call
  std::vector<uint32_t> discarded; // interpreters to destroy when the process is idle

  static constexpr double grace = 0.25; // seconds beyond the limit, which the helper checks itself
  // A computing program gets its seconds of processor time, but may wait for a processor at most
  // this many times as long.
  static constexpr double maximumWaitFactor = 16;

 private:
  State lost(State state, std::string why);
  // Serves one message. Returns false if the process has been lost.
  bool answer(const wire::Message& message, double time);
  void callBegins();
  // Returns extra seconds for the time in which other processes had the processors.
  double grantExtraTime(double limit);

  const ProcessSettings settings_;
  const XsHost& host_;
  Child child_;
  std::unique_ptr<wire::Channel> channel_; // null: the process is dead
  std::string death_;
  bool ready_ = false, busy_ = false, stopped_ = false, initializeFollows_ = false;
  uint32_t scripts_ = 0;
  uint64_t base_ = 0; // bytes of address space when it was ready; 0: it cannot be limited
  XsResult result_ = XS_OK;
  double used_ = 0;              // seconds used by the call
  double processor_ = 0;         // processor time of the process when the call began
  double reportedProcessor_ = 0; // processor time already returned by takeProcessorTime()
  double shared_ = 0;            // seconds added to the call because it had to wait for a processor
  wire::Clock::time_point lastServed_; // when the call was last served
  wire::Message message_;
  wire::Writer answer_;
};

} // namespace xvrml
