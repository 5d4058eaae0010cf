// straight_passages.cpp: what lets light pass straight on is no bounce, and light samples pass it:
// clear sheets, alpha of textures, boundaries without effect (docs/decisions/0077). Against closed
// forms; uses the C API.
#include <string>

#include "numeric/sensor_scene.h"

namespace numeric {
namespace {

class StraightPassages : public Sensors {
 protected:
  void SetUp() override {
    Sensors::SetUp();
    rtQuality(RT_MAX_DEPTH, 1);
  }
  static constexpr RTenum all[] = {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH,
                                   RT_TRANSPORT_LIGHT};
  static constexpr const char* classes[] = {"VRML97", "GlobalIllumination", "Physical"};
  // A sheet that passes a part of the light and is black otherwise.
  static Shader sheet(double passes, const char* name = "VRML97") {
    Shader s(name);
    s.set("transparency", {passes});
    const std::string is = name;
    if (is == "Physical") s.setInt("alphaMode", 2).set("baseColor", {0, 0, 0});
    if (is == "VRML97" || is == "GlobalIllumination") s.set("diffuseColor", {0, 0, 0});
    return s;
  }
  static void sheets(int count, const Shader& shader, double from, double step) {
    const RTid object = square(shader, 100);
    for (int i = 0; i < count; i++) placeAt(from + i * step, object);
  }
  static void glowing(double radiance) { place(square(matt(0, radiance))); }
};

TEST_F(StraightPassages, AHundredClearSheetsHideNothing) {
  glowing(2);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  for (const char* name : classes) {
    const RTid object = square(sheet(1, name), 100);
    std::vector<RTid> placed;
    for (int i = 0; i < 100; i++) placed.push_back(placeAt(1 + .1 * i, object));
    for (const RTenum transport : all) {
      rtQuality(RT_TRANSPORT, int(transport));
      expectGrey(look(), 2);
      EXPECT_EQ(stats().leftOut.cutByDepth, 0) << name;
    }
    for (const RTid instance : placed) rtDeleteInstance(instance);
  }
}

TEST_F(StraightPassages, SheetsThatPassAPartDimByTheirPower) {
  glowing(2);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  sheets(60, sheet(.95), 1, .1);
  for (const RTenum transport : {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED}) {
    rtQuality(RT_TRANSPORT, int(transport));
    expectGrey(look(), 2 * std::pow(.95, 60), 1e-4);
  }
}

TEST_F(StraightPassages, WhatIsBehindMoreSheetsThanTheLimitIsInTheLedger) {
  glowing(2);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  sheets(600, sheet(1), 1, .01);
  for (const RTenum transport : all) {
    rtQuality(RT_TRANSPORT, int(transport));
    expectGrey(look(), 0);
    expectClose(stats().leftOut.cutByDepth, 3);
  }
}

TEST_F(StraightPassages, ShadowRaysPassAsManySheets) {
  place(square(Shader("VRML97").set("diffuseColor", {1, 1, 1}), 100));
  use(directional({0, 0, -1}));
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  const double lit = double(look(0, 0, .5).g);
  EXPECT_GT(lit, .1);
  sheets(100, sheet(1), 1, .01);
  for (const RTenum transport : all) {
    rtQuality(RT_TRANSPORT, int(transport));
    expectGrey(look(0, 0, .5), lit);
    EXPECT_EQ(stats().leftOut.cutByDepth, 0);
  }
}

TEST_F(StraightPassages, WhatIsCutFromAShadowRayIsInTheLedger) {
  place(square(Shader("VRML97").set("diffuseColor", {1, 1, 1}), 100));
  use(directional({0, 0, -1}));
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  sheets(600, sheet(1), 1, .01);
  for (const RTenum transport : all) {
    rtQuality(RT_TRANSPORT, int(transport));
    expectGrey(look(0, 0, .5), 0);
    // The rays that the floor scatters meet the sheets, too.
    expectClose(stats().leftOut.cutByDepth, transport < RT_TRANSPORT_PATH ? 3 : 6);
  }
}

TEST_F(StraightPassages, ALampOfAShapeShinesThroughASheetOfAnyClass) {
  floor();
  lamp(rectangle(.5, 1));
  const double bare = polygon(rectangle(.5, 1));
  for (const char* name : classes) {
    rtPushMatrix();
    rtTranslated(0, 0, .5);
    const RTid placed = place(square(sheet(.5, name), 100));
    rtPopMatrix();
    for (const RTenum transport : {RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
      rtQuality(RT_TRANSPORT, int(transport));
      expectQ(name, lit(), .5 * bare, 2e-3);
    }
    rtDeleteInstance(placed);
  }
}

// An even sky is not sampled: BSDF samples alone tell what the lacquer passes.
TEST_F(StraightPassages, ALampShinesThroughLacquerAsASkyDoes) {
  floor();
  placeAt(.5, square(sheet(.5, "Plastic").set("color", {.2, .4, .6}), 1000));
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {1, 1, 1});
  rtUseEnvironment(sky);
  const double passes = lit();
  rtUseEnvironment(0);
  lamp(rectangle(.5, 1));
  EXPECT_GT(passes, .1);
  EXPECT_LT(passes, .9);
  expectQ("lacquer", lit(), passes * polygon(rectangle(.5, 1)), 5e-3);
}

TEST_F(StraightPassages, ATinyLampBehindSheetsIsSampled) {
  constexpr double r = .02, height = 2, radiance = 1e3;
  placeAt({0, 0, height}, [] {
    const RTid object = rtBeginObject(0);
    rtBindShader(matt(0, radiance));
    rtSphere(float(r));
    rtEndObject();
    rtBindShader(0);
    return object;
  }());
  const double bare = pi * radiance * r * r / (height * height);
  for (const char* name : classes) {
    const RTid object = square(sheet(.9, name), 100);
    std::vector<RTid> placed;
    for (int i = 0; i < 40; i++) placed.push_back(placeAt(1 + .01 * i, object));
    const Reading got = read({}, up);
    // One BSDF sample in ten thousand hits the lamp: its share may be missing.
    EXPECT_NEAR(got.value, bare * std::pow(.9, 40), 5e-4 * got.value);
    EXPECT_TRUE(got.trusted) << name;
    for (const RTid instance : placed) rtDeleteInstance(instance);
  }
}

// Two thirds of the light come by light samples and by BSDF samples alike: counted twice, or with
// weights that do not belong together, the reading would differ.
TEST_F(StraightPassages, ALargeNearLampBehindASheetCountsOnce) {
  floor();
  lamp(rectangle(2, .5));
  placeAt(.25, square(sheet(.25), 100));
  rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
  expectQ("near", lit(), .25 * polygon(rectangle(2, .5)), 1e-3);
}

TEST_F(StraightPassages, ASkyWithASunShinesThroughASheet) {
  floor();
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {500, 500, 500, 500, 500, 500, .1f, .1f, .1f, .1f, .1f, .1f})
      .setList("skyAngle", {.1f, .11f, 3});
  rtPushMatrix();
  rtRotated(90, 1, 0, 0); // the zenith is above the floor
  rtUseEnvironment(sky);
  rtPopMatrix();
  const double bare = lit();
  placeAt(.5, square(sheet(.5), 2000));
  const double half = lit();
  EXPECT_NEAR(half, .5 * bare, .01 * bare);
}

TEST_F(StraightPassages, TheHolesOfATextureLetALampShineIn) {
  floor();
  lamp(rectangle(.5, 1));
  const Shader hole = Shader("VRML97").setTexture("texture", texture(4, {1, 1, 1, 0}));
  placeAt(.5, square(hole, 100));
  expectQ("hole", lit(), polygon(rectangle(.5, 1)), 2e-3);
}

TEST_F(StraightPassages, AClearSheetBesideGlassPassesAndGlassBends) {
  floor();
  lamp(rectangle(.5, 1));
  placeAt(.5, square(sheet(.5), 100));
  placeAt({50, 0, .25}, square(Shader("Glass"), 1)); // only its medium matters
  expectQ("glass", lit(), .5 * polygon(rectangle(.5, 1)), 2e-3);
}

TEST_F(StraightPassages, BodiesOfFogThatScatterNothingTakeNoLight) {
  place(square(Shader("Diffuse").set("reflectance", {.7, .7, .7}), 100));
  use(point({0, 0, 4}, {0, 0, 1}));
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  rtQuality(RT_MAX_DEPTH, 3);
  const double bare = double(look(0, 0, .1).g);
  Shader thin("Fog");
  thin.set("scattering", {1e-7, 1e-7, 1e-7});
  for (int i = 0; i < 30; i++)
    for (const bool down : {false, true})
      placeAt(.5 + .1 * i + (down ? 0 : .02), square(thin, 200), down);
  expectGrey(look(0, 0, .1), bare, 1e-4);
}

TEST_F(StraightPassages, SensorsSeeThroughManySheets) {
  placeAt(3, square(matt(0, 5), 1000), true);
  sheets(200, sheet(1), 1, .005);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  const Reading got = read({}, up);
  EXPECT_NEAR(got.value, 5 * pi, .01 * 5 * pi);
  EXPECT_TRUE(got.trusted);
}

TEST_F(StraightPassages, ChannelsWithFollowedImagesLookThroughManySheets) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtQuality(RT_FOLLOW_IMAGES, 1);
  rtLoadName(7);
  glowing(1);
  rtLoadName(0);
  sheets(100, sheet(1), 1, .1);
  for (const RTenum transport : {RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, int(transport));
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, 20);
    rtOrtho(1e-6);
    rtPopMatrix();
    render(RT_RGBA | RT_DEPTH);
    float depth = 0;
    rtReadPixels(RT_DEPTH, &depth, 1);
    EXPECT_NEAR(depth, 20, 1e-3); // every sheet takes a step off its surface away
  }
}

// An even sky and nothing else: every path finds the same light, so the reading is exact.
TEST_F(StraightPassages, AnEvenSkyOverASensorIsTrusted) {
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {.5f, .5f, .5f});
  rtUseEnvironment(sky);
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  const Reading got = read({}, up);
  EXPECT_NEAR(got.value, .5 * pi, 1e-5);
  EXPECT_TRUE(got.trusted);
}

// A slab of index n between surfaces of two shaders: a point behind it appears nearer by (1 - 1/n)
// of the thickness. Equal parameters make one body.
// All paths find the same light behind the sheet, though each takes a random decision there.
TEST_F(StraightPassages, AnEvenSkyBehindASheetOverASensorIsTrusted) {
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {.5f, .5f, .5f});
  rtUseEnvironment(sky);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  placeAt(1, square(sheet(.5), 1e6));
  const Reading behind = read({0, 0, 0}, up);
  EXPECT_TRUE(behind.trusted);
  EXPECT_NEAR(behind.value, .25 * pi, 1e-4);
  EXPECT_GT(behind.halfWidth, 0); // a small thing may be hidden
  EXPECT_LT(behind.halfWidth, .001 * behind.value);
}

// The lamp's light is equal in all samples. But what grey things send back was found by none.
TEST_F(StraightPassages, EqualLightOfALampDoesNotTellThatNoneIsMissing) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_MAX_DEPTH, 4);
  Shader lampShader = bulb({0, 0, 3}, 4 * pi);
  use(lampShader);
  placeAt(5, square(matt(.5), 1e-3)); // no path meets it
  const Reading lit = read({0, 0, 0}, up);
  EXPECT_GT(lit.value, 0);
  EXPECT_FALSE(lit.trusted);
}

TEST_F(StraightPassages, SurfacesWithEqualGlassBoundOneBody) {
  Shader lampShader = bulb({0, 0, 4}, 400 * pi);
  use(lampShader);
  placeAt(2.3, square(Shader("Glass").set("index", {1.5}), 10));
  placeAt(2, square(Shader("Glass").set("index", {1.5}), 10), true);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  rtQuality(RT_MAX_DEPTH, 25);
  rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
  const Vec across{.1, 0, 0}, down{0, -.1, 0};
  const double reading = readGrid({{}, across, down, 1, 1})[0].value,
               apparent = 4 - .3 * (1 - 1 / 1.5), passed = .96 / 1.04;
  EXPECT_NEAR(reading, 100 * passed / (apparent * apparent), .01 * reading);
}

} // namespace
} // namespace numeric
