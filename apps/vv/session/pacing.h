// pacing.h: Chooses the size and the samples of the next picture. While something moves, the frame
// rate is kept; otherwise the picture becomes as good as possible. Only the resolution is reduced,
// never the light transport. Pure arithmetic without clock, thread or window. Owned by a session.
#pragma once

namespace vv {

struct FrameSize {
  int width = 1, height = 1, samples = 1;
  bool operator==(const FrameSize&) const = default;
};

class Pacing {
 public:
  explicit Pacing(double framesPerSecond);

  // Records a frame that has ended or was cancelled.
  //
  //   seconds:  from its start to its end
  //   alone:    part of `seconds` while no other frame was in flight
  //   overhead: part of `seconds` before tracing (the world is read, structures are built)
  //   samples:  samples taken, mean over the pixels; 0: the cost of a pixel is unknown
  void took(const FrameSize& frame, double seconds, double alone, double overhead, double samples);

  // Returns the next frame for a window of this size. moving: the viewer or something in the world
  // moves. A moving frame takes at most a frame's time, as predicted from earlier frames, but has
  // at least an eighth of the window in each direction and 64 pixels. Otherwise the frame fills the
  // window and gets all requested samples.
  FrameSize next(int width, int height, bool moving, int samples);

  double predicted(const FrameSize& frame) const; // in seconds; 0: unknown

 private:
  // Returns the frame size of a quality step, from the smallest picture to the best. Steps are far
  // enough apart that small variations of the time do not change the step.
  FrameSize at(int step, int width, int height) const;

  double budget_; // seconds per frame
  // seconds per sample of a pixel, seconds per frame; both smoothed
  double pixel_ = 0, overhead_ = 0;
  int step_ = 0;
  int framesWithRoom_ = 0; // consecutive frames that left enough time for a better step
  bool moving_ = false;
};

} // namespace vv
