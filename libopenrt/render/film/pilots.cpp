// pilots.cpp: the decision rule.
//
// The first pilot has 32 samples per pixel. It predicts a tile's half-width after N samples: noise
// falls as 1/sqrt(N), the bound of a constant pixel beside an edge as 1/N, and the error of light
// paths does not fall. A pilot cannot decide in two cases:
// * untrusted pixels of the tile, or of the surrounding tiles, make up too much of the prediction;
// * the prediction would exceed eight times the pilot's own number of samples.
// The tile then has a further pilot. It has a quarter of the samples that the picture may take, or
// a quarter of that, and so on, but at least twice as many as the previous one. If the largest
// pilot cannot decide either, all allowed samples are taken.
//
// All pilots of a tile together have at most 32 + a third of RT_SAMPLES_PER_PIXEL samples.
#include "render/film/pilots.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/film/light_image.h"

namespace openrt {
namespace {

// Fraction of the target to aim at. It is below 1 because a picture is noisier than its pilot as
// often as less noisy.
constexpr double margin = .9;
constexpr double unknownPart = .25; // fraction of the target that untrusted pixels may make up
// largest predicted number of samples, divided by that of the pilot
constexpr double farthest = 8;
// growth: ratio of the samples of successive pilots. share: samples that the picture may take,
// divided by those of the largest pilot.
constexpr uint32_t growth = 4, share = 4;

// Returns the numbers of samples that tiles may take: four per octave, multiples of 32. The last is
// the number allowed.
std::vector<uint32_t> ladderOf(uint32_t most) {
  std::vector<uint32_t> out;
  for (uint64_t octave = samplesOfPilot; octave < most; octave *= 2)
    for (uint64_t quarter = 4; quarter < 8; quarter++)
      if (const uint64_t n = octave * quarter / 4; n % samplesOfPilot == 0 && n < most)
        out.push_back(uint32_t(n));
  out.push_back(most);
  return out;
}

// Returns the number of samples of the pilot that follows a pilot of `samples`; 0: there is none.
uint32_t pilotAfter(uint32_t samples, uint32_t most) {
  uint32_t next = 0;
  for (uint32_t n = most / share; n >= 2 * samples; n /= growth)
    next = n / samplesOfPilot * samplesOfPilot;
  return next;
}

} // namespace

uint32_t firstPilotOf(const edit::FrameSettingsT& frame, bool timed) {
  if (timed) return frame.targetError > 0 ? std::min(samplesOfPilot, frame.samples) : 1;
  return frame.targetError > 0 && frame.samples > samplesOfPilot ? samplesOfPilot : 0;
}

PilotPixel pilotPixel(PixelError& error, const LightSums* light) {
  PilotPixel out;
  double half = 0;
  for (const float h : error.halfWidth) half += double(h);
  out.trusted = error.trusted;
  if (light) addLight(*light, error);
  const auto scale = double(error.noise.scale);
  out.noise = float(half / scale);
  out.constant = error.constant;
  if (light) out.light = float(lightHalfWidth(*light) / scale);
  return out;
}

Pilots::Pilots(const edit::FrameSettingsT& frame, const TileGrid& grid, bool timed)
    : grid_(grid), width_(frame.width), most_(frame.samples), target_(double(frame.targetError)),
      timed_(timed), ladder_(ladderOf(frame.samples)),
      map_(frame.width, frame.height, ErrorMap::Kind::doubts) {
  const size_t pixels = size_t(frame.width) * frame.height;
  first_.resize(pixels);
  scale_.resize(pixels);
}

void Pilots::note(uint32_t tile, std::span<const PilotPixel> pixels,
                  std::span<const PixelError> errors) {
  const Tile t = grid_.at(tile);
  size_t i = 0;
  for (uint32_t y = t.y0; y < t.y1; y++)
    for (uint32_t x = t.x0; x < t.x1; x++, i++) {
      const size_t at = size_t(y) * width_ + x;
      map_.store(at, errors[i]);
      first_[at] = pixels[i];
      scale_[at] = errors[i].noise.scale;
    }
}

// Predicts the mean over the pixels of their half-widths after `wanted` samples, at most 1 each.
double Pilots::expected(const Tile& tile, std::span<const PilotPixel> pixels, double samples,
                        double wanted) const {
  const double less = std::sqrt(samples / wanted), lessDoubt = samplesOfPilot / wanted;
  double sum = 0;
  size_t i = 0;
  for (uint32_t y = tile.y0; y < tile.y1; y++)
    for (uint32_t x = tile.x0; x < tile.x1; x++, i++) {
      const PilotPixel& p = pixels[i];
      const double doubt = double(doubtOf(p, size_t(y) * width_ + x)) * lessDoubt;
      sum += std::min(1.0, std::hypot(double(p.noise) * less, double(p.light)) + doubt);
    }
  return sum / double(pixels.size());
}

Pilots::Estimate Pilots::estimate(const Tile& tile, std::span<const PilotPixel> pixels,
                                  uint32_t samples) const {
  double light = 0, unknown = 0;
  for (const PilotPixel& p : pixels)
    light += std::min(1.0, double(p.light)) / double(pixels.size());
  // If the error of the light paths alone exceeds the target, samples help until they add little to
  // it.
  const double target = std::max(margin * target_, 1.1 * light);
  const auto enough = [&](uint32_t wanted) {
    return expected(tile, pixels, samples, wanted) <= target;
  };
  const auto found = std::partition_point(ladder_.begin(), ladder_.end() - 1,
                                          [&](uint32_t n) { return !enough(n); });
  Estimate out{*found, 0};
  const double less = std::sqrt(double(samples) / out.wanted);
  for (const PilotPixel& p : pixels)
    if (!p.trusted && !p.constant) unknown += std::min(1.0, double(p.noise) * less);
  out.unknown = unknown / double(pixels.size());
  return out;
}

Pilots::Decision Pilots::decision(const Estimate& o, double unknown, uint32_t samples) const {
  const bool known = unknown <= unknownPart * target_;
  if (known && (o.wanted >= most_ || o.wanted <= farthest * samples)) return {o.wanted, false};
  if (const uint32_t next = timed_ ? 0 : pilotAfter(samples, most_)) return {next, true};
  return {known ? o.wanted : most_, false};
}

std::vector<PilotPixel> Pilots::pixelsOf(const Tile& tile) const {
  std::vector<PilotPixel> out;
  out.reserve(tile.pixels());
  for (uint32_t y = tile.y0; y < tile.y1; y++)
    for (uint32_t x = tile.x0; x < tile.x1; x++) out.push_back(first_[size_t(y) * width_ + x]);
  return out;
}

std::vector<Pilots::Decision> Pilots::decideAll() {
  doubt_.assign(first_.size(), 0);
  map_.doubtConstants([this](size_t pixel, const float half[3], bool) {
    doubt_[pixel] = (half[0] + half[1] + half[2]) / scale_[pixel];
  });
  std::vector<Estimate> estimates;
  for (uint32_t i = 0; i < grid_.count(); i++)
    estimates.push_back(estimate(grid_.at(i), pixelsOf(grid_.at(i)), samplesOfPilot));
  // The neighbouring tiles may be the only ones that have hit a rare feature.
  const uint32_t columns = grid_.columns(), rows = grid_.count() / columns;
  std::vector<Decision> out;
  for (uint32_t i = 0; i < grid_.count(); i++) {
    const uint32_t x = i % columns, y = i / columns;
    double sum = 0, n = 0;
    for (uint32_t v = y - std::min(y, 1u); v <= std::min(y + 1, rows - 1); v++)
      for (uint32_t u = x - std::min(x, 1u); u <= std::min(x + 1, columns - 1); u++) {
        sum += estimates[v * columns + u].unknown;
        n++;
      }
    out.push_back(decision(estimates[i], std::max(estimates[i].unknown, sum / n), samplesOfPilot));
  }
  map_ = {};
  first_ = {};
  scale_ = {};
  return out;
}

Pilots::Decision Pilots::decide(uint32_t tile, std::span<const PilotPixel> pixels,
                                uint32_t samples) const {
  Estimate o = estimate(grid_.at(tile), pixels, samples);
  // With fewer samples than the last pilot, the picture's error would be as unreliable as that of
  // the pilot.
  o.wanted = std::max(o.wanted, samples);
  return decision(o, o.unknown, samples);
}

} // namespace openrt
