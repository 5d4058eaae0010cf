// picture.cpp: positions in a picture: orientation, the channels besides colour, the background
// around the eye.
#include <limits>

#include "numeric/support.h"

namespace numeric {
namespace {

class Picture : public Scene {
 protected:
  static constexpr int width = 4, height = 2;
  static RTid glow(Vec c) {
    return Shader("VRML97").set("diffuseColor", {0, 0, 0}).set("emissiveColor", {c.x, c.y, c.z});
  }
  static void placeAt(RTid object, double x, double y, double z) {
    rtPushMatrix();
    rtTranslated(x, y, z);
    place(object);
    rtPopMatrix();
  }
  static std::vector<float> shoot(RTenum channel, int components) {
    rtFrameBuffer(width, height, RT_RGBA | channel);
    rtRender();
    std::vector<float> values(size_t(width * height * components));
    rtReadPixels(channel, values.data(), values.size());
    return values;
  }
  static void eye(double x, double y, double z) {
    rtLoadIdentity();
    rtTranslated(x, y, z);
  }
};

TEST_F(Picture, FirstRowIsTheTopAndFirstColumnTheLeft) {
  placeAt(square(glow({1, 0, 0}), 1), -1, 1, 0);
  placeAt(square(glow({0, 1, 0}), 1), 1, 1, 0);
  placeAt(square(glow({0, 0, 1}), 1), -1, -1, 0);
  placeAt(square(glow({1, 1, 0}), 1), 1, -1, 0);
  const Vec quarter[2][2] = {{{1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 1, 0}}};
  for (const bool perspective : {false, true}) {
    eye(0, 0, 2);
    if (perspective)
      // The view is 1.6 high and 3.2 wide at the squares.
      rtPerspective(2 * std::atan(.4) * 180 / pi);
    else
      rtOrtho(1.6);
    const std::vector<float> p = shoot(RT_RGBA, 4);
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) {
        const float* pixel = &p[size_t(4 * (y * width + x))];
        expectColor({pixel[0], pixel[1], pixel[2], pixel[3]}, quarter[y][x / 2]);
      }
  }
}

TEST_F(Picture, DepthRunsAlongTheViewAxis) {
  place(square(glow({1, 1, 1}), 1));
  eye(0, 0, 3);
  // The view is 1.6 high at the square and 3.2 wide, so the outer columns miss it.
  rtPerspective(30);
  const std::vector<float> depth = shoot(RT_DEPTH, 1);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const float d = depth[size_t(y * width + x)];
      if (x == 1 || x == 2)
        expectClose(d, 3);
      else if (!std::isinf(d))
        expectClose(d, 3); // the pixel straddles the border
    }
  eye(5, 0, 3);
  rtPerspective(30);
  for (const float d : shoot(RT_DEPTH, 1)) EXPECT_TRUE(std::isinf(d));
}

TEST_F(Picture, PositionsLieOnTheSurfaceInTheWorld) {
  const double far = 5000;
  placeAt(square(glow({1, 1, 1}), 10), far, -far, 7);
  eye(far, -far, 9);
  rtPerspective(40);
  const std::vector<float> p = shoot(RT_POSITION, 3);
  for (size_t i = 0; i < p.size(); i += 3) {
    EXPECT_NEAR(p[i], far, 1.7);
    EXPECT_NEAR(p[i + 1], -far, .8);
    EXPECT_NEAR(p[i + 2], 7, 1e-5);
  }
  EXPECT_LT(p[0], p[9]);                     // left to right
  EXPECT_GT(p[1], p[size_t(3 * width) + 1]); // top to bottom
}

TEST_F(Picture, NamesAlbedoAndSamples) {
  const RTid object = rtBeginObject(0);
  rtLoadName(42);
  rtBindShader(Shader("VRML97").set("diffuseColor", {.25, .5, .75}));
  rtSphere(10);
  rtEndObject();
  rtBindShader(0);
  place(object);
  eye(0, 0, 30);
  rtPerspective(10);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4);
  for (const float name : shoot(RT_NAME, 1)) EXPECT_EQ(name, 42);
  for (const float samples : shoot(RT_SAMPLES, 1)) EXPECT_EQ(samples, 4);
  const std::vector<float> albedo = shoot(RT_ALBEDO, 3);
  for (size_t i = 0; i < albedo.size(); i++) expectClose(albedo[i], .25 + .25 * double(i % 3));
  for (const float v : shoot(RT_VARIANCE, 3)) EXPECT_EQ(v, 0); // black everywhere
}

TEST_F(Picture, SpheresAreExact) {
  const RTid object = rtBeginObject(0);
  rtSphere(2);
  rtEndObject();
  place(object);
  use(tilted(0));
  for (const double x : {0., .5, 1., 1.5, 1.9, 1.99})
    expectClose(look(x).r, .8 * std::sqrt(1 - x * x / 4), 1e-5, .05);
  EXPECT_EQ(look(2.0001).a, 0);
  EXPECT_EQ(look(1.4143, 1.4143).a, 0);
}

// Returns the background seen along the axis of a camera turned by a matrix.
class Background : public Scene {
 protected:
  static Rgba towards(Vec d) {
    rtPushMatrix();
    rtLoadIdentity();
    const bool steep = d.x == 0 && d.z == 0;
    rtLookAt(300, 400, 500, 300 + d.x, 400 + d.y, 500 + d.z, 0, steep ? 0 : 1, steep ? 1 : 0);
    rtPerspective(1e-4);
    rtPopMatrix();
    return render();
  }
  static Vec zenith(double angle) { return {std::sin(angle), std::cos(angle), 0}; }
};

TEST_F(Background, BandsAroundTheEyeWhereverItIs) {
  Shader air("VRML97Environment");
  air.setList("skyColor", {0, 0, 0, 1, 0, 0, 1, 1, 0}).setList("skyAngle", {.8f, 1.5f});
  air.setList("groundColor", {0, 0, 1, 0, 1, 1}).setList("groundAngle", {1});
  rtUseEnvironment(air);
  expectColor(towards(zenith(.4)), {.5, 0, 0});
  expectColor(towards(zenith(1.15)), {1, .5, 0});
  expectColor(towards(zenith(1.8)), {1, 1, 0});
  expectColor(towards(zenith(pi - .5)), {0, .5, 1});
  expectClose(towards(zenith(1)).a, 1);
}

TEST_F(Background, TurnsWithItsMatrixButDoesNotMove) {
  Shader air("VRML97Environment");
  air.setList("skyColor", {0, 0, 0, 1, 0, 0}).setList("skyAngle", {float(pi)});
  rtPushMatrix();
  rtTranslated(1000, 2000, 3000);
  rtRotated(90, 0, 0, 1); // its zenith now points to -x
  rtUseEnvironment(air);
  rtPopMatrix();
  expectColor(towards({-1, 0, 0}), {0, 0, 0});
  expectColor(towards({0, 1, 0}), {.5, 0, 0});
  expectColor(towards({1, 0, 0}), {1, 0, 0});
}

TEST_F(Background, EveryPictureWhereItBelongs) {
  const struct {
    const char* name;
    Vec direction, colour;
  } faces[] = {
      {"frontTexture", {0, 0, -1}, {1, 0, 0}}, {"backTexture", {0, 0, 1}, {0, 1, 0}},
      {"leftTexture", {-1, 0, 0}, {0, 0, 1}},  {"rightTexture", {1, 0, 0}, {1, 1, 0}},
      {"topTexture", {0, 1, 0}, {1, 0, 1}},    {"bottomTexture", {0, -1, 0}, {0, 1, 1}},
  };
  Shader air("VRML97Environment");
  air.setList("skyColor", {.5f, .5f, .5f});
  for (const auto& f : faces)
    air.setTexture(f.name, texture(3, {float(f.colour.x), float(f.colour.y), float(f.colour.z)}));
  rtUseEnvironment(air);
  for (const auto& f : faces) expectColor(towards(f.direction), f.colour);
  air.setTexture("frontTexture", texture(4, {1, 1, 1, .25f}));
  expectColor(towards({0, 0, -1}), {.625, .625, .625});
}

} // namespace
} // namespace numeric
