// vrml97_places.cpp: the lights, cameras and environment of the stock plug-in in a fake host,
// against values computed in double from ISO/IEC 14772-1 clauses 4.14, 6.5, 6.16, 6.19, 6.33 and
// 6.41.
#include <cmath>

#include <gtest/gtest.h>

#include "abi/fake_host.h"
#include "shading/registry.h"

namespace openrt::test {
namespace {

const RtsClass& stock(const char* name) {
  static const ShaderRegistry registry(shaderFolders(""));
  return registry.find(name, "");
}

struct Vec {
  float x, y, z;
};

struct Arrays {
  explicit Arrays(const std::vector<Vec>& points) {
    std::vector<float> c[3];
    for (const Vec& p : points) {
      c[0].push_back(p.x);
      c[1].push_back(p.y);
      c[2].push_back(p.z);
    }
    for (size_t k = 0; k < 3; k++) {
      lanes[k] = Lanes(c[k]);
      in[k] = lanes[k].data();
    }
  }
  Lanes lanes[3];
  const float* in[3];
};

struct Lit {
  float direct, ambient, toLight[3];
  int directional;
};

Lit illuminate(const char* name, const ParamBlock& p, Vec point) {
  FakeHost host;
  Arrays at({point});
  Lanes lanes[9];
  RtsIllumination out{};
  for (size_t c = 0; c < 3; c++) {
    for (size_t k = 0; k < 3; k++) lanes[3 * k + c] = Lanes(1, -7.0f);
    out.toLight[c] = lanes[c].data();
    out.color[c] = lanes[3 + c].data();
    out.ambient[c] = lanes[6 + c].data();
  }
  stock(name).illuminate(&host, host.batch(), p.get(), 1, at.in, &out);
  EXPECT_FLOAT_EQ(out.color[1][0], 0.5f * out.color[0][0]) << "tests use colours of (1, .5, 0)";
  EXPECT_EQ(out.color[2][0], 0.0f);
  return {out.color[0][0],
          out.ambient[0][0],
          {out.toLight[0][0], out.toLight[1][0], out.toLight[2][0]},
          out.directional};
}

ParamBlock block(const char* name) {
  ParamBlock p(stock(name));
  p.set("color", {1, .5f, 0});
  return p;
}

TEST(Vrml97Lights, Directional) {
  ParamBlock p = block("VRML97DirectionalLight");
  p.set("direction", {1, 2, -3});
  p.set("intensity", {2.0f});
  p.set("ambientIntensity", {.25f});
  const Lit l = illuminate("VRML97DirectionalLight", p, {1e6f, 0, 0});
  EXPECT_EQ(l.direct, 2);
  EXPECT_EQ(l.ambient, .25f);
  EXPECT_TRUE(l.directional);
  EXPECT_EQ(l.toLight[0], -1);
  EXPECT_EQ(l.toLight[1], -2);
  EXPECT_EQ(l.toLight[2], 3);
}

TEST(Vrml97Lights, PointAttenuationIsNeverBelowOne) { // V2, V3
  for (const auto& [attenuation, d, wanted] : {std::tuple{std::vector<float>{0, 0, 1}, 2.0f, .25},
                                               {{0, 0, 1}, .5f, 1.0},
                                               {{1, 1, 1}, 3.0f, 1 / 13.0},
                                               {{0, 0, 0}, 9.0f, 1.0},
                                               {{1, 0, 0}, 9.0f, 1.0},
                                               {{0, 2, 0}, 4.0f, .125}}) {
    ParamBlock p = block("VRML97PointLight");
    p.set("attenuation", attenuation);
    p.set("location", {1, 2, 3});
    p.set("ambientIntensity", {.5f});
    const Lit l = illuminate("VRML97PointLight", p, {1, 2 - d, 3});
    EXPECT_NEAR(l.direct, wanted, 1e-6 * wanted);
    EXPECT_NEAR(l.ambient, .5 * wanted, 1e-6 * wanted);
    EXPECT_FALSE(l.directional);
    EXPECT_EQ(l.toLight[0], 0);
    EXPECT_EQ(l.toLight[1], d);
    EXPECT_EQ(l.toLight[2], 0);
  }
}

TEST(Vrml97Lights, NothingBeyondTheRadius) { // V11
  ParamBlock p = block("VRML97PointLight");
  p.set("radius", {5.0f});
  p.set("ambientIntensity", {1.0f});
  EXPECT_EQ(illuminate("VRML97PointLight", p, {0, 0, 4.999f}).direct, 1);
  EXPECT_EQ(illuminate("VRML97PointLight", p, {0, 0, 5.001f}).direct, 0);
  EXPECT_EQ(illuminate("VRML97PointLight", p, {0, 0, 5.001f}).ambient, 0);
  p.set("radius", {0.0f});
  EXPECT_EQ(illuminate("VRML97PointLight", p, {0, 0, .001f}).direct, 0);
}

TEST(Vrml97Lights, SpotFallsOffBetweenItsAngles) { // V6
  ParamBlock p = block("VRML97SpotLight");
  p.set("beamWidth", {.3f});
  p.set("cutOffAngle", {.6f});
  p.set("direction", {0, 0, -5}); // any length is allowed
  for (const auto& [angle, wanted] : {std::pair{.45, .5},
                                      {.3, 1.0},
                                      {.6, 0.0},
                                      {.0, 1.0},
                                      {.301, .99666667},
                                      {.599, .0033333},
                                      {.61, 0.0},
                                      {3.1, 0.0}}) {
    const Lit l = illuminate("VRML97SpotLight", p,
                             {float(7 * std::sin(angle)), 0, float(-7 * std::cos(angle))});
    EXPECT_NEAR(l.direct, wanted, 2e-6) << angle;
  }
}

TEST(Vrml97Lights, NarrowSpotsKeepTheirDigits) {
  ParamBlock p = block("VRML97SpotLight");
  p.set("beamWidth", {.0f});
  p.set("cutOffAngle", {1e-3f});
  for (const double angle : {1e-4, 2.5e-4, 9e-4})
    EXPECT_NEAR(
        illuminate("VRML97SpotLight", p, {0, float(std::sin(angle)), float(-std::cos(angle))})
            .direct,
        1 - angle * 1e3, 1e-5);
}

TEST(Vrml97Lights, TheDefaultSpotIsAHardCone) {
  const ParamBlock p = block("VRML97SpotLight");
  EXPECT_EQ(illuminate("VRML97SpotLight", p, {std::sin(.70f), 0, -std::cos(.70f)}).direct, 1);
  EXPECT_EQ(illuminate("VRML97SpotLight", p, {std::sin(.80f), 0, -std::cos(.80f)}).direct, 0);
  EXPECT_EQ(illuminate("VRML97SpotLight", p, {0, 0, 1}).direct, 0);
}

TEST(Vrml97Lights, ShadowsAreATrait) {
  FakeHost host;
  for (const char* name : {"VRML97DirectionalLight", "VRML97PointLight", "VRML97SpotLight"}) {
    ParamBlock p = block(name);
    EXPECT_EQ(stock(name).traits(&host, p.get()), unsigned(RTS_IRRADIANCE));
    p.setInt("shadows", 0);
    EXPECT_EQ(stock(name).traits(&host, p.get()), unsigned(RTS_IRRADIANCE | RTS_NO_SHADOW));
  }
}

struct Colour {
  float r, g, b, a;
};

std::vector<Colour> miss(const ParamBlock& p, std::vector<Vec> directions,
                         FakeHost&& host = FakeHost()) {
  for (Vec& d : directions) {
    const float length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    d = {d.x / length, d.y / length, d.z / length};
  }
  Arrays in(directions);
  const auto n = static_cast<uint32_t>(directions.size());
  Lanes lanes[4] = {Lanes(n, 9.0f), Lanes(n, 9.0f), Lanes(n, 9.0f), Lanes(n, 9.0f)};
  float* rgba[4] = {lanes[0].data(), lanes[1].data(), lanes[2].data(), lanes[3].data()};
  stock("VRML97Environment").miss(&host, host.batch(), p.get(), n, in.in, rgba);
  std::vector<Colour> out;
  for (uint32_t i = 0; i < n; i++)
    out.push_back({lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i]});
  return out;
}

// Returns the direction at an angle from the zenith.
Vec zenith(double angle, double around = 0.7) {
  return {float(std::sin(angle) * std::cos(around)), float(std::cos(angle)),
          float(std::sin(angle) * std::sin(around))};
}

TEST(Vrml97Background, OneColourAndNone) {
  ParamBlock p(stock("VRML97Environment"));
  Colour c = miss(p, {{0, 0, -1}})[0];
  EXPECT_EQ(c.r + c.g + c.b + c.a, 0);
  p.set("skyColor", {.1f, .2f, .3f});
  c = miss(p, {{1, -2, 3}})[0];
  EXPECT_EQ(c.g, .2f);
  EXPECT_EQ(c.a, 1);
}

TEST(Vrml97Background, SkyBandsAreInterpolatedAndTheLastGoesToTheNadir) {
  ParamBlock p(stock("VRML97Environment"));
  p.set("skyColor", {0, 0, 0, 1, 0, 0, 1, 1, 0});
  p.set("skyAngle", {1, 1.5f});
  const auto c =
      miss(p, {zenith(0), zenith(.25), zenith(.999), zenith(1.25), zenith(1.6), zenith(3.14)});
  EXPECT_NEAR(c[0].r, 0, 1e-6);
  EXPECT_NEAR(c[1].r, .25, 1e-6);
  EXPECT_NEAR(c[2].r, .999, 1e-6);
  EXPECT_NEAR(c[3].g, .5, 2e-6);
  EXPECT_EQ(c[4].g, 1);
  EXPECT_EQ(c[5].g, 1);
}

TEST(Vrml97Background, GroundCoversUpToItsLastAngle) {
  ParamBlock p(stock("VRML97Environment"));
  p.set("skyColor", {0, 0, 1});
  p.set("groundColor", {1, 0, 0, 0, 1, 0});
  p.set("groundAngle", {1.0f});
  const double pi = 3.14159265358979;
  const auto c =
      miss(p, {zenith(pi), zenith(pi - .5), zenith(pi - .999), zenith(pi - 1.001), zenith(1)});
  EXPECT_NEAR(c[0].r, 1, 1e-6);
  EXPECT_NEAR(c[1].g, .5, 1e-6);
  EXPECT_NEAR(c[2].g, .999, 1e-5);
  EXPECT_EQ(c[3].b, 1);
  EXPECT_EQ(c[4].b, 1);
}

TEST(Vrml97Background, AnglesOutOfOrderOrRangeAreHarmless) {
  ParamBlock p(stock("VRML97Environment"));
  p.set("skyColor", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  // More angles than colours, a decreasing angle, one that is too large.
  p.set("skyAngle", {2, 1, 77, 5, NAN});
  for (double a = 0; a <= 3.2; a += .05)
    for (const Colour& c : miss(p, {zenith(a)})) {
      EXPECT_TRUE(c.r >= 0 && c.r <= 1 && c.g >= 0 && c.g <= 1 && c.b >= 0 && c.b <= 1) << a;
      EXPECT_EQ(c.a, 1);
    }
  EXPECT_NEAR(miss(p, {zenith(1)})[0].r, .5,
              1e-6); // interpolates towards the second colour at 2, where the third one starts, too
}

TEST(Vrml97Background, PicturesLieWhereTheHeadTurns) {
  // The fake host's red channel grows by 10 u + 100 v, which shows s and t of each face.
  const struct {
    const char* name;
    Vec direction;
    float s, t;
  } looks[] = {
      {"frontTexture", {.5f, .25f, -1}, .75f, .625f},
      {"backTexture", {.5f, .25f, 1}, .25f, .625f},
      {"leftTexture", {-1, .25f, .5f}, .25f, .625f},
      {"rightTexture", {1, .25f, .5f}, .75f, .625f},
      {"topTexture", {.5f, 1, .25f}, .75f, .625f},
      {"bottomTexture", {.5f, -1, .25f}, .75f, .375f},
  };
  for (const auto& look : looks) {
    ParamBlock p(stock("VRML97Environment"));
    p.setInt(look.name, 1);
    FakeHost host;
    host.textures = {{3, {0, .5f, 0, 1}}};
    const Colour c = miss(p, {look.direction}, std::move(host))[0];
    EXPECT_NEAR(c.r, 10 * look.s + 100 * look.t, 1e-3) << look.name;
    EXPECT_EQ(c.g, .5f);
    EXPECT_EQ(c.a, 1);
  }
}

TEST(Vrml97Background, AlphaOfAPictureShowsTheSky) {
  ParamBlock p(stock("VRML97Environment"));
  p.set("skyColor", {0, 1, .5f});
  p.setInt("frontTexture", 1);
  FakeHost host;
  host.textures = {{4, {0, 0, 1, .25f}}};
  const auto c = miss(p, {{0, 0, -1}, {0, 0, 1}}, std::move(host));
  EXPECT_FLOAT_EQ(c[0].g, .75f);
  EXPECT_FLOAT_EQ(c[0].b, .75f * .5f + .25f);
  EXPECT_EQ(c[1].g, 1);
}

float fraction(const ParamBlock& p, Vec fromEye, float* red = nullptr) {
  FakeHost host;
  Arrays in({fromEye});
  Lanes lanes[4] = {Lanes(1), Lanes(1), Lanes(1), Lanes(1, 9.0f)};
  float* color[3] = {lanes[0].data(), lanes[1].data(), lanes[2].data()};
  stock("VRML97Environment")
      .attenuate(&host, host.batch(), p.get(), 1, in.in, color, lanes[3].data());
  if (red) *red = lanes[0][0];
  return lanes[3][0];
}

TEST(Vrml97Fog, FractionsOfBothKinds) { // V7
  ParamBlock p(stock("VRML97Environment"));
  p.set("fogColor", {.3f, .2f, .1f});
  p.set("fogRange", {10.0f});
  EXPECT_EQ(fraction(p, {0, 0, -4}), 1); // no fog type
  p.setInt("fogType", 1);
  float red = 0;
  EXPECT_NEAR(fraction(p, {0, 0, -4}, &red), .6, 1e-6);
  EXPECT_EQ(red, .3f);
  EXPECT_EQ(fraction(p, {0, 10, 0}), 0);
  EXPECT_EQ(fraction(p, {0, 0, 11}), 0);
  p.setInt("fogType", 2);
  EXPECT_NEAR(fraction(p, {4, 0, 0}), std::exp(-4 / 6.0), 1e-6);
  EXPECT_NEAR(fraction(p, {9, 0, 0}), std::exp(-9.0), 1e-9);
  EXPECT_LE(fraction(p, {9.9f, 0, 0}), 1e-30);
  EXPECT_GE(fraction(p, {9.9f, 0, 0}), 0);
  EXPECT_EQ(fraction(p, {10, 0, 0}), 0);
  EXPECT_EQ(fraction(p, {11, 0, 0}), 0);
  EXPECT_EQ(fraction(p, {0, 0, 0}), 1);
  p.set("fogRange", {0.0f});
  EXPECT_EQ(fraction(p, {11, 0, 0}), 1);
}

TEST(Vrml97Fog, DistanceIsMeasuredInTheFogsSpace) {
  ParamBlock p(stock("VRML97Environment"));
  p.setInt("fogType", 1);
  p.set("fogRange", {10.0f});
  p.set("fogMatrix", {.5f, 0, 0, 0, 0, 0, 2, 0, 0, 1, 0, 0, 99, 99, 99, 1});
  EXPECT_NEAR(fraction(p, {4, 0, 0}), .8, 1e-6);
  EXPECT_NEAR(fraction(p, {0, 4, 0}), .2, 1e-6);
}

void generate(const ParamBlock& p, const char* name, Vec pixel, Vec& origin, Vec& direction) {
  FakeHost host;
  Arrays in({pixel});
  const float size[2] = {200, 100};
  Lanes lanes[6];
  RtsRays rays{};
  for (size_t c = 0; c < 3; c++) {
    lanes[c] = lanes[3 + c] = Lanes(1, 9.0f);
    rays.origin[c] = lanes[c].data();
    rays.direction[c] = lanes[3 + c].data();
  }
  stock(name).generate(&host, host.batch(), p.get(), 1, in.in, size, &rays);
  origin = {lanes[0][0], lanes[1][0], lanes[2][0]};
  direction = {lanes[3][0], lanes[4][0], lanes[5][0]};
}

TEST(Vrml97Cameras, PerspectiveLooksDownTheAxisWithItsAngleAtTheEdge) {
  ParamBlock p(stock("PerspectiveCamera"));
  p.set("fovy", {60.0f});
  Vec o{}, d{};
  generate(p, "PerspectiveCamera", {100, 50, 0}, o, d);
  EXPECT_EQ(d.x, 0);
  EXPECT_EQ(d.y, 0);
  EXPECT_EQ(d.z, -1);
  EXPECT_EQ(o.x, 0);
  generate(p, "PerspectiveCamera", {100, 0, 0}, o,
           d); // the middle of the upper edge: 30 degrees up
  EXPECT_NEAR(d.y, .5, 1e-6);
  EXPECT_NEAR(d.z, -std::sqrt(.75), 1e-6);
  generate(p, "PerspectiveCamera", {200, 50, 0}, o, d); // the right edge is twice as far out
  EXPECT_NEAR(d.x / -d.z, 2 / std::sqrt(3.0), 1e-6);
}

TEST(Vrml97Cameras, OrthographicRaysAreParallel) {
  ParamBlock p(stock("OrthographicCamera"));
  p.set("height", {8.0f});
  Vec o{}, d{};
  generate(p, "OrthographicCamera", {200, 0, 0}, o, d);
  EXPECT_FLOAT_EQ(o.x, 8);
  EXPECT_FLOAT_EQ(o.y, 4);
  EXPECT_EQ(o.z, 0);
  EXPECT_EQ(d.z, -1);
  EXPECT_EQ(d.x, 0);
}

} // namespace
} // namespace openrt::test
