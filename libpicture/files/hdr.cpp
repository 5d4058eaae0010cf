// hdr.cpp: Encodes Radiance pictures (RGBE): G. Ward, "Real Pixels", Graphics Gems II, with the
// run-length code of later files. Numbers are as in the other formats of radiance: 1 is 1 cd/m2.
// [any thread]
#include <algorithm>
#include <array>
#include <cmath>

#include "libpicture/files/formats.h"

namespace picture {

namespace {

using Pixel = std::array<uint8_t, 4>;

// Returns three numbers with one exponent, that of the largest. Readers add half a step to each, so
// the mantissas are cut off. Numbers below 0 and NaN become 0, too large ones the largest.
Pixel rgbeOf(const float* rgb) {
  constexpr float most = 1.6e38f;
  float v[3], largest = 0;
  for (int c = 0; c < 3; ++c) {
    v[c] = rgb[c] > 0 ? std::min(rgb[c], most) : 0;
    largest = std::max(largest, v[c]);
  }
  if (largest < 1e-32f) return {};
  int exponent = 0;
  const float scale = std::frexp(largest, &exponent) * 256 / largest;
  const auto mantissa = [&](int c) { return uint8_t(std::min(v[c] * scale, 255.0f)); };
  return {mantissa(0), mantissa(1), mantissa(2), uint8_t(exponent + 128)};
}

// Appends one of the four planes of a row as runs and literal bytes.
void appendRuns(const std::vector<Pixel>& row, size_t plane, std::string& out) {
  constexpr size_t shortest = 4, longestRun = 127, longestLiteral = 128;
  const auto runAt = [&](size_t x) {
    size_t end = x + 1;
    while (end < row.size() && end - x < longestRun && row[end][plane] == row[x][plane]) ++end;
    return end - x;
  };
  for (size_t x = 0; x < row.size();) {
    size_t run = runAt(x);
    if (run >= shortest) {
      out += char(128 + run);
      out += char(row[x][plane]);
      x += run;
      continue;
    }
    size_t end = x;
    while (end < row.size() && end - x < longestLiteral && (run = runAt(end)) < shortest)
      end = std::min(end + run, x + longestLiteral);
    out += char(end - x);
    for (; x < end; ++x) out += char(row[x][plane]);
  }
}

} // namespace

std::string encodeHdr(const Picture& picture) {
  std::string out = "#?RADIANCE\n";
  if (!picture.note.empty()) out += "# " + picture.note + "\n";
  out += "FORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(picture.height) + " +X " +
         std::to_string(picture.width) + "\n";
  const std::vector<float>& rgba = rgbaOf(picture);
  const size_t width = size_t(picture.width);
  const bool hasRuns = width >= 8 && width <= 32767; // other widths cannot be told from a pixel
  std::vector<Pixel> row(width);
  for (size_t y = 0; y < size_t(picture.height); ++y) {
    for (size_t x = 0; x < width; ++x) row[x] = rgbeOf(rgba.data() + 4 * (y * width + x));
    if (hasRuns) {
      out += {2, 2, char(width >> 8), char(width & 255)};
      for (size_t plane = 0; plane < 4; ++plane) appendRuns(row, plane, out);
    } else {
      for (const Pixel& pixel : row) out.append(pixel.begin(), pixel.end());
    }
  }
  return out;
}

} // namespace picture
