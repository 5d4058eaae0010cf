// openrt_rays.cpp: the case "direct": 808,000 triangles, one point light, hard shadows, 640x480.
// Compares the wavefront through the API and the VRML97 shader plug-in with a loop of raw Embree on
// the same rays: one camera ray and one shadow ray at a time, inlined shading, default mode and
// robust mode. The counter `ratio` of the API's line is measured in the same run: raw time divided
// by ours.
#include <benchmark/benchmark.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "bench/raw_embree.h"
#include "openrt/openrt.h"
#include "render/wave/sampler.h"

namespace {

constexpr int width = 640, height = 480, spp = 4, edge = 636;
constexpr float light[3] = {3, 6, 2};
constexpr double eye[3] = {0, 4, 7}, at[3] = {0, 0, 0}, fovy = 45;

struct Terrain {
  std::vector<float> points;
  std::vector<uint32_t> indices;
  Terrain() {
    for (int z = 0; z <= edge; z++)
      for (int x = 0; x <= edge; x++) {
        const float u = float(x) / edge * 10 - 5, v = float(z) / edge * 10 - 5;
        points.insert(
            points.end(),
            {u, 0.4f * std::sin(3 * u) * std::cos(2 * v) + 0.02f * std::sin(40 * u + 30 * v), v});
      }
    for (int z = 0; z < edge; z++)
      for (int x = 0; x < edge; x++) {
        const uint32_t i = uint32_t(z * (edge + 1) + x);
        indices.insert(indices.end(), {i, i + edge + 1, i + 1, i + 1, i + edge + 1, i + edge + 2});
      }
  }
};
const Terrain& terrain() {
  static const Terrain t;
  return t;
}

struct Raw {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  explicit Raw(bool robust) {
    if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* p = static_cast<float*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, terrain().points.size() / 3));
    auto* i = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, terrain().indices.size() / 3));
    std::copy(terrain().points.begin(), terrain().points.end(), p);
    std::copy(terrain().indices.begin(), terrain().indices.end(), i);
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(scene);
  }
  ~Raw() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  float pixel(uint32_t x, uint32_t y) const {
    static const double fl = std::sqrt(eye[1] * eye[1] + eye[2] * eye[2]);
    const float f[3] = {0, float(-eye[1] / fl), float(-eye[2] / fl)}, up[3] = {0, -f[2], f[1]};
    const float scale = float(2 * std::tan(fovy * M_PI / 360) / height);
    float sum = 0;
    for (uint32_t s = 0; s < spp; s++) {
      float dx, dy;
      openrt::PairSampler(y * width + x, 0, 0)(s, dx, dy);
      const float a = (float(x) + dx - width / 2) * scale,
                  b = -(float(y) + dy - height / 2) * scale;
      float d[3] = {a, f[1] + b * up[1], f[2] + b * up[2]};
      const float l = 1 / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      for (float& c : d) c *= l;
      RTCRayHit r{};
      r.ray = {
          float(eye[0]), float(eye[1]), float(eye[2]), 0, d[0], d[1], d[2], 0, INFINITY, ~0u, 0, 0};
      r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      raw::intersect(scene, r);
      if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      float n[3] = {r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z}, p[3], w[3];
      const float nl = 1 / std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      const float side = n[0] * d[0] + n[1] * d[1] + n[2] * d[2] > 0 ? -nl : nl;
      float w2 = 0;
      for (int k = 0; k < 3; k++) {
        n[k] *= side;
        p[k] = float(eye[k]) + r.ray.tfar * d[k] + 1e-4f * n[k];
        w[k] = light[k] - p[k];
        w2 += w[k] * w[k];
      }
      const float distance = std::sqrt(w2),
                  cosine = (n[0] * w[0] + n[1] * w[1] + n[2] * w[2]) / distance;
      if (cosine <= 0) continue;
      RTCRay shadow{p[0],     p[1], p[2], 0, w[0] / distance, w[1] / distance, w[2] / distance, 0,
                    distance, ~0u,  0,    0};
      raw::occluded(scene, shadow);
      if (shadow.tfar >= 0) sum += 0.8f * cosine;
    }
    return sum / spp;
  }

  void render(std::vector<float>& image, int threads) const {
    std::atomic<int> next{0};
    std::vector<std::thread> pool;
    constexpr int tile = 32;
    for (int t = 0; t < threads; t++)
      pool.emplace_back([&] {
        for (int i; (i = next++) < (width / tile) * (height / tile);) {
          const int x0 = i % (width / tile) * tile, y0 = i / (width / tile) * tile;
          for (int y = y0; y < y0 + tile; y++)
            for (int x = x0; x < x0 + tile; x++)
              image[size_t(y) * width + x] = pixel(uint32_t(x), uint32_t(y));
        }
      });
    for (auto& thread : pool) thread.join();
  }
};

void drawScene() {
  const RTid object = rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, terrain().points.data());
  rtDrawElements(RT_TRIANGLES, terrain().indices.size(), terrain().indices.data(),
                 terrain().points.size() / 3);
  rtEndObject();
  rtInstantiateObject(object);
  const RTid lamp = rtNewShader(rtNewShaderClass("VRML97PointLight", nullptr));
  rtBindShader(lamp);
  rtParameter3f(rtParameterHandle("location"), light[0], light[1], light[2]);
  rtUseLight(lamp);
  rtPushMatrix();
  rtLookAt(eye[0], eye[1], eye[2], at[0], at[1], at[2], 0, 1, 0);
  rtPerspective(fovy);
  rtPopMatrix();
  rtFrameBuffer(width, height, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, spp);
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Small dynamic objects, beside the view or under the terrain. There rays pass their boxes without
// hitting them.
void drawDynamic(int count, bool inView) {
  rtBindShader(0);
  const RTid ball = rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, terrain().points.data());
  const uint32_t corners[] = {0, 1, 1000, 1, 2000, 1000, 0, 2000, 1};
  rtDrawElements(RT_TRIANGLES, 9, corners, terrain().points.size() / 3);
  rtEndObject();
  for (int i = 0; i < count; i++) {
    const double s = .02, x = inView ? (i % 100) / 12. - 4 : 50 + i % 100,
                 z = inView ? (i / 100) / 12. - 4 : 50;
    const double m[16] = {s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, x, -1, z, 1};
    const RTid instance = rtInstantiateObject(ball);
    rtInstanceMatrix(instance, m);
    rtInstanceHint(instance, RT_DYNAMIC);
  }
}

void direct(benchmark::State& state, int threads, bool robust, int dynamic = 0,
            bool inView = false) {
  const Raw raw(robust);
  std::vector<float> image(size_t(width) * height), ours(size_t(width) * height * 4);
  rtNewContext(("threads=" + std::to_string(threads)).c_str());
  drawScene();
  if (dynamic) drawDynamic(dynamic, inView);
  rtRender(); // builds the acceleration structures
  double rawTime = 0, ourTime = 0;
  for (auto _ : state) {
    const double a = seconds();
    raw.render(image, threads);
    const double b = seconds();
    rtRender();
    const double c = seconds();
    state.SetIterationTime(c - b);
    rawTime += b - a;
    ourTime += c - b;
  }
  rtReadPixels(RT_RGBA, ours.data(), ours.size());
  double difference = 0;
  for (size_t i = 0; i < image.size(); i++) difference += std::fabs(double(image[i]) - ours[4 * i]);
  RTstats stats{};
  stats.size = sizeof stats;
  rtGetStats(&stats);
  state.counters["ratio"] = rawTime / ourTime;
  state.counters["Mrays/s"] =
      double(stats.rays.camera + stats.rays.shadow) * double(state.iterations()) / ourTime / 1e6;
  state.counters["mean_difference"] = difference / double(image.size());
  if (rtGetError() != RT_NO_ERROR) state.SkipWithError(rtGetErrorMessage());
  rtDeleteContext(rtGetCurrent());
}

} // namespace

BENCHMARK_CAPTURE(direct, one_thread_against_robust, 1, true)
    ->UseManualTime()
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(direct, one_thread_against_default, 1, false)
    ->UseManualTime()
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(direct, two_threads_against_robust, 2, true)
    ->UseManualTime()
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(direct, beside_one_dynamic_object, 1, true, 1)
    ->UseManualTime()
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(direct, above_100_dynamic_objects, 1, true, 100, true)
    ->UseManualTime()
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(direct, above_10000_dynamic_objects, 1, true, 10000, true)
    ->UseManualTime()
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
