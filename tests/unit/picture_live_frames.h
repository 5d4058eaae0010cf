// picture_live_frames.h: Frames for tests of previews, from closed forms: textured planes and
// balls, a camera, samples at random places in their pixels, and noise like that of light sampling.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "libpicture/live/reconstruction.h"

namespace live_frames {

struct Vec {
  double x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec turned(Vec v, double angle) { // about the y axis
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

// Holds what a ray meets. Without a hit the light is that of the environment.
struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  Vec normal, motion;
  Vec albedo{1, 1, 1};
  double light = 0; // expected illumination
  int name = 0;
  bool sampled = true; // the frame's noise applies to its light
};
using World = std::function<Hit(Vec origin, Vec direction)>;

// A hash of pixel, frame and dimension as a number from 0 to 1.
inline double random(uint32_t pixel, uint32_t frame, uint32_t dimension) {
  uint64_t v = (uint64_t(pixel) << 32) ^ (uint64_t(frame) << 8) ^ dimension;
  v = (v ^ (v >> 31)) * 0x9E3779B97F4A7C15u;
  v = (v ^ (v >> 29)) * 0xBF58476D1CE4E5B9u;
  v ^= v >> 32;
  return double(v & 0xFFFFFFFFu) / 4294967296.0;
}

struct Shot {
  int width = 96, height = 72;
  picture::live::FrameCamera camera;
  uint32_t number = 0;  // the number of the frame: places of samples and noise follow from it
  bool centred = false; // samples lie in the middles of the pixels
  bool noisy = false;   // a sample has light only by chance, one in four, and then four times more
};

inline picture::live::FrameCamera cameraAt(Vec eye, double angle = 0, double fovy = 0.8,
                                           double aspect = 4.0 / 3) {
  picture::live::FrameCamera camera;
  const Vec x = turned({1, 0, 0}, angle), z = turned({0, 0, 1}, angle);
  const double matrix[16] = {x.x, x.y, x.z, 0, 0,     1,     0,     0,
                             z.x, z.y, z.z, 0, eye.x, eye.y, eye.z, 1};
  std::copy_n(matrix, 16, camera.settings.matrix);
  camera.settings.fovy = fovy;
  camera.aspect = aspect;
  return camera;
}

// The ray of a place in the picture, in pixels.
inline void rayOf(const Shot& shot, double x, double y, Vec& origin, Vec& direction) {
  const auto& settings = shot.camera.settings;
  const double* m = settings.matrix;
  const bool parallel = settings.fovy == 0;
  const double height = parallel ? settings.height : 2 * std::tan(settings.fovy / 2);
  const double across = (x / shot.width - 0.5) * height * shot.camera.aspect,
               up = (0.5 - y / shot.height) * height;
  const Vec right{m[0], m[1], m[2]}, above{m[4], m[5], m[6]}, back{m[8], m[9], m[10]};
  const Vec eye{m[12], m[13], m[14]}, beside = right * across + above * up;
  origin = parallel ? eye + beside : eye;
  direction = parallel ? back * -1 : beside - back; // at depth 1
}

// The colour of a hit without noise.
inline Vec colourOf(const Hit& hit) { return hit.albedo * hit.light; }

inline picture::Picture render(const World& world, const Shot& shot) {
  picture::Picture frame;
  frame.width = shot.width;
  frame.height = shot.height;
  const auto plane = [&](uint32_t channel, size_t numbers) -> std::vector<float>& {
    auto& made = frame.planes[channel];
    made.resize(size_t(shot.width) * size_t(shot.height) * numbers);
    return made;
  };
  auto &rgba = plane(RT_RGBA, 4), &depth = plane(RT_DEPTH, 1), &normal = plane(RT_NORMAL, 3),
       &albedo = plane(RT_ALBEDO, 3), &position = plane(RT_POSITION, 3), &name = plane(RT_NAME, 1),
       &motion = plane(RT_MOTION, 3), &samples = plane(RT_SAMPLES, 1), &place = plane(RT_PLACE, 2);
  plane(RT_REFLECTION, 3); // there are no coats
  const auto set = [](std::vector<float>& to, size_t i, Vec v) {
    to[i] = float(v.x);
    to[i + 1] = float(v.y);
    to[i + 2] = float(v.z);
  };
  for (int y = 0; y < shot.height; y++)
    for (int x = 0; x < shot.width; x++) {
      const auto pixel = uint32_t(y * shot.width + x);
      const size_t i = pixel;
      const double dx = shot.centred ? 0.5 : random(pixel, shot.number, 0),
                   dy = shot.centred ? 0.5 : random(pixel, shot.number, 1);
      place[2 * i] = float(dx);
      place[2 * i + 1] = float(dy);
      Vec origin, direction;
      rayOf(shot, x + dx, y + dy, origin, direction);
      Hit hit = world(origin, direction);
      if (shot.noisy && hit.sampled)
        hit.light *=
            random(pixel, shot.number, 2) < 0.25 ? 4 * (0.5 + random(pixel, shot.number, 3)) : 0;
      set(rgba, 4 * i, colourOf(hit));
      rgba[4 * i + 3] = 1;
      samples[i] = 1;
      const bool met = std::isfinite(hit.distance);
      depth[i] = float(hit.distance);
      name[i] = float(hit.name);
      set(albedo, 3 * i, met ? hit.albedo : Vec());
      set(normal, 3 * i, met ? hit.normal : Vec());
      set(position, 3 * i, met ? origin + direction * hit.distance : Vec());
      set(motion, 3 * i, met ? hit.motion : Vec());
    }
  return frame;
}

// Returns what the frame would show with very many samples: red, green, blue of each pixel.
inline std::vector<float> converged(const World& world, const Shot& shot, int grid = 6) {
  std::vector<float> rgb(size_t(shot.width) * size_t(shot.height) * 3);
  for (int y = 0; y < shot.height; y++)
    for (int x = 0; x < shot.width; x++) {
      Vec sum;
      for (int k = 0; k < grid * grid; k++) {
        Vec origin, direction;
        rayOf(shot, x + (k % grid + 0.5) / grid, y + (k / grid + 0.5) / grid, origin, direction);
        sum = sum + colourOf(world(origin, direction));
      }
      float* to = rgb.data() + 3 * size_t(y * shot.width + x);
      to[0] = float(sum.x / (grid * grid));
      to[1] = float(sum.y / (grid * grid));
      to[2] = float(sum.z / (grid * grid));
    }
  return rgb;
}

// A plane z = `z` that faces +z, from x = left to right; it has moved by `moved` since the frame
// before.
inline Hit plane(Vec origin, Vec direction, double z, double left, double right, Vec moved = {}) {
  Hit hit;
  const double t = (z - origin.z) / direction.z;
  const double x = origin.x + t * direction.x;
  if (!(t > 0) || x < left || x > right) return hit;
  hit.distance = t;
  hit.normal = {0, 0, 1};
  hit.motion = moved;
  hit.light = 1;
  return hit;
}

// A ball around the origin that has turned by `step` about the y axis since the frame before.
inline Hit ball(Vec origin, Vec direction, double radius, double step) {
  Hit hit;
  const double a = dot(direction, direction), b = dot(origin, direction),
               c = dot(origin, origin) - radius * radius, d = b * b - a * c;
  if (d < 0) return hit;
  hit.distance = (-b - std::sqrt(d)) / a;
  const Vec p = origin + direction * hit.distance;
  hit.normal = p * (1 / radius);
  hit.motion = p - turned(p, -step);
  hit.light = 1;
  return hit;
}

// Pictures that are compared with the truth
// --------------------------------------------------------

using picture::Picture;
constexpr double infinite = std::numeric_limits<double>::infinity();

inline const std::vector<float>& valuesOf(const Picture& picture) {
  return picture.planes.at(RT_RGBA);
}

inline float colourAt(const Picture& picture, int x, int y, int colour) {
  return valuesOf(picture).at(4 * size_t(y * picture.width + x) + size_t(colour));
}

// A part of the picture, in pixels.
struct Part {
  int left, top, right, bottom;
};
inline Part inner(const Shot& shot, int margin = 8) {
  return {margin, margin, shot.width - margin, shot.height - margin};
}

// Calls use(difference, pixel) for each colour of a part.
template <class Use>
void compare(const Picture& picture, const std::vector<float>& truth, Part part, const Use& use) {
  for (int y = part.top; y < part.bottom; y++)
    for (int x = part.left; x < part.right; x++)
      for (int c = 0; c < 3; c++) {
        const size_t pixel = size_t(y * picture.width + x);
        use(colourAt(picture, x, y, c) - truth.at(3 * pixel + size_t(c)), pixel);
      }
}

inline double rms(const Picture& picture, const std::vector<float>& truth, Part part) {
  double sum = 0, n = 0;
  compare(picture, truth, part, [&](float d, size_t) {
    sum += double(d) * d;
    n++;
  });
  return std::sqrt(sum / n);
}

inline double largest(const Picture& picture, const std::vector<float>& truth, Part part) {
  double most = 0;
  compare(picture, truth, part,
          [&](float d, size_t) { most = std::max(most, std::abs(double(d))); });
  return most;
}

inline bool isShowable(const Picture& picture) {
  return std::ranges::all_of(valuesOf(picture), [](float v) { return std::isfinite(v) && v >= 0; });
}

// Returns by how many pixels the picture lies to the right of the truth: least squares of the
// difference against the truth's slope.
inline double shiftOf(const Picture& picture, const std::vector<float>& truth, Part part) {
  double slopes = 0, products = 0;
  for (int y = part.top; y < part.bottom; y++)
    for (int x = part.left; x < part.right; x++) {
      const size_t pixel = size_t(y * picture.width + x);
      const double slope = (double(truth[3 * (pixel + 1)]) - double(truth[3 * (pixel - 1)])) / 2;
      slopes += slope * slope;
      products += slope * (double(colourAt(picture, x, y, 0)) - double(truth[3 * pixel]));
    }
  return -products / slopes;
}

inline std::vector<float> colours(const Picture& frame) {
  std::vector<float> rgb;
  for (size_t i = 0; i < valuesOf(frame).size(); i++)
    if (i % 4 != 3) rgb.push_back(valuesOf(frame)[i]);
  return rgb;
}

// A wave over a surface, about ten pixels long in these pictures.
inline double wave(double u, double v) {
  return 0.5 + 0.2 * std::sin(9 * u) + 0.2 * std::sin(7 * v + u);
}

// A plane that moves to the right by `step` a frame; its texture moves with it.
inline World movingPlane(uint32_t frame, double step, bool textured) {
  return [=](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0, -infinite, infinite, {frame ? step : 0, 0, 0});
    const Vec p = origin + direction * hit.distance;
    const double w = wave(p.x - step * frame, p.y);
    (textured ? hit.albedo : hit.normal) = textured ? Vec{w, w, w} : hit.normal;
    if (!textured) hit.light = w;
    hit.name = 1;
    return hit;
  };
}

inline World turningBall(uint32_t frame, double step, bool textured) {
  return [=](Vec origin, Vec direction) {
    Hit hit = ball(origin, direction, 1, frame ? step : 0);
    if (!std::isfinite(hit.distance)) return hit;
    const Vec local = turned(origin + direction * hit.distance, -step * frame);
    const double w = wave(std::atan2(local.x, local.z), 2 * local.y);
    if (textured)
      hit.albedo = {w, w, w};
    else
      hit.light = w;
    hit.name = 2;
    return hit;
  };
}

inline Shot shotAt(Vec eye, uint32_t number, bool noisy = false) {
  Shot shot;
  shot.camera = cameraAt(eye);
  shot.number = number;
  shot.noisy = noisy;
  return shot;
}

// A checkered floor with a sharp shadow, a lamp, and a picture of the sky behind. Nothing is
// sampled.
inline World quietWorld() {
  return [](Vec origin, Vec direction) {
    Hit hit;
    const double t = (-1 - origin.y) / direction.y;
    const Vec p = origin + direction * t;
    const Hit lamp = ball(origin - Vec{0.8, 0.6, 0}, direction, 0.4, 0);
    if (std::isfinite(lamp.distance)) {
      hit = lamp;
      hit.albedo = {0, 0, 0};
      hit.name = 3;
    } else if (t > 0 && t < 20) {
      hit.distance = t;
      hit.normal = {0, 1, 0};
      hit.name = 1;
      const bool dark = (int(std::floor(p.x * 2)) + int(std::floor(p.z * 2))) % 2 != 0;
      hit.albedo = dark ? Vec{0.1, 0.2, 0.05} : Vec{0.8, 0.7, 0.6};
      hit.light = p.x + 0.3 * p.z > -0.4 ? 1 : 0.15;
    } else {
      hit.light = 0.3 + 0.2 * direction.y;
    }
    return hit;
  };
}

// The lamp shines, though its albedo is black.
inline Picture quietFrame(const Shot& shot) {
  Picture frame = render(quietWorld(), shot);
  for (size_t i = 0; i < frame.planes[RT_NAME].size(); i++)
    if (frame.planes[RT_NAME][i] == 3) std::fill_n(&frame.planes[RT_RGBA][4 * i], 3, 5.0f);
  return frame;
}

} // namespace live_frames
