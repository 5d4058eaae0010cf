// region.h: A rectangle of the picture: the light of its pixels, and the nodes that are seen in it.
// [the browser's thread]
#pragma once

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

struct RegionReading {
  PixelRectangle pixels;
  // The mean luminance with its interval. It is trusted if those of all pixels are; its samples
  // are those of the pixel with the fewest. It has no colours.
  picture::PixelReading mean;
  double least = 0, most = 0; // cd/m2
  // The least over the mean luminance (EN 12665).
  double uniformity() const { return mean.luminance > 0 ? least / double(mean.luminance) : 0; }
};
// picture: has picture::readingChannels, and linear light.
RegionReading readRegion(const picture::Picture& picture, const Region& region);

// Selects the Shapes that are seen in a region, or the nodes of the file that they belong to. Rays
// of a grid of at most 64 x 64 places decide what is seen: what is narrower than their distance may
// be missed. add: they are added to the selection. [while the world can be used]
void selectIn(WorldEditor& editor, const EditView& view, const Region& region, bool add);

} // namespace vv
