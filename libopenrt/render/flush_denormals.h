// flush_denormals.h: RAII guard that flushes denormal floats to zero, as the ray kernels require.
// It is used around all code that computes or rounds the numbers of a picture, so that these do not
// depend on the settings of the thread.
#pragma once

#include <cstdint>

#if defined(__x86_64__) || defined(__i386__)
#include <xmmintrin.h>
#endif

namespace openrt {

class FlushDenormals {
 public:
  FlushDenormals() : before_(control()) { setControl(before_ | flush); }
  ~FlushDenormals() { setControl(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__x86_64__) || defined(__i386__)
  using Control = unsigned;
  static constexpr Control flush = 0x8040; // results (FTZ) and operands (DAZ)
  static Control control() { return _mm_getcsr(); }
  static void setControl(Control value) { _mm_setcsr(value); }
#elif defined(__aarch64__)
  using Control = uint64_t;
  static constexpr Control flush = 1 << 24; // FZ: results and operands, of scalars and vectors
  static Control control() {
    Control value;
    asm volatile("mrs %0, fpcr" : "=r"(value));
    return value;
  }
  // Clobbers memory, so that the compiler moves no stores of results past it.
  static void setControl(Control value) { asm volatile("msr fpcr, %0" : : "r"(value) : "memory"); }
#else
#error "flush_denormals.h: how does this processor flush denormal numbers to zero?"
#endif
  Control before_;
};

} // namespace openrt
