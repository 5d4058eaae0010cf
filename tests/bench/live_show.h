// live_show.h: Shows a scripted turn as vv's window would and keeps each picture, and renders the
// true pictures of its instants. Two modes of bench_live, for live_flip.py.
#pragma once

#include <string>
#include <vector>

#include "libpicture/live/pacing.h"
#include "libpicture/renderer.h"

struct ShowOptions {
  std::string world, folder;     // folder: for the pictures; it exists
  int width = 800, height = 600; // the size of the window
  int threads = 0;
  double fps = 30, seconds = 4;
  double speed = 0.15; // the speed of the turn, in radians per second
  picture::Denoiser denoiser = picture::Denoiser::own;
  bool raw = false; // the samples as they are, instead of rebuilt pictures
  // Not 0: this many pictures at the instants 0, 1, 2 ... instead of those that the clock leaves
  // time for. Then all of them have the size `frame`, and nothing depends on the clock.
  int steps = 0;
  picture::FrameSize frame{400, 300, 1};
  int stillSamples = 4; // with `steps`: samples of the picture after the stop
};

// Writes NNNN.ppm for each instant that was shown, still.ppm (shown half a second after the stop),
// and frames.json: what was shown when. Throws.
void showTurn(const ShowOptions& options);

struct ConvergeOptions {
  std::string world, folder;
  int width = 800, height = 600;
  int threads = 0;
  double fps = 30, speed = 0.15;
  std::vector<int> instants;
  int samples = 1024;  // at most, per pixel
  double error = 0.03; // relative half-width of the error bars at which a part is good enough
  int seed = 0;
};

// Writes NNNN.ppm for each of these instants. Throws.
void convergeTurn(const ConvergeOptions& options);
