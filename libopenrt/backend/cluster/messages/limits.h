// limits.h: Defines the limits of the protocol (docs/protocol.md), for messages and for sessions.
// [any]
#pragma once

#include <cstddef>
#include <cstdint>

namespace openrt::cluster::limits {
// Enough for a Scene with two million arrays.
inline constexpr size_t headerBytes = size_t(64) << 20;
inline constexpr size_t frames = 130; // maximum number of frames of a message, with the header
// Maximum number of bytes of the edits of one commit.
inline constexpr size_t editBytes = size_t(1) << 30;
// Maximum number of bytes of a text in a header; longer texts are cut when sent.
inline constexpr size_t textBytes = 4096;
inline constexpr size_t libraries = 1000;  // maximum number of shader libraries of a scene
inline constexpr size_t statistics = 1000; // maximum number of statistics of a scene
inline constexpr size_t jobs = 4096;       // maximum number of jobs in one message
inline constexpr uint64_t epochs = uint64_t(1) << 40;     // maximum number of epochs in one session
inline constexpr uint64_t arrayBytes = uint64_t(1) << 34; // maximum size of one array
// Smaller arrays are always sent by the master, and not kept in folders.
inline constexpr uint64_t keptArrayBytes = 4096;
// Maximum size of all arrays of one commit.
inline constexpr uint64_t sceneBytes = uint64_t(1) << 36;
inline constexpr size_t arraysAtOnce = 16; // maximum number of arrays that are partly received
// Maximum number of arrays that a worker has asked another one for and not got yet.
inline constexpr size_t arraysAsked = size_t(1) << 16;
// Maximum number of scenes that a worker was sent and has not applied yet.
inline constexpr size_t scenesAtOnce = 1024;
inline constexpr size_t scenesBytes = 2 * editBytes; // maximum size of the edits of these scenes
// Maximum number of messages that a worker has not read.
inline constexpr size_t outboxMessages = size_t(1) << 16;
inline constexpr size_t outboxBytes = size_t(1) << 32; // maximum size of these messages
inline constexpr uint64_t logLines = 1000; // maximum number of log lines of one connection
inline constexpr uint64_t resultBytes = uint64_t(1) << 32; // maximum size of one result
// Maximum number of bytes of a result in one frame, before compression.
inline constexpr size_t chunkBytes = size_t(32) << 20;
} // namespace openrt::cluster::limits
