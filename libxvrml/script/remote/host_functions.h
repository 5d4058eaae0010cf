// host_functions.h: the functions of XsHost that go through a process's socket, in the order of
// their numbers, and how the browser serves them: it reads the arguments, calls the host's function
// and writes the answer. The coding depends only on the C types of the arguments. The helper's side
// is in tools/script_host/forward.h. The list omits the functions that the helper answers itself
// (now, shouldStop, lastError) and those of trusted worlds (object, number).
#pragma once

#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>

#include "script/remote/wire.h"

namespace xvrml::wire {

template <auto... Members> struct FunctionList {
  static constexpr size_t size = sizeof...(Members);
};
using HostFunctions =
    FunctionList<&XsHost::send, &XsHost::write, &XsHost::read, &XsHost::post, &XsHost::describe,
                 &XsHost::field, &XsHost::findField, &XsHost::retain, &XsHost::release,
                 &XsHost::getName, &XsHost::getVersion, &XsHost::getCurrentSpeed,
                 &XsHost::getCurrentFrameRate, &XsHost::getWorldUrl, &XsHost::setDescription,
                 &XsHost::replaceWorld, &XsHost::loadUrl, &XsHost::createVrmlFromUrl,
                 &XsHost::createVrmlFromString, &XsHost::addRoute, &XsHost::deleteRoute,
                 &XsHost::log, &XsHost::namedNode, &XsHost::rootNodes, &XsHost::sceneFacts,
                 &XsHost::createInstance, &XsHost::nodeWithin, &XsHost::nodeTypes,
                 &XsHost::writeNode, &XsHost::writeScene, &XsHost::otherName>;

// Output arguments.
template <class T> constexpr bool isOut =
    std::is_same_v<T, XsValue*> || std::is_same_v<T, XsString*> || std::is_same_v<T, XsField*> ||
    std::is_same_v<T, XsNodeInfo*>;

// One argument while a function is served.
template <class T> struct Argument {
  T value{};
  void read(Reader& in) { in.get(value); }
  T pass() { return value; }
  void write(Writer&) const {}
};
template <class T>
requires isOut<T>
struct Argument<T> {
  std::remove_pointer_t<T> value{};
  void read(Reader&) {
    if constexpr (std::is_same_v<T, XsNodeInfo*>) value.size = sizeof(XsNodeInfo);
  }
  T pass() { return &value; }
  void write(Writer& out) const { out.put(value); }
};

// Serves one function. Returns false if the message does not fit it. out: the answer, already
// begun.
template <class R, class... A> bool serveOne(R (*XsHost::*function)(const XsHost*, XsNode, A...),
                                             const XsHost& host, XsNode self, Reader& in,
                                             Writer& out) {
  std::tuple<Argument<A>...> arguments;
  std::apply([&](auto&... a) { (a.read(in), ...); }, arguments);
  if (!in.complete()) return false;
  const auto call = [&] {
    return std::apply([&](auto&... a) { return (host.*function)(&host, self, a.pass()...); },
                      arguments);
  };
  if constexpr (std::is_void_v<R>) {
    call();
  } else if constexpr (std::is_same_v<R, double>) {
    out.put(call());
  } else {
    const XsResult result = call();
    out.header().result = result;
    XsString why{"", 0};
    if (result == XS_OK)
      std::apply([&](auto&... a) { (a.write(out), ...); }, arguments);
    else if (host.lastError(&host, self, &why) == XS_OK)
      out.put(why);
    else
      out.put(XsString{"", 0});
  }
  return true;
}

template <class R, class... A> constexpr bool answers(R (*XsHost::*)(const XsHost*, XsNode, A...)) {
  return !std::is_void_v<R>;
}

struct Served {
  bool good;    // false: not a message of this protocol
  bool answers; // the sender waits for the answer
};

// Serves one message of a helper.
template <auto... Members>
Served serve(FunctionList<Members...>, const XsHost& host, const Message& message, Writer& out) {
  using Serve = bool (*)(const XsHost&, XsNode, Reader&, Writer&);
  static constexpr Serve table[] = {[](const XsHost& h, XsNode self, Reader& in, Writer& answer) {
    return serveOne(Members, h, self, in, answer);
  }...};
  static constexpr bool answered[] = {answers(Members)...};
  const size_t index = size_t(message.header.op) - size_t(Op::host);
  if (message.header.op < uint16_t(Op::host) || index >= std::size(table)) return {false, false};
  Reader in(message);
  const auto self = in.take<uint64_t>();
  return {in.good() && table[index](host, self, in, out), answered[index]};
}

} // namespace xvrml::wire
