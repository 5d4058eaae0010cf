#include "render/path/guide_trial.h"

#include <algorithm>
#include <cmath>

namespace openrt {
namespace {

// Neighbouring cells are judged together until they have sent this many rays. Few of them may have
// found light, so the gain of all cells counts like that of `priorRays` more rays.
constexpr double fewestRays = 64, priorRays = 256;
// Measured cost of a guided ray, in ordinary rays: it is chosen among the lobes of its cell, and
// its waves are small.
constexpr double costOfGuided = 3.5;

struct Region { // consecutive cells
  uint32_t begin, end;
  double gain = 0, rays = 0;
  void add(double moreGain, double moreRays) {
    gain += moreGain;
    rays += moreRays;
  }
};

// Divides the cells into regions. They are in the order of a tree, so that consecutive ones are
// near each other.
std::vector<Region> divide(const std::vector<uint32_t>& rays, const std::vector<double>& gain) {
  std::vector<Region> regions;
  for (uint32_t cell = 0; cell < rays.size(); cell++) {
    if (regions.empty() || regions.back().rays >= fewestRays) regions.push_back({cell, cell});
    regions.back().end = cell + 1;
    regions.back().add(gain[cell], rays[cell]);
  }
  if (regions.size() > 1 && regions.back().rays < fewestRays) {
    const Region last = regions.back();
    regions.pop_back();
    regions.back().end = last.end;
    regions.back().add(last.gain, last.rays);
  }
  return regions;
}

// Replaces the gains found in the regions by estimates that have the same sum.
void estimateGains(const Region& all, std::vector<Region>& regions) {
  double sum = 0;
  for (Region& r : regions)
    sum += r.gain = r.rays * (r.gain + priorRays * all.gain / all.rays) / (r.rays + priorRays);
  if (sum > 0)
    for (Region& r : regions) r.gain *= all.gain / sum;
}

} // namespace

// The estimator F of the light that both BSDF sampling (pdf p) and guided rays (pdf g) find has the
// second moment  integral f^2 / (p + g); that of BSDF sampling alone is  integral f^2 / p. The
// difference is the integral of f^2 g / (p (p + g)). A guided ray, sampled with g, has added
// light = f / (p + g), so its estimate of the difference is  f^2 / (p (p + g)) = light^2 / w with
// the weight w = p / (p + g).
void GuideTrial::meet(uint32_t cell, const Vec3f& light, double unguidedWeight) {
  gains_.push_back({cell, dot(Vec3d(light), Vec3d(light)) / unguidedWeight});
}

void GuideTrial::endBlock(std::span<const PixelSums> sums) {
  Block block{0, 0, gains_.size()};
  for (const PixelSums& s : sums) {
    if (s.samples < 2) continue;
    const double n = s.samples;
    for (int k = 0; k < 3; k++) {
      block.mean += s.rgba[k] / n / double(sums.size());
      block.variance += std::max(0.0, s.delta2[k] - s.delta[k] * s.delta[k] / n) * n / (n - 1);
    }
  }
  blocks_.push_back(block);
}

std::vector<uint8_t> GuideTrial::choose(const RayCounters& counters) const {
  double mean = 0;
  for (const Block& b : blocks_) mean += b.mean / double(blocks_.size());
  // Errors count relative to the brightness of the block and of the picture.
  double variance = 0;
  std::vector<double> gain(rays_.size());
  size_t g = 0;
  for (const Block& b : blocks_) {
    const double scale = (b.mean + mean) * (b.mean + mean);
    if (scale > 0) variance += b.variance / scale;
    for (; g < b.end; g++)
      if (scale > 0) gain[gains_[g].cell] += gains_[g].variance / scale;
  }
  std::vector<Region> regions = divide(rays_, gain);
  Region all{0, 0};
  for (const Region& r : regions) all.add(r.gain, r.rays);
  if (!(all.rays > 0)) return std::vector<uint8_t>(rays_.size());
  estimateGains(all, regions);
  std::stable_sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) {
    return a.gain * b.rays > b.gain * a.rays;
  });
  // Begins without any guided ray.
  variance += all.gain;
  double cost = double(counters.camera + counters.shadow + counters.secondary) - all.rays;
  double best = variance * cost;
  size_t kept = 0;
  for (size_t r = 0; r < regions.size(); r++) {
    variance -= regions[r].gain;
    cost += costOfGuided * regions[r].rays;
    if (variance * cost >= best) continue;
    best = variance * cost;
    kept = r + 1;
  }
  std::vector<uint8_t> chosen(rays_.size());
  for (size_t r = 0; r < kept; r++)
    std::fill(chosen.begin() + regions[r].begin, chosen.begin() + regions[r].end, uint8_t(1));
  return chosen;
}

} // namespace openrt
