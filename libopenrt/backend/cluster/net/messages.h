// messages.h: every message of the protocol (docs/protocol.md), made and read in one place: structs
// on this side, a header (messages.fbs) and bulk frames on the other. Reading believes nothing:
// what does not verify, exceeds a limit or contradicts itself is refused with a reason, before
// memory is taken for it. Pure functions. [any]
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "backend/cluster/net/wire.h"
#include "backend/cluster/worker/worker_core.h"

namespace openrt::cluster {

inline constexpr uint32_t protocolVersion = 2; // another one is refused

namespace limits {
inline constexpr size_t headerBytes = size_t(64) << 20; // of a Scene: two million arrays
inline constexpr size_t frames = 130;                   // of a message, the header included
inline constexpr size_t editBytes = size_t(1) << 30;    // of the edits of one commit
inline constexpr size_t textBytes = 4096; // of a text in a header; longer ones are cut when sent
inline constexpr size_t libraries = 1000; // of a scene
inline constexpr size_t jobs = 4096;      // of a message
inline constexpr uint64_t epochs = uint64_t(1) << 40; // of a session
inline constexpr uint64_t arrayBytes = uint64_t(1) << 34;
inline constexpr uint64_t sceneBytes = uint64_t(1) << 36; // of all arrays of one commit
inline constexpr size_t arraysAtOnce = 16;                // that are in the middle of their pieces
inline constexpr size_t scenesAtOnce = 1024; // that a worker has been sent and has not made yet
inline constexpr size_t scenesBytes = 2 * editBytes;      // of the edits of these
inline constexpr size_t outboxMessages = size_t(1) << 16; // that a worker has not read
inline constexpr size_t outboxBytes = size_t(1) << 32;    // of these
inline constexpr uint64_t logLines = 1000;                // of a connection
inline constexpr uint64_t resultBytes = uint64_t(1) << 32;
inline constexpr size_t chunkBytes = size_t(32)
                                     << 20; // of a result that a frame holds, before it is packed
} // namespace limits

struct Hash {
  uint64_t low = 0, high = 0;
  auto operator<=>(const Hash&) const = default;
};
Hash hashOf(std::span<const std::byte> bytes); // XXH3, 128 bits
std::string hex(const Hash& hash);             // for people

namespace message {

struct Unknown {}; // of a later version: to be ignored

// From the worker.
struct Hello {
  uint32_t protocol = protocolVersion;
  std::string library; // version of OpenRT
  uint32_t api = 0, shaderAbi = 0;
  std::string isa, kernel, platform;
  uint32_t threads = 0;
  std::string host;
  uint32_t process = 0;
};
struct Need {
  Epoch epoch = 0;
  std::vector<Hash> arrays;
};
struct Ready {
  Epoch epoch = 0;
  FrameFacts facts;
  uint8_t transport = 0; // that was chosen
  RTstats stats{};
};
struct Failed {
  Epoch epoch = 0;
  std::string why;
};
struct Fault { // openrt::Fault, of a shader class of the scene
  std::string name, library;
  uint8_t kind = 0;
  uint64_t hits = 0;
};
struct Result {
  Epoch epoch = 0;
  Lease lease = 0;
  double seconds = 0;
  uint64_t camera = 0, shadow = 0, secondary = 0; // rays
  std::vector<Fault> faults;
  std::vector<std::byte> bytes; // of encodeResult; empty before unpack()
  struct Packed {               // as it came
    Frames frames;
    uint64_t bytes = 0, hash = 0;
    bool lz4 = false;
  } packed{};
};
struct Log {
  int level = 0;
  std::string text;
};

// From the master.
struct Welcome {
  uint32_t protocol = protocolVersion;
  uint64_t session = 0;
  float heartbeat = 0.1f, silence = 0.5f; // seconds
};
struct ArrayName {
  ArrayId id = 0;
  uint64_t bytes = 0;
  Hash hash;
};
struct Library {
  std::string name; // bare, as plug-ins are named
  Hash hash;        // of its file
};
struct Scene {
  Epoch epoch = 0;
  bool whole = false, prepare = false; // as of WorkerCore::scene
  std::vector<ArrayName> arrays;       // that the commit brings
  std::vector<Library> libraries;      // that are new in the commit
  std::vector<std::byte> edits;        // packEdits (backend/record/edits_bytes.h)
};
struct Piece {
  Hash hash;
  uint64_t bytes = 0, stored = 0, offset = 0; // of the array; of packArray; in that
  std::vector<std::byte> data;
};
struct Prepare {
  Epoch epoch = 0;
};
struct Jobs {
  Epoch epoch = 0;
  std::vector<LeasedJob> jobs;
};
struct Drop {
  Epoch epoch = 0;
};

// From both. Seen by the Wire, not by those behind it.
struct Beat {
  double sent = 0;
  bool answer = false;
};
struct Bye {
  std::string why;
};

using Body = std::variant<Unknown, Hello, Need, Ready, Failed, Result, Log, Welcome, Scene, Piece,
                          Prepare, Jobs, Drop, Beat, Bye>;

} // namespace message

struct Message {
  uint64_t session = 0;
  message::Body body;
};

Frames encode(uint64_t session, message::Body&& body);
// Empty, or what is wrong with it. What frames hold is taken from them.
std::string decode(Frames&& frames, Message& out, uint64_t largestResult = limits::resultBytes);
// As decode(), but a Result stays packed: what costs time is left to unpack(), on another thread.
std::string decodePacked(Frames&& frames, Message& out,
                         uint64_t largestResult = limits::resultBytes);
std::string unpack(message::Result& result);
// Whether a frame is a Header whose tables lie within it; empty, or what is wrong. kind: number of
// its member of the union.
std::string verifyHeader(std::span<const std::byte> frame, uint8_t& kind);

// How an array travels: packed by zstd, level 1, then piece by piece.
std::vector<std::byte> packArray(std::span<const std::byte> array);
// Null: not an array of so many bytes and of this hash.
ArrayPtr unpackArray(std::span<const std::byte> packed, uint64_t bytes, const Hash& hash);
// Whether an array of so many bytes can have become so few.
bool plausible(uint64_t bytes, uint64_t stored);
// One piece of a packed array; offset: a multiple of pieceBytes, smaller than packed.size().
message::Piece pieceOf(const Hash& hash, uint64_t bytes, std::span<const std::byte> packed,
                       uint64_t offset);

// Faults by the names of their classes, and back; those of classes that are not loaded are left
// out.
std::vector<message::Fault> faultsOf(const ShaderFaults& faults);
ShaderFaults faultsFrom(std::span<const message::Fault> faults, const ShaderRegistry& shaders);

} // namespace openrt::cluster
