// flush_denormals.h: RAII guard that flushes denormal floats to zero, as the ray kernels require.
// It is used around all code that computes or rounds the numbers of a picture, so that these do not
// depend on the settings of the thread.
#pragma once

#include <xmmintrin.h>

namespace openrt {

class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

} // namespace openrt
