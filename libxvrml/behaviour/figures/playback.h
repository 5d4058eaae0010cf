// playback.h: which frame an HAnimMotion has at a time. A pure function of the time since the
// playback began, so that pictures do not depend on when others were made. [any thread]
#pragma once

#include <cstdint>

namespace xvrml {

// The frames that are played, and how: `first` <= `last`, increment is not 0, duration is above 0.
struct PlayedFrames {
  int64_t first = 0, last = 0;
  int64_t increment = 1;
  double duration = 0.1; // seconds of a frame
  bool loop = false;
};

struct PlayedFrame {
  int64_t frame = 0;
  int64_t cycle = 0;     // how often it has begun again
  double cycleBegan = 0; // seconds since the playback began
  bool ended = false;    // the last frame has been shown for its time
  double elapsed = 0;    // seconds since the playback began, at most until its end
};
// Returns the frame at a time in seconds since the playback began with the frame `from`, which is
// one of those that are played.
PlayedFrame playedFrame(const PlayedFrames& played, int64_t from, double seconds);

} // namespace xvrml
