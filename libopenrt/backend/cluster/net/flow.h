// flow.h: whether a connection carries a message that has not come whole: a large one on a slow
// line. [wire]
#pragma once

#include <cstdint>

namespace openrt::cluster {

class Flow {
 public:
  // To be called often; looks at the file of a connection once in `window` seconds.
  void look(int fd, double now, double window);
  // Much more came in the last window than beats: these also come where a damaged length has the
  // connection wait for a frame that never ends.
  bool flowing() const { return flowing_; }

 private:
  double since_ = 0;
  uint64_t bytes_ = 0;
  bool flowing_ = false;
};

} // namespace openrt::cluster
