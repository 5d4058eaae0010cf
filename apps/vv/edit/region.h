// region.h: A rectangle of the picture: the light of its pixels, and the nodes that are seen in it;
// and the mean of several readings.
// [the browser's thread]
#pragma once

#include <functional>

#include "edit/edit_model.h"
#include "libpicture/pixel_reading.h"

namespace vv {

// From -1 at the left and bottom of the picture to 1 at its right and top.
struct Region {
  double left = 0, bottom = 0, right = 0, top = 0;
};
// Returns the part of the picture between two places, in any order.
Region regionBetween(double x0, double y0, double x1, double y1);

struct PixelRectangle {
  int left = 0, top = 0, width = 0, height = 0; // from the left upper corner
};
// Returns the pixels whose middle is in a region of a picture of this size; at least one.
PixelRectangle pixelsOf(const Region& region, int width, int height);

// The light of several pixels, or of several points of a sensor.
struct MeanReading {
  // The mean with its interval. It is trusted if those of all are; its samples are those of the one
  // with the fewest. It has no colours.
  picture::PixelReading mean;
  double least = 0, most = 0;
  // The least over the mean (EN 12665).
  double uniformity() const { return mean.luminance > 0 ? least / double(mean.luminance) : 0; }
};
// reading: returns one of them, by its number.
MeanReading meanOf(size_t count, const std::function<picture::PixelReading(size_t)>& reading);

struct RegionReading : MeanReading {
  PixelRectangle pixels;
};
// picture: has picture::readingChannels, and linear light.
RegionReading readRegion(const picture::Picture& picture, const Region& region);

// Selects the Shapes that are seen in a region, or the nodes of the file that they belong to. Rays
// of a grid of at most 64 x 64 places decide what is seen: what is narrower than their distance may
// be missed. add: they are added to the selection. [while the world can be used]
void selectIn(WorldEditor& editor, const EditView& view, const Region& region, bool add);

} // namespace vv
