#include "decode/decoder.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <unistd.h>

#include "printable.h"

namespace xvrml {

using namespace decoding;
using wire::Channel;
using wire::Clock;

namespace {

constexpr auto slice = std::chrono::milliseconds(50); // between two looks at the process
constexpr int mostIdle = 200;                         // slices in which it does not compute
constexpr double waitFactor = 4; // seconds on the clock for a second of processor time at most
constexpr auto startTime = std::chrono::seconds(20);
constexpr auto patience = std::chrono::seconds(30); // for a process that reads nothing
constexpr uint64_t leastRate = 4 << 20;             // bytes a second that it must read
constexpr uint64_t slack = 64 << 20;                // bytes that libraries allocate on first use
constexpr size_t mostReason = 500;                  // bytes of a message

uint64_t add(uint64_t a, uint64_t b) { return a + std::min(b, ~uint64_t(0) - a); }

} // namespace

struct Decoder::Process {
  Child child;
  std::unique_ptr<Channel> channel;       // closed before the process is waited for
  pid_t owner = getpid();                 // a copy made by fork() must not use the channel
  uint64_t base = 0;                      // bytes of address space when it was ready
  double began = 0;                       // processor time when it was given the current file
  double limit = 0;                       // processor time that the file may take
  Clock::time_point given = Clock::now(); // when it was given the current file
  uint64_t memory = 0;                    // bytes of address space that it may use
  int idle = 0;
  wire::Message message;

  // Returns the processor time of the current file, or a part of the time on the clock if that is
  // more.
  double used() const {
    const std::chrono::duration<double> clock = Clock::now() - given;
    return std::max(child.processorSeconds() - began, clock.count() / waitFactor);
  }
  // Lets the process use so many bytes for a file. The limit only grows, because the process may
  // keep some memory of earlier files.
  void allow(uint64_t bytes) {
    if (base == 0) return;
    memory = std::max(memory, add(base + slack, bytes));
    child.limitMemory(memory);
  }
};

Decoder::Decoder(const DecoderKind& kind) : kind_(kind) {}
Decoder::Decoder(int socket, const DecoderKind& kind)
    : kind_(kind), process_(std::make_unique<Process>()) {
  process_->channel = std::make_unique<Channel>(socket, patience);
}
Decoder::~Decoder() = default;

long Decoder::processNumber() const {
  const std::lock_guard lock(mutex_);
  return process_ ? long(process_->child.number()) : 0;
}

// Adds the processor time of the current file to that of the world.
void Decoder::charge() {
  used_ += process_->used();
  process_->given = Clock::now();
  process_->began = process_->child.processorSeconds();
}

void Decoder::lost(std::string why) {
  charge();
  process_->channel.reset(); // first, because the process may be waiting for us
  if (why.empty()) why = process_->child.ending();
  process_.reset();
  ++ended_;
  throw std::runtime_error(
      fmt::format("{}, which decodes such files, {}", kind_.program.name, why));
}

void Decoder::start() {
  if (process_ && process_->owner != getpid()) process_.reset();
  if (used_ >= secondsPerWorld)
    throw std::runtime_error(fmt::format(
        "the files of this world have taken {} s of processor time to decode", secondsPerWorld));
  if (ended_ >= mostEnded)
    throw std::runtime_error(fmt::format(
        "{} processes of {} have been ended by files of this world", ended_, kind_.program.name));
  if (process_) return;
  std::string why;
  const std::string program = findHelper(kind_.program, why);
  if (program.empty())
    throw std::runtime_error(fmt::format("no program decodes it: {}{}", why, kind_.remedy));
  process_ = std::make_unique<Process>();
  const int socket = process_->child.start(program, why);
  if (socket < 0) {
    process_.reset();
    throw std::runtime_error(fmt::format("no program decodes it: {}", why));
  }
  process_->channel = std::make_unique<Channel>(socket, patience);
  const auto got = process_->channel->receive(process_->message, Clock::now() + startTime);
  if (got == Channel::Received::nothing) lost("is not ready in time");
  if (got != Channel::Received::message) lost({});
  const wire::Message& message = process_->message;
  if (const auto text = contentOf(message); text && message.header.op == uint16_t(Op::failed))
    lost(printable({text->data(), std::min(text->size(), mostReason)}));
  const auto ready = as<Ready>(message, Op::ready);
  if (!ready || ready->version != version) lost("is of another version than the library");
  process_->base = ready->addressSpace;
}

void Decoder::send(const File& file) {
  Channel& channel = *process_->channel;
  const auto until =
      Clock::now() + 2 * patience + std::chrono::seconds(file.bytes.size() / leastRate);
  std::span<const char> left(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
  if (!decoding::send(channel, Op::decode, Request{file.format, 0, left.size(), file.chordError}))
    lost({});
  while (!left.empty()) {
    const auto part = left.first(std::min(left.size(), partBytes));
    if (!decoding::send(channel, Op::bytes, part)) lost({});
    if (Clock::now() > until) lost("reads too slowly");
    left = left.subspan(part.size());
  }
}

// Returns the next message of the process. Its processor time counts, and a fourth of the time on
// the clock, so that one that answers byte by byte is ended as well. One that neither computes nor
// answers is ended sooner.
wire::Message& Decoder::receive() {
  Process& process = *process_;
  for (;;) {
    const auto got = process.channel->receive(process.message, Clock::now() + slice);
    if (got == Channel::Received::closed) lost({});
    if (got == Channel::Received::bad) lost("broke the protocol");
    if (process.used() > process.limit)
      lost(fmt::format("took more than {:.0f} s of processor time, or {:.0f} s on the clock",
                       process.limit, process.limit * waitFactor));
    if (got == Channel::Received::message) return process.message;
    if (!process.child.computes() && ++process.idle > mostIdle) lost("does not answer");
  }
}

void Decoder::receiveNumbers(const Contents& contents,
                             const std::function<void(std::span<const char>)>& more) {
  uint64_t left = contents.columns * contents.rows * contents.components * contents.componentBytes;
  // Only the last part of each step of a decoder is not full. Many small ones would take very long.
  uint64_t parts = 64 + 4 * (left / partBytes);
  for (;;) {
    const wire::Message& message = receive();
    if (message.header.op != uint16_t(Op::bytes)) return;
    if (parts-- == 0) lost("sends too small parts");
    const auto part = contentOf(message);
    if (!part || part->empty() || part->size() > left) lost("broke the protocol");
    left -= part->size();
    more(*part);
  }
}

void Decoder::decode(const File& file, const std::function<bool(const Contents&)>& begin,
                     const std::function<void(std::span<const char>)>& more) {
  const std::lock_guard lock(mutex_);
  start();
  process_->idle = 0;
  process_->given = Clock::now();
  process_->began = process_->child.processorSeconds();
  process_->limit = std::min(kind_.secondsPerFile, secondsPerWorld - used_);
  process_->allow(add(file.bytes.size(), add(file.mostBytes, file.mostBytes)));
  send(file);
  receive();
  if (const auto contents = as<Contents>(process_->message, Op::contents)) {
    bool wanted = false;
    try {
      wanted = begin(*contents);
    } catch (...) {
      charge();
      if (!decoding::send(*process_->channel, Op::stop)) process_.reset();
      throw;
    }
    if (!decoding::send(*process_->channel, wanted ? Op::proceed : Op::stop)) lost({});
    if (!wanted) return finish();
    try {
      receiveNumbers(*contents, more);
    } catch (...) {
      if (process_) charge();
      process_.reset(); // it may be in the middle of the file
      throw;
    }
  }
  const wire::Message& last = process_->message;
  const auto text = contentOf(last);
  if (text && last.header.op == uint16_t(Op::failed)) {
    const std::string why = printable({text->data(), std::min(text->size(), mostReason)});
    finish();
    throw std::runtime_error(why);
  }
  if (last.header.op != uint16_t(Op::end)) lost("broke the protocol");
  finish();
}

void Decoder::finish() {
  charge();
  if (!kind_.servesMore) process_.reset();
}

namespace {

std::shared_ptr<Decoder> made(std::shared_ptr<Decoder> Budget::*place, Budget* budget,
                              const DecoderKind& kind) {
  if (!budget) return std::make_shared<Decoder>(kind);
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (!(budget->*place)) budget->*place = std::make_shared<Decoder>(kind);
  return budget->*place;
}

} // namespace

std::shared_ptr<Decoder> decoderOf(Budget* budget) {
  return made(&Budget::decoder, budget, mediaDecoder);
}

std::shared_ptr<Decoder> stepReaderOf(Budget* budget) {
  return made(&Budget::stepReader, budget, stepReader);
}

} // namespace xvrml
