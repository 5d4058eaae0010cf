// output_written.h: Checks whether the printed output of a program was written. Standard output may
// be a file on a full disk; buffered output fails only when it is flushed, and after main() the
// error would be lost. Programs call this at their end, on the main thread.
#pragma once

#include <cerrno>
#include <cstdio>
#include <iostream>

// Flushes standard output and returns whether all of it could be written. A closed pipe is not an
// error.
inline bool outputWritten() {
  errno = 0;
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  return (flushed && std::cout.good() && !std::ferror(stdout)) || errno == EPIPE;
}
