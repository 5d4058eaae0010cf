// shader_helper.cpp: openrts.hpp: the tables that it builds from small classes, and the data that
// its loops pass to them and back. Also the plug-in Debug, which is written with it.
#include "openrt/openrts.hpp"

#include <gtest/gtest.h>

#include "abi/fake_host.h"
#include "shading/plugin_check.h"
#include "shading/registry.h"

namespace helper {

struct Lambert : rts::Surface<Lambert> {
  static constexpr const char* text = "even scattering";
  rts::Param<int32_t> steps{"steps", 3, "a whole number", 1, 9};
  rts::Param<rts::Color> color{"color", {.5f, .25f, 1}, "colour"};
  rts::Param<rts::Texture> picture{"picture", "picture"};
  rts::Param<rts::Matrix> place{"place", {}, "matrix"};
  rts::Param<rts::Floats> list{"list", "list"};
  rts::Param<rts::String> note{"note", "text"};

  rts::Shaded shade(const rts::Hit& hit) const {
    const rts::Vec4 texel = hit.sample(picture, hit.uv);
    return {{texel.x, hit.distance, hit.position.y}, {.5f, .5f, .5f}, color};
  }
  rts::Color reflect(const rts::Hit& hit, const rts::Light& light) const {
    const float cosine = rts::dot(hit.normal, light.toLight);
    return cosine > 0 ? cosine * (*color * light.color) + light.ambient : rts::Color{};
  }
  rts::Color transmit(const rts::Hit& hit) const {
    return {hit.uv.x, hit.color.y, hit.back() ? 1.0f : 0.0f};
  }
};

struct Flat : rts::Surface<Flat> {
  rts::Shaded shade(const rts::Hit&) const { return {{1, 2, 3}, {}, {}}; }
};

struct Sun : rts::LightSource<Sun> {
  static constexpr bool directional = true, shadows = false;
  rts::Param<rts::Vec3> to{"to", {0, 1, 0}, "towards the sun"};
  rts::Illumination illuminate(rts::Vec3 point) const {
    return {to, {point.x, point.y, point.z}, {1, 1, 1}};
  }
};

struct Lamp : rts::LightSource<Lamp> {
  rts::Illumination illuminate(rts::Vec3 point) const { return {-point, {1, 1, 1}, {}}; }
};

struct Pixel : rts::Camera<Pixel> {
  rts::Ray generate(rts::Vec2 pixel, rts::Vec2 size) const {
    return {{pixel.x / size.x, pixel.y / size.y, 0}, rts::normalize({0, 0, -2})};
  }
};

struct Haze : rts::Environment<Haze> {
  rts::Vec4 miss(rts::Vec3 d) const { return {d.x, d.y, d.z, .5f}; }
  rts::Fog attenuate(rts::Vec3 v) const { return {{.1f, .2f, .3f}, 1 / (1 + rts::length(v))}; }
};

} // namespace helper

RTS_PLUGIN(helper::Lambert, helper::Flat, helper::Sun, helper::Lamp, helper::Pixel, helper::Haze)

namespace openrt::test {
namespace {

const RtsClass& helperClass(const char* name) {
  static const std::vector<RtsClass> classes = checkPlugin(&rtsPlugin, sizeof(RtsPlugin), "test");
  for (const RtsClass& c : classes)
    if (std::string(name) == c.name) return c;
  throw std::runtime_error(name);
}

TEST(ShaderHelper, ClassesBearTheirNamesAndPassTheCheckOfPlugins) {
  EXPECT_EQ(rtsPlugin.classCount, 6u);
  EXPECT_EQ(helperClass("Lambert").kind, RTS_SURFACE);
  EXPECT_STREQ(helperClass("Lambert").text, "even scattering");
  EXPECT_EQ(helperClass("Sun").kind, RTS_LIGHT);
  EXPECT_EQ(helperClass("Pixel").kind, RTS_CAMERA);
  EXPECT_EQ(helperClass("Haze").kind, RTS_ENVIRONMENT);
  EXPECT_EQ(helperClass("Flat").transmit, nullptr);
  EXPECT_NE(helperClass("Lambert").transmit, nullptr);
}

TEST(ShaderHelper, ParametersAreDeclaredInTheirOrder) {
  const RtsClass& c = helperClass("Lambert");
  ASSERT_EQ(c.paramCount, 6u);
  EXPECT_EQ(c.paramSize, sizeof(helper::Lambert));
  EXPECT_STREQ(c.params[0].name, "steps");
  EXPECT_EQ(c.params[0].type, RTS_INT);
  EXPECT_EQ(c.params[0].defaultValue[0], 3);
  EXPECT_EQ(c.params[0].maximum, 9);
  EXPECT_EQ(c.params[1].type, RTS_COLOR);
  EXPECT_EQ(c.params[1].defaultValue[1], .25f);
  EXPECT_EQ(c.params[2].type, RTS_TEXTURE);
  EXPECT_EQ(c.params[3].defaultValue[15], 1);
  EXPECT_EQ(c.params[4].type, RTS_FLOATS);
  EXPECT_EQ(c.params[5].type, RTS_STRING);
}

TEST(ShaderHelper, TraitsFollowFromTheFunctions) {
  FakeHost host;
  EXPECT_EQ(helperClass("Lambert").traits(&host, nullptr), unsigned(RTS_TRANSPARENT));
  EXPECT_EQ(helperClass("Flat").traits(&host, nullptr), unsigned(RTS_UNLIT));
  EXPECT_EQ(helperClass("Sun").traits(&host, nullptr), unsigned(RTS_NO_SHADOW));
  EXPECT_EQ(helperClass("Lamp").traits(&host, nullptr), 0u);
}

// Hits in which every array holds a different number.
struct NumberedHits {
  explicit NumberedHits(uint32_t n, const void* params)
      : flags(n + RTS_LANES, 0), pointers(n + RTS_LANES, params) {
    for (size_t k = 0; k < 19; k++) {
      lanes[k] = Lanes(n);
      for (uint32_t i = 0; i < n; i++) lanes[k][i] = float(k) + float(i) * 0.01f;
    }
    for (size_t c = 0; c < 3; c++) {
      hits.position[c] = lanes[c].data();
      hits.direction[c] = lanes[3 + c].data();
      hits.geometric[c] = lanes[6 + c].data();
      hits.normal[c] = lanes[9 + c].data();
    }
    for (size_t c = 0; c < 2; c++) hits.uv[c] = lanes[12 + c].data();
    for (size_t c = 0; c < 4; c++) hits.color[c] = lanes[14 + c].data();
    hits.distance = hits.segment = lanes[18].data();
    hits.count = n;
    hits.flags = flags.data();
    hits.params = pointers.data();
  }
  Lanes lanes[19];
  std::vector<uint32_t> flags;
  std::vector<const void*> pointers;
  RtsHits hits{};
};

TEST(ShaderHelper, EveryHitIsShadedAndLit) {
  constexpr uint32_t n = 21;
  const RtsClass& c = helperClass("Lambert");
  ParamBlock p(c);
  FakeHost host;
  host.shining = {{{0, 0, 1}, {2, 2, 2}, {1, 1, 1}, .5f}};
  NumberedHits in(n, p.get());
  Lanes out[9];
  RtsShading shading{};
  for (size_t k = 0; k < 3; k++) {
    for (size_t g = 0; g < 3; g++) out[3 * g + k] = Lanes(n);
    shading.radiance[k] = out[k].data();
    shading.transmission[k] = out[3 + k].data();
    shading.albedo[k] = out[6 + k].data();
  }
  c.shade(&host, host.batch(), &in.hits, &shading);
  for (uint32_t i = 0; i < n; i++) {
    const float normalZ = in.lanes[11][i];
    EXPECT_FLOAT_EQ(out[0][i], 1 + normalZ * .5f * 1 + 1)
        << i; // white texel + colour x light x visibility + ambient
    EXPECT_FLOAT_EQ(out[1][i], in.lanes[18][i] + normalZ * .25f + 1);
    EXPECT_FLOAT_EQ(out[2][i], in.lanes[1][i] + normalZ * 1 + 1);
    EXPECT_FLOAT_EQ(out[4][i], .5f);
    EXPECT_FLOAT_EQ(out[7][i], .25f);
  }
  EXPECT_EQ(host.shadowLanes, n);
}

TEST(ShaderHelper, ShadowRaysReadOnlyWhatTheyAreGiven) {
  const RtsClass& c = helperClass("Lambert");
  ParamBlock p(c);
  NumberedHits in(2, p.get());
  in.flags[1] = RTS_HIT_BACK;
  for (size_t k = 0; k < 3; k++) in.hits.geometric[k] = in.hits.normal[k] = nullptr;
  in.hits.distance = nullptr;
  Lanes out[3] = {Lanes(2), Lanes(2), Lanes(2)};
  float* transmission[3] = {out[0].data(), out[1].data(), out[2].data()};
  FakeHost host;
  c.transmit(&host, host.batch(), &in.hits, transmission);
  EXPECT_FLOAT_EQ(out[0][1], 12.01f);
  EXPECT_FLOAT_EQ(out[1][1], 15.01f);
  EXPECT_EQ(out[2][0], 0);
  EXPECT_EQ(out[2][1], 1);
}

TEST(ShaderHelper, LightsCamerasAndEnvironments) {
  FakeHost host;
  Lanes x({1, 2, 3}), y({4, 5, 6}), z({7, 8, 9}), out[9];
  for (Lanes& o : out) o = Lanes(3);
  const float* in[3] = {x.data(), y.data(), z.data()};
  RtsIllumination light{};
  for (size_t c = 0; c < 3; c++) {
    light.toLight[c] = out[c].data();
    light.color[c] = out[3 + c].data();
    light.ambient[c] = out[6 + c].data();
  }
  const ParamBlock sun(helperClass("Sun"));
  helperClass("Sun").illuminate(&host, host.batch(), sun.get(), 3, in, &light);
  EXPECT_EQ(light.directional, 1);
  EXPECT_EQ(out[1][2], 1);
  EXPECT_EQ(out[5][1], 8);
  const ParamBlock lamp(helperClass("Lamp")), pixel(helperClass("Pixel")),
      haze(helperClass("Haze"));
  helperClass("Lamp").illuminate(&host, host.batch(), lamp.get(), 3, in, &light);
  EXPECT_EQ(light.directional, 0);
  EXPECT_EQ(out[2][2], -9);

  RtsRays rays{};
  for (size_t c = 0; c < 3; c++) {
    rays.origin[c] = out[c].data();
    rays.direction[c] = out[3 + c].data();
  }
  const float size[2] = {2, 4};
  helperClass("Pixel").generate(&host, host.batch(), pixel.get(), 3, in, size, &rays);
  EXPECT_EQ(out[0][2], 1.5f);
  EXPECT_EQ(out[1][0], 1);
  EXPECT_EQ(out[5][1], -1);

  float* rgba[4] = {out[0].data(), out[1].data(), out[2].data(), out[3].data()};
  helperClass("Haze").miss(&host, host.batch(), haze.get(), 3, in, rgba);
  EXPECT_EQ(out[2][1], 8);
  EXPECT_EQ(out[3][1], .5f);
  helperClass("Haze").attenuate(&host, host.batch(), haze.get(), 3, in, rgba, out[3].data());
  EXPECT_EQ(out[1][2], .2f);
  EXPECT_FLOAT_EQ(out[3][0], 1 / (1 + std::sqrt(66.0f)));
}

TEST(DebugShader, ShowsNormalsCoordinatesAndSides) {
  const ShaderRegistry registry(shaderFolders(""));
  const RtsClass& c = registry.find("Debug", "debug");
  for (const auto& [show, r, g, b] : {std::tuple{0, 5.0f, 5.5f, 6.0f},
                                      {1, 3.5f, 4.0f, 4.5f},
                                      {2, .01f, .01f, .0f},
                                      {3, 1.0f, .0f, .0f}}) {
    ParamBlock p(c);
    p.setInt("show", show);
    NumberedHits in(2, p.get());
    in.flags[1] = RTS_HIT_BACK;
    Lanes out[3] = {Lanes(2), Lanes(2), Lanes(2)}, clear[3] = {Lanes(2), Lanes(2), Lanes(2)};
    RtsShading shading{};
    for (size_t k = 0; k < 3; k++) {
      shading.radiance[k] = out[k].data();
      shading.transmission[k] = clear[k].data();
    }
    FakeHost host;
    c.shade(&host, host.batch(), &in.hits, &shading);
    const float half = show < 2 ? .005f : 0; // lane 1 of the normals adds half of .01
    EXPECT_NEAR(out[0][1], r + half, 1e-5) << show;
    EXPECT_NEAR(out[1][1], g + half, 1e-5) << show;
    EXPECT_NEAR(out[2][1], b + half, 1e-5) << show;
  }
}

} // namespace
} // namespace openrt::test
