// stages.h: The stages of Reconstruction::add, each a function of one row of pixels or cells. A
// stage reads what the stages before it wrote, of any row, and writes its own row only. So rows run
// in any order and on any number of threads with the same result. Highway compiles most stages for
// several instruction sets. [any thread]
#pragma once

#include <array>

#include "libpicture/live/planes.h"
#include "libpicture/live/projection.h"

namespace picture::live {

// The planes of a frame, width * height times their number of floats.
struct FramePlanes {
  const float *rgba, *depth, *normal, *albedo, *position, *name, *motion, *samples, *reflection,
      *place;
  const float* variance; // that of the samples in a pixel, not that of their mean; null: unknown
};

// The surfaces of a frame, by pixel or by cell, and what is kept of them for the next frame.
struct Moment {
  Moment() { resize(Layout(1, 1)); } // without a surface: nothing is found in it
  void resize(const Layout& wanted, bool accumulates = true) {
    layout = wanted;
    guides.resize(wanted);
    if (accumulates) accumulated.resize(wanted);
  }

  Layout layout;
  int block = 1; // pixels of a cell each way; 1: cells are pixels
  Projection projection;
  Guides guides;
  Accumulated accumulated;
};

// Two lumas are alike if they differ by less than this fraction and this amount, which cannot be
// told on a screen.
constexpr float alikeFraction = 0.02f, alikeAmount = 3e-4f;
// A bright sample without any like it around counts as that many unlike ones.
constexpr float lonelyWeight = 5;

// Holds what is read of a frame and not kept, by pixel or by cell.
struct Reading {
  void resize(const Layout& layout) {
    for (Plane3* planes : {&albedo, &light, &reflection}) planes->assign(layout.size(), 0);
    for (Plane* plane : {&moveX, &moveY, &pastX, &pastY, &pastNearness, &hitX, &hitY})
      plane->assign(layout.size(), 0);
    for (Plane* plane : {&variance, &reflectionVariance}) plane->assign(layout.size(), unknown);
  }

  // By pixel: how far the surface has moved in the picture since the frame before, in widths and
  // heights of the picture: exactly 0 if it rests, not a number if it was nowhere.
  Plane moveX, moveY;
  // By pixel: the pixel of the shown picture that the sample lies in; -1: there is no sample.
  Plane hitX, hitY;

  // Where the surface was in the frame before, in its pixels or cells (0: centre of the first one),
  // and its nearness there. Not a number: nowhere.
  Plane pastX, pastY, pastNearness;
  Plane3 albedo;     // what the illumination is multiplied by; nowhere 0
  Plane3 light;      // illumination of this frame's samples, without what coats reflect
  Plane3 reflection; // radiance that coats reflect
  // Variance of the luma of both, as the samples in a pixel tell; unknown: there are too few.
  static constexpr float unknown = -1;
  Plane variance, reflectionVariance;
};

// Holds what is computed of the illumination and not kept, by cell.
struct Work {
  void resize(const Layout& layout) {
    filtered.assign(layout.size(), 0);
    for (Plane* plane :
         {&deviation, &expected, &unlike, &variance, &filteredVariance, &limit, &noise, &change,
          &level, &doubt, &otherChange, &otherLevel, &otherDoubt, &calm})
      plane->assign(layout.size(), 0);
    verdict.assign(layout.size(), notJudged);
    found.assign(size_t(layout.height), 0);
    frames.assign(size_t(layout.height), 0);
  }

  // Square of what a cell's luma differs from its neighbours', scaled to the variance of noise
  // without correlation; 1 where that is more than edges and smooth shading explain.
  Plane deviation, unlike;
  // The deviation that the noise of the samples in the pixels explains; negative: unknown.
  Plane expected;
  Plane variance; // variance of the illumination's luma as it goes into the filter
  Plane limit;    // luma beyond that is taken for a rare bright sample
  Plane noise;    // whether this frame's samples are noisy around here, 0 to 1
  // By how much the luma differs from the accumulated one, the accumulated one, and the variance of
  // the difference; each summed up around the cell.
  Plane change, level, doubt, otherChange, otherLevel, otherDoubt;
  // Holds what the samples of the last frames tell about the cell's one, where cells have several
  // pixels: 0: it is like them, or as much as it counts in `unlike`. `calm`: fraction of 0 around
  // the cell.
  static constexpr float notJudged = -1;
  Plane verdict, calm;
  Plane3 filtered;
  Plane filteredVariance;
  // For each row: cells that were found in the frame before, and their frames summed up.
  std::vector<double> found, frames;
};

// The picture of this frame before it is accumulated over time, by pixel of the frame, and what was
// shown of it.
struct Fresh {
  void resize(const Layout& layout) {
    for (Plane3* planes : {&colour, &light, &oldColour}) planes->assign(layout.size(), 0);
    for (Plane* plane : {&noise, &sample, &oldFrames, &trust, &tolerance, &front, &behind, &rests})
      plane->assign(layout.size(), 0);
  }

  Plane3 colour; // red, green and blue
  Plane3 light;  // illumination
  Plane noise;   // 0 to 1: of the illumination
  Plane sample;  // luma of the last sample, or ShownLight::noSample
  // Colour and number of samples that were shown where the sample lies; 0: nothing that counts.
  Plane3 oldColour;
  Plane oldFrames;
  // Whether the frame before has shown the surface.
  static constexpr float unseen = 0, seen = 1, seenAround = 2, forgotten = 3;
  Plane trust;
  Plane tolerance;     // how far the nearness may be from that where it was
  Plane front, behind; // surfaces of other depths beside the pixel (Beside), as offsets in planes
  Plane rests;         // 1: the sample's place in the shown picture has not moved
};

// The colours that the pixels around allow what was shown to have, by pixel of the frame.
struct Bounds {
  void resize(const Layout& layout) {
    for (Plane3* planes : {&low, &high}) planes->assign(layout.size(), 0);
    valid.assign(layout.size(), 0);
  }

  Plane3 low, high;
  Plane valid; // part of the accumulated samples that still counts
};

// Reads a row of pixels: guides, illumination, and where the surfaces were in the frame before.
// rests: no number of the camera has changed since then. sparse: pixels without a sample of light
// have guides. shown: the size of the picture that is shown. isFirst: everything in the frame is
// new, whatever it has moved since a frame that was not added.
struct ReadPass {
  const FramePlanes& frame;
  const Moment& before;
  bool rests, sparse;
  const Layout& shown;
  bool isFirst;
};
void readRow(const ReadPass& pass, int y, Moment& now, Reading& reading);
// Finds shapes that the frame before showed and this one shows nowhere, and marks their pixels in
// what was shown as gone, so that nothing of them stays at their edges (wasUncovered). Shapes of a
// few pixels are left alone.
class NamesSeen {
 public:
  void markGone(const Moment& before, const Moment& now, Shown& shown);

 private:
  std::vector<uint32_t> before_, now_; // pixels of each shape
};
// Reads a row of cells, each from the pixel of its block that has a sample of light.
struct CellPass {
  const FramePlanes& frame;
  const Moment &pixels, &pixelsBefore; // surfaces by pixel
  const Reading& reading;              // by pixel
  const Moment& before;                // cells
  const ShownLight& shown;             // by the frame before
};
void cellRow(const CellPass& pass, int y, Moment& now, Reading& reading, Work& work);

// Compares each cell with its eight neighbours: slopes, `deviation` and `unlike`.
void compareRow(const Reading& reading, int y, Moment& now, Work& work);
// Sums up over 7 x 7 cells of the same surface: `variance`, `limit` and `noise`.
void estimateRow(const Reading& reading, int y, const Moment& now, Work& work);
// Finds what was accumulated on the same surfaces, and by how much this frame differs from it.
void recallRow(const Reading& reading, int y, const Moment& before, Moment& now, Work& work);
// One pass of a filter that sums up these differences over neighbours, `step` cells apart.
struct ChangePass {
  std::array<Plane*, 3> from, to; // change, level and doubt
  int step;
};
void changeRow(const ChangePass& pass, int y, const Moment& now);
// Adds the illumination to what was accumulated, brought to the present brightness.
void accumulateRow(const Reading& reading, int y, Moment& now, Work& work);
// Bounds what was accumulated by what the last few frames show around the cell.
void boundRow(int y, Moment& now);

// One pass of the à-trous filter over illumination and variance. Neighbours are `step` cells apart.
// perPixel: samples in a pixel of the frame, 1 or more.
struct FilterPass {
  const Plane3* from;
  const Plane* variance;
  Plane3* to;
  Plane* toVariance;
  int step;
  float perPixel;
};
void filterRow(const FilterPass& pass, int y, const Moment& now);

// Holds what the stages of the picture read.
struct ColourPass {
  const FramePlanes& frame;
  const Moment &pixels, &before; // surfaces by pixel
  const Reading& reading;        // by pixel
  const Moment& cells;
  const Plane3& cellAlbedo;
  const Plane3& light;      // illumination by cell, filtered
  const Plane3* reflection; // radiance that coats reflect, by cell, filtered; null: none
  const Plane& verdict;
  // By the frame before, and the size of the picture that is shown now.
  const ShownLight& shownLight;
  const Shown& shown;
  const Layout& showing;
};
// Multiplies the illumination by albedo again where cells are pixels, and finds what was shown.
void colourRow(const ColourPass& pass, int y, Fresh& fresh);
// The same where cells have several pixels: each pixel takes its illumination from the cells around
// it that show its surface, or from what was shown.
void spreadRow(const ColourPass& pass, int y, Fresh& fresh);
// Finds which colours the pixels around allow, and keeps the illumination for the next frame.
void boundColourRow(const Layout& layout, int y, const Fresh& fresh, Bounds& bounds,
                    ShownLight& shown);

// Holds what the stage of the shown picture reads.
struct ShowPass {
  const FramePlanes& frame;
  // By pixel of the frame.
  const Moment& pixels;
  const Reading& reading;
  const Fresh& fresh;
  const Bounds& bounds;
  const Overlaps &columns, &rows;
  const Shown& before; // what the frame before has shown
  float perPixel;      // as in FilterPass
};
// Accumulates the colours over time, which smooths edges and textures, in a row of the shown
// picture: each sample counts for the pixel that it lies in. Writes width * 4 floats with the alpha
// of the frame.
void showRow(const ShowPass& pass, int y, Shown& shown, float* rgba);

} // namespace picture::live
