// main.cpp: xvrml-script-host: runs Scripts' programs for a browser that does not trust them. The
// browser starts it with one end of a socket pair as file descriptor 3. It loads one engine, drops
// its privileges and serves calls until the socket closes. The messages are described in
// script/remote/wire.h, its use in docs/scripts.md.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>

#include <sys/stat.h>
#include <unistd.h>

#include "forward.h"
#include "script/library.h"
#include "tools/cage/cage.h"

namespace xvrml {
namespace {

using namespace wire;

constexpr int socketNumber = 3;

class Server {
 public:
  Server(Channel& channel, const XsEngine& engine, uint64_t steps, double seconds)
      : channel_(channel), engine_(engine), host_(channel, steps, seconds) {}

  void run() {
    Message call;
    while (channel_.receive(call, never) == Channel::Received::message) {
      const wire::Header header = call.header;
      const bool begins = Op(header.op) == Op::create && (header.flags & Flags::thenInitialize);
      if (!serveOne(call)) return;
      if (!begins || !lastCallSucceeded_) continue;
      Message next;
      next.header = header;
      next.header.op = uint16_t(Op::initialize);
      if (!serveOne(next)) return;
    }
  }

 private:
  // Serves a call and reports its end. Returns false if the browser has ended.
  bool serveOne(Message& call) {
    const uint32_t script = call.header.script;
    host_.enter(call.header.time);
    const XsResult result = serve(call);
    lastCallSucceeded_ = result == XS_OK && !host_.stopped();
    Writer done;
    done.begin(Op::done, script);
    done.header().result = result;
    done.header().flags = host_.stopped() ? uint16_t(Flags::stopped) : uint16_t(0);
    done.finish();
    return channel_.send(done.bytes());
  }

  XsResult create(Message&& call) {
    const uint32_t number = call.header.script;
    auto made = std::make_unique<HostedScript>(std::move(call));
    if (!made->good || hostedScripts_.contains(number)) _exit(1);
    HostedScript& hosted = *(hostedScripts_[number] = std::move(made));
    host_.hostedScripts[hosted.info.self] = &hosted;
    const XsResult result = engine_.create(&host_, &hosted.info, &hosted.interpreter);
    if (result != XS_OK) forget(hosted);
    return result;
  }
  void forget(HostedScript& hosted) {
    host_.hostedScripts.erase(hosted.info.self);
    hostedScripts_.erase(hosted.number);
  }
  XsResult event(const HostedScript& hosted, const Message& call) {
    if (!engine_.event) return XS_OK;
    Reader in(call);
    XsEvent event{sizeof(XsEvent), in.take<uint32_t>(), nullptr, {}, call.header.time};
    in.get(event.value);
    if (!in.complete() || event.index >= hosted.fields.size()) _exit(1);
    event.name = hosted.fields[event.index].name;
    return engine_.event(hosted.interpreter, &event);
  }

  XsResult serve(Message& call) {
    const double time = call.header.time;
    const auto op = Op(call.header.op);
    if (op == Op::create) return create(std::move(call));
    const auto found = hostedScripts_.find(call.header.script);
    // The Script could not be created.
    if (found == hostedScripts_.end() && op == Op::destroy) return XS_OK;
    if (found == hostedScripts_.end()) _exit(1);
    HostedScript& hosted = *found->second;
    const auto plain = [&](XsResult (*function)(XsInterpreter, double)) {
      return function ? function(hosted.interpreter, time) : XS_OK;
    };
    switch (op) {
    case Op::initialize: return plain(engine_.initialize);
    case Op::event: return event(hosted, call);
    case Op::eventsProcessed: return plain(engine_.eventsProcessed);
    case Op::shutdown: return plain(engine_.shutdown);
    case Op::tick: return plain(engine_.tick);
    case Op::destroy:
      engine_.destroy(hosted.interpreter);
      forget(hosted);
      return XS_OK;
    default: _exit(1);
    }
  }

  Channel& channel_;
  const XsEngine& engine_;
  Forward host_;
  std::unordered_map<uint32_t, std::unique_ptr<HostedScript>> hostedScripts_;
  bool lastCallSucceeded_ = false; // the last call succeeded
};

const XsEngine& engineNamed(const std::vector<XsEngine>& engines, std::string_view name,
                            const char* library) {
  for (const XsEngine& engine : engines)
    if (name == engine.name) return engine;
  throw std::runtime_error(std::string("script library ") + library + ": no engine " +
                           std::string(name));
}

void serve(Channel& channel) {
  Message setup;
  if (channel.receive(setup, never) != Channel::Received::message ||
      setup.header.op != uint16_t(Op::setup))
    return;
  Writer answer;
  try {
    Reader in(setup);
    if (in.take<uint32_t>() != wire::version)
      throw std::runtime_error("is of another version than the library");
    const auto* library = in.take<const char*>();
    const auto* name = in.take<const char*>();
    const auto steps = in.take<uint64_t>();
    const auto seconds = in.take<double>();
    if (!in.complete() || !library || !name)
      throw std::runtime_error("did not understand the library");
    static const std::vector<XsEngine> engines = loadScriptLibrary(library);
    const XsEngine& engine = engineNamed(engines, name, library);
    if (engine.prepare && engine.prepare() != XS_OK)
      throw std::runtime_error(std::string("engine ") + engine.name + " cannot be prepared");
    const uint64_t base = addressSpace();
    std::string why;
    if (!enterSandbox(why)) throw std::runtime_error("cannot be closed in: " + why);
    answer.begin(Op::ready);
    answer.put(base);
    answer.finish();
    if (channel.send(answer.bytes())) Server(channel, engine, steps, seconds).run();
  } catch (const std::exception& error) {
    answer.begin(Op::failed);
    answer.put(error.what());
    answer.finish();
    channel.send(answer.bytes());
  }
}

} // namespace
} // namespace xvrml

int main(int argc, char** argv) {
  struct stat info {};
  if (argc != 2 || fstat(xvrml::socketNumber, &info) != 0 || !S_ISSOCK(info.st_mode)) {
    std::fputs(
        "xvrml-script-host runs the Scripts of worlds for the XVRML library, which starts it.\n",
        stderr);
    return 2;
  }
  if (!xvrml::bindToParent(std::atol(argv[1]), xvrml::socketNumber)) return 0;
  {
    // The browser may be busy for long before it reads, so the patience is unlimited. The socket
    // and the kernel tell when the browser has ended.
    xvrml::wire::Channel channel(xvrml::socketNumber, std::chrono::hours(10000));
    xvrml::serve(channel);
  }
  _exit(0); // nothing of an interpreter is needed any more
}
