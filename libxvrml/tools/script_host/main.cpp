// main.cpp: xvrml-script-host: runs programs of Scripts for a browser that does not trust them. The
// browser starts it with one end of a socket pair as file descriptor 3; it loads one engine, gives
// up all it may do, and serves calls until the socket closes. See script/remote/wire.h for the
// messages, docs/scripts.md for people.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>

#include <sys/stat.h>
#include <unistd.h>

#include "cage.h"
#include "forward.h"
#include "script/library.h"

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
    while (channel_.receive(call, never) == Channel::Got::message) {
      const wire::Header header = call.header;
      const bool begins = Op(header.op) == Op::create && (header.flags & Flags::thenInitialize);
      if (!one(call)) return;
      if (!begins || !lastGood_) continue;
      Message next;
      next.header = header;
      next.header.op = uint16_t(Op::initialize);
      if (!one(next)) return;
    }
  }

 private:
  // Serves a call and says that it is done. False: the browser has gone.
  bool one(Message& call) {
    const uint32_t script = call.header.script;
    host_.enter(call.header.time);
    const XsResult result = serve(call);
    lastGood_ = result == XS_OK && !host_.stopped();
    Writer done;
    done.begin(Op::done, script);
    done.header().result = result;
    done.header().flags = host_.stopped() ? uint16_t(Flags::stopped) : uint16_t(0);
    done.finish();
    return channel_.send(done.bytes());
  }

  XsResult create(Message&& call) {
    const uint32_t number = call.header.script;
    auto made = std::make_unique<Guest>(std::move(call));
    if (!made->good || guests_.contains(number)) _exit(1);
    Guest& guest = *(guests_[number] = std::move(made));
    host_.guests[guest.info.self] = &guest;
    const XsResult result = engine_.create(&host_, &guest.info, &guest.interpreter);
    if (result != XS_OK) forget(guest);
    return result;
  }
  void forget(Guest& guest) {
    host_.guests.erase(guest.info.self);
    guests_.erase(guest.number);
  }
  XsResult event(const Guest& guest, const Message& call) {
    if (!engine_.event) return XS_OK;
    Reader in(call);
    XsEvent event{sizeof(XsEvent), in.take<uint32_t>(), nullptr, {}, call.header.time};
    in.get(event.value);
    if (!in.complete() || event.index >= guest.fields.size()) _exit(1);
    event.name = guest.fields[event.index].name;
    return engine_.event(guest.interpreter, &event);
  }

  XsResult serve(Message& call) {
    const double time = call.header.time;
    const auto op = Op(call.header.op);
    if (op == Op::create) return create(std::move(call));
    const auto found = guests_.find(call.header.script);
    if (found == guests_.end() && op == Op::destroy) return XS_OK; // it could not be made
    if (found == guests_.end()) _exit(1);
    Guest& guest = *found->second;
    const auto plain = [&](XsResult (*function)(XsInterpreter, double)) {
      return function ? function(guest.interpreter, time) : XS_OK;
    };
    switch (op) {
    case Op::initialize: return plain(engine_.initialize);
    case Op::event: return event(guest, call);
    case Op::eventsProcessed: return plain(engine_.eventsProcessed);
    case Op::shutdown: return plain(engine_.shutdown);
    case Op::tick: return plain(engine_.tick);
    case Op::destroy:
      engine_.destroy(guest.interpreter);
      forget(guest);
      return XS_OK;
    default: _exit(1);
    }
  }

  Channel& channel_;
  const XsEngine& engine_;
  Forward host_;
  std::unordered_map<uint32_t, std::unique_ptr<Guest>> guests_;
  bool lastGood_ = false; // the last call has succeeded
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
  if (channel.receive(setup, never) != Channel::Got::message ||
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
    if (!closeCage(why)) throw std::runtime_error("cannot be closed in: " + why);
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
    // The browser may look after others for long before it reads; that it has ended is told by the
    // socket and by the kernel.
    xvrml::wire::Channel channel(xvrml::socketNumber, std::chrono::hours(10000));
    xvrml::serve(channel);
  }
  _exit(0); // nothing of an interpreter is of use any more
}
