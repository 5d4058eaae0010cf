// process.cpp: see process.h.
#include "script/remote/process.h"

#include <algorithm>

#include <fmt/format.h>

#include "script/remote/host_functions.h"

namespace xvrml {

using namespace wire;

namespace {

constexpr double startSeconds = 20;  // a process that is not ready by then never will be
constexpr uint64_t slack = 64 << 20; // messages, and what a library takes when it is first used

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }
Clock::duration duration(double s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::clamp(s, 0.0, 1e6)));
}

} // namespace

ScriptProcess::ScriptProcess(const std::string& program, ProcessSettings settings, const XsHost& host)
    : settings_(std::move(settings)), host_(host) {
  const int socket = child_.start(program, death_);
  if (socket < 0) return;
  channel_ = std::make_unique<Channel>(socket);
  Writer setup;
  setup.begin(Op::setup);
  setup.put(wire::version);
  setup.put(settings_.library.c_str());
  setup.put(settings_.engine.c_str());
  setup.put(settings_.steps);
  setup.put(settings_.seconds);
  if (!setup.finish() || !channel_->send(setup.bytes())) lost(State::died, {});
}

bool ScriptProcess::ready() {
  if (ready_ || dead()) return !dead();
  const Channel::Got got = channel_->receive(message_, Clock::now() + duration(startSeconds));
  Reader in(message_);
  if (got == Channel::Got::nothing) {
    kill(fmt::format("is not ready after {} s", startSeconds));
  } else if (got == Channel::Got::message && message_.header.op == uint16_t(Op::failed)) {
    const auto why = in.take<XsString>();
    kill(in.complete() ? std::string(why.data, why.bytes) : "cannot serve");
  } else if (got == Channel::Got::message && message_.header.op == uint16_t(Op::ready)) {
    base_ = in.take<uint64_t>();
    ready_ = in.complete();
    if (!ready_) kill("broke the protocol");
  } else {
    lost(State::died, {});
  }
  return !dead();
}

void ScriptProcess::add() {
  ++scripts_;
  if (base_ > 0 && settings_.memory > 0 && settings_.memory < (uint64_t(1) << 50))
    child_.limitMemory(base_ + slack + settings_.memory * scripts_);
}

ScriptProcess::State ScriptProcess::lost(State state, std::string why) {
  channel_.reset(); // first: it may be waiting for us
  if (why.empty())
    why = child_.ending();
  else
    child_.kill();
  death_ = std::move(why);
  busy_ = false;
  return state;
}

void ScriptProcess::kill(std::string why) {
  if (!dead()) lost(State::died, std::move(why));
}

bool ScriptProcess::begin(Writer& call) {
  if (dead() || !call.finish()) return false;
  if (!channel_->send(call.bytes())) return lost(State::died, {}), false;
  busy_ = true;
  seenBusy_ = false;
  used_ = 0;
  sent_ = Clock::now();
  return true;
}

// What an application does between two ticks is nothing that a program may be blamed for: it counts the time up to a message that
// was waited for, or up to the last time that there was none.
ScriptProcess::State ScriptProcess::serve(double first, double next, Clock::time_point until, double time) {
  bool waited = false;
  for (double patience = first;; patience = next) {
    const auto now = Clock::now();
    const double limit = settings_.seconds + grace;
    const auto hard = std::min(sent_, now) + duration(limit - used_);
    const auto end = std::min({until, hard, now + duration(patience)});
    const Channel::Got got = channel_->receive(message_, std::max(end, now));
    const auto then = Clock::now();
    if (got == Channel::Got::nothing) {
      seenBusy_ = true;
      seen_ = then;
      if (used_ + seconds(then - sent_) >= limit) return lost(State::tooLong, "took too long");
      if (then >= until || patience < 1e5) return State::running;
      continue;
    }
    if (got == Channel::Got::closed) return lost(State::died, {});
    if (got == Channel::Got::bad) return lost(State::died, "sent a message that is too long");
    if (waited || first > 0)
      used_ += seconds(then - sent_);
    else if (seenBusy_)
      used_ += std::max(0.0, seconds(seen_ - sent_));
    waited = true;
    if (message_.header.op == uint16_t(Op::done)) {
      const int32_t answer = message_.header.result;
      if (!message_.bytes.empty()) return lost(State::died, "broke the protocol");
      result_ = answer >= XS_OK && answer <= XS_FAILED ? XsResult(answer) : XS_FAILED;
      stopped_ = message_.header.flags & Flags::stopped;
      busy_ = false;
      return State::returned;
    }
    if (!answer(message_, time)) return dead() ? State::died : lost(State::died, "broke the protocol");
    sent_ = Clock::now();
    seenBusy_ = false;
    if (used_ >= limit) return lost(State::tooLong, "took too long");
    if (sent_ >= until) return State::running;
  }
}

bool ScriptProcess::answer(const Message& message, double time) {
  answer_.begin(Op::answer, message.header.script, time);
  const Served served = wire::serve(HostFunctions{}, host_, message, answer_);
  if (!served.good) return false;
  if (!served.answers) return true;
  if (!answer_.finish()) {
    answer_.begin(Op::answer, message.header.script, time);
    answer_.header().result = XS_FAILED;
    answer_.put("longer than a message to a process may be");
    answer_.finish();
  }
  return channel_->send(answer_.bytes());
}

} // namespace xvrml
