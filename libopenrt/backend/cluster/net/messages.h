// messages.h: encodes and decodes all messages of the protocol (docs/protocol.md): structs in
// memory, a header (messages.fbs) and bulk frames on the wire. Decoding trusts nothing: it refuses
// messages that do not verify, exceed a limit or contradict themselves, with a reason and before
// memory is allocated for them. Pure functions. [any]
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

inline constexpr uint32_t protocolVersion = 2; // other versions are refused

namespace limits {
// Enough for a Scene with two million arrays.
inline constexpr size_t headerBytes = size_t(64) << 20;
inline constexpr size_t frames = 130;                // frames of a message, including the header
inline constexpr size_t editBytes = size_t(1) << 30; // edits of one commit
// A text in a header; longer ones are cut when sent.
inline constexpr size_t textBytes = 4096;
inline constexpr size_t libraries = 1000;             // shader libraries of a scene
inline constexpr size_t jobs = 4096;                  // jobs in one message
inline constexpr uint64_t epochs = uint64_t(1) << 40; // epochs in one session
inline constexpr uint64_t arrayBytes = uint64_t(1) << 34;
inline constexpr uint64_t sceneBytes = uint64_t(1) << 36; // all arrays of one commit
inline constexpr size_t arraysAtOnce = 16;                // arrays that are partly received
// Scenes that a worker was sent and has not applied yet.
inline constexpr size_t scenesAtOnce = 1024;
inline constexpr size_t scenesBytes = 2 * editBytes;      // edits of these scenes
inline constexpr size_t outboxMessages = size_t(1) << 16; // messages that a worker has not read
inline constexpr size_t outboxBytes = size_t(1) << 32;    // bytes of these messages
inline constexpr uint64_t logLines = 1000;                // log lines of one connection
inline constexpr uint64_t resultBytes = uint64_t(1) << 32;
// Bytes of a result in one frame, before compression.
inline constexpr size_t chunkBytes = size_t(32) << 20;
} // namespace limits

struct Hash {
  uint64_t low = 0, high = 0;
  auto operator<=>(const Hash&) const = default;
};
Hash hashOf(std::span<const std::byte> bytes); // XXH3, 128 bits
std::string hex(const Hash& hash);             // for messages to the user

namespace message {

struct Unknown {}; // a message of a later version; ignored

// Worker to master.
struct Hello {
  uint32_t protocol = protocolVersion;
  std::string library; // OpenRT version
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
  uint8_t transport = 0; // the transport that was chosen
  RTstats stats{};
};
struct Failed {
  Epoch epoch = 0;
  std::string why;
};
struct Fault { // openrt::Fault of a shader class of the scene
  std::string name, library;
  uint8_t kind = 0;
  uint64_t hits = 0;
};
struct Result {
  Epoch epoch = 0;
  Lease lease = 0;
  double seconds = 0;
  uint64_t camera = 0, shadow = 0, secondary = 0; // rays traced
  std::vector<Fault> faults;
  std::vector<std::byte> bytes; // output of encodeResult; empty before unpack()
  struct Packed {               // the frames as received
    Frames frames;
    uint64_t bytes = 0, hash = 0;
    bool lz4 = false;
  } packed{};
};
struct Log {
  int level = 0;
  std::string text;
};

// Master to worker.
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
  std::string name; // bare name, like that of a plug-in
  Hash hash;        // content hash of its file
};
struct Scene {
  Epoch epoch = 0;
  bool whole = false, prepare = false; // as in WorkerCore::scene
  std::vector<ArrayName> arrays;       // arrays that the commit adds
  std::vector<Library> libraries;      // libraries that the commit adds
  std::vector<std::byte> edits;        // output of packEdits (backend/record/edits_bytes.h)
};
struct Piece {
  Hash hash;
  // bytes: size of the array; stored: its size as packed by packArray; offset: into the packed
  // bytes.
  uint64_t bytes = 0, stored = 0, offset = 0;
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

// Both directions. Handled inside the Wire.
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
// Decodes a message; consumes the frames. Returns an empty string, or what is wrong.
std::string decode(Frames&& frames, Message& out, uint64_t largestResult = limits::resultBytes);
// Like decode(), but leaves a Result packed: the expensive unpack() can then run on another thread.
std::string decodePacked(Frames&& frames, Message& out,
                         uint64_t largestResult = limits::resultBytes);
std::string unpack(message::Result& result);
// Verifies that a frame is a Header whose tables lie within it. Returns an empty string, or what is
// wrong. kind: index of the union member.
std::string verifyHeader(std::span<const std::byte> frame, uint8_t& kind);

// Compresses an array for sending (zstd, level 1).
std::vector<std::byte> packArray(std::span<const std::byte> array);
// Returns null if the result does not have this size and hash.
ArrayPtr unpackArray(std::span<const std::byte> packed, uint64_t bytes, const Hash& hash);
// Returns true if an array of `bytes` can be compressed to `stored` bytes.
bool plausible(uint64_t bytes, uint64_t stored);
// Returns one piece of a packed array; offset: a multiple of pieceBytes, less than packed.size().
message::Piece pieceOf(const Hash& hash, uint64_t bytes, std::span<const std::byte> packed,
                       uint64_t offset);

// Convert faults to class names and back. Faults of classes that are not loaded are dropped.
std::vector<message::Fault> faultsOf(const ShaderFaults& faults);
ShaderFaults faultsFrom(std::span<const message::Fault> faults, const ShaderRegistry& shaders);

} // namespace openrt::cluster
