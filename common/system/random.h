// random.h: random bytes for secrets. Any thread.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <system_error>

#include <sys/random.h>
#include <unistd.h>

namespace os {

// Fills bytes with random numbers that nobody can guess. Throws std::system_error.
inline void fillRandomly(unsigned char* bytes, size_t count) {
  constexpr size_t most = 256; // that getentropy gives at once
  for (size_t done = 0; done < count;) {
    const size_t some = std::min(most, count - done);
    if (getentropy(bytes + done, some) != 0)
      throw std::system_error(errno, std::generic_category(), "no random numbers");
    done += some;
  }
}

} // namespace os
