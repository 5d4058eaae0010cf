#include "forward.h"

#include <algorithm>
#include <ctime>
#include <new>

#include <unistd.h>

namespace xvrml {

using namespace wire;

namespace {

constexpr uint64_t stepsOfCall = 100; // steps of one call, as the browser counts them

template <size_t I, auto First, auto... Others>
constexpr auto memberAt(FunctionList<First, Others...>) {
  if constexpr (I == 0)
    return First;
  else
    return memberAt<I - 1>(FunctionList<Others...>{});
}

template <class A, class B> constexpr bool same(A a, B b) {
  if constexpr (std::is_same_v<A, B>)
    return a == b;
  else
    return false;
}
template <auto Member, auto... All> constexpr uint16_t numberIn(FunctionList<All...>) {
  uint16_t number = uint16_t(Op::host);
  bool found = false;
  ((found = found || same(Member, All), number = uint16_t(number + (found ? 0 : 1))), ...);
  return number;
}

Clock::duration duration(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::min(seconds, 1e6)));
}

double processorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

template <class T> bool present(const T& argument) {
  if constexpr (std::is_same_v<T, XsNodeInfo*>)
    return argument && argument->size >= sizeof(XsNodeInfo);
  else if constexpr (isOut<T>)
    return argument;
  else
    return true;
}
template <class T> void put(Writer& out, const T& argument) {
  if constexpr (!isOut<T>) out.put(argument);
}
template <class T> bool takeOut(Reader& in, const T& argument) {
  if constexpr (isOut<T>) in.get(*argument);
  return isOut<T>;
}

} // namespace

template <class R, class... A, R (*XsHost::*Member)(const XsHost*, XsNode, A...)>
struct Forward::Function<Member> {
  static constexpr bool counted = std::is_same_v<R, XsResult> && !same(Member, &XsHost::release);

  static R call(const XsHost* host, XsNode self, A... arguments) noexcept {
    try {
      return pass(from(host), self, arguments...);
    } catch (const std::exception&) { return R(XS_FAILED); } // memory is exhausted
  }

  static R pass(Forward& host, XsNode self, A... arguments) {
    HostedScript* hosted = host.find(self);
    if (!hosted) return R(XS_NO_NODE);
    const auto refuse = [&](XsResult why, const char* text) {
      hosted->error = text;
      return R(why);
    };
    if (counted && host.chargeSteps(stepsOfCall))
      return refuse(XS_STOPPED, "the Script's time is up");
    if (!(present(arguments) && ...)) return refuse(XS_FAILED, "no place for the answer");
    Writer& out = host.writer_;
    out.begin(Op::host, hosted->number);
    out.header().op = numberIn<Member>(HostFunctions{});
    out.put(self);
    (put(out, arguments), ...);
    if (!out.finish()) return refuse(XS_FAILED, "longer than a message may be");
    if constexpr (std::is_void_v<R>) {
      if (!host.channel_.send(out.bytes())) _exit(0);
    } else {
      return receive(host, *hosted, arguments...);
    }
  }

  static R receive(Forward& host, HostedScript& hosted, A... arguments) {
    Message answer = host.ask();
    if constexpr (std::is_same_v<R, double>) {
      return Reader(answer).take<double>();
    } else {
      const auto result = XsResult(answer.header.result);
      if (result != XS_OK) {
        const auto why = Reader(answer).take<XsString>();
        hosted.error.assign(why.data ? why.data : "", why.bytes);
      } else if constexpr ((isOut<A> || ...)) {
        hosted.lent = std::move(answer);
        hosted.lentReader = Reader(hosted.lent);
        (takeOut(hosted.lentReader, arguments), ...);
        if (!hosted.lentReader.complete()) _exit(1);
      }
      return result;
    }
  }
};

HostedScript::HostedScript(Message&& made)
    : message(std::move(made)), reader(message), lentReader(lent) {
  number = message.header.script;
  info.size = sizeof info;
  info.flags = reader.take<uint32_t>();
  info.self = reader.take<uint64_t>();
  info.memory = reader.take<uint64_t>();
  info.scheme = reader.take<const char*>();
  info.origin = reader.take<const char*>();
  info.text = reader.take<XsString>();
  info.fieldCount = reader.take<uint32_t>();
  if (!reader.good() || info.fieldCount > message.bytes.size()) return;
  fields.resize(info.fieldCount);
  for (XsField& field : fields) reader.get(field);
  info.fields = fields.data();
  good = reader.complete() && info.scheme && info.origin && info.text.data;
}

Forward::Forward(Channel& channel, uint64_t steps, double seconds)
    : XsHost{}, channel_(channel), maxSteps_(steps), seconds_(seconds) {
  size = sizeof(XsHost);
  major = XS_ABI_MAJOR;
  minor = XS_ABI_MINOR;
  [&]<auto... Members>(FunctionList<Members...>) {
    ((this->*Members = Function<Members>::call), ...);
  }
  (HostFunctions{});
  now = [](const XsHost* host, XsNode) { return from(host).now_; };
  shouldStop = [](const XsHost* host, XsNode self, uint64_t steps) -> int32_t {
    return !from(host).find(self) || from(host).chargeSteps(steps) ? 1 : 0;
  };
  lastError = [](const XsHost* host, XsNode self, XsString* text) {
    const HostedScript* hosted = from(host).find(self);
    if (!hosted || !text) return XS_NO_NODE;
    *text = {hosted->error.c_str(), hosted->error.size()};
    return XS_OK;
  };
}

void Forward::enter(double time) {
  now_ = time;
  steps_ = 0;
  stopped_ = false;
  processor_ = processorSeconds();
  end_ = Clock::now() + duration(seconds_);
}

// Returns whether the program's time is up. The limit counts processor time, because a process that
// shares the processors with others is slower through no fault of its program. The browser ends
// programs that sleep.
bool Forward::isOverTime() {
  const auto now = Clock::now();
  if (now <= end_) return false;
  const double left = seconds_ - (processorSeconds() - processor_);
  if (left > 0) end_ = now + duration(std::max(left, 0.001));
  return left <= 0;
}

HostedScript* Forward::find(XsNode self) const {
  const auto found = hostedScripts.find(self);
  return found == hostedScripts.end() ? nullptr : found->second;
}

bool Forward::chargeSteps(uint64_t steps) {
  steps_ = steps_ + steps < steps_ ? UINT64_MAX : steps_ + steps;
  return stopped_ = stopped_ || steps_ > maxSteps_ || isOverTime();
}

// Sends a request and waits for the answer. The browser's time does not count as the program's.
Message Forward::ask() {
  const auto before = Clock::now();
  Message answer;
  if (!channel_.send(writer_.bytes()) ||
      channel_.receive(answer, never) != Channel::Received::message ||
      answer.header.op != uint16_t(Op::answer))
    _exit(0); // the browser has ended
  end_ += Clock::now() - before;
  now_ = answer.header.time;
  return answer;
}

} // namespace xvrml
