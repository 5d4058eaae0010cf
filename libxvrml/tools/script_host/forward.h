// forward.h: the table of functions that an engine gets in this process: each goes to the browser
// as a message and waits for the answer. What needs no browser is answered here: time, budget, why
// something was refused. [one thread]
#pragma once

#include <string>
#include <unordered_map>

#include "script/remote/channel.h"
#include "script/remote/host_functions.h"

namespace xvrml {

// A Script whose interpreter is here.
struct Guest {
  explicit Guest(wire::Message&& made);
  wire::Message message; // what it was made from; info points into it
  wire::Reader reader;
  std::vector<XsField> fields;
  XsScriptInfo info{};
  bool good = false;
  uint32_t number = 0;
  XsInterpreter interpreter = 0;
  wire::Message lent; // what was given out last
  wire::Reader lentReader;
  std::string error;
};

class Forward : public XsHost {
 public:
  Forward(wire::Channel& channel, uint64_t steps, double seconds);

  // The budget of one call begins.
  void enter(double time);
  bool stopped() const { return stopped_; }
  Guest* find(XsNode self) const;

  std::unordered_map<XsNode, Guest*> guests; // by their own nodes

 private:
  template <auto Member> struct Function;
  static Forward& of(const XsHost* host) {
    return *const_cast<Forward*>(static_cast<const Forward*>(host));
  }
  bool spend(uint64_t steps);
  bool late();
  wire::Message ask();

  wire::Channel& channel_;
  const uint64_t mostSteps_;
  const double seconds_;
  uint64_t steps_ = 0;
  wire::Clock::time_point end_;
  double processor_ = 0; // processor time of this process when the call began
  double now_ = 0;
  bool stopped_ = false;
  wire::Writer writer_;
};

} // namespace xvrml
