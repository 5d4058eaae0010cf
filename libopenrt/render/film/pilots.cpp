// pilots.cpp: see pilots.h.
//
// The first pilot has 32 samples a pixel. A tile's half-width after N samples is foretold from it:
// that of noise falls as 1/sqrt(N), the bound of a constant pixel beside an edge as 1/N, that of
// paths from lamps does not fall. Two things make a pilot unable to decide: pixels of it, or of the
// tiles around, that do not trust themselves make up too much of what is foretold; or it would have
// to foretell more than eight times its own number. Then the tile has a further pilot: of a quarter
// of the samples that the picture may take, or of a quarter of that, and so on, at least twice as
// many as before. Where the largest cannot decide either, all samples are taken that are allowed.
//   All pilots of a tile together have at most 32 + a third of RT_SAMPLES_PER_PIXEL samples.
#include "render/film/pilots.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/film/light_image.h"

namespace openrt {
namespace {

constexpr double margin =
    .9; // of the target: a picture has more noise than its pilot as often as less
constexpr double unknownPart = .25; // of the target
constexpr double farthest = 8;      // what is foretold, over the pilot's own number
constexpr uint32_t growth = 4,
                   share =
                       4; // from pilot to pilot; samples allowed, over those of the largest pilot

// The numbers of samples that tiles may take are four an octave, and multiples of 32: the last is
// all that are allowed.
std::vector<uint32_t> ladderOf(uint32_t most) {
  std::vector<uint32_t> out;
  for (uint64_t octave = samplesOfPilot; octave < most; octave *= 2)
    for (uint64_t quarter = 4; quarter < 8; quarter++)
      if (const uint64_t n = octave * quarter / 4; n % samplesOfPilot == 0 && n < most)
        out.push_back(uint32_t(n));
  out.push_back(most);
  return out;
}

// Samples of the pilot after one of so many; 0: there is none.
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

// Mean over the pixels of their half-widths after so many samples, at most 1 each.
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

Pilots::Opinion Pilots::opinion(const Tile& tile, std::span<const PilotPixel> pixels,
                                uint32_t samples) const {
  double light = 0, unknown = 0;
  for (const PilotPixel& p : pixels)
    light += std::min(1.0, double(p.light)) / double(pixels.size());
  // Where paths from lamps alone are over it, samples are of use until they add little.
  const double target = std::max(margin * target_, 1.1 * light);
  const auto enough = [&](uint32_t wanted) {
    return expected(tile, pixels, samples, wanted) <= target;
  };
  const auto found = std::partition_point(ladder_.begin(), ladder_.end() - 1,
                                          [&](uint32_t n) { return !enough(n); });
  Opinion out{*found, 0};
  const double less = std::sqrt(double(samples) / out.wanted);
  for (const PilotPixel& p : pixels)
    if (!p.trusted && !p.constant) unknown += std::min(1.0, double(p.noise) * less);
  out.unknown = unknown / double(pixels.size());
  return out;
}

Pilots::Verdict Pilots::verdict(const Opinion& o, double unknown, uint32_t samples) const {
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

std::vector<Pilots::Verdict> Pilots::judgeAll() {
  doubt_.assign(first_.size(), 0);
  map_.doubtConstants([this](size_t pixel, const float half[3]) {
    doubt_[pixel] = (half[0] + half[1] + half[2]) / scale_[pixel];
  });
  std::vector<Opinion> opinions;
  for (uint32_t i = 0; i < grid_.count(); i++)
    opinions.push_back(opinion(grid_.at(i), pixelsOf(grid_.at(i)), samplesOfPilot));
  // What is rare may have been met by the tiles around alone.
  const uint32_t columns = grid_.columns(), rows = grid_.count() / columns;
  std::vector<Verdict> out;
  for (uint32_t i = 0; i < grid_.count(); i++) {
    const uint32_t x = i % columns, y = i / columns;
    double sum = 0, n = 0;
    for (uint32_t v = y - std::min(y, 1u); v <= std::min(y + 1, rows - 1); v++)
      for (uint32_t u = x - std::min(x, 1u); u <= std::min(x + 1, columns - 1); u++) {
        sum += opinions[v * columns + u].unknown;
        n++;
      }
    out.push_back(verdict(opinions[i], std::max(opinions[i].unknown, sum / n), samplesOfPilot));
  }
  map_ = {};
  first_ = {};
  scale_ = {};
  return out;
}

Pilots::Verdict Pilots::judge(uint32_t tile, std::span<const PilotPixel> pixels,
                              uint32_t samples) const {
  Opinion o = opinion(grid_.at(tile), pixels, samples);
  o.wanted = std::max(
      o.wanted, samples); // with fewer the picture would know itself as little as the last pilot
  return verdict(o, o.unknown, samples);
}

} // namespace openrt
