// stages.h: The stages of Reconstruction::add, each a function of one row of pixels. A stage reads
// what the stages before it wrote, of any row, and writes its own row only. So rows run in any
// order and on any number of threads with the same result. Highway compiles each stage for several
// instruction sets. [any thread]
#pragma once

#include <array>

#include "libpicture/live/planes.h"
#include "libpicture/live/projection.h"

namespace picture::live {

// The planes of a frame, width * height times their number of floats.
struct FramePlanes {
  const float *rgba, *depth, *normal, *albedo, *position, *name, *motion, *samples;
};

// What is kept of a frame for the next one.
struct Moment {
  Moment() { resize(Layout(1, 1)); } // without a surface: nothing is found in it
  void resize(const Layout& wanted) {
    layout = wanted;
    guides.resize(wanted);
    accumulated.resize(wanted);
  }

  Layout layout;
  Projection projection;
  Guides guides;
  Accumulated accumulated;
};

// What is computed of a frame and not kept.
struct Work {
  void resize(const Layout& layout) {
    for (Plane3* planes : {&albedo, &light, &filtered, &colour}) planes->assign(layout.size(), 0);
    for (Plane* plane :
         {&pastX, &pastY, &pastNearness, &deviation, &unlike, &variance, &filteredVariance, &limit,
          &noise, &change, &level, &doubt, &otherChange, &otherLevel, &otherDoubt})
      plane->assign(layout.size(), 0);
    found.assign(size_t(layout.height), 0);
    frames.assign(size_t(layout.height), 0);
  }

  // Where the surface was in the frame before, in its pixels (0: centre of the first pixel), and
  // its nearness there. Not a number: nowhere.
  Plane pastX, pastY, pastNearness;
  Plane3 albedo; // what the illumination is multiplied by; nowhere 0
  Plane3 light;  // illumination of this frame's samples
  // Square of what a pixel's luma differs from its neighbours', scaled to the variance of noise
  // without correlation; 1 where that is more than edges and smooth shading explain.
  Plane deviation, unlike;
  Plane variance; // of the illumination's luma as it goes into the filter
  Plane limit;    // luma beyond that is taken for a rare bright sample
  Plane noise;    // whether this frame's samples are noisy around here, 0 to 1
  // By how much the luma differs from the accumulated one, the accumulated one, and the variance of
  // the difference; each summed up around the pixel.
  Plane change, level, doubt, otherChange, otherLevel, otherDoubt;
  Plane3 filtered;
  Plane filteredVariance;
  Plane3 colour; // red, green and blue of the frame before accumulation over time
  // For each row: pixels that were found in the frame before, and their frames summed up.
  std::vector<double> found, frames;
};

// Reads a row: guides, illumination, and where the surfaces were in the frame before. rests: no
// number of the camera has changed since then.
void readRow(const FramePlanes& frame, const Moment& before, bool rests, int y, Moment& now,
             Work& work);
// Compares each pixel with its eight neighbours: slopes, `deviation` and `unlike`.
void compareRow(int y, Moment& now, Work& work);
// Sums up over 7 x 7 pixels of the same surface: `variance`, `limit` and `noise`.
void estimateRow(int y, const Moment& now, Work& work);
// Finds what was accumulated on the same surfaces, and by how much this frame differs from it.
void recallRow(int y, const Moment& before, Moment& now, Work& work);
// One pass of a filter that sums up these differences over neighbours, `step` pixels apart.
struct ChangePass {
  std::array<Plane*, 3> from, to; // change, level and doubt
  int step;
};
void changeRow(const ChangePass& pass, int y, const Moment& now);
// Adds the illumination to what was accumulated, brought to the present brightness.
void accumulateRow(int y, Moment& now, Work& work);
// Bounds what was accumulated by what the last few frames show around the pixel.
void boundRow(int y, Moment& now);

// One pass of the à-trous filter over illumination and variance. Neighbours are `step` pixels
// apart.
struct FilterPass {
  const Plane3* from;
  const Plane* variance;
  Plane3* to;
  Plane* toVariance;
  int step;
};
void filterRow(const FilterPass& pass, int y, const Moment& now);

// Multiplies illumination by albedo again.
void colourRow(const Plane3& light, int y, const Moment& now, Work& work);
// Accumulates the colours over time, which smooths edges and textures, and writes width * 4 floats
// with the alpha of the frame.
void showRow(const FramePlanes& frame, int y, const Moment& before, Moment& now, const Work& work,
             float* rgba);

} // namespace picture::live
