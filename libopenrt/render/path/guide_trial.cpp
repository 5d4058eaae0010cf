#include "render/path/guide_trial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace openrt {
namespace {

// Neighbouring cells are judged together until they have sent this many rays. Few of them may have
// found light, so the gain of all cells counts like that of `priorRays` more rays.
constexpr double fewestRays = 64, priorRays = 256;
// Measured cost of a guided ray, in ordinary rays: it is chosen among the lobes of its cell, and
// its waves are small.
constexpr double costOfGuided = 3.5;

constexpr size_t levels = std::size(GuideTrial::shares);
using Gains = std::array<double, levels>; // by share

void addTo(Gains& sum, const Gains& more) {
  for (size_t l = 0; l < levels; l++) sum[l] += more[l];
}

struct Region { // consecutive cells
  uint32_t begin, end;
  Gains gain{};
  double rays = 0;
  void add(const Gains& moreGain, double moreRays) {
    addTo(gain, moreGain);
    rays += moreRays;
  }
};

// Divides the cells into regions. They are in the order of a tree, so that consecutive ones are
// near each other.
std::vector<Region> divide(const std::vector<uint32_t>& rays, const std::vector<Gains>& gain) {
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
  for (size_t l = 0; l < levels; l++) {
    double sum = 0;
    for (Region& r : regions)
      sum += r.gain[l] =
          r.rays * (r.gain[l] + priorRays * all.gain[l] / all.rays) / (r.rays + priorRays);
    if (sum > 0)
      for (Region& r : regions) r.gain[l] *= all.gain[l] / sum;
  }
}

// A step raises the share of a region from the level below to this one: it gains so much, and sends
// so many more guided rays.
struct Step {
  size_t region, level;
  double gain, rays;
};

// Returns the steps of all regions, those with the most gain for their rays first.
std::vector<Step> stepsOf(const std::vector<Region>& regions) {
  std::vector<Step> steps;
  for (size_t r = 0; r < regions.size(); r++)
    for (size_t l = 0; l < levels; l++) {
      const double gainBelow = l > 0 ? regions[r].gain[l - 1] : 0,
                   shareBelow = l > 0 ? double(GuideTrial::shares[l - 1]) : 0;
      steps.push_back({r, l, regions[r].gain[l] - gainBelow,
                       regions[r].rays * (double(GuideTrial::shares[l]) - shareBelow)});
    }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.gain * b.rays > b.gain * a.rays; });
  return steps;
}

} // namespace

// The estimator F of the light that both BSDF sampling (pdf p) and guided rays (pdf g) find has the
// second moment  integral f^2 / (p + g); that of BSDF sampling alone is  integral f^2 / p. The
// difference is the integral of f^2 g / (p (p + g)). A guided ray, sampled with g, has added
// light = f / (p + g), so its estimate of the difference is  f^2 / (p (p + g)) = light^2 / w with
// the weight w = p / (p + g). If only a share q of the hits sends guided rays, the difference is
// the integral of f^2 q g / (p (p + q g)), for which the same ray gives light^2 q / (w (w + q (1 -
// w))).
void GuideTrial::meet(uint32_t cell, const Vec3f& light, double unguidedWeight) {
  gains_.push_back({cell, dot(Vec3d(light), Vec3d(light)), unguidedWeight});
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

std::vector<float> GuideTrial::choose(const RayCounters& counters, bool always) const {
  double mean = 0;
  for (const Block& b : blocks_) mean += b.mean / double(blocks_.size());
  // Errors count relative to the brightness of the block and of the picture.
  double variance = 0;
  std::vector<Gains> gain(rays_.size());
  size_t g = 0;
  for (const Block& b : blocks_) {
    const double scale = (b.mean + mean) * (b.mean + mean);
    if (scale > 0) variance += b.variance / scale;
    for (; g < b.end; g++)
      for (size_t l = 0; scale > 0 && l < levels; l++)
        gain[gains_[g].cell][l] += gains_[g].at(double(shares[l])) / scale;
  }
  std::vector<float> chosen(rays_.size(), always ? shares[leastAlways] : 0.f);
  std::vector<Region> regions = divide(rays_, gain);
  Region all{0, 0};
  for (const Region& r : regions) all.add(r.gain, r.rays);
  if (!(all.rays > 0)) return chosen;
  estimateGains(all, regions);
  // Begins without any guided ray.
  variance += all.gain[levels - 1];
  double cost = double(counters.camera + counters.shadow + counters.secondary) - all.rays;
  std::vector<Step> steps = stepsOf(regions);
  if (always) {
    variance -= all.gain[leastAlways];
    cost += costOfGuided * double(shares[leastAlways]) * all.rays;
    std::erase_if(steps, [](const Step& s) { return s.level <= leastAlways; });
  }
  double best = variance * cost;
  size_t taken = 0;
  for (size_t s = 0; s < steps.size(); s++) {
    variance -= steps[s].gain;
    cost += costOfGuided * steps[s].rays;
    if (variance * cost >= best) continue;
    best = variance * cost;
    taken = s + 1;
  }
  for (size_t s = 0; s < taken; s++) {
    const Region& r = regions[steps[s].region];
    for (uint32_t cell = r.begin; cell < r.end; cell++)
      chosen[cell] = std::max(chosen[cell], shares[steps[s].level]);
  }
  return chosen;
}

} // namespace openrt
