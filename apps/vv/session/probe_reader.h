// probe_reader.h: Reads the probes of an editor from the still pictures of the viewer that the
// world knows. Owned by a face of the editor. [the browser's thread, while the world can be used]
#pragma once

#include "edit/probes.h"
#include "session/session.h"

namespace vv {

class ProbeReader {
 public:
  // Reads the probes from the picture of the world as it is, a few times a second, and lets them
  // wait when there is none. seconds: time of any clock. Returns whether they say something else.
  bool update(Session& session, Probes& probes, double seconds);

 private:
  double read_ = 0;           // when
  uint64_t finishedRead_ = 0; // the number of the finished frame that they were read from
};

} // namespace vv
