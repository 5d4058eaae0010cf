// raw_rays.cpp: a loop of raw Embree over rays, one rtcIntersect1 each, as a library for
// tools/bench_rays.py. Ray queries from Python are compared with it. Results have the layout of
// cast_rays.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

#include "raw_embree.h"

namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Raw {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
};

} // namespace

extern "C" {

__attribute__((visibility("default"))) void*
raw_scene(const float* vertices, size_t n, const uint32_t* triangles, size_t m, int robust) {
  auto* raw = new Raw;
  if (robust) rtcSetSceneFlags(raw->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry g = rtcNewGeometry(raw->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  std::copy_n(vertices, 3 * n,
              static_cast<float*>(
                  rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, n)));
  std::copy_n(triangles, 3 * m,
              static_cast<uint32_t*>(
                  rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, m)));
  rtcCommitGeometry(g);
  rtcAttachGeometry(raw->scene, g);
  rtcReleaseGeometry(g);
  rtcCommitScene(raw->scene);
  return raw;
}

// rays: 6 floats each. Returns the elapsed seconds.
__attribute__((visibility("default"))) double raw_cast(const void* scene, const float* rays,
                                                       size_t count, int threads, float* t,
                                                       uint32_t* primitive, float* uv,
                                                       float* normal) {
  const RTCScene s = static_cast<const Raw*>(scene)->scene;
  const double begin = seconds();
  std::atomic<size_t> next{0};
  constexpr size_t block = 4096;
  const auto work = [&] {
    for (size_t first; (first = next.fetch_add(block)) < count;)
      for (size_t i = first; i < std::min(first + block, count); i++) {
        const float* r = rays + 6 * i;
        RTCRayHit q;
        q.ray = {r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, std::numeric_limits<float>::infinity(),
                 ~0u,  0,    0};
        q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        q.hit.primID = RTC_INVALID_GEOMETRY_ID;
        q.hit.u = q.hit.v = q.hit.Ng_x = q.hit.Ng_y = q.hit.Ng_z = 0;
        raw::intersect(s, q);
        t[i] = q.ray.tfar;
        primitive[i] = q.hit.primID;
        uv[2 * i] = q.hit.u;
        uv[2 * i + 1] = q.hit.v;
        const float l =
            std::sqrt(q.hit.Ng_x * q.hit.Ng_x + q.hit.Ng_y * q.hit.Ng_y + q.hit.Ng_z * q.hit.Ng_z);
        const float k = l > 0 ? 1 / l : 0;
        normal[3 * i] = k * q.hit.Ng_x;
        normal[3 * i + 1] = k * q.hit.Ng_y;
        normal[3 * i + 2] = k * q.hit.Ng_z;
      }
  };
  std::vector<std::thread> pool;
  for (int k = 0; k < threads; k++) pool.emplace_back(work);
  for (auto& one : pool) one.join();
  return seconds() - begin;
}

__attribute__((visibility("default"))) void raw_delete(void* scene) {
  auto* raw = static_cast<Raw*>(scene);
  rtcReleaseScene(raw->scene);
  rtcReleaseDevice(raw->device);
  delete raw;
}

} // extern "C"
