#include "libpicture/missing_light.h"

#include <algorithm>
#include <cmath>

#include "student.h"

namespace picture {

namespace {

using Series = std::vector<std::vector<float>>;

// The mean of a series of numbers, and its standard error.
struct Mean {
  double value = 0, error = 0;
};

Mean meanOf(const std::vector<double>& numbers) {
  const double count = double(numbers.size());
  Mean mean;
  for (const double x : numbers) mean.value += x / count;
  for (const double x : numbers) mean.error += (x - mean.value) * (x - mean.value);
  mean.error = std::sqrt(mean.error / (count - 1) / count);
  return mean;
}

struct Rectangle {
  int x, y, width, height;
};

// Returns the mean light of a part, by picture: red, green and blue together.
std::vector<double> lightOf(const Series& pictures, int width, const Rectangle& part) {
  std::vector<double> out;
  for (const std::vector<float>& rgba : pictures) {
    double sum = 0;
    for (int y = part.y; y < part.y + part.height; y++)
      for (int x = part.x; x < part.x + part.width; x++) {
        const float* pixel = &rgba[4 * (size_t(y) * size_t(width) + size_t(x))];
        const double light = double(pixel[0]) + double(pixel[1]) + double(pixel[2]);
        if (std::isfinite(light)) sum += light;
      }
    out.push_back(sum / part.width / part.height);
  }
  return out;
}

struct Comparison {
  Mean sampled, more;
  // Tells whether there is more light than chance explains: by this many standard errors.
  bool isMore(double errors) const {
    return more.value > errors * more.error && more.value > .01 * sampled.value;
  }
};

Comparison compare(const Series& sampled, const Series& hit, int width, const Rectangle& part) {
  const Mean a = meanOf(lightOf(sampled, width, part)), b = meanOf(lightOf(hit, width, part));
  return {a, {b.value - a.value, std::hypot(a.error, b.error)}};
}

} // namespace

// Sums of rare bright hits are skewed: a series that happens to be bright has a large standard
// error, too. So chance exceeds these limits more seldom than by the normal distribution. There are
// many tiles, which need a higher limit than the picture.
MissingLight findMissingLight(const Series& sampled, const Series& hit, int width, int height,
                              int tileEdge) {
  constexpr double errorsOfPicture = 6, errorsOfTile = 8;
  const Comparison whole = compare(sampled, hit, width, {0, 0, width, height});
  const double unit = whole.sampled.value > 0 ? whole.sampled.value : 1;
  MissingLight missing;
  missing.more = whole.more.value / unit;
  missing.interval = student::quantile95(double(hit.size() - 1)) * whole.more.error / unit;
  missing.inPicture = whole.isMore(errorsOfPicture);
  for (int y = 0; y < height; y += tileEdge)
    for (int x = 0; x < width; x += tileEdge) {
      const Rectangle tile{x, y, std::min(tileEdge, width - x), std::min(tileEdge, height - y)};
      missing.tiles++;
      missing.inTiles += compare(sampled, hit, width, tile).isMore(errorsOfTile);
    }
  return missing;
}

} // namespace picture
