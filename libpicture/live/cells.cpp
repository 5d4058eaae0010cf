// cells.cpp: Reads cells where light is followed in one pixel of each block of pixels. A cell shows
// the surface of the pixel that has light.
#include <algorithm>
#include <cmath>

#include "libpicture/live/stages.h"

namespace picture::live {

namespace {

constexpr int fewestSamples = 3; // that judge another one

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

bool areAlike(float a, float b) {
  return std::abs(a - b) <= std::max(std::abs(a), std::abs(b)) * alikeFraction + alikeAmount;
}

// The last samples of nine pixels around a place of the frame before: those of the same shape.
struct Samples {
  Samples(const CellPass& pass, size_t pixel);
  float at[9];
  int count = 0;
};

Samples::Samples(const CellPass& pass, size_t pixel) {
  std::fill_n(at, 9, ShownLight::noSample);
  const float pastX = pass.reading.pastX[pixel], pastY = pass.reading.pastY[pixel];
  const Layout& old = pass.shown.layout;
  if (!(pastX >= 0 && pastY >= 0 && pastX < float(old.width) && pastY < float(old.height))) return;
  const size_t middle = old.row(int(pastY + 0.5f)) + size_t(pastX + 0.5f);
  for (int k = 0; k < 9; k++) {
    const size_t i = middle + size_t((k / 3 - 1) * ptrdiff_t(old.stride) + k % 3 - 1);
    if (pass.pixelsBefore.guides.name[i] != pass.pixels.guides.name[pixel]) continue;
    at[k] = pass.shown.light[4 * i + 3];
    if (at[k] >= 0) count++;
  }
}

// Tells whether a luma continues smooth shading, whose samples lie anywhere in their pixels. The
// samples of noise that are rarely light or dark have no such gradient.
bool isSmooth(const Samples& samples, float luma) {
  if (samples.count < 4) return false;
  float least = 1e30f, most = 0, sum = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0, xv = 0, yv = 0;
  for (int k = 0; k < 9; k++) {
    const float v = samples.at[k], dx = float(k % 3 - 1), dy = float(k / 3 - 1);
    if (v < 0) continue;
    least = std::min(least, v);
    most = std::max(most, v);
    sum += v;
    x += dx;
    y += dy;
    xx += dx * dx;
    yy += dy * dy;
    xy += dx * dy;
    xv += dx * v;
    yv += dy * v;
  }
  if (most > 2 * least) return false;
  // The plane of least squares: its gradient and its value in the middle.
  const auto n = float(samples.count);
  const float a = xx - x * x / n, b = yy - y * y / n, c = xy - x * y / n, p = xv - x * sum / n,
              q = yv - y * sum / n;
  const float determinant = a * b - c * c;
  if (determinant < 0.1f) return false;
  const float across = (p * b - q * c) / determinant, down = (q * a - p * c) / determinant;
  const float middle = (sum - across * x - down * y) / n;
  return std::abs(luma - middle) <=
         2 * (std::abs(across) + std::abs(down)) + std::abs(middle) * alikeFraction + alikeAmount;
}

// Judges a sample by those that the pixels around its place had last, as compareRow judges pixels
// by their neighbours. So edges of shadows that are finer than cells are not taken for noise.
float verdictOn(const CellPass& pass, size_t pixel) {
  const Samples samples(pass, pixel);
  const float luma = pass.reading.light.x[pixel];
  int alike = 0, straight = 0;
  float most = 0;
  for (int k = 0; k < 9; k++) {
    if (samples.at[k] < 0) continue;
    alike += areAlike(samples.at[k], luma);
    most = std::max(most, samples.at[k]);
    const float opposite = samples.at[8 - k];
    if (k < 4 && opposite >= 0) straight += areAlike((samples.at[k] + opposite) * 0.5f, luma);
  }
  if (samples.count < fewestSamples) return Work::notJudged;
  if (alike >= 3 || 2 * alike >= samples.count || straight >= 2 || isSmooth(samples, luma))
    return 0;
  return alike < 1 && luma > 2 * most ? lonelyWeight : 1;
}

void setEmpty(size_t i, Moment& now, Reading& reading, Work& work) {
  now.guides.name[i] = emptyName;
  for (Plane* plane : {
           &now.guides.nearness,
           &now.guides.offsetX,
           &now.guides.offsetY,
           &reading.light.x,
           &reading.light.y,
           &reading.light.z,
           &reading.reflection.x,
           &reading.reflection.y,
           &reading.reflection.z,
           &reading.pastNearness,
       })
    (*plane)[i] = 0;
  reading.pastX[i] = reading.pastY[i] = NAN;
  work.verdict[i] = Work::notJudged;
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
    reading.albedo.x[i] = pass.reading.albedo.x[j];
    reading.albedo.y[i] = pass.reading.albedo.y[j];
    reading.albedo.z[i] = pass.reading.albedo.z[j];
    reading.reflection.x[i] = pass.reading.reflection.x[j];
    reading.reflection.y[i] = pass.reading.reflection.y[j];
    reading.reflection.z[i] = pass.reading.reflection.z[j];

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
    // Light of lamps that few paths brought is noise.
    const bool lonely = lamps.luma > pass.reading.light.x[j] * alikeFraction + alikeAmount;
    work.verdict[i] = now.block == 1 ? Work::notJudged : lonely ? lonelyWeight : verdictOn(pass, j);
  }
}

} // namespace picture::live
