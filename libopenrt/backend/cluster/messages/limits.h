// limits.h: the limits of the protocol (docs/protocol.md), for messages and for sessions. [any]
#pragma once

#include <cstddef>
#include <cstdint>

namespace openrt::cluster::limits {
// Enough for a Scene with two million arrays.
inline constexpr size_t headerBytes = size_t(64) << 20;
inline constexpr size_t frames = 130;                // frames of a message, including the header
inline constexpr size_t editBytes = size_t(1) << 30; // edits of one commit
// A text in a header; longer ones are cut when sent.
inline constexpr size_t textBytes = 4096;
inline constexpr size_t libraries = 1000;             // shader libraries of a scene
inline constexpr size_t statistics = 1000;            // statistics of a scene
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
} // namespace openrt::cluster::limits
