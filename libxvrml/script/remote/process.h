// process.h: the browser's end of one xvrml-script-host: calls of an engine's functions there, one
// at a time, and the functions of the host that they call meanwhile. Nothing that comes from it is
// believed; whatever is wrong ends it. A call can be left running and looked after later. [the
// browser's thread]
#pragma once

#include <memory>

#include "script/remote/channel.h"
#include "script/remote/child.h"

namespace xvrml {

struct ProcessSettings {
  std::string library, engine; // the plug-in's file, the engine's name in it
  uint64_t steps;
  double seconds;
  uint64_t memory; // for each Script; 0: no limit
};

class ScriptProcess {
 public:
  // Starts the program, does not wait for it. host: what programs call.
  ScriptProcess(const std::string& program, ProcessSettings settings, const XsHost& host);
  // At the other end of a socket is whoever: for tests.
  ScriptProcess(int socket, ProcessSettings settings, const XsHost& host);

  const ProcessSettings& settings() const { return settings_; }
  // Waits until it is ready. False: it is dead.
  bool ready();
  bool dead() const { return !channel_; }
  const std::string& death() const {
    return death_;
  } // why: "its process ended by signal 9 (Killed)"
  pid_t number() const { return child_.number(); }

  // Interpreters in it.
  void add();
  void remove() { --scripts_; }
  uint32_t scripts() const { return scripts_; }

  // Begins a call; only while none is under way. False: it is dead, or, if it is not, the message
  // is too long. The flag thenInitialize of a create call stands for two calls: busy() is still
  // true when the first has succeeded.
  bool begin(wire::Writer& call);
  bool busy() const { return busy_; }
  enum class State { returned, running, tooLong, died };
  // Serves the call that is under way. first: seconds to wait for a message if there is none; next:
  // for further ones; not beyond `until`. time: the timestamp that programs see.
  State serve(double first, double next, wire::Clock::time_point until, double time);
  // Of the call that has returned.
  XsResult result() const { return result_; }
  bool stopped() const { return stopped_; }
  void kill(std::string why);
  // Returns the processor time that its programs have used since the last call of this, in seconds;
  // 0 if it is dead.
  double takeProcessorTime();

  bool orphaned = false;           // nobody waits for the call that is under way
  std::vector<uint32_t> discarded; // interpreters to be destroyed when it is not busy

  static constexpr double grace = 0.25; // seconds beyond the limit, which the helper keeps itself
  // A program that computes has its seconds of processor time, but waits for a processor at most so
  // many times as long.
  static constexpr double mostShared = 16;

 private:
  State lost(State state, std::string why);
  bool answer(const wire::Message& message, double time); // false: it has been lost
  void callBegins();
  double missing(double limit); // seconds of its time that the program could not use: others had
                                // the processors

  const ProcessSettings settings_;
  const XsHost& host_;
  Child child_;
  std::unique_ptr<wire::Channel> channel_; // null: it is dead
  std::string death_;
  bool ready_ = false, busy_ = false, stopped_ = false, follows_ = false;
  uint32_t scripts_ = 0;
  uint64_t base_ = 0; // bytes of address space that it had when it was ready; 0: cannot be limited
  XsResult result_ = XS_OK;
  double used_ = 0;      // seconds of the call
  double processor_ = 0; // processor time of the process when the call began
  double taken_ = 0;     // processor time that takeProcessorTime() has told
  double shared_ = 0; // seconds that were given to the call because it had waited for a processor
  wire::Clock::time_point left_; // when it was last looked after
  wire::Message message_;
  wire::Writer answer_;
};

} // namespace xvrml
