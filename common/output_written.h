// output_written.h: whether what a program has printed has arrived. Standard output may be a file
// on a full disk; what is buffered fails only when it is flushed, and after main() nobody hears of
// it. Programs ask at their end, on the main thread.
#pragma once

#include <cerrno>
#include <cstdio>
#include <iostream>

// Flushes standard output. Returns whether all of it could be written; a reader who has gone is no
// fault.
inline bool outputWritten() {
  errno = 0;
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  return (flushed && std::cout.good() && !std::ferror(stdout)) || errno == EPIPE;
}
