#include "libpicture/studio.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libpicture/environment_map.h"
#include "libpicture/vec.h"
#include "srgb.h"

namespace picture {

namespace {

Vec unit(Vec a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? a * (1 / length) : Vec{0, 1, 0};
}

constexpr int mapWidth = 256, mapHeight = 128;

// A soft box: a rectangle on the sphere around the model, with soft edges.
struct SoftBox {
  double right, above; // degrees from the camera's direction
  double wide, high;   // half sizes in degrees
  double radiance;
};
// Key from the left, strip from the right, a rim behind; none overhead, where flat models reflect.
constexpr SoftBox boxes[] = {{-50, 42, 28, 20, 5.0}, {70, 30, 12, 26, 2.2}, {165, 40, 34, 12, 2.8}};

double smooth(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double boxesAt(Vec d) {
  constexpr double degree = std::numbers::pi / 180, soft = 5;
  double sum = 0;
  for (const SoftBox& box : boxes) {
    const double a = box.right * degree, e = box.above * degree;
    const Vec middle{std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
    const Vec across = unit(cross(Vec{0, 1, 0}, middle)), upwards = cross(middle, across);
    const double z = dot(d, middle);
    if (z <= 0) continue;
    const double x = std::abs(std::atan2(dot(d, across), z)) / degree,
                 y = std::abs(std::atan2(dot(d, upwards), z)) / degree;
    sum += box.radiance * (1 - smooth(box.wide - soft, box.wide + soft, x)) *
           (1 - smooth(box.high - soft, box.high + soft, y));
  }
  return sum;
}

} // namespace

// The backdrop rises a little above the horizon, for views from just above the ground, and fades to
// a darker room, so that metals have something to reflect.
StudioLight makeStudioLight(const std::array<float, 3>& backdrop, bool linear) {
  StudioLight light;
  light.width = mapWidth;
  light.height = mapHeight;
  light.rgb.resize(size_t(mapWidth) * mapHeight * 3);
  std::array<double, 3> base{};
  for (size_t c = 0; c < 3; ++c)
    base[c] = linear ? decodeSrgb(double(backdrop[c])) : double(backdrop[c]);
  const double mean = (base[0] + base[1] + base[2]) / 3;
  const double room = 0.25 + 0.15 * mean;
  std::array<double, 3> irradiance{}; // what the ground gets from the upper half
  for (int row = 0; row < mapHeight; ++row) {
    const double theta = std::numbers::pi * ((row + 0.5) / mapHeight - 0.5); // above the horizon
    const double weight = std::sin(theta) * std::cos(theta) * (std::numbers::pi / mapHeight) *
                          (2 * std::numbers::pi / mapWidth);
    const double wall = 1 - smooth(0.1, 0.6, theta);
    for (int column = 0; column < mapWidth; ++column) {
      // the middle of the map is towards -z, its right half towards +x
      const double phi = 2 * std::numbers::pi * ((column + 0.5) / mapWidth - 0.5);
      const Vec d{std::sin(phi) * std::cos(theta), std::sin(theta),
                  -std::cos(phi) * std::cos(theta)};
      const double shine = theta > 0 ? boxesAt(d) : 0;
      for (size_t c = 0; c < 3; ++c) {
        const double v = theta > 0 ? base[c] * wall + room * (1 - wall) + shine : base[c];
        light.rgb[(size_t(row) * mapWidth + size_t(column)) * 3 + c] = float(v);
        if (theta > 0) irradiance[c] += v * weight;
      }
    }
  }
  for (size_t c = 0; c < 3; ++c)
    light.groundReflectance[c] = std::clamp(base[c] * std::numbers::pi / irradiance[c], 0.0, 0.95);
  return light;
}

void StudioSet::clear() {
  if (instance_) rtDeleteInstance(instance_);
  if (ground_) rtDeleteObject(ground_);
  if (environment_) {
    rtUseEnvironment(0);
    rtDeleteShader(environment_);
    rtDeleteShader(groundShader_);
    rtDeleteTexture(texture_);
  }
  forget();
}

void StudioSet::place(const Studio& studio, bool linear, const xvrml::CameraSettings& camera,
                      const xvrml::Bounds& bounds, xvrml::Axis upAxis) {
  double axis[3];
  xvrml::upVector(upAxis, axis);
  const Vec up{axis[0], axis[1], axis[2]};
  Vec middle{0, 0, 0};
  double radius = 1, bottom = 0;
  if (!bounds.empty) {
    const double* low = bounds.minimum;
    const double* high = bounds.maximum;
    middle = Vec{low[0] + high[0], low[1] + high[1], low[2] + high[2]} * 0.5;
    const Vec size{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    radius = std::max(std::sqrt(dot(size, size)) / 2, 1e-30);
    const Vec half{std::abs(up.x) * size.x, std::abs(up.y) * size.y, std::abs(up.z) * size.z};
    bottom = dot(middle, up) - (half.x + half.y + half.z) / 2 - 1e-4 * radius;
  }
  const double* m = camera.matrix;
  const Vec above{m[4], m[5], m[6]}, back{m[8], m[9], m[10]}, eye{m[12], m[13], m[14]};
  const bool isAbove = dot(eye, up) >= bottom;
  const Vec top = up * (isAbove ? 1.0 : -1.0);
  // Towards the viewer: back, or for a camera that looks straight down or up, the lower edge of the
  // picture. So top and bottom have the same light. From below, the world's up is often the
  // picture's.
  const bool hangs = dot(unit(above), top) < -1e-6;
  Vec front = unit(back) + unit(above) * (hangs ? 1.0 : -1.0);
  front = front + top * -dot(front, top);
  if (!(dot(front, front) > 1e-12)) {
    const Vec other = std::abs(top.z) < 0.5 ? Vec{0, 0, 1} : Vec{0, -1, 0};
    front = other + top * -dot(other, top);
  }
  front = unit(front);
  const Vec across = cross(top, front);
  const std::array<double, 16> around = {across.x, across.y, across.z, 0, top.x, top.y, top.z, 0,
                                         front.x,  front.y,  front.z,  0, 0,     0,     0,     1};
  if (!(made_ == studio) && environment_) clear();
  if (environment_ == 0) {
    const StudioLight light = makeStudioLight(studio.backdrop, linear);
    environment_ = makeEnvironmentMap(light.width, light.height, light.rgb.data(), texture_);
    groundShader_ = rtNewShader(rtNewShaderClass("Diffuse", nullptr));
    rtBindShader(groundShader_);
    const auto& r = light.groundReflectance;
    rtParameter3f(rtParameterHandle("reflectance"), float(r[0]), float(r[1]), float(r[2]));
    rtGenObjects(1, &ground_);
    rtBeginObject(ground_);
    rtLoadName(0);
    rtBegin(RT_QUADS);
    constexpr float far = 1;
    rtVertex3f(-far, 0, far);
    rtVertex3f(far, 0, far);
    rtVertex3f(far, 0, -far);
    rtVertex3f(-far, 0, -far);
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    made_ = studio;
  }
  rtLoadMatrixd(around.data());
  rtUseEnvironment(environment_); // each time, because the mapper may have set its own
  const double extent = 60 * radius;
  const Vec place = middle + up * (bottom - dot(middle, up));
  const std::array<double, 16> placed = {
      across.x * extent, across.y * extent, across.z * extent, 0,
      top.x * extent,    top.y * extent,    top.z * extent,    0,
      front.x * extent,  front.y * extent,  front.z * extent,  0,
      place.x,           place.y,           place.z,           1};
  if (instance_ == 0) {
    rtLoadName(0);
    rtLoadMatrixd(placed.data());
    instance_ = rtInstantiateObject(ground_);
  } else if (placed != placed_) {
    rtInstanceMatrix(instance_, placed.data());
  }
  rtInstanceVisible(instance_, isAbove ? 1 : 0);
  placed_ = placed;
  rtLoadIdentity();
}

} // namespace picture
