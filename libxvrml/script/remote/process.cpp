#include "script/remote/process.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "script/remote/host_functions.h"

namespace xvrml {

using namespace wire;

namespace {

constexpr double startSeconds = 20;  // a process that is not ready by then never will be
constexpr uint64_t slack = 64 << 20; // for messages, and for what a library allocates on first use

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }
Clock::duration duration(double s) {
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::clamp(s, 0.0, 1e6)));
}

} // namespace

ScriptProcess::ScriptProcess(const std::string& program, ProcessSettings settings,
                             const XsHost& host)
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

ScriptProcess::ScriptProcess(int socket, ProcessSettings settings, const XsHost& host)
    : settings_(std::move(settings)), host_(host), channel_(std::make_unique<Channel>(socket)),
      ready_(true) {}

bool ScriptProcess::ready() {
  if (ready_ || dead()) return !dead();
  const Channel::Received got = channel_->receive(message_, Clock::now() + duration(startSeconds));
  Reader in(message_);
  if (got == Channel::Received::nothing) {
    kill(fmt::format("is not ready after {} s", startSeconds));
  } else if (got == Channel::Received::message && message_.header.op == uint16_t(Op::failed)) {
    const auto why = in.take<XsString>();
    kill(in.complete() ? std::string(why.data, why.bytes) : "cannot serve");
  } else if (got == Channel::Received::message && message_.header.op == uint16_t(Op::ready)) {
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
  channel_.reset(); // first, because the process may be waiting for us
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
  if (!channel_->send(call.bytes())) {
    lost(State::died, {});
    return false;
  }
  busy_ = true;
  initializeFollows_ =
      call.header().op == uint16_t(Op::create) && (call.header().flags & Flags::thenInitialize);
  callBegins();
  return true;
}

void ScriptProcess::callBegins() {
  used_ = shared_ = 0;
  processor_ = child_.processorSeconds();
  lastServed_ = Clock::now();
}

double ScriptProcess::takeProcessorTime() {
  const double now = dead() ? reportedProcessor_ : child_.processorSeconds();
  return std::max(0.0, now - std::exchange(reportedProcessor_, now));
}

double ScriptProcess::grantExtraTime(double limit) {
  const double left = limit - (child_.processorSeconds() - processor_);
  if (left <= 0 || shared_ >= maximumWaitFactor * limit || !child_.computes()) return 0;
  const double given = std::max(left, 0.01);
  shared_ += given;
  return given;
}

// Serves the running call. Wall clock time counts, except the time spent in the host's functions
// and the time in which the program waited for a processor. The application's time between two
// ticks hardly counts.
ScriptProcess::State ScriptProcess::serve(double first, double next, Clock::time_point until,
                                          double time) {
  constexpr double mostBetween = 0.1;
  const double limit = settings_.seconds + grace;
  used_ += std::min(seconds(Clock::now() - lastServed_), mostBetween);
  auto start = Clock::now();
  const auto leave = [&](State state) {
    lastServed_ = Clock::now();
    used_ += seconds(lastServed_ - start);
    return state;
  };
  for (double patience = first;; patience = next) {
    const auto now = Clock::now();
    const auto hard = start + duration(limit - used_);
    const Channel::Received got = channel_->receive(
        message_, std::max(now, std::min({until, hard, now + duration(patience)})));
    if (got == Channel::Received::nothing && Clock::now() >= hard) {
      const double more = grantExtraTime(limit);
      if (more <= 0) return lost(State::tooLong, "took too long");
      start += duration(more);
      continue;
    }
    if (got == Channel::Received::nothing) return leave(State::running);
    if (got == Channel::Received::closed) return lost(State::died, {});
    if (got == Channel::Received::bad) return lost(State::died, "sent a message that is too long");
    if (message_.header.op == uint16_t(Op::done)) {
      if (!message_.bytes.empty()) return lost(State::died, "broke the protocol");
      const int32_t answer = message_.header.result;
      result_ = answer >= XS_OK && answer <= XS_FAILED ? XsResult(answer) : XS_FAILED;
      stopped_ = message_.header.flags & Flags::stopped;
      busy_ = std::exchange(initializeFollows_, false) && result_ == XS_OK && !stopped_;
      if (busy_) callBegins();
      return State::returned;
    }
    const auto asked = Clock::now();
    if (!answer(message_, time)) return State::died;
    const auto answered = Clock::now();
    start += answered - asked;
    if (answered >= start + duration(limit - used_)) {
      const double more = grantExtraTime(limit);
      if (more <= 0) return lost(State::tooLong, "took too long");
      start += duration(more);
    }
    if (answered >= until) return leave(State::running);
  }
}

bool ScriptProcess::answer(const Message& message, double time) {
  answer_.begin(Op::answer, message.header.script, time);
  const Served served = wire::serve(HostFunctions{}, host_, message, answer_);
  if (!served.good) {
    lost(State::died, "broke the protocol");
    return false;
  }
  if (!served.answers) return true;
  if (!answer_.finish()) {
    answer_.begin(Op::answer, message.header.script, time);
    answer_.header().result = XS_FAILED;
    answer_.put("longer than a message to a process may be");
    answer_.finish();
  }
  if (!channel_->send(answer_.bytes())) {
    lost(State::died, {});
    return false;
  }
  return true;
}

} // namespace xvrml
