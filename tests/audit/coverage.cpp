// coverage.cpp: see coverage.h.
#include "audit/coverage.h"

#include <algorithm>
#include <cmath>

#include "openrt/openrt.h"

namespace audit {
namespace {

std::vector<float> read(RTenum channel, size_t floats) {
  std::vector<float> out(floats);
  rtReadPixels(channel, out.data(), out.size());
  return out;
}

struct Shot {
  std::vector<float> rgba, half, trust, variance;
  RTstats stats{};
};

Shot shoot(size_t pixels, int seed) {
  rtQuality(RT_SEED, seed);
  rtRender();
  Shot s{read(RT_RGBA, 4 * pixels), read(RT_ERROR, 3 * pixels), read(RT_TRUST, pixels), read(RT_VARIANCE, 3 * pixels), {}};
  s.stats.size = sizeof s.stats;
  rtGetStats(&s.stats);
  return s;
}

constexpr int tileEdge = 8;

class Count {
 public:
  Count(const Scenario& s, int seeds, int edge)
      : s_(s), seeds_(seeds), edge_(edge), pixels_(size_t(edge) * size_t(edge)), tilesAcross_((edge + tileEdge - 1) / tileEdge),
        tiles_(size_t(tilesAcross_) * size_t(tilesAcross_)) {}

  // weight: samples of the reference; it and the other pictures are what each picture is compared with.
  void run(const std::vector<Shot>& shots, const std::vector<double>& reference, double weight) {
    std::vector<double> sum(3 * pixels_);
    for (const Shot& shot : shots)
      for (size_t i = 0; i < 3 * pixels_; i++) sum[i] += colour(shot, i);
    double square = 0, variance = 0;
    for (const Shot& shot : shots) {
      double off = 0;
      const double others = weight < 0 ? 0 : s_.samples * (seeds_ - 1.0);
      // Two means compared: the truth has an error of its own.
      const double wider = others > 0 ? std::sqrt(1 + s_.samples / (weight + others)) : 1;
      for (size_t i = 0; i < pixels_; i++) {
        double error = 0, all = .03;
        for (size_t k = 3 * i; k < 3 * i + 3; k++) {
          const double mine = colour(shot, k);
          const double truth =
              others > 0 ? (reference[k] * weight + (sum[k] - mine) * s_.samples) / (weight + others) : reference[k];
          if (k == 3 * i) one(shot, i, mine - truth, wider, truth);
          error += std::fabs(mine - truth) / wider, all += std::fabs(mine);
          square += (mine - truth) * (mine - truth) / wider / wider, variance += double(shot.variance[k]) / s_.samples;
        }
        off += std::min(1.0, error / all) / double(pixels_);
      }
      c.meanError += off / seeds_;
      c.promised += shot.stats.errorMean / seeds_, c.promisedInterval += shot.stats.errorMeanInterval / seeds_;
    }
    c.cost = variance > 0 ? square / variance : 0;
    if (c.intervals()) c.halfWidth /= double(c.intervals());
    bias(shots, reference);
    std::vector<double> shares;
    for (const auto& [held, all] : tiles_)
      if (all > 0) shares.push_back(double(held) / double(all));
    std::sort(shares.begin(), shares.end());
    if (!shares.empty()) c.worstTiles = shares[(shares.size() - 1) / 20];
  }

  Coverage c;

 private:
  static double colour(const Shot& shot, size_t k) { return double(shot.rgba[k / 3 * 4 + k % 3]); }
  void one(const Shot& shot, size_t i, double off, double wider, double truth) {
    const double half = double(shot.half[3 * i]) * wider;
    const bool held = std::fabs(off) <= half + 1e-6 * truth; // sums of floats have rounding errors of their own
    c.pixels++, c.held += held;
    if (shot.trust[i] == 0) return;
    c.trusted++;
    if (half == 0) {
      c.exact++, c.exactHeld += held;
      return;
    }
    c.heldTrusted += held, c.halfWidth += half;
    const size_t x = i % size_t(edge_), y = i / size_t(edge_);
    auto& tile = tiles_[y / tileEdge * size_t(tilesAcross_) + x / tileEdge];
    tile.first += held, tile.second++;
  }
  // Of the mean over the picture: independent from seed to seed.
  void bias(const std::vector<Shot>& shots, const std::vector<double>& reference) {
    double all = 0, sum = 0, sum2 = 0;
    for (double r : reference) all += r;
    for (const Shot& shot : shots) {
      double off = 0;
      for (size_t k = 0; k < 3 * pixels_; k++) off += colour(shot, k) - reference[k];
      sum += off / all, sum2 += off / all * (off / all);
    }
    c.bias = sum / seeds_;
    const double v = std::max(0.0, sum2 / seeds_ - c.bias * c.bias);
    c.biasInterval = seeds_ > 1 ? 2.0 * std::sqrt(v / (seeds_ - 1)) : 1;
  }

  const Scenario& s_;
  int seeds_, edge_;
  size_t pixels_;
  int tilesAcross_;
  std::vector<std::pair<uint64_t, uint64_t>> tiles_; // held, all
};

} // namespace

double Coverage::share() const { return intervals() ? double(heldTrusted) / double(intervals()) : 0; }
double Coverage::shareInterval() const {
  if (!intervals()) return 1;
  const double n = double(intervals()), p = share(), z = 1.959964;
  return z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
}

Coverage measure(const Scenario& s, int seeds, int edge) {
  const size_t pixels = size_t(edge) * size_t(edge);
  s.draw();
  rtQuality(RT_TRANSPORT, s.transport);
  std::vector<double> truth(3 * pixels, s.exact);
  if (s.reference) {
    rtFrameBuffer(edge, edge, RT_RGBA);
    rtQuality(RT_SEED, 1000003);
    rtQuality(RT_SAMPLES_PER_PIXEL, s.reference);
    rtRender();
    const std::vector<float> rgba = read(RT_RGBA, 4 * pixels);
    for (size_t i = 0; i < 3 * pixels; i++) truth[i] = double(rgba[i / 3 * 4 + i % 3]);
  }
  rtFrameBuffer(edge, edge, RT_RGBA | RT_ERROR | RT_TRUST | RT_VARIANCE);
  rtQuality(RT_SAMPLES_PER_PIXEL, s.samples);
  std::vector<Shot> shots;
  for (int seed = 1; seed <= seeds; seed++) shots.push_back(shoot(pixels, seed));
  Count count(s, seeds, edge);
  count.run(shots, truth, s.reference ? s.reference : -1);
  return count.c;
}

} // namespace audit
