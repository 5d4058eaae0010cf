// running.h: which shader class runs on this thread, for handlers of crashes. Whoever calls a
// function of a class puts a RunningShader beside the call. Any thread; runningShader() is
// async-signal-safe.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "openrt/openrts.h"

namespace openrt {

// A class as the host keeps it: every RtsClass that the registry hands out is one.
struct LoadedClass : RtsClass {
  uint16_t minor = RTS_ABI_MINOR;         // of the ABI that its library was made for
  std::string label;                      // "CLASS of LIBRARY"
  mutable std::atomic<bool> found{false}; // somebody asked for it
  // Tables of the host's where a library was loaded anew; empty: the plug-in's own.
  std::vector<RtsParam> mergedParams;
  std::vector<uint8_t> mergedFrequency;
  std::vector<std::string> mergedNames; // by parameter, also of those that are gone
};

inline const char* labelOf(const RtsClass& shaderClass) {
  return static_cast<const LoadedClass&>(shaderClass).label.c_str();
}

inline uint16_t minorOf(const RtsClass& shaderClass) {
  return static_cast<const LoadedClass&>(shaderClass).minor;
}

// No lazy allocation of the thread's storage: a signal handler may come first.
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
    std::atomic_signal_fence(std::memory_order_seq_cst); // the call comes after it
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

// Label of the class whose function runs on this thread, or null.
const char* runningShader() noexcept;

} // namespace openrt
