// pacing.h: how large the next picture is and how many samples it gets, so that the frame rate
// holds while something moves, and the picture becomes as good as it can while nothing does. Never
// less light: only fewer pixels. Numbers alone: no clock, no thread, no window. Owned by a session.
#pragma once

namespace vv {

struct FrameSize {
  int width = 1, height = 1, samples = 1;
  bool operator==(const FrameSize&) const = default;
};

class Pacing {
 public:
  explicit Pacing(double framesPerSecond);

  // A frame has ended, or was given up.
  //   seconds:  from its start to its end
  //   alone:    of these, while no other frame was in flight
  //   overhead: of the seconds, before light was traced (the world is read, structures are built)
  //   samples:  taken, mean over the pixels; 0: not known what a pixel costs
  void took(const FrameSize& frame, double seconds, double alone, double overhead, double samples);

  // The next frame in a window of this size. moving: the viewer, or anything else in the world;
  // then it takes at most a frame's time as far as the frames before tell, at least an eighth of
  // the window each way and 64 pixels; else it is as large as the window and gets the samples that
  // were asked for.
  FrameSize next(int width, int height, bool moving, int samples);

  double predicted(const FrameSize& frame) const; // seconds; 0: nothing is known yet

 private:
  // Of the steps from the least picture to the best. Neighbours are far enough apart to stay at one
  // while times vary.
  FrameSize at(int step, int width, int height) const;

  double budget_;                   // seconds
  double pixel_ = 0, overhead_ = 0; // seconds: of a sample of a pixel, of a frame; smoothed
  int step_ = 0;
  int calm_ = 0; // frames in a row that a better step would have had time for
  bool moving_ = false;
};

} // namespace vv
