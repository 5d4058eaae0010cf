// forward.h: the function table of an engine in this process. Each function is sent to the browser
// as a message and waits for the answer. Functions that need no browser are answered here: time,
// budget, last error. [one thread]
#pragma once

#include <string>
#include <unordered_map>

#include "process/channel.h"
#include "script/remote/host_functions.h"

namespace xvrml {

// A Script whose interpreter is in this process.
struct HostedScript {
  explicit HostedScript(wire::Message&& made);
  wire::Message message; // the create message; info points into it
  wire::Reader reader;
  std::vector<XsField> fields;
  XsScriptInfo info{};
  bool good = false;
  uint32_t number = 0;
  XsInterpreter interpreter = 0;
  wire::Message lent; // the answer with the values given out last
  wire::Reader lentReader;
  std::string error;
};

class Forward : public XsHost {
 public:
  Forward(wire::Channel& channel, uint64_t steps, double seconds);

  // Starts the budget of one call.
  void enter(double time);
  bool stopped() const { return stopped_; }
  HostedScript* find(XsNode self) const;

  std::unordered_map<XsNode, HostedScript*> hostedScripts; // by the handles of their own nodes

 private:
  template <auto Member> struct Function;
  static Forward& from(const XsHost* host) {
    return *const_cast<Forward*>(static_cast<const Forward*>(host));
  }
  bool chargeSteps(uint64_t steps);
  bool isOverTime();
  wire::Message ask();

  wire::Channel& channel_;
  const uint64_t maxSteps_;
  const double seconds_;
  uint64_t steps_ = 0;
  wire::Clock::time_point end_;
  double processor_ = 0; // processor time of this process when the call began
  double now_ = 0;
  bool stopped_ = false;
  wire::Writer writer_;
};

} // namespace xvrml
