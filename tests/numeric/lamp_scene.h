// lamp_scene.h: a fixture for tests of emissive shapes against closed forms: a floor, lamps above
// it, and the form factors of polygons. Uses only the public C API. A white surface under
// irradiance E shows E / pi, which is the lamp's form factor if its radiance is 1.
#pragma once

#include <cstdio>
#include <functional>

#include "numeric/support.h"

namespace numeric {

inline constexpr double degree = pi / 180;

inline Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }

// R7: Lambert's formula, divided by pi, for a polygon seen from the origin by a surface that faces
// z. The whole polygon is above the surface.
inline double polygon(const std::vector<Vec>& v) {
  double sum = 0;
  for (size_t i = 0; i < v.size(); i++) {
    const Vec a = v[i], b = v[(i + 1) % v.size()], n = cross(a, b);
    if (length(n) > 0) sum += std::atan2(length(n), dot(a, b)) * n.z / length(n);
  }
  return std::fabs(sum) / (2 * pi);
}

// Clips a polygon; the rest has dot(normal, p) >= offset.
inline std::vector<Vec> clip(const std::vector<Vec>& v, Vec normal, double offset) {
  std::vector<Vec> out;
  for (size_t i = 0; i < v.size(); i++) {
    const Vec a = v[i], b = v[(i + 1) % v.size()];
    const double s = dot(normal, a) - offset, t = dot(normal, b) - offset;
    if (s >= 0) out.push_back(a);
    if ((s < 0) != (t < 0)) {
      const double f = s / (s - t);
      out.push_back({a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), a.z + f * (b.z - a.z)});
    }
  }
  return out;
}

inline std::vector<Vec> rectangle(double half, double z) {
  return {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
}

class Lamps : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtQuality(RT_MAX_DEPTH, 1);
    rtQuality(RT_SAMPLES_PER_PIXEL, 16384);
  }
  static RTid floor(double half = 100) { return place(square(matt(1), half)); }
  // A fan around the first corner.
  static RTid lamp(const std::vector<Vec>& v, double radiance = 1, bool culled = false) {
    const RTid object = rtBeginObject(0);
    if (culled) rtEnable(RT_CULL_FACE);
    rtBindShader(matt(0, radiance));
    rtBegin(RT_TRIANGLES);
    for (size_t i = 1; i + 1 < v.size(); i++)
      for (const Vec& p : {v[0], v[i], v[i + 1]}) rtVertex3d(p.x, p.y, p.z);
    rtEnd();
    rtDisable(RT_CULL_FACE);
    rtEndObject();
    rtBindShader(0);
    return place(object);
  }
  static RTid ball(const Shader& shader, double radius) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtSphere(float(radius));
    rtEndObject();
    rtBindShader(0);
    return place(object);
  }
  // Returns a triangulated disc of area pi r^2. Its outline error is negligible.
  static std::vector<Vec> disc(double r, double z) {
    constexpr int n = 512;
    const double out = r * std::sqrt(2 * pi / n / std::sin(2 * pi / n));
    std::vector<Vec> v;
    for (int i = 0; i < n; i++)
      v.push_back({out * std::cos(2 * pi * i / n), out * std::sin(2 * pi * i / n), z});
    return v;
  }
  // Returns the colour of the floor, seen from below the lamps over it.
  static double lit(double x = 0) { return look(x, 0, .001).g; }
  static void expectQ(const char* id, double got, double expected, double tolerance) {
    std::printf("%-10s expected %.8f got %.8f tolerance %.1e\n", id, expected, got, tolerance);
    EXPECT_NEAR(got, expected, tolerance * std::max(expected, .1)) << id;
  }
  static double mean(int size, const std::function<void()>& camera) {
    camera();
    rtFrameBuffer(uint32_t(size), uint32_t(size), RT_RGBA);
    rtRender();
    std::vector<float> pixels(size_t(size) * size_t(size) * 4);
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    double total = 0;
    for (size_t i = 1; i < pixels.size(); i += 4) total += double(pixels[i]);
    return total / (double(size) * size);
  }
};

} // namespace numeric
