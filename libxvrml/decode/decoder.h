// decoder.h: decodes files of formats whose libraries are not trusted with the files of strangers.
// The libraries are linked by the programs xvrml-decoder and xvrml-step-reader, which have given up
// all rights except computing (docs/decisions/0110, 0114). A world has one process of each. It is
// started by the first file that needs it, started anew when it dies, and ended with the world.
// [any thread; the files of a world are decoded one after the other]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "base/budget.h"
#include "decode/protocol.h"
#include "process/child.h"

namespace xvrml {

// A program that decodes files, and how it is used.
struct DecoderKind {
  HelperProgram program;
  double secondsPerFile; // processor time
  bool servesMore;       // false: the process ends after a file, with all memory that it has kept
  const char* remedy;    // how to get the program, for messages; may be empty
};
inline constexpr DecoderKind mediaDecoder = {decoderProgram, 30, true, ""};
inline constexpr DecoderKind stepReader = {
    stepReaderProgram, 120, false,
    "; STEP models need it: build with Open CASCADE (Debian: libocct-data-exchange-dev)"};

class Decoder {
 public:
  explicit Decoder(const DecoderKind& kind = mediaDecoder);
  // Uses a socket whose other end is already connected (for tests).
  explicit Decoder(int socket, const DecoderKind& kind = mediaDecoder);
  ~Decoder(); // ends the process
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  struct File {
    decoding::Format format;
    std::span<const uint8_t> bytes;
    uint64_t mostBytes;    // decoded numbers take at most so many; the process may use more
    double chordError = 0; // see decoding::Request
  };
  // Decodes a file. begin: is told what the file holds, checks it, and returns whether the numbers
  // are wanted, too. more: is called with parts of the numbers, together as many bytes as begin was
  // told at most. Throws std::runtime_error with the reason if the file cannot be decoded, and
  // whatever the functions throw.
  void decode(const File& file, const std::function<bool(const decoding::Contents&)>& begin,
              const std::function<void(std::span<const char>)>& more);

  // Returns the number of the process; 0 if there is none.
  long processNumber() const;

  // These limits are fixed (docs/limits.md).
  static constexpr double secondsPerWorld = 300; // processor time
  static constexpr int mostEnded = 100;          // processes that a world's files may end

 private:
  struct Process;
  void start();
  void finish();
  void send(const File& file);
  wire::Message& receive();
  void receiveNumbers(const decoding::Contents& contents,
                      const std::function<void(std::span<const char>)>& more);
  void charge();
  [[noreturn]] void lost(std::string why);

  const DecoderKind kind_;
  mutable std::mutex mutex_;
  std::unique_ptr<Process> process_;
  double used_ = 0; // seconds of processor time
  int ended_ = 0;   // processes that have ended
};

// Return the decoder of the world that has this budget; without a budget, one for a single file.
std::shared_ptr<Decoder> decoderOf(Budget* budget);
std::shared_ptr<Decoder> stepReaderOf(Budget* budget);

} // namespace xvrml
