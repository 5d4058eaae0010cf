// pacing.h: Chooses the size and the samples of the next picture. While something moves, the frame
// rate is kept; otherwise the picture becomes as good as possible. Only the resolution is reduced,
// never the light transport. Pure arithmetic without clock, thread or window. Owned by whoever
// starts the frames.
#pragma once

#include <cstdint>

#include "openrt/openrt.h"

namespace picture {

struct FrameSize {
  int width = 1, height = 1, samples = 1;
  int lightStride = 1; // RT_LIGHT_STRIDE
  bool operator==(const FrameSize&) const = default;
};

class Pacing {
 public:
  // The light of a world, and what becomes of it.
  enum class Light : uint8_t {
    sampled, // every pixel gets light, shown as it is
    sparse,  // sampled, and rebuilt: a picture needs its size more than it needs light everywhere
    direct,  // none is sampled: a picture needs its full size more than it needs many samples
    sparseDirect // none is sampled, and rebuilt: light in one of four pixels is enough in motion
  };

  explicit Pacing(double framesPerSecond);

  // Records a frame that has ended or was cancelled.
  //
  //   seconds:    from its start to its end
  //   alone:      part of `seconds` while no other frame was in flight
  //   overhead:   part of `seconds` before tracing (the world is read, structures are built)
  //   samples:    samples taken, mean over the pixels; 0: the cost of a pixel is unknown. Not used
  //               where frame.lightStride is more than 1
  //   rebuilding: part of `seconds` after tracing, in which the picture was rebuilt
  //   showing:    part of `rebuilding` that belongs to the size of shown(), whatever the frame has
  void took(const FrameSize& frame, double seconds, double alone, double overhead, double samples,
            double rebuilding = 0, double showing = 0);

  // Returns the next frame for a window of this size. moving: the viewer or something in the world
  // moves. A moving frame takes at most a frame's time, as predicted from earlier frames. Where
  // that would make it smaller than a quarter of the window in each direction (Light::sparse: than
  // half of it, without sampled light: than the window), it may take half as long again before it
  // shrinks further. Where pictures are rebuilt, one pixel in 4 gets light unless there is time
  // for more. It has at least an eighth of the window in each direction and 64 pixels, and no more
  // while the cost of a pixel is unknown. A frame that does not move fills the window and gets all
  // requested samples.
  FrameSize next(int width, int height, bool moving, int samples, Light light = Light::sampled);

  // Returns a frame between motion and rest: larger than the frames of the motion, because it may
  // take a tenth of a second, if the cost of a pixel is known.
  FrameSize settle(int width, int height, int samples) const;

  // Returns the pixels of the picture that previews make for a window of this size: those of the
  // window, or fewer where they would take more than half of a frame's time.
  FrameSize shown(int width, int height);

  double predicted(const FrameSize& frame) const; // in seconds; 0: unknown

 private:
  // Returns the frame size of a quality step, from the smallest picture to the best. Steps are far
  // enough apart that small variations of the time do not change the step.
  FrameSize at(int step, int width, int height) const;
  int best() const;                             // the best step
  double costOf(const FrameSize& frame) const;  // the cost of a pixel, in costs of one with light
  double seconds(const FrameSize& frame) const; // as predicted(); the cost of a pixel is known

  double budget_; // seconds per frame
  // seconds per sample of a pixel, to rebuild a pixel, to show a picture, and per frame; all
  // smoothed
  double pixel_ = 0, rebuilt_ = 0, showing_ = 0, overhead_ = 0;
  double lastOverhead_ = 0; // overhead of the last frame
  Light light_ = Light::sampled;
  int step_ = 0;
  int shownStep_ = 0;      // that of shown(): 0 is the window, -4 half of it in each direction
  bool growing_ = true;    // the frames of the first motion have not found their size yet
  bool measured_ = false;  // a frame has ended since the last one of a motion was chosen
  int framesWithRoom_ = 0; // consecutive frames that left enough time for a better step
  bool moving_ = false;
};

// Tells which light a world has from the statistics of its last frame, as the engine chose its
// transport. rebuilt: previews of it are rebuilt.
Pacing::Light lightOf(const RTstats& stats, bool rebuilt);

// Returns the light of the same world where previews are not rebuilt.
Pacing::Light rawOf(Pacing::Light light);

} // namespace picture
