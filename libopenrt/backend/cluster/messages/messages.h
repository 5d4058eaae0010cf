// messages.h: encodes and decodes all messages of the protocol (docs/protocol.md): structs in
// memory (kinds.h), a header (messages.fbs) and bulk frames on the wire. Decoding trusts nothing:
// it refuses messages that do not verify, exceed a limit or contradict themselves, with a reason
// and before memory is allocated for them. Pure functions. [any]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "backend/cluster/messages/kinds.h"

namespace openrt::cluster {

inline constexpr uint32_t protocolVersion = 4; // other versions are refused

Hash hashOf(std::span<const std::byte> bytes); // XXH3, 128 bits
std::string hex(const Hash& hash);             // for messages to the user

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
