// film.cpp: converts sums of samples to means and sample variances, and stores them in the
// channels' planes.
#include "render/film/film.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace openrt {

Film::Film(uint32_t width, uint32_t height, uint32_t channels, ErrorMap::Kind errors)
    : width_(width), height_(height), channels_(channels), errors_(width, height, errors) {
  for (const ChannelInfo& row : channelTable)
    if (has(row.bit)) plane(row.bit).assign(size_t(width) * height * row.components, row.nothing);
}

namespace {
size_t planeOf(uint32_t channel) {
  return std::min(size_t(std::countr_zero(channel)), size_t(channelBits - 1));
}
} // namespace

std::vector<float>& Film::plane(uint32_t channel) { return planes_[planeOf(channel)]; }

void Film::store(uint32_t x, uint32_t y, const PixelSums& s, const LightSums* light,
                 const PixelError* error) {
  const size_t pixel = size_t(y) * width_ + x;
  const double n = s.samples ? s.samples : 1;
  if (has(RT_RGBA))
    for (int k = 0; k < 4; k++)
      plane(RT_RGBA)[4 * pixel + k] = float(s.rgba[k] / n + (light && k < 3 ? light->mean[k] : 0));
  for (const ChannelInfo& row : channelTable) {
    if (row.source == ChannelSource::film || !has(row.bit)) continue;
    float* const out = &plane(row.bit)[row.components * pixel];
    for (uint32_t k = 0; k < row.components; k++)
      out[k] = row.source == ChannelSource::mean ? float(s.valueSums[row.place + k] / n)
                                                 : s.firstValues[row.place + k];
  }
  for (int k = 0; k < 3 && has(RT_VARIANCE); k++) {
    const double sum2 = s.delta2[k] - s.delta[k] * s.delta[k] / n;
    plane(RT_VARIANCE)[3 * pixel + k] = s.samples > 1 ? float(std::max(sum2, 0.0) / (n - 1)) : 0.0f;
  }
  if (has(RT_ERROR))
    for (int k = 0; k < 3; k++)
      plane(RT_ERROR)[3 * pixel + k] =
          error ? error->halfWidth[k] : std::numeric_limits<float>::infinity();
  if (has(RT_TRUST)) plane(RT_TRUST)[pixel] = error && error->trusted ? 1.0f : 0.0f;
  if (error) errors_.store(pixel, *error);
  if (has(RT_SAMPLES)) plane(RT_SAMPLES)[pixel] = float(s.samples);
}

namespace {

// Writes the pairs of RT_COVERAGE of a pixel with n samples: the largest shares of `hits`.
void writeCoverage(std::span<const HitCount> hits, double n, float* out) {
  std::array<HitCount, coverageNames> largest;
  const auto end =
      std::partial_sort_copy(hits.begin(), hits.end(), largest.begin(), largest.end(),
                             [](const HitCount& a, const HitCount& b) {
                               return a.times != b.times ? a.times > b.times : a.name < b.name;
                             });
  for (auto hit = largest.begin(); hit != end; ++hit) {
    *out++ = float(hit->name);
    *out++ = float(hit->times / n);
  }
}

} // namespace

void Film::storeHits(const Tile& tile, const HitCounts& hits, std::span<const PixelSums> sums) {
  if (!has(RT_COVERAGE)) return;
  const size_t components = channelComponents(RT_COVERAGE);
  std::span<const HitCount> left = hits.all();
  uint32_t place = 0;
  for (uint32_t y = tile.y0; y < tile.y1; y++)
    for (uint32_t x = tile.x0; x < tile.x1; x++, place++) {
      float* const out = &plane(RT_COVERAGE)[components * (size_t(y) * width_ + x)];
      std::fill_n(out, components, 0.0f);
      size_t count = 0;
      while (count < left.size() && left[count].pixel == place) count++;
      // A pixel whose light is not followed has one sample (RT_LIGHT_STRIDE).
      writeCoverage(left.first(count), std::max(sums[place].samples, 1u), out);
      left = left.subspan(count);
    }
}

void Film::finishErrors() {
  errors_.doubtConstants([this](size_t pixel, const float halfWidth[3], bool known) {
    if (has(RT_ERROR))
      std::copy_n(halfWidth, 3, plane(RT_ERROR).begin() + std::ptrdiff_t(3 * pixel));
    if (!known && has(RT_TRUST)) plane(RT_TRUST)[pixel] = 0;
  });
}

void Film::addMissing(const Tile& tile, double bound, double expected) {
  errors_.addMissing(tile, bound, expected, [this](size_t pixel) {
    if (has(RT_TRUST)) plane(RT_TRUST)[pixel] = 0;
  });
}

bool Film::read(uint32_t channel, std::span<float> out) const {
  if (!std::has_single_bit(channel) || !has(channel)) return false;
  const auto& source = planes_[planeOf(channel)];
  if (out.size() < source.size()) return false;
  std::copy(source.begin(), source.end(), out.begin());
  return true;
}

bool Film::clear(uint32_t channel, std::span<float> out) const {
  if (!std::has_single_bit(channel) || !has(channel)) return false;
  const ChannelInfo& row = channelInfo(channel);
  const size_t size = size_t(width_) * height_ * row.components;
  if (out.size() < size) return false;
  std::fill_n(out.begin(), size, row.nothing);
  return true;
}

void Film::copy(uint32_t channel, const Tile& tile, std::span<float> out) const {
  const auto& source = planes_[planeOf(channel)];
  const size_t components = channelComponents(channel);
  for (uint32_t y = tile.y0; y < tile.y1; y++) {
    const size_t first = (size_t(y) * width_ + tile.x0) * components;
    std::copy_n(source.begin() + std::ptrdiff_t(first), (tile.x1 - tile.x0) * components,
                out.begin() + std::ptrdiff_t(first));
  }
}

} // namespace openrt
