// flush_denormals.h: within a block of code denormal floats are zero, as the ray kernels want it:
// for all that makes or rounds a picture's numbers, so that these do not depend on the thread.
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
