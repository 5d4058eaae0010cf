// coverage.cpp: see coverage.h.
#include "audit/coverage.h"

#include <cmath>

#include "openrt/openrt.h"

namespace audit {
namespace {

RTid diffuse(float emission, float reflectance) {
  const RTid shader = rtNewShader(rtNewShaderClass("Diffuse", nullptr));
  rtBindShader(shader);
  rtParameter3f(rtParameterHandle("emission"), emission, emission, emission);
  rtParameter3f(rtParameterHandle("reflectance"), reflectance, reflectance, reflectance);
  rtBindShader(0);
  return shader;
}

// A square in z = 0 that faces +z, under the current matrix.
void square(RTid shader, double half) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  rtVertex3d(-half, -half, 0), rtVertex3d(half, -half, 0), rtVertex3d(half, half, 0), rtVertex3d(-half, half, 0);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  rtInstantiateObject(object);
}

void lookDown(double height) { // from far above on a square of this height about the origin
  rtPushMatrix();
  rtTranslated(0, 0, 40);
  rtOrtho(height);
  rtPopMatrix();
}

// Stripes at an angle, a few pixels wide: pixels with edges, and some without.
void drawEdges() {
  const RTid white = diffuse(1, 0), grey = diffuse(.25f, 0);
  square(grey, 20);
  for (int i = -8; i <= 8; i++) {
    rtPushMatrix();
    rtRotated(23, 0, 0, 1);
    rtTranslated(.437 * i, 0, .1);
    rtScaled(.01, 1, 1);
    square(white, 10);
    rtPopMatrix();
  }
  lookDown(2);
}

// A closed box that glows: radiance .5 / (1 - .5) = 1 everywhere.
void drawFurnace() {
  const RTid wall = diffuse(.5f, .5f);
  for (int i = 0; i < 6; i++) {
    rtPushMatrix();
    if (i < 4)
      rtRotated(90 * i, 1, 0, 0);
    else
      rtRotated(i == 4 ? 90 : -90, 0, 1, 0);
    rtTranslated(0, 0, -1);
    square(wall, 1);
    rtPopMatrix();
  }
  rtPushMatrix();
  rtPerspective(60);
  rtPopMatrix();
}

// A lamp that faces a floor; the camera looks past it.
void lampOver(double half, double height, float radiance) {
  square(diffuse(0, .5f), 10);
  rtPushMatrix();
  rtTranslated(0, 0, height);
  rtRotated(180, 1, 0, 0);
  square(diffuse(radiance, 0), half);
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(-1.5, 0, .5);
  rtRotated(-60, 0, 1, 0);
  rtPerspective(50);
  rtPopMatrix();
}
void drawLamp() { lampOver(1, 1, 1); }
void drawSmallLamp() { lampOver(.15, 1, 40); }
void drawTinyLamp() { lampOver(.03, 1, 1000); }

// A room with a lamp in its ceiling: light between coloured walls, edges, shadows.
void drawRoom() {
  const RTid white = diffuse(0, .7f), dark = diffuse(0, .2f), lamp = diffuse(8, 0);
  const auto wall = [](double angle, double x, double y, double z, RTid shader) {
    rtPushMatrix();
    rtRotated(angle, x, y, z);
    rtTranslated(0, 0, -1);
    square(shader, 1);
    rtPopMatrix();
  };
  wall(0, 1, 0, 0, white), wall(-90, 1, 0, 0, white), wall(90, 1, 0, 0, white);
  wall(90, 0, 1, 0, dark), wall(-90, 0, 1, 0, dark);
  rtPushMatrix();
  rtTranslated(0, .99, 0);
  rtRotated(90, 1, 0, 0);
  square(lamp, .4);
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(-.3, -.5, -.2);
  rtRotated(20, 0, 1, 0);
  square(white, .4);
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(0, 0, 2.9);
  rtPerspective(40);
  rtPopMatrix();
}

const std::vector<Scenario> table = {
    {"edges", "stripes seen directly: the area's average alone", RT_TRANSPORT_DIRECT, 64, 16384, 0, drawEdges},
    {"furnace", "a closed box that glows, closed form", RT_TRANSPORT_PATH, 256, 0, 1, drawFurnace},
    {"lamp", "a floor under a large lamp", RT_TRANSPORT_PATH, 64, 16384, 0, drawLamp},
    {"small lamp", "a lamp that few directions meet", RT_TRANSPORT_PATH, 64, 65536, 0, drawSmallLamp},
    {"tiny lamp", "a lamp that one direction in a thousand meets", RT_TRANSPORT_PATH, 64, 65536, 0, drawTinyLamp},
    {"room", "light between walls, edges, soft shadows", RT_TRANSPORT_PATH, 512, 16384, 0, drawRoom},
};

std::vector<float> read(RTenum channel, size_t floats) {
  std::vector<float> out(floats);
  rtReadPixels(channel, out.data(), out.size());
  return out;
}

} // namespace

const std::vector<Scenario>& scenarios() { return table; }

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
  std::vector<float> truth(4 * pixels, float(s.exact));
  if (s.reference) {
    rtFrameBuffer(edge, edge, RT_RGBA);
    rtQuality(RT_SEED, 1000003);
    rtQuality(RT_SAMPLES_PER_PIXEL, s.reference);
    rtRender();
    truth = read(RT_RGBA, 4 * pixels);
  }
  rtFrameBuffer(edge, edge, RT_RGBA | RT_ERROR | RT_TRUST);
  rtQuality(RT_SAMPLES_PER_PIXEL, s.samples);
  Coverage c;
  for (int seed = 1; seed <= seeds; seed++) {
    rtQuality(RT_SEED, seed);
    rtRender();
    const std::vector<float> rgba = read(RT_RGBA, 4 * pixels), half = read(RT_ERROR, 3 * pixels), trust = read(RT_TRUST, pixels);
    double off = 0;
    for (size_t i = 0; i < pixels; i++) {
      const double error = std::fabs(double(rgba[4 * i]) - truth[4 * i]);
      const bool held = error <= half[3 * i] + 1e-6 * truth[4 * i]; // sums of floats have rounding errors of their own
      c.pixels++, c.held += held;
      off += std::min(1.0, error / (double(rgba[4 * i]) + .01)) / double(pixels);
      if (trust[i] == 0) continue;
      c.trusted++;
      if (half[3 * i] == 0)
        c.exact++, c.exactHeld += held;
      else
        c.heldTrusted += held, c.halfWidth += half[3 * i];
    }
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    c.meanError += off / seeds, c.promised += stats.errorMean / seeds, c.promisedInterval += stats.errorMeanInterval / seeds;
  }
  if (c.intervals()) c.halfWidth /= double(c.intervals());
  return c;
}

} // namespace audit
