// serve.cpp: enters the cage and answers the library.
#include "serve.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "tools/cage/cage.h"

namespace xvrml::decoding {

void Answer::contents(const Contents& contents) {
  wire::Message reply;
  if (!send(channel_, Op::contents, contents) ||
      channel_.receive(reply, wire::never) != wire::Channel::Received::message)
    _exit(0); // the library has gone
  if (reply.header.op != uint16_t(Op::proceed)) throw Stopped();
}

void Answer::add(const void* numbers, size_t bytes) {
  if (!sendParts(channel_, {static_cast<const char*>(numbers), bytes})) _exit(0);
}

namespace {

constexpr int socketNumber = 3;

std::vector<uint8_t> receiveFile(wire::Channel& channel, uint64_t size) {
  std::vector<uint8_t> file;
  file.reserve(size);
  wire::Message message;
  while (file.size() < size) {
    if (channel.receive(message, wire::never) != wire::Channel::Received::message) _exit(0);
    const auto part = contentOf(message);
    if (!part || message.header.op != uint16_t(Op::bytes) || part->size() > size - file.size())
      _exit(1);
    file.insert(file.end(), part->begin(), part->end());
  }
  return file;
}

bool fail(wire::Channel& channel, std::string_view why) {
  return send(channel, Op::failed, {why.data(), why.size()});
}

void serve(wire::Channel& channel, const Service& service) {
  service.prepare();
  const Ready ready{version, 0, addressSpace()};
  std::string why;
  if (!enterSandbox(why)) {
    fail(channel, "cannot be closed in: " + why);
    return;
  }
  bool connected = send(channel, Op::ready, ready);
  wire::Message message;
  while (connected && channel.receive(message, wire::never) == wire::Channel::Received::message) {
    const auto request = as<Request>(message, Op::decode);
    if (!request) _exit(1);
    try {
      const std::vector<uint8_t> file = receiveFile(channel, request->fileBytes);
      Answer answer(channel);
      service.decode(*request, file, answer);
      connected = send(channel, Op::end);
    } catch (const Stopped&) {
    } catch (const std::bad_alloc&) {
      connected = fail(channel, "it needs more memory than the limits of the world leave");
    } catch (const std::exception& error) { connected = fail(channel, error.what()); }
  }
}

} // namespace

int serveFiles(int argc, char** argv, const Service& service) {
  struct stat info {};
  if (argc != 2 || fstat(socketNumber, &info) != 0 || !S_ISSOCK(info.st_mode)) {
    std::fputs(service.usage, stderr);
    return 2;
  }
  if (!bindToParent(std::atol(argv[1]), socketNumber)) return 0;
  {
    // The library may be busy for long before it reads, so the patience is unlimited. The socket
    // and the kernel tell when the library has ended.
    wire::Channel channel(socketNumber, std::chrono::hours(10000));
    serve(channel, service);
  }
  _exit(0);
}

} // namespace xvrml::decoding
