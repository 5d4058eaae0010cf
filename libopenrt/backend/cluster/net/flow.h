// flow.h: detects whether a connection is still receiving a large message over a slow link. [wire]
#pragma once

#include <cstdint>

namespace openrt::cluster {

class Flow {
 public:
  // Checks the connection's file descriptor once every `window` seconds; call it often.
  void look(int fd, double now, double window);
  // Returns true if much more than heartbeats arrived in the last window. Heartbeats alone do not
  // count: they also arrive while a damaged length makes the connection wait for a frame that never
  // ends.
  bool flowing() const { return flowing_; }

 private:
  double since_ = 0;
  uint64_t bytes_ = 0;
  bool flowing_ = false;
};

} // namespace openrt::cluster
