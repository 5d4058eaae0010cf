// denoise_choice.h: Decides which previews Open Image Denoise filters, where that depends on the
// time that it takes. Pure arithmetic without clock and thread.
#pragma once

#include <limits>

namespace picture::live {

// The seconds that a picture which moves, at so many frames a second, leaves for the library.
double denoisingInMotion(double framesPerSecond);
// The same for a preview of what has just stopped. The next input waits for it.
constexpr double denoisingAtRest = 0.06;

// How long the library takes, as far as it has been measured.
class DenoiseTime {
 public:
  // Notes that a picture of so many pixels took that long.
  void took(double pixels, double seconds);
  // Replaces what is known: it was measured while nothing else was done with the library.
  void probed(double secondsPerPixel) { perPixel_ = secondsPerPixel; }
  // Returns the seconds for so many pixels; infinity: nothing has been measured.
  double of(double pixels) const { return perPixel_ * pixels; }

 private:
  double perPixel_ = std::numeric_limits<double>::infinity();
};

// Chooses between the two filters for the previews of one viewer. The pictures of the filters
// differ a little, so the choice must not swing: the library gets its turn only where it leaves
// room, keeps it as long as it is in time, and after it has been too slow, waits for twice as many
// frames as the time before. Among n frames there are at most 2 log2(n / firstPause) + 4 changes.
class DenoiseSwitch {
 public:
  static constexpr int firstPause = 32; // frames; nearly a second

  // Returns whether the library filters the next frame. seconds: for which it will take about;
  // allowed: that it may take. Where `allowed` is another than for the frame before, because the
  // viewer stopped or began to move, the choice is made anew.
  bool next(double seconds, double allowed);

 private:
  bool on_ = false;
  double allowed_ = 0;
  int wait_ = 0, pause_ = firstPause; // frames until the library may try again; the next wait
};

} // namespace picture::live
