#include "libpicture/false_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "libpicture/luminance.h"
#include "libpicture/neighbours.h"
#include "openrt/openrt.h"
#include "parallel_for.h"

namespace picture {

namespace {

using Colour = std::array<float, 3>;
constexpr Colour black{0, 0, 0};

// The letters of numbers and of the unit, 5 x 7 dots each; a row is a number of 5 bits.
struct Glyph {
  char letter;
  uint8_t rows[7];
};
constexpr Glyph glyphs[] = {{'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
                            {'2', {14, 17, 1, 2, 4, 8, 31}},     {'3', {31, 2, 4, 2, 1, 17, 14}},
                            {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
                            {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
                            {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
                            {'.', {0, 0, 0, 0, 0, 12, 12}},      {'-', {0, 0, 0, 31, 0, 0, 0}},
                            {'+', {0, 4, 4, 31, 4, 4, 0}},       {'e', {0, 0, 14, 17, 31, 16, 14}},
                            {'c', {0, 0, 14, 16, 16, 17, 14}},   {'d', {1, 1, 13, 19, 17, 17, 15}},
                            {'m', {0, 0, 26, 21, 21, 17, 17}},   {'/', {1, 1, 2, 4, 8, 16, 16}}};
constexpr int letterWidth = 6, letterHeight = 7; // with the gap to the next letter

class Canvas {
 public:
  Canvas(int width, int height) {
    out_.width = width;
    out_.height = height;
    out_.linear = false;
    out_.planes[RT_RGBA].assign(size_t(width) * size_t(height) * 4, 1.0f);
  }
  void set(int x, int y, const Colour& colour) {
    if (x < 0 || y < 0 || x >= out_.width || y >= out_.height) return;
    std::copy(colour.begin(), colour.end(),
              out_.planes[RT_RGBA].begin() +
                  std::ptrdiff_t(4 * (size_t(y) * size_t(out_.width) + size_t(x))));
  }
  void fill(int x, int y, int width, int height, const Colour& colour) {
    for (int j = 0; j < height; j++)
      for (int i = 0; i < width; i++) set(x + i, y + j, colour);
  }
  // Writes a text whose left upper corner is at (x, y); a dot has `size` pixels each way.
  void write(int x, int y, int size, std::string_view text) {
    for (const char letter : text) {
      for (const Glyph& glyph : glyphs)
        for (int row = 0; glyph.letter == letter && row < letterHeight; row++)
          for (int column = 0; column < 5; column++)
            if (glyph.rows[row] >> (4 - column) & 1)
              fill(x + column * size, y + row * size, size, size, black);
      x += letterWidth * size;
    }
  }
  Picture take() { return std::move(out_); }

 private:
  Picture out_;
};

// Calls f for each row of a picture, on several threads: the window shows such pictures on its own
// thread.
template <typename F> void eachRow(int height, const F& f) {
  constexpr int rowsOfAPart = 32;
  parallelFor(tbb::blocked_range<int>(0, height, rowsOfAPart),
              [&](const tbb::blocked_range<int>& rows) {
                for (int y = rows.begin(); y < rows.end(); y++) f(y);
              });
}

std::vector<float> luminancesOf(const Picture& picture) {
  const std::vector<float>& rgba = rgbaOf(picture);
  const size_t width = size_t(picture.width);
  std::vector<float> out(rgba.size() / 4);
  eachRow(picture.height, [&](int row) {
    for (size_t i = size_t(row) * width; i < (size_t(row) + 1) * width; i++) {
      const float y = luminanceOf(&rgba[4 * i]);
      out[i] = std::isfinite(y) ? y : 0;
    }
  });
  return out;
}

// Interpolates linearly between the centres of pixels.
std::vector<float> scaled(const std::vector<float>& values, int width, int height, int newWidth,
                          int newHeight) {
  if (width == newWidth && height == newHeight) return values;
  const std::vector<Neighbours> columns = neighbours(width, newWidth),
                                rows = neighbours(height, newHeight);
  std::vector<float> out(size_t(newWidth) * size_t(newHeight));
  eachRow(newHeight, [&](int y) {
    const Neighbours& row = rows[size_t(y)];
    const float *const above = &values[row.first * size_t(width)],
                       *const below = &values[row.second * size_t(width)];
    float* const to = &out[size_t(y) * size_t(newWidth)];
    for (size_t x = 0; x < columns.size(); x++) {
      const Neighbours& c = columns[x];
      const auto weight = float(c.weight);
      const float upper = above[c.first] + weight * (above[c.second] - above[c.first]),
                  lower = below[c.first] + weight * (below[c.second] - below[c.first]);
      to[x] = upper + float(row.weight) * (lower - upper);
    }
  });
  return out;
}

// In a room luminaires are a few percent of the picture, and a hundred times as bright as the rest.
double mostOf(std::vector<float> values) {
  const auto at = values.begin() + std::ptrdiff_t(double(values.size() - 1) * .95);
  std::nth_element(values.begin(), at, values.end());
  const double most = double(*at);
  return most > 0 ? most : 1;
}

// Returns the means over the 5x5 pixels around each, so that noise breaks no isoline.
std::vector<float> smoothed(const std::vector<float>& values, int width, int height) {
  constexpr int reach = 2;
  std::vector<float> along(values.size()), out(values.size());
  eachRow(height, [&](int y) {
    const float* const from = &values[size_t(y) * size_t(width)];
    float* const to = &along[size_t(y) * size_t(width)];
    for (int x = 0; x < width; x++) {
      const int first = std::max(0, x - reach), end = std::min(width, x + reach + 1);
      float sum = 0;
      for (int u = first; u < end; u++) sum += from[u];
      to[x] = sum / float(end - first);
    }
  });
  eachRow(height, [&](int y) {
    float* const to = &out[size_t(y) * size_t(width)];
    const int first = std::max(0, y - reach), end = std::min(height, y + reach + 1);
    for (int v = first; v < end; v++) {
      const float* const from = &along[size_t(v) * size_t(width)];
      for (int x = 0; x < width; x++) to[x] += from[x];
    }
    for (int x = 0; x < width; x++) to[x] /= float(end - first);
  });
  return out;
}

// The sizes of a picture of some height in false colours, in pixels.
struct Sizes {
  explicit Sizes(int height) : dot(std::max(1, height / 300)) {}
  int dot; // size of dots of letters and isolines
  int line() const { return letterHeight * dot; }
  int bar() const { return 12 * dot; }
  int gap() const { return 3 * dot; }
};

constexpr std::string_view unit = "cd/m2";
int labelsOf(const LuminanceScale& scale) { return int(std::lround(scale.top / scale.step)); }
std::string labelOf(const LuminanceScale& scale, int i) {
  return fmt::format("{:g}", scale.step * i);
}

int legendWidth(const LuminanceScale& scale, const Sizes& sizes) {
  size_t letters = unit.size();
  for (int i = 0; i <= labelsOf(scale); i++) letters = std::max(letters, labelOf(scale, i).size());
  return 3 * sizes.gap() + sizes.bar() + int(letters) * letterWidth * sizes.dot;
}

// Draws the colours of the luminances, and isolines over them.
void drawLuminances(const std::vector<float>& luminance, int width, int height,
                    const LuminanceScale& scale, Canvas& canvas) {
  const std::vector<float> smooth = smoothed(luminance, width, height);
  const double lowest = -1, highest = labelsOf(scale);
  std::vector<int> level(smooth.size()); // the isoline below each pixel
  eachRow(height, [&](int y) {
    for (int x = 0; x < width; x++) {
      const size_t at = size_t(y) * size_t(width) + size_t(x);
      canvas.set(x, y, scaleColour(double(luminance[at]) / scale.top));
      // truncated like the positive numbers that light is
      level[at] = int(std::clamp(double(smooth[at]) / scale.step, lowest, highest) + 1);
    }
  });
  const int dot = Sizes(height).dot;
  for (int y = 0; y + 1 < height; y++) {
    const int *const row = &level[size_t(y) * size_t(width)], *const next = row + width;
    for (int x = 0; x + 1 < width; x++)
      if (row[x] != row[x + 1] || row[x] != next[x]) canvas.fill(x, y, dot, dot, black);
  }
}

// Draws the unit, then the bar with a label at each isoline that has room. x: the left side.
void drawLegend(const LuminanceScale& scale, int x, int height, Canvas& canvas) {
  const Sizes sizes(height);
  const int line = sizes.line(), bar = sizes.bar(), gap = sizes.gap(), labels = labelsOf(scale);
  const int top = 2 * line, bottom = height - line, left = x + gap;
  canvas.write(left, line / 2, sizes.dot, unit);
  const int length = std::max(bottom - top, 1);
  for (int y = top; y < bottom; y++)
    canvas.fill(left, y, bar, 1, scaleColour(1 - double(y - top) / length));
  int last = height + line;
  for (int i = 0; i <= labels; i++) {
    const int y = bottom - int(std::lround(double(length) * i / labels));
    canvas.fill(left, std::min(y, bottom - 1), bar, 1, black);
    if (last - y < line + gap || y - line / 2 < line * 3 / 2) continue;
    canvas.write(left + bar + gap, y - line / 2, sizes.dot, labelOf(scale, i));
    last = y;
  }
}

} // namespace

// This is A. Mikhailov, "Turbo, An Improved Rainbow Colormap for
// Visualization", 2019, in its polynomial form.
std::array<float, 3> scaleColour(double at) {
  const double x = std::clamp(at, 0.0, 1.0);
  const auto polynomial = [x](const double(&c)[6]) {
    double sum = 0;
    for (int i = 5; i >= 0; i--) sum = sum * x + c[i];
    return float(std::clamp(sum, 0.0, 1.0));
  };
  return {
      polynomial({.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943}),
      polynomial({.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604}),
      polynomial({.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973})};
}

LuminanceScale luminanceScale(double most) {
  const double fine = most / 10, power = std::pow(10, std::floor(std::log10(fine)));
  LuminanceScale scale;
  scale.step = 10 * power;
  for (const double round : {1.0, 2.0, 5.0})
    if (round * power >= fine * (1 - 1e-9)) {
      scale.step = round * power;
      break;
    }
  scale.top = scale.step * std::ceil(most / scale.step - 1e-9);
  return scale;
}

double mostLuminance(const Picture& picture) { return mostOf(luminancesOf(picture)); }

Picture falseColours(const Picture& picture, std::optional<double> most, Legend legend, int width,
                     int height) {
  if (width <= 0 || height <= 0) {
    width = picture.width;
    height = picture.height;
  }
  const std::vector<float> own = luminancesOf(picture);
  const LuminanceScale scale = luminanceScale(most ? *most : mostOf(own));
  const std::vector<float> luminance = scaled(own, picture.width, picture.height, width, height);
  const bool beside = legend == Legend::beside;
  Canvas canvas(width + (beside ? legendWidth(scale, Sizes(height)) : 0), height);
  drawLuminances(luminance, width, height, scale, canvas);
  if (beside) drawLegend(scale, width, height, canvas);
  Picture out = canvas.take();
  out.note = picture.note;
  return out;
}

Picture falseColourLegend(double most, int height) {
  const LuminanceScale scale = luminanceScale(most);
  Canvas canvas(legendWidth(scale, Sizes(height)), height);
  drawLegend(scale, 0, height, canvas);
  return canvas.take();
}

} // namespace picture
