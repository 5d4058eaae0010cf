// vrml97_surface.cpp: the surface of the stock plug-in, loaded as a plug-in and run in a fake host:
// both tables of ISO/IEC 14772-1 clause 4.14.3, the lighting equation, traits and transmission. The
// expected values are computed in double.
#include <cmath>

#include <gtest/gtest.h>

#include "abi/fake_host.h"
#include "shading/registry.h"

namespace openrt::test {
namespace {

const RtsClass& surface() {
  static const ShaderRegistry registry(shaderFolders(""));
  return registry.find("VRML97", "");
}

struct Rgb {
  float r, g, b;
};

void expectRgb(Rgb got, Rgb wanted, double relative = 1e-5) {
  EXPECT_NEAR(got.r, wanted.r, relative * std::max(1e-3f, std::fabs(wanted.r)));
  EXPECT_NEAR(got.g, wanted.g, relative * std::max(1e-3f, std::fabs(wanted.g)));
  EXPECT_NEAR(got.b, wanted.b, relative * std::max(1e-3f, std::fabs(wanted.b)));
}

// One batch of hits of a surface in the plane z = 0, seen from +z. Each lane has its own
// parameters.
struct Hits {
  explicit Hits(std::vector<const void*> parameters)
      : count(static_cast<uint32_t>(parameters.size())), params(std::move(parameters)) {
    const uint32_t lanes = (count + RTS_LANES - 1) / RTS_LANES * RTS_LANES;
    for (auto* group : {position, direction, geometric, normal, color})
      for (int c = 0; c < 3; c++) group[c] = Lanes(count, 0.0f);
    for (int c = 0; c < 3; c++) color[c] = Lanes(count, 1.0f);
    color[3] = Lanes(count, 1.0f);
    direction[2] = Lanes(count, -1.0f);
    geometric[2] = normal[2] = Lanes(count, 1.0f);
    uv[0] = uv[1] = distance = Lanes(count, 0.0f);
    flags.assign(lanes, 0);
    params.resize(lanes, params.back());
  }
  RtsHits table() {
    RtsHits h{};
    h.count = count;
    for (int c = 0; c < 3; c++) {
      h.position[c] = position[c].data();
      h.direction[c] = direction[c].data();
      h.geometric[c] = geometric[c].data();
      h.normal[c] = normal[c].data();
    }
    for (int c = 0; c < 4; c++) h.color[c] = color[c].data();
    for (int c = 0; c < 2; c++) h.uv[c] = uv[c].data();
    h.distance = distance.data();
    h.flags = flags.data();
    h.params = params.data();
    return h;
  }
  void paint(uint32_t lane, Rgb c) {
    flags[lane] |= RTS_HIT_COLOR;
    color[0][lane] = c.r;
    color[1][lane] = c.g;
    color[2][lane] = c.b;
  }

  uint32_t count;
  Lanes position[4], direction[4], geometric[4], normal[4], color[4], uv[2], distance;
  std::vector<uint32_t> flags;
  std::vector<const void*> params;
};

struct Answer {
  explicit Answer(uint32_t n) {
    for (auto* group : {radiance, transmission, albedo})
      for (int c = 0; c < 3; c++) group[c] = Lanes(n, 0.0f);
  }
  Rgb light(size_t i = 0) { return {radiance[0][i], radiance[1][i], radiance[2][i]}; }
  Rgb through(size_t i = 0) { return {transmission[0][i], transmission[1][i], transmission[2][i]}; }
  Rgb colour(size_t i = 0) { return {albedo[0][i], albedo[1][i], albedo[2][i]}; }
  Lanes radiance[3], transmission[3], albedo[3];
};

Answer shade(FakeHost& host, Hits& hits) {
  Answer a(hits.count);
  const RtsHits table = hits.table();
  RtsShading out{};
  for (int c = 0; c < 3; c++) {
    out.radiance[c] = a.radiance[c].data();
    out.transmission[c] = a.transmission[c].data();
    out.albedo[c] = a.albedo[c].data();
  }
  surface().shade(&host, host.batch(), &table, &out);
  return a;
}

Rgb transmit(FakeHost& host, Hits& hits, size_t lane = 0) {
  Lanes t[3] = {Lanes(hits.count), Lanes(hits.count), Lanes(hits.count)};
  float* out[3] = {t[0].data(), t[1].data(), t[2].data()};
  const RtsHits table = hits.table();
  surface().transmit(&host, host.batch(), &table, out);
  return {t[0][lane], t[1][lane], t[2][lane]};
}

constexpr float degree = 0.017453292519943295f;
FakeLight lightAt(float degrees) {
  return {{std::sin(degrees * degree), 0, std::cos(degrees * degree)}};
}

TEST(Vrml97Surface, DiffuseFollowsTheCosine) { // V1
  const ParamBlock p(surface());
  for (const auto& [angle, wanted] :
       {std::pair{0.0f, 0.8f}, {60.0f, 0.4f}, {90.0f, 0.0f}, {120.0f, 0.0f}}) {
    FakeHost host;
    host.shining = {lightAt(angle)};
    Hits hits({p.get()});
    expectRgb(shade(host, hits).light(), {wanted, wanted, wanted});
  }
}

TEST(Vrml97Surface, AmbientPartIsNotShadowedAndNeedsNoFacing) { // V4
  ParamBlock p(surface());
  for (const auto& [angle, visible, wanted] :
       {std::tuple{0.0f, 1.0f, 0.88f}, {90.0f, 1.0f, 0.08f}, {0.0f, 0.0f, 0.08f}}) {
    FakeHost host;
    host.shining = {lightAt(angle)};
    for (float& a : host.shining[0].ambient) a = 0.5f;
    host.shining[0].visible = visible;
    Hits hits({p.get()});
    expectRgb(shade(host, hits).light(), {wanted, wanted, wanted});
  }
}

TEST(Vrml97Surface, HighlightOfBlinn) { // V5: the half vector is at half the light's angle
  for (const auto& [half, shininess, wanted] : {std::tuple{10.0f, 0.2f, 0.675768f},
                                                {10.0f, 1.0f, 0.140925f},
                                                {5.0f, 0.2f, 0.907010f},
                                                {0.0f, 1.0f, 1.0f}}) {
    ParamBlock p(surface());
    p.set("diffuseColor", {0, 0, 0});
    p.set("specularColor", {1, 0.5f, 0});
    p.set("shininess", {shininess});
    FakeHost host;
    host.shining = {lightAt(2 * half)};
    Hits hits({p.get()});
    expectRgb(shade(host, hits).light(), {wanted, wanted / 2, 0});
  }
}

TEST(Vrml97Surface, HighlightAgainstDoublePrecision) {
  for (float shininess = 0.0f; shininess <= 1.0f; shininess += 0.125f)
    for (float angle = 0; angle < 90; angle += 3.0f) {
      ParamBlock p(surface());
      p.set("diffuseColor", {0, 0, 0});
      p.set("specularColor", {1, 1, 1});
      p.set("shininess", {shininess});
      FakeHost host;
      host.shining = {lightAt(angle)};
      Hits hits({p.get()});
      const FakeLight& l = host.shining[0];
      const double hx = l.toLight[0], hz = l.toLight[2] + 1.0, cosine = hz / std::hypot(hx, hz);
      const double wanted = std::pow(cosine, 128.0 * shininess);
      EXPECT_NEAR(shade(host, hits).light().r, wanted, 1e-5 * std::max(wanted, 1e-3))
          << shininess << ' ' << angle;
    }
}

TEST(Vrml97Surface, NoHighlightOnTheDarkSide) {
  ParamBlock p(surface());
  p.set("specularColor", {1, 1, 1});
  for (const float shininess : {0.0f, 0.001f, 1.0f}) {
    p.set("shininess", {shininess});
    FakeHost host;
    host.shining = {lightAt(90.001f), lightAt(135), lightAt(180)};
    Hits hits({p.get()});
    expectRgb(shade(host, hits).light(), {0, 0, 0});
    EXPECT_EQ(host.shadowCalls, 0u);
  }
}

TEST(Vrml97Surface, ShininessZeroIsOneOnTheLitSide) {
  ParamBlock p(surface());
  p.set("diffuseColor", {0, 0, 0});
  p.set("specularColor", {1, 1, 1});
  p.set("shininess", {0.0f});
  FakeHost host;
  host.shining = {lightAt(89)};
  Hits hits({p.get()});
  // Seen from such a flat angle on the other side that N.H is below 0: 0 to the power of 0 is still
  // 1.
  hits.direction[0][0] = 0.999f;
  hits.direction[2][0] = 0.04f;
  expectRgb(shade(host, hits).light(), {1, 1, 1});
}

// Rows of tables 4.5 and 4.6 of the standard: the resulting diffuse (or unlit) colour and A.
struct Row {
  int components;
  bool coloured, lit;
  Rgb wanted;
  float alpha;
};

TEST(Vrml97Surface, EveryRowOfTheTextureTables) { // V9
  const Rgb red{1, 0, 0}, rgb{0.5f, 0.25f, 1};
  const float transparency = 0.25f, opaque = 1 - transparency, texelAlpha = 0.75f;
  const Row rows[] = {
      {0, false, true, {.8f, .8f, .8f}, opaque},
      {0, true, true, red, opaque},
      {1, false, true, {.4f, .4f, .4f}, opaque},
      {1, true, true, {.5f, 0, 0}, opaque},
      {2, false, true, {.4f, .4f, .4f}, texelAlpha},
      {2, true, true, {.5f, 0, 0}, texelAlpha},
      {3, false, true, rgb, opaque},
      {3, true, true, rgb, opaque},
      {4, false, true, rgb, texelAlpha},
      {4, true, true, rgb, texelAlpha},
      {0, false, false, {1, 1, 1}, 1},
      {0, true, false, red, 1},
      {1, false, false, {.5f, .5f, .5f}, 1},
      {1, true, false, {.5f, 0, 0}, 1},
      {2, false, false, {.5f, .5f, .5f}, texelAlpha},
      {2, true, false, {.5f, 0, 0}, texelAlpha},
      {3, false, false, rgb, 1},
      {3, true, false, rgb, 1},
      {4, false, false, rgb, texelAlpha},
      {4, true, false, rgb, texelAlpha},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(testing::Message() << row.components << " components, coloured " << row.coloured
                                    << ", lit " << row.lit);
    ParamBlock p(surface());
    // Transparency is the material's; without one nothing is lit.
    p.set("transparency", {row.lit ? transparency : 0});
    p.setInt("lit", row.lit ? 1 : 0);
    FakeHost host;
    if (row.components <= 2)
      host.textures = {
          {uint32_t(row.components), {.5f, .5f, .5f, row.components == 2 ? texelAlpha : 1}}};
    else
      host.textures = {
          {uint32_t(row.components), {rgb.r, rgb.g, rgb.b, row.components == 4 ? texelAlpha : 1}}};
    if (row.components) p.setInt("texture", 1);
    host.shining = {lightAt(0)};
    Hits hits({p.get()});
    if (row.coloured) hits.paint(0, red);
    Answer a = shade(host, hits);
    const float A = row.alpha;
    expectRgb(a.light(), {row.wanted.r * A, row.wanted.g * A, row.wanted.b * A});
    expectRgb(a.through(), {1 - A, 1 - A, 1 - A});
    expectRgb(a.colour(), row.wanted);
    expectRgb(transmit(host, hits), {1 - A, 1 - A, 1 - A});
    const bool transparent = A < 1;
    const unsigned unlit = RTS_UNLIT | RTS_EMISSIVE | RTS_NO_SCATTER;
    EXPECT_EQ(surface().traits(&host, p.get()),
              (transparent ? unsigned(RTS_TRANSPARENT) : 0u) | (row.lit ? 0u : unlit));
  }
}

// The alpha of a texture and the colours of vertices change what a surface emits.
TEST(Vrml97Surface, TraitsOfEmission) {
  FakeHost host;
  host.textures = {{3, {.5f, .5f, .5f, 1}}};
  ParamBlock p(surface());
  EXPECT_EQ(surface().traits(&host, p.get()) & (RTS_EMISSIVE | RTS_UNIFORM_EMISSION), 0u);
  p.set("emissiveColor", {.1f, 0, 0});
  EXPECT_EQ(surface().traits(&host, p.get()) & (RTS_EMISSIVE | RTS_UNIFORM_EMISSION),
            unsigned(RTS_EMISSIVE | RTS_UNIFORM_EMISSION));
  p.setInt("texture", 1);
  EXPECT_EQ(surface().traits(&host, p.get()) & (RTS_EMISSIVE | RTS_UNIFORM_EMISSION),
            unsigned(RTS_EMISSIVE));
  p.setInt("texture", 0);
  p.setInt("lit", 0);
  EXPECT_EQ(surface().traits(&host, p.get()) & (RTS_EMISSIVE | RTS_UNIFORM_EMISSION),
            unsigned(RTS_EMISSIVE));
}

TEST(Vrml97Surface, LinesShowTheirColourInAnyLight) {
  ParamBlock p(surface()), bare(surface());
  p.set("emissiveColor", {.1f, .2f, .3f});
  p.set("specularColor", {1, 1, 1});
  p.setInt("texture", 1);
  bare.setInt("lit", 0);
  FakeHost host;
  host.textures = {{4, {.5f, .5f, .5f, .5f}}};
  host.shining = {lightAt(0)};
  Hits hits({p.get(), p.get(), bare.get()});
  for (int i = 0; i < 3; i++) hits.flags[size_t(i)] = RTS_HIT_LINE;
  hits.paint(1, {1, 0, 0});
  Answer a = shade(host, hits);
  expectRgb(a.light(0), {.1f, .2f, .3f});
  expectRgb(a.light(1), {1, 0, 0});
  expectRgb(a.light(2), {1, 1, 1});
  expectRgb(a.through(0), {0, 0, 0});
  EXPECT_EQ(host.shadowCalls, 0u);
}

TEST(Vrml97Surface, EmissionAndTransparency) { // V10: alpha .7 over what lies behind
  ParamBlock p(surface());
  p.set("transparency", {.3f});
  p.set("emissiveColor", {2, 1, 0});
  FakeHost host;
  host.shining = {lightAt(0)};
  Hits hits({p.get()});
  Answer a = shade(host, hits);
  expectRgb(a.light(), {.7f * 2.8f, .7f * 1.8f, .7f * .8f});
  expectRgb(a.through(), {.3f, .3f, .3f});
}

TEST(Vrml97Surface, TwoHundredLightsAddUp) { // V12
  const ParamBlock p(surface());
  FakeHost host;
  double wanted = 0;
  for (int i = 0; i < 200; i++) {
    host.shining.push_back(lightAt(0.4f * float(i)));
    wanted += 0.8 * host.shining.back().toLight[2];
  }
  Hits hits({p.get()});
  EXPECT_NEAR(shade(host, hits).light().r, wanted, 1e-5 * wanted);
}

TEST(Vrml97Surface, ShadowRaysOnlyWhereTheyMatter) {
  ParamBlock lit(surface()), black(surface()), unlit(surface());
  black.set("diffuseColor", {0, 0, 0});
  unlit.setInt("lit", 0);
  FakeHost host;
  host.shining = {lightAt(10)};
  host.shining[0].visible = 0.5f;
  Hits hits({lit.get(), black.get(), unlit.get(), lit.get()});
  hits.normal[2][3] = -1; // facing away from the light
  Answer a = shade(host, hits);
  EXPECT_EQ(host.shadowLanes, 1u);
  EXPECT_NEAR(a.light(0).r, 0.4 * std::cos(10 * degree), 1e-6);
  expectRgb(a.light(1), {0, 0, 0});
  expectRgb(a.light(2), {1, 1, 1});
  FakeHost dark;
  dark.shining = {{{0, 0, 1}, {0, 0, 0}}};
  shade(dark, hits);
  EXPECT_EQ(dark.shadowCalls, 0u);
}

TEST(Vrml97Surface, TextureCoordinatesAreTransformed) {
  ParamBlock p(surface());
  p.setInt("lit", 0);
  p.setInt("texture", 1);
  p.set("textureTransform",
        {0, 2, 0, 0, 3, 0, 0, 0, 0, 0, 1, 0, .5f, .25f, 0, 1}); // s' = 3 t + .5, t' = 2 s + .25
  FakeHost host;
  host.textures = {{3, {0, 0, 0, 1}}};
  Hits hits({p.get()});
  hits.uv[0][0] = 0.125f;
  hits.uv[1][0] = 0.0625f;
  EXPECT_NEAR(shade(host, hits).light().r, 10 * (3 * 0.0625 + .5) + 100 * (2 * 0.125 + .25), 1e-3);
}

TEST(Vrml97Surface, MixedBatchesOfManyTextures) {
  constexpr uint32_t n = 203;
  FakeHost host;
  std::deque<ParamBlock> blocks;
  std::vector<const void*> params;
  for (uint32_t k = 0; k < 7; k++)
    host.textures.push_back({1 + k % 4, {.1f * float(k), .2f, .3f, .5f}});
  for (uint32_t i = 0; i < n; i++) {
    blocks.emplace_back(surface());
    blocks.back().setInt("lit", 0);
    blocks.back().setInt("texture", int(i * 5 % 8)); // 0 .. 7
    params.push_back(blocks.back().get());
  }
  Hits hits(params);
  for (uint32_t i = 0; i < n; i++) hits.uv[0][i] = float(i) * 0.1f;
  Answer a = shade(host, hits);
  EXPECT_LE(host.sampleCalls, 7u);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t k = i * 5 % 8;
    const uint32_t components = k == 0 ? 0 : host.textures[k - 1].components;
    const float alpha = components == 2 || components == 4 ? .5f : 1;
    const float wanted = (k == 0 ? 1 : .1f * float(k - 1) + float(i)) * alpha;
    EXPECT_NEAR(a.light(i).r, wanted, 1e-5f * wanted + 1e-6f) << i;
    EXPECT_FLOAT_EQ(a.through(i).b, 1 - alpha) << i;
  }
}

TEST(Vrml97Surface, NumbersOutOfHandStayFinite) {
  ParamBlock p(surface());
  p.set("specularColor", {1, 1, 1});
  p.set("shininess", {1});
  FakeHost host;
  host.shining = {{{NAN, NAN, NAN}}, {{0, 0, 0}}, {{0, 0, -1}}, lightAt(0)};
  Hits hits({p.get()});
  EXPECT_TRUE(std::isfinite(shade(host, hits).light().r));
}

} // namespace
} // namespace openrt::test
