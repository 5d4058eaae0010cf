// decoder.h: decodes files of formats whose libraries are not trusted with the files of strangers.
// The libraries are linked by the program xvrml-decoder, which has given up all rights except
// computing (docs/decisions/0110). A world has one such process. It is started by the first file
// that needs it, started anew when it dies, and ended with the world. [any thread; the files of a
// world are decoded one after the other]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "base/budget.h"
#include "decode/protocol.h"

namespace xvrml {

class Decoder {
 public:
  Decoder();
  // Uses a socket whose other end is already connected (for tests).
  explicit Decoder(int socket);
  ~Decoder(); // ends the process
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  struct File {
    decoding::Format format;
    std::span<const uint8_t> bytes;
    uint64_t mostBytes; // decoded numbers take at most so many; the process may use more
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
  static constexpr double secondsPerFile = 30;   // processor time
  static constexpr double secondsPerWorld = 300; // processor time
  static constexpr int mostEnded = 100;          // processes that a world's files may end

 private:
  struct Process;
  void start();
  void send(const File& file);
  wire::Message& receive();
  void receiveNumbers(const decoding::Contents& contents,
                      const std::function<void(std::span<const char>)>& more);
  void charge();
  [[noreturn]] void lost(std::string why);

  mutable std::mutex mutex_;
  std::unique_ptr<Process> process_;
  double used_ = 0; // seconds of processor time
  int ended_ = 0;   // processes that have ended
};

// Returns the decoder of the world that has this budget; without a budget, one for a single file.
std::shared_ptr<Decoder> decoderOf(Budget* budget);

} // namespace xvrml
