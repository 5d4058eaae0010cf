// lamps.cpp: light of emissive shapes, of many lights and inside spheres, by path tracing, against
// closed forms (accuracy catalogue R4 to R12, G3, G9, form factors). Uses the C API. A white
// surface under irradiance E shows E / pi, which is the lamp's form factor if its radiance is 1.
#include "numeric/support.h"

#include <cstdio>
#include <functional>

namespace numeric {
namespace {

constexpr double degree = pi / 180;

Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(Vec a) { return std::sqrt(dot(a, a)); }

// R7: Lambert's formula, divided by pi, for a polygon seen from the origin by a surface that faces
// z. The whole polygon is above the surface.
double polygon(const std::vector<Vec>& v) {
  double sum = 0;
  for (size_t i = 0; i < v.size(); i++) {
    const Vec a = v[i], b = v[(i + 1) % v.size()], n = cross(a, b);
    if (length(n) > 0) sum += std::atan2(length(n), dot(a, b)) * n.z / length(n);
  }
  return std::fabs(sum) / (2 * pi);
}

// Clips a polygon; the rest has dot(normal, p) >= offset.
std::vector<Vec> clip(const std::vector<Vec>& v, Vec normal, double offset) {
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

std::vector<Vec> rectangle(double half, double z) {
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
  static Shader matt(double reflectance, double radiance = 0) {
    Shader s("Diffuse");
    s.set("reflectance", {reflectance, reflectance, reflectance})
        .set("emission", {radiance, radiance, radiance});
    return s;
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

TEST_F(Lamps, R4ADiscOnItsAxis) {
  floor();
  lamp(disc(1, 1));
  expectQ("R4", lit(), .5, 1e-3);
}

TEST_F(Lamps, R5ADiscFromBesideItsAxis) {
  floor();
  lamp(disc(1, 1));
  expectQ("R5 x=.5", lit(.5), .43798263, 1e-3);
  expectQ("R5 x=1", lit(1), .27639320, 1e-3);
  expectQ("R5 x=2", lit(2), .05278640, 1e-3);
}

TEST_F(Lamps, R6ASphere) {
  floor();
  for (const double tilt : {0., 60.}) {
    rtPushMatrix();
    rtTranslated(3 * std::sin(tilt * degree), 0, 3 * std::cos(tilt * degree));
    const RTid sphere = ball(matt(0, 1), 1);
    rtPopMatrix();
    expectQ(tilt > 0 ? "R6 t=60" : "R6 t=0", lit(), std::cos(tilt * degree) / 9, 1e-3);
    rtDeleteInstance(sphere);
  }
}

// The tangent cone from the point is that of a disc of radius a c / sqrt(d^2 - c^2) at distance d.
TEST_F(Lamps, R6AnEllipsoidIsSeenAsItsOutline) {
  floor();
  rtPushMatrix();
  rtTranslated(0, 0, 3);
  rtScaled(2, 2, .5);
  ball(matt(0, 1), 1);
  rtPopMatrix();
  const double tangent = 2 / std::sqrt(9 - .25); // tangent of the cone's half angle
  expectQ("R6 flat", lit(), tangent * tangent / (1 + tangent * tangent), 1e-3);
}

TEST_F(Lamps, R7Polygons) {
  floor();
  const std::vector<Vec> triangle{{1, 0, 1}, {0, 1, 1}, {-1, -1, 1}};
  EXPECT_NEAR(polygon(triangle) * pi, .94357481, 1e-8);
  EXPECT_NEAR(polygon(rectangle(.5, 1)) * pi, .75227469, 1e-8);
  const RTid first = lamp(triangle);
  expectQ("R7 3", lit(), polygon(triangle), 1e-3);
  rtDeleteInstance(first);
  lamp(rectangle(.5, 1));
  expectQ("R7 4", lit(), polygon(rectangle(.5, 1)), 1e-3);
}

TEST_F(Lamps, R8APolygonBehindAnEdge) {
  floor();
  lamp(rectangle(.5, 1));
  rtPushMatrix();
  rtTranslated(100.1, 0, .5); // occludes the part with x > .2 in the lamp's plane
  place(square(matt(0), 100));
  rtPopMatrix();
  expectQ("R8", lit(), polygon(clip(rectangle(.5, 1), {-1, 0, 0}, -.2)), 2e-3);
}

TEST_F(Lamps, R9APolygonThatCrossesTheHorizon) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
  floor();
  const std::vector<Vec> tilted{{1, -1, -.7}, {1, 1, -.7}, {.5, 1, 1.5}, {.5, -1, 1.5}};
  lamp(tilted);
  expectQ("R9", lit(), polygon(clip(tilted, {0, 0, 1}, 0)), 1e-3);
}

TEST_F(Lamps, R10TheNearField) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
  floor();
  const RTid corner = lamp({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  expectQ("R10 corner", lit(), .13853161, 1e-3);
  rtDeleteInstance(corner);
  lamp(rectangle(1, .01));
  expectQ("R10 near", lit(), .99991818, 1e-3);
}

TEST_F(Lamps, R11NothingArrivesAndItIsZero) {
  floor();
  const auto dark = [](RTid what, const char* why) {
    const Rgba pixel = look(0, 0, .001);
    EXPECT_EQ(pixel.r, 0) << why;
    EXPECT_EQ(pixel.g, 0) << why;
    rtDeleteInstance(what);
  };
  dark(lamp({{0, 0, 1}, {1, 1, 1}, {2, 2, 1}}), "no area");
  dark(lamp({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), "a point");
  dark(lamp({{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}}), "behind the surface");
  dark(lamp({{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}), "edge-on, without area");
  dark(lamp({{-1, 0, 1}, {1, 0, 1}, {0, 0, 2}}, 1), "edge-on: in a plane with the point");
  dark(lamp(rectangle(1, 1), 0), "no emission");
  dark(lamp({{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}, 1, true), "a back that is not there");
  rtPushMatrix();
  rtTranslated(0, 0, -2);
  dark(ball(matt(0, 1), 1), "a sphere behind the surface");
  rtPopMatrix();
}

TEST_F(Lamps, R11NoLightBeyondItsRadius) {
  floor();
  for (int i = 0; i < 40; i++)
    use(Shader("VRML97PointLight").set("location", {0, 0, 2}).set("radius", {1.9}));
  EXPECT_EQ(lit(), 0);
}

TEST_F(Lamps, LightIsLinearInRadiance) {
  floor();
  double before = 0;
  for (const double radiance : {1., 16., 65536.}) {
    const RTid instance = lamp(rectangle(.5, 1), radiance);
    const double now = lit() / radiance;
    EXPECT_NEAR(now, before > 0 ? before : now, 1e-6);
    before = now;
    rtDeleteInstance(instance);
  }
}

TEST_F(Lamps, R12ManyEqualLightsAreOneOfTheirPower) {
  floor();
  rtQuality(RT_SAMPLES_PER_PIXEL, 16);
  for (const int n : {1, 4, 1000, 100000}) {
    Shader light = point({.5, 0, 1}, {0, 0, 1});
    light.set("intensity", {2. / n});
    std::vector<RTid> ids;
    for (int i = 0; i < n; i++) ids.push_back(use(light));
    const double d2 = 1.25;
    // All lights are in one place, so each choice is exact.
    expectQ("R12", lit(), 2 / d2 / std::sqrt(d2), 1e-5);
    for (const RTid id : ids) rtRemoveLight(id);
  }
}

TEST_F(Lamps, R12ManyLightsOfAllKindsAddUp) {
  floor();
  double expected = 0;
  for (int i = 0; i < 900; i++) {
    const double x = i % 30 - 14.5, y = i / 30 - 14.5, z = 1 + i % 7, d2 = x * x + y * y + z * z;
    const double strength = .01 * (1 + i % 5);
    Shader light(i % 3 ? "VRML97PointLight" : "VRML97SpotLight");
    light.set("location", {x, y, z}).set("attenuation", {0, 0, 1}).set("intensity", {strength});
    if (i % 3 == 0)
      light.set("direction", {0, 0, -1}).set("cutOffAngle", {.8}).set("beamWidth", {.8});
    use(light);
    if (i % 3 == 0 && z < std::sqrt(d2) * std::cos(.8)) continue;
    expected += strength / d2 * z / std::sqrt(d2);
  }
  use(Shader("VRML97DirectionalLight").set("intensity", {.1}).set("direction", {0, 0, -1}));
  expectQ("R12 mixed", lit(), expected + .1, 5e-3);
}

TEST_F(Lamps, R12ALampInManyPiecesIsOneLamp) {
  floor();
  for (const int n : {1, 2, 32, 224}) {
    const RTid object = rtBeginObject(0);
    rtBindShader(matt(0, 1));
    rtBegin(RT_QUADS);
    for (int i = 0; i < n * n; i++)
      for (const auto& c : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        rtVertex3d(double(i % n + c[0]) / n - .5, double(i / n + c[1]) / n - .5, 1);
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    const RTid placed = place(object);
    expectQ("R12 pieces", lit(), .75227469 / pi, 1e-3);
    rtDeleteInstance(placed);
  }
}

// A ray reports only one of two coincident hits.
TEST_F(Lamps, TwoLampsInOnePlaceAreOne) {
  floor();
  const RTid object = rtBeginObject(0);
  rtBindShader(matt(0, 1));
  rtBegin(RT_QUADS);
  for (int copy = 0; copy < 3; copy++)
    for (const Vec& p : rectangle(.5, 1)) rtVertex3d(p.x, p.y, p.z);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  place(object);
  lamp(rectangle(.5, 1));
  expectQ("in one place", lit(), .75227469 / pi, 2e-3);
}

// One-sided by culling. Light sampling must choose the same side as ray intersection.
TEST_F(Lamps, LampsThatAreMirroredAndTurned) {
  floor();
  for (const double flip : {1., -1.}) {
    const RTid object = rtBeginObject(0);
    rtEnable(RT_CULL_FACE);
    rtBindShader(matt(0, 1));
    rtBegin(RT_QUADS);
    for (const auto& c : {std::array{-.5, .5}, {.5, .5}, {.5, -.5}, {-.5, -.5}})
      rtVertex3d(c[0], c[1], 0); // faces down
    rtEnd();
    rtDisable(RT_CULL_FACE);
    rtEndObject();
    rtBindShader(0);
    std::vector<RTid> placed;
    for (int i = 0; i < 3; i++) { // instances of one object
      rtPushMatrix();
      rtTranslated(0, i == 0 ? 0 : 50 * i, 1);
      rtScaled(flip, 1, 1);
      placed.push_back(place(object));
      rtPopMatrix();
    }
    expectQ("mirrored", lit(), .75227469 / pi, 2e-3);
    for (const RTid id : placed) rtDeleteInstance(id);
  }
}

TEST_F(Lamps, FormFactorOfParallelSquares) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  floor(.5);
  const double z = 1;
  rtPushMatrix();
  rtLoadIdentity();
  lamp(rectangle(.5, z));
  rtPopMatrix();
  const double f = mean(16, [] {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, .5);
    rtOrtho(1);
    rtPopMatrix();
  });
  expectQ("parallel", f, .19982490, 1e-3);
}

TEST_F(Lamps, FormFactorOfSquaresWithACommonEdge) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  floor(.5);
  lamp({{.5, -.5, 0}, {.5, .5, 0}, {.5, .5, 1}, {.5, -.5, 1}});
  const double f = mean(16, [] {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, 2);
    rtOrtho(1);
    rtPopMatrix();
  });
  expectQ("edge", f, .20004378, 1e-3);
}

TEST_F(Lamps, FormFactorOfDiscs) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  lamp(disc(1, 1));
  const RTid object = rtBeginObject(0);
  rtBindShader(matt(1));
  rtBegin(RT_TRIANGLES);
  const std::vector<Vec> v = disc(1, 0);
  for (size_t i = 1; i + 1 < v.size(); i++)
    for (const Vec& p : {v[0], v[i], v[i + 1]}) rtVertex3d(p.x, p.y, p.z);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  place(object);
  const double f = mean(32, [] {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, .5);
    rtOrtho(2.01);
    rtPopMatrix();
  });
  expectQ("discs", f * 2.01 * 2.01 / pi, .38196601, 2e-3);
}

// The eye is inside, and the whole sphere sees the source. G3: the indirect part is the same
// everywhere.
TEST_F(Lamps, G3AnIntegratingSphere) {
  rtQuality(RT_MAX_DEPTH, 60);
  rtQuality(RT_SAMPLES_PER_PIXEL, 16384);
  constexpr double rho = .5, radius = 4;
  ball(matt(rho), radius);
  for (const double off : {0., 2.}) {
    const double c = 32; // the light's colour: intensity over pi
    const RTid source = use(point({off, 0, 0}, {0, 0, 1}).set("intensity", {c}));
    const double direct = rho * c / (radius * radius + off * off) * radius /
                          std::sqrt(radius * radius + off * off); // seen at (0,0,-4)
    const double indirect = rho * rho * c / (radius * radius * (1 - rho));
    expectQ(off > 0 ? "G3 off" : "G3 centre", double(lookFrom(1).g), direct + indirect, 2e-3);
    rtRemoveLight(source);
  }
}

// G9: reciprocity. Light that travels from lamp to sensor via a room is the same after the two are
// exchanged.
TEST_F(Lamps, G9LampAndSensorChangePlaces) {
  rtQuality(RT_MAX_DEPTH, 5);
  rtQuality(RT_SAMPLES_PER_PIXEL, 2048);
  double seen[2];
  for (int turn = 0; turn < 2; turn++) {
    const RTid floorPlaced = place(square(matt(.6), 3));
    std::vector<RTid> placed{floorPlaced};
    rtPushMatrix();
    rtTranslated(0, 0, .6);
    rtRotated(90, 0, 1, 0);
    rtTranslated(.35, 0, 0); // from z = 0 to .5: hides lamp and sensor from each other
    placed.push_back(place(square(matt(.3), .25)));
    rtPopMatrix();
    rtPushMatrix();
    rtTranslated(0, 0, 2);
    placed.push_back(place(square(matt(.6), 3)));
    rtPopMatrix();
    for (int i = 0; i < 2; i++) {
      const bool sensor = i == turn;
      rtPushMatrix();
      rtTranslated(i ? .8 : -.5, 0, i ? .3 : .1);
      const RTid object = rtBeginObject(0); // the sensor has one side, so the lamp has one, too
      rtEnable(RT_CULL_FACE);
      rtBindShader(matt(.5, sensor ? 0 : 10));
      rtBegin(RT_QUADS);
      for (const Vec& p : rectangle(.2, 0)) rtVertex3d(p.x, p.y, p.z);
      rtEnd();
      rtDisable(RT_CULL_FACE);
      rtEndObject();
      rtBindShader(0);
      placed.push_back(place(object));
      rtPopMatrix();
    }
    seen[turn] = mean(8, [&] { // averaged over the whole sensor
      rtPushMatrix();
      rtLoadIdentity();
      rtTranslated(turn ? .8 : -.5, 0, turn ? .31 : .11);
      rtOrtho(.4);
      rtPopMatrix();
    });
    for (const RTid id : placed) rtDeleteInstance(id);
  }
  expectQ("G9", seen[0] / seen[1], 1, 1e-2);
}

} // namespace
} // namespace numeric
