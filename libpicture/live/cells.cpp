// cells.cpp: Reads cells where light is followed in one pixel of each block of pixels. A cell shows
// the surface of the pixel that has light.
#include <algorithm>
#include <cmath>

#include "libpicture/live/stages.h"

namespace picture::live {

namespace {

// A luma that lies by that fraction and that amount out of a range is unlike it.
constexpr float unlikeFraction = 0.02f, unlikeAmount = 3e-4f;

// The pixels of a cell.
struct Block {
  Block(const Layout& pixels, int edge, int cellX, int cellY)
      : x0(cellX * edge), y0(cellY * edge), x1(std::min(x0 + edge, pixels.width)),
        y1(std::min(y0 + edge, pixels.height)) {}
  int x0, y0, x1, y1;
};

struct Pixel {
  int x = -1, y = -1;
  bool exists() const { return x >= 0; }
};

// Returns the pixel of a block that has light, one that shows a surface if there is one.
Pixel litPixel(const CellPass& pass, const Block& block) {
  const int width = pass.pixels.layout.width;
  Pixel lit;
  for (int y = block.y0; y < block.y1; y++)
    for (int x = block.x0; x < block.x1; x++) {
      const size_t at = size_t(y) * size_t(width) + size_t(x);
      if (!(pass.frame.samples[at] > 0)) continue;
      lit = {x, y};
      if (std::isfinite(pass.frame.depth[at])) return lit;
    }
  return lit;
}

struct Light {
  float luma = 0, orange = 0, green = 0;
};

// Returns the light that paths from lamps brought to the block: the pixels without light of their
// own show it.
Light lampLight(const CellPass& pass, const Block& block, float name) {
  const Layout& layout = pass.pixels.layout;
  const Plane3& light = pass.reading.light;
  Light sum;
  float pixels = 0;
  for (int y = block.y0; y < block.y1; y++)
    for (int x = block.x0; x < block.x1; x++) {
      const size_t at = size_t(y) * size_t(layout.width) + size_t(x), i = layout.row(y) + size_t(x);
      if (pass.frame.samples[at] > 0 || pass.pixels.guides.name[i] != name) continue;
      pixels++;
      sum.luma += light.x[i];
      sum.orange += light.y[i];
      sum.green += light.z[i];
    }
  const float per = 1 / std::max(pixels, 1.0f);
  return {sum.luma * per, sum.orange * per, sum.green * per};
}

// Tells whether the luma at a pixel is unlike what was shown around it.
bool isUnlikeShown(const CellPass& pass, size_t pixel) {
  const float pastX = pass.reading.pastX[pixel], pastY = pass.reading.pastY[pixel];
  const Layout& old = pass.shown.layout;
  if (!(pastX >= 0 && pastY >= 0 && pastX < float(old.width) && pastY < float(old.height)))
    return true;
  const size_t middle = old.row(int(pastY + 0.5f)) + size_t(pastX + 0.5f);
  float least = 1e30f, most = 0;
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const size_t at = middle + size_t(dy * ptrdiff_t(old.stride) + dx);
      if (pass.pixelsBefore.guides.name[at] != pass.pixels.guides.name[pixel]) continue;
      const float luma = pass.shown.light[4 * at];
      least = std::min(least, luma);
      most = std::max(most, luma);
    }
  const float luma = pass.reading.light.x[pixel],
              most2 = most * (1 + unlikeFraction) + unlikeAmount,
              least2 = least * (1 - unlikeFraction) - unlikeAmount;
  return luma > most2 || luma < least2;
}

void setEmpty(size_t i, Moment& now, Reading& reading, Work& work) {
  now.guides.name[i] = emptyName;
  for (Plane* plane :
       {&now.guides.nearness, &now.guides.offsetX, &now.guides.offsetY, &reading.light.x,
        &reading.light.y, &reading.light.z, &reading.pastNearness, &work.changed})
    (*plane)[i] = 0;
  reading.pastX[i] = reading.pastY[i] = NAN;
}

} // namespace

void cellRow(const CellPass& pass, int y, Moment& now, Reading& reading, Work& work) {
  const Layout& layout = pass.pixels.layout;
  const Layout& old = pass.pixelsBefore.layout;
  const auto edge = float(now.block), oldEdge = float(pass.before.block);
  const Resampling alongX(layout.width, std::max(1, old.width)),
      alongY(layout.height, std::max(1, old.height));
  const Guides& from = pass.pixels.guides;
  Guides& to = now.guides;
  for (int x = 0; x < now.layout.width; x++) {
    const size_t i = now.layout.row(y) + size_t(x);
    const Block block(layout, now.block, x, y);
    const Pixel lit = litPixel(pass, block);
    if (!lit.exists()) {
      setEmpty(i, now, reading, work);
      continue;
    }
    const size_t j = layout.row(lit.y) + size_t(lit.x);
    to.name[i] = from.name[j];
    to.nearness[i] = from.nearness[j];
    to.normal.x[i] = from.normal.x[j];
    to.normal.y[i] = from.normal.y[j];
    to.normal.z[i] = from.normal.z[j];

    // The middle of the cell moves as the pixel does.
    const float middleX = edge * float(x) + (edge - 1) / 2,
                middleY = edge * float(y) + (edge - 1) / 2;
    to.offsetX[i] = (float(lit.x) - middleX + from.offsetX[j]) / edge;
    to.offsetY[i] = (float(lit.y) - middleY + from.offsetY[j]) / edge;
    const float pastX = alongX(middleX) + (pass.reading.pastX[j] - alongX(float(lit.x))),
                pastY = alongY(middleY) + (pass.reading.pastY[j] - alongY(float(lit.y)));
    reading.pastX[i] = (pastX + 0.5f) / oldEdge - 0.5f;
    reading.pastY[i] = (pastY + 0.5f) / oldEdge - 0.5f;
    reading.pastNearness[i] = pass.reading.pastNearness[j];

    const Light lamps = lampLight(pass, block, from.name[j]);
    reading.light.x[i] = pass.reading.light.x[j] + lamps.luma;
    reading.light.y[i] = pass.reading.light.y[j] + lamps.orange;
    reading.light.z[i] = pass.reading.light.z[j] + lamps.green;
    work.changed[i] = isUnlikeShown(pass, j) ? 1.0f : 0.0f;
  }
}

} // namespace picture::live
