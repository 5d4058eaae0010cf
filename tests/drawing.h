// drawing.h: what tests draw through the C API: contexts, planes and balls, a room, and the
// channels of the pictures. Uses only the public C API.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "openrt/openrt.h"

namespace drawing {

// --- Contexts ---

// Calls `draw` in a context, which is deleted afterwards. Errors fail the test.
inline void drawIn(RTcontext context, const std::function<void()>& draw) {
  ASSERT_NE(context, nullptr) << (rtGetError(), rtGetErrorMessage());
  draw();
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  rtDeleteContext(context);
}

inline RTcontext contextWith(int threads) {
  return rtNewContext(("threads=" + std::to_string(threads)).c_str());
}

// --- Objects ---

inline RTid colored(const char* shaderClass, const char* parameter, std::array<float, 3> color) {
  const RTid shader = rtNewShader(rtNewShaderClass(shaderClass, nullptr));
  rtBindShader(shader);
  if (parameter) rtParameter3f(rtParameterHandle(parameter), color[0], color[1], color[2]);
  rtBindShader(0);
  return shader;
}

// A square in the plane z = 0 that faces +z.
inline RTid square(RTid shader, float half) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  rtNormal3f(0, 0, 1);
  for (const auto& c : {std::array{-half, -half}, {half, -half}, {half, half}, {-half, half}})
    rtVertex3f(c[0], c[1], 0);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  return object;
}

// object: 0, or the object that is defined again.
inline RTid ball(RTid shader, float radius, RTid object = 0) {
  const RTid defined = rtBeginObject(object);
  rtBindShader(shader);
  rtSphere(radius);
  rtEndObject();
  rtBindShader(0);
  return defined;
}

struct Point {
  double x, y, z;
};

// Defines a net of triangles with cells x cells squares. place: the vertex of u and v, both from -1
// to 1. object: 0, or the object that is defined again.
inline RTid net(const std::function<Point(double u, double v)>& place, RTid object, int cells) {
  std::vector<float> points;
  std::vector<uint32_t> corners;
  for (int y = 0; y <= cells; y++)
    for (int x = 0; x <= cells; x++) {
      const Point p = place(2.0 * x / cells - 1, 2.0 * y / cells - 1);
      points.insert(points.end(), {float(p.x), float(p.y), float(p.z)});
      const auto i = uint32_t(y * (cells + 1) + x), above = i + uint32_t(cells) + 1;
      if (x < cells && y < cells)
        corners.insert(corners.end(), {i, i + 1, above, above, i + 1, above + 1});
    }
  const RTid defined = rtBeginObject(object);
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  rtDrawElements(RT_TRIANGLES, corners.size(), corners.data(), points.size() / 3);
  rtVertexPointer(3, RT_FLOAT, 0, nullptr);
  rtEndObject();
  return defined;
}

// Instantiates an object at a place. turn: degrees about the x axis.
inline RTid at(double x, double y, double z, RTid object, double turn = 0) {
  rtPushMatrix();
  rtTranslated(x, y, z);
  rtRotated(turn, 1, 0, 0);
  const RTid instance = rtInstantiateObject(object);
  rtPopMatrix();
  return instance;
}

// Looks at the origin.
inline void lookFrom(double x, double y, double z) {
  rtPushMatrix();
  rtLookAt(x, y, z, 0, 0, 0, 0, 1, 0);
  rtPerspective(40);
  rtPopMatrix();
}

// Draws a floor of two coincident faces, a lamp, a mirror and a glass ball, so that paths split,
// continue and hit ties.
inline void drawRoom() {
  rtLoadIdentity();
  at(0, -1, 0, square(colored("Diffuse", "reflectance", {.8f, .3f, .2f}), 4), -90);
  at(0, -1, 0, square(colored("Diffuse", "reflectance", {.2f, .3f, .8f}), 4), -90);
  at(0, 2.5, 0, square(colored("Diffuse", "emission", {9, 9, 8}), .3f), 90);
  at(-1, 0, -1, square(colored("Mirror", "reflectance", {.9f, .9f, .9f}), .8f), 10);
  at(.6, 0, 0, ball(colored("Glass", nullptr, {}), .6f));
  lookFrom(0, .5, 5);
}

// --- Pictures ---

inline constexpr uint32_t everyChannel = (RT_REFLECTION << 1) - 1;

// Returns the numbers that a pixel of a channel has.
inline size_t componentsOf(uint32_t channel) {
  RTchannelInfo info{};
  info.size = sizeof info;
  for (int i = 0; rtGetChannelInfo(i, &info) && info.channel != channel; i++) {}
  return size_t(info.components);
}

inline std::vector<float> readChannel(uint32_t channel, int width, int height) {
  std::vector<float> plane(size_t(width) * size_t(height) * componentsOf(channel));
  rtReadPixels(channel, plane.data(), plane.size());
  return plane;
}

// Returns the channels one after the other.
inline std::vector<float> readChannels(uint32_t channels, int width, int height) {
  std::vector<float> all;
  for (uint32_t channel = 1; channel <= channels; channel <<= 1) {
    if (!(channels & channel)) continue;
    const std::vector<float> plane = readChannel(channel, width, height);
    all.insert(all.end(), plane.begin(), plane.end());
  }
  return all;
}

} // namespace drawing
