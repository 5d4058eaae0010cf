#include "edit/region.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "edit/actions.h"

namespace vv {

namespace {

// The error bars of the pixels of a picture may all be too narrow, by as much (docs/accuracy.md).
constexpr double unsureScale = 0.6;
// Rays of a selection, in each direction, and their distance in the picture.
constexpr int mostRays = 64;
constexpr double rayDistance = 0.01;

int raysAlong(double length) {
  return std::clamp(int(std::ceil(length / rayDistance)), 1, mostRays);
}

} // namespace

Region regionBetween(double x0, double y0, double x1, double y1) {
  const auto inside = [](double x) { return std::clamp(x, -1.0, 1.0); };
  return {inside(std::min(x0, x1)), inside(std::min(y0, y1)), inside(std::max(x0, x1)),
          inside(std::max(y0, y1))};
}

PixelRectangle pixelsOf(const Region& region, int width, int height) {
  // Returns the number of the first pixel whose middle is not before a place, from 0 to 1.
  const auto first = [](double place, int count) {
    return std::clamp(int(std::ceil(place * count - .5)), 0, count);
  };
  const int left = std::min(first((1 + region.left) / 2, width), width - 1),
            top = std::min(first((1 - region.top) / 2, height), height - 1);
  return {left, top, std::max(first((1 + region.right) / 2, width) - left, 1),
          std::max(first((1 - region.bottom) / 2, height) - top, 1)};
}

// The errors of readings are independent, so squares of half-widths add up. This also holds for
// upper bounds by the rule of three: for all readings together it is as narrow as for one. Readings
// that are not trusted may err in one direction, so their half-widths are added. The neighbours'
// variance is part of each error bar, so all may be wrong in the same direction (decision 37).
MeanReading meanOf(size_t count, const std::function<picture::PixelReading(size_t)>& reading) {
  MeanReading out;
  double sum = 0, squares = 0, doubtful = 0;
  out.mean.trusted = true;
  for (size_t i = 0; i < count; ++i) {
    const picture::PixelReading one = reading(i);
    const bool isFirst = i == 0;
    const auto value = double(one.luminance), half = double(one.luminanceHalfWidth);
    sum += value;
    (one.trusted ? squares : doubtful) += one.trusted ? half * half : half;
    out.mean.trusted &= one.trusted;
    out.least = isFirst ? value : std::min(out.least, value);
    out.most = isFirst ? value : std::max(out.most, value);
    out.mean.samples = isFirst ? one.samples : std::min(out.mean.samples, one.samples);
  }
  out.mean.luminance = float(sum / double(count));
  const bool isAlone = count == 1; // the error bar of one reading is what it is
  out.mean.luminanceHalfWidth =
      float((std::sqrt(squares) * (isAlone ? 1 : 1 + unsureScale) + doubtful) / double(count));
  return out;
}

RegionReading readRegion(const picture::Picture& picture, const Region& region) {
  const PixelRectangle pixels = pixelsOf(region, picture.width, picture.height);
  const auto width = size_t(pixels.width);
  const MeanReading mean = meanOf(width * size_t(pixels.height), [&](size_t i) {
    return readPixel(picture, pixels.left + int(i % width), pixels.top + int(i / width));
  });
  return {mean, pixels};
}

void selectIn(WorldEditor& editor, const EditView& view, const Region& region, bool add) {
  const int columns = raysAlong(region.right - region.left),
            rows = raysAlong(region.top - region.bottom);
  xvrml::MFNode nodes = add ? editor.selection() : xvrml::MFNode();
  std::set<const xvrml::Node*> seen; // the Shapes
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double x = region.left + (region.right - region.left) * (i + .5) / columns,
                   y = region.top - (region.top - region.bottom) * (j + .5) / rows;
      const xvrml::CameraRay ray = rayThrough(view.camera, view.aspect, x, y);
      xvrml::PickHit hit;
      if (!editor.browser().pick(ray.origin, ray.direction, {.bothSides = true}, hit) ||
          !seen.insert(hit.path.back().node.get()).second)
        continue;
      const xvrml::NodeRef node = nodeOf(editor, std::move(hit), false);
      if (node && std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
    }
  editor.select(std::move(nodes));
}

} // namespace vv
