// running.h: records which shader class runs on the current thread, so that a crash handler can
// name it. Code that calls a function of a class holds a RunningShader during the call. [any
// thread] runningShader() is async-signal-safe.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "openrt/openrts.h"

namespace openrt {

// A class in a loaded library. Every RtsClass that the registry returns is a LoadedClass.
struct LoadedClass : RtsClass {
  std::string label;                      // "CLASS of LIBRARY"
  mutable std::atomic<bool> found{false}; // was returned by find(), so it may be in use
  // The host's tables for a reloaded library; empty: the plug-in's own tables are used.
  std::vector<RtsParam> mergedParams;
  std::vector<uint8_t> mergedFrequency;
  std::vector<std::string> mergedNames; // by parameter, including removed ones
};

inline const char* labelOf(const RtsClass& shaderClass) {
  return static_cast<const LoadedClass&>(shaderClass).label.c_str();
}

// The initial-exec model allocates no storage lazily: a signal handler may be the first to read it.
#if defined(__GNUC__) && !defined(_WIN32)
#define OPENRT_SIGNAL_SAFE_TLS __attribute__((tls_model("initial-exec")))
#else
#define OPENRT_SIGNAL_SAFE_TLS
#endif
extern constinit thread_local const RtsClass* runningClass OPENRT_SIGNAL_SAFE_TLS;

class RunningShader {
 public:
  explicit RunningShader(const RtsClass& shaderClass) : before_(runningClass) {
    runningClass = &shaderClass;
    std::atomic_signal_fence(std::memory_order_seq_cst); // keeps the call behind the store
  }
  ~RunningShader() {
    std::atomic_signal_fence(std::memory_order_seq_cst);
    runningClass = before_;
  }
  RunningShader(const RunningShader&) = delete;
  RunningShader& operator=(const RunningShader&) = delete;

 private:
  const RtsClass* before_;
};

// Returns the label of the class whose function runs on this thread, or null.
const char* runningShader() noexcept;

} // namespace openrt
