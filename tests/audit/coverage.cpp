#include "audit/coverage.h"

#include "openrt/openrt.h"

namespace audit {
namespace {

constexpr int tileEdge = 8;

std::vector<float> read(RTenum channel, size_t floats) {
  std::vector<float> out(floats);
  rtReadPixels(channel, out.data(), out.size());
  return out;
}

picture::Shot shoot(size_t pixels, int samples, int seed) {
  rtQuality(RT_SEED, seed);
  rtRender();
  RTstats stats{};
  stats.size = sizeof stats;
  rtGetStats(&stats);
  return {read(RT_RGBA, 4 * pixels), read(RT_ERROR, 3 * pixels),
          read(RT_TRUST, pixels),    read(RT_VARIANCE, 3 * pixels),
          double(samples),           stats.error.mean,
          stats.error.meanInterval};
}

} // namespace

Judge::Judge(const Scenario& s, int edge) : scenario_(s), edge_(edge) {
  const size_t pixels = size_t(edge) * size_t(edge);
  s.draw();
  rtQuality(RT_TRANSPORT, s.transport);
  reference_.colours.assign(3 * pixels, s.exact);
  if (s.reference == 0) return;
  rtFrameBuffer(edge, edge, RT_RGBA);
  rtQuality(RT_SEED, 1000003);
  rtQuality(RT_SAMPLES_PER_PIXEL, s.reference);
  rtRender();
  const std::vector<float> rgba = read(RT_RGBA, 4 * pixels);
  for (size_t k = 0; k < 3 * pixels; k++) reference_.colours[k] = double(rgba[k / 3 * 4 + k % 3]);
}

Coverage Judge::measure(int samples, int seeds) {
  if (scenario_.reference) reference_.worth = double(scenario_.reference) / samples;
  rtFrameBuffer(edge_, edge_, RT_RGBA | RT_ERROR | RT_TRUST | RT_VARIANCE);
  rtQuality(RT_SAMPLES_PER_PIXEL, samples);
  std::vector<picture::Shot> shots;
  for (int seed = 1; seed <= seeds; seed++)
    shots.push_back(shoot(size_t(edge_) * size_t(edge_), samples, seed));
  return picture::countCoverage(shots, reference_, edge_, edge_, tileEdge);
}

Coverage measure(const Scenario& s, int seeds, int edge) {
  return Judge(s, edge).measure(s.samples, seeds);
}

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = [] {
    std::vector<Scenario> v = firstScenes();
    v.insert(v.end(), trainingScenes().begin(), trainingScenes().end());
    v.insert(v.end(), judgingScenes().begin(), judgingScenes().end());
    v.insert(v.end(), unseenScenes().begin(), unseenScenes().end());
    return v;
  }();
  return all;
}

} // namespace audit
