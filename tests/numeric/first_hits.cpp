// first_hits.cpp: RT_FOLLOW_IMAGES against closed forms: what is seen in mirrors and through smooth
// glass, how it moves, and that the light of a picture does not depend on it. Frames without light.
#include <cstring>

#include "drawing.h"
#include "numeric/support.h"

namespace numeric {
namespace {

constexpr uint32_t ofFirstSample = RT_DEPTH | RT_POSITION | RT_NAME | RT_MOTION;
constexpr uint32_t features = RT_DEPTH | RT_NORMAL | RT_ALBEDO | RT_POSITION | RT_NAME | RT_MOTION;

// Holds what the pixel in the middle says about its surface.
struct Surface {
  float depth, name;
  Vec normal, albedo, position, motion;
};

class FirstHits : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_FOLLOW_IMAGES, 1);
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
  }
  static Vec vector(RTenum channel) {
    float v[3];
    rtReadPixels(channel, v, 3);
    return {v[0], v[1], v[2]};
  }
  // Looks straight down -z through (x, y), from a height of 20.
  static Surface see(double x = .25, double y = .5) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(x, y, 20);
    rtOrtho(1e-6);
    rtPopMatrix();
    rtFrameBuffer(1, 1, features | RT_RGBA);
    rtRender();
    Surface s{};
    rtReadPixels(RT_DEPTH, &s.depth, 1);
    rtReadPixels(RT_NAME, &s.name, 1);
    s.normal = vector(RT_NORMAL);
    s.albedo = vector(RT_ALBEDO);
    s.position = vector(RT_POSITION);
    s.motion = vector(RT_MOTION);
    return s;
  }
  static void expectVector(const Vec& got, const Vec& expected, double tolerance = 1e-5) {
    EXPECT_NEAR(got.x, expected.x, tolerance);
    EXPECT_NEAR(got.y, expected.y, tolerance);
    EXPECT_NEAR(got.z, expected.z, tolerance);
  }
  // Defines a square that bears a name.
  static RTid namedSquare(uint32_t name, RTid shader, double half = 10) {
    rtLoadName(name);
    const RTid object = square(shader, half);
    rtLoadName(0);
    return object;
  }
  static RTid painted() { return Shader("Diffuse").set("reflectance", {.8, .4, .2}); }
  static RTid mirror(double reflectance = .5) {
    return Shader("Mirror").set("reflectance", {reflectance, reflectance, reflectance});
  }
  static void moveTo(RTid instance, double x, double y, double z, double turnX = 0,
                     double turnY = 0) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(x, y, z);
    rtRotated(turnX, 1, 0, 0);
    rtRotated(turnY, 0, 1, 0);
    double m[16];
    rtGetMatrixd(m);
    rtPopMatrix();
    rtInstanceMatrix(instance, m);
  }
};

TEST_F(FirstHits, DescribeTheImageInAMirror) {
  placeAt(0, namedSquare(1, mirror()));
  placeAt(30, namedSquare(2, painted()), true); // above the camera, facing down
  Surface s = see();
  EXPECT_NEAR(s.depth, 50, 1e-4);
  EXPECT_EQ(s.name, 2);
  expectVector(s.position, {.25, .5, -30});
  expectVector(s.normal, {0, 0, 1});
  expectVector(s.albedo, {.4, .2, .1});
  rtQuality(RT_FOLLOW_IMAGES, 0);
  s = see();
  EXPECT_NEAR(s.depth, 20, 1e-4);
  EXPECT_EQ(s.name, 1);
  expectVector(s.position, {.25, .5, 0});
  expectVector(s.albedo, {.5, .5, .5});
}

TEST_F(FirstHits, DescribeNoImageThatTheTransportDoesNotShow) {
  placeAt(0, namedSquare(1, mirror()));
  placeAt(30, namedSquare(2, painted()), true);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_DIRECT);
  EXPECT_EQ(see().name, 1);
  for (const int transport : {RT_TRANSPORT_AUTO, RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
    rtQuality(RT_TRANSPORT, transport);
    EXPECT_EQ(see().name, 2);
  }
}

TEST_F(FirstHits, DescribeNothingInAMirrorOfTheSky) {
  placeAt(0, namedSquare(1, mirror(.75)));
  const Surface s = see();
  EXPECT_TRUE(std::isinf(s.depth));
  EXPECT_EQ(s.name, 0);
  expectVector(s.normal, {0, 0, 0}, 0);
  expectVector(s.position, {0, 0, 0}, 0);
  expectVector(s.motion, {0, 0, 0}, 0);
  expectVector(s.albedo, {.75, .75, .75});
}

TEST_F(FirstHits, LookThroughGlass) {
  const RTid face = namedSquare(1, Shader("Glass"));
  placeAt(2, face);
  placeAt(1, face, true);
  placeAt(0, namedSquare(2, painted()));
  const Surface s = see();
  EXPECT_NEAR(s.depth, 20, 1e-4);
  EXPECT_EQ(s.name, 2);
  expectVector(s.position, {.25, .5, 0}, 1e-4); // rounding at a distance of 20
  expectVector(s.normal, {0, 0, 1});
  const double clear = .96 * .96; // transmittance of two faces of index 1.5
  expectVector(s.albedo, {.8 * clear, .4 * clear, .2 * clear});
}

TEST_F(FirstHits, LookThroughWhatIsTransparent) {
  const auto sheet = [](double transparency) {
    return Shader("VRML97").set("transparency", {transparency});
  };
  placeAt(1, namedSquare(1, sheet(.75)));
  placeAt(0, namedSquare(2, painted()));
  for (const int transport : {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, transport);
    const Surface s = see();
    EXPECT_EQ(s.name, 2);
    EXPECT_NEAR(s.depth, 20, 1e-4);
    expectVector(s.albedo, {.6, .3, .15});
  }
  placeAt(3, namedSquare(3, sheet(.25)));
  for (const int transport : {RT_TRANSPORT_DIRECT, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, transport);
    EXPECT_EQ(see().name, 3) << "most light comes from the sheet itself";
  }
}

TEST_F(FirstHits, StayAtSurfacesThatReflectLittle) {
  placeAt(0, namedSquare(1, Shader("Plastic")));
  placeAt(30, namedSquare(2, painted()), true);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  const Surface s = see();
  EXPECT_EQ(s.name, 1);
  EXPECT_NEAR(s.depth, 20, 1e-4);
}

TEST_F(FirstHits, EndAfterEightSurfaces) {
  const RTid plane = namedSquare(1, mirror());
  placeAt(0, plane);
  placeAt(40, plane, true);
  const Surface s = see();
  EXPECT_NEAR(s.depth, 20 + 8 * 40, 1e-2);
  EXPECT_NEAR(s.albedo.x, std::pow(.5, 9), 1e-6) << "eight mirrors and the ninth's own";
}

TEST_F(FirstHits, ImagesMoveAsTheirShapes) {
  placeAt(0, namedSquare(1, mirror()));
  const RTid target = placeAt(30, namedSquare(2, painted()), true);
  EXPECT_TRUE(std::isnan(see().motion.x)) << "nothing was there before";
  expectVector(see().motion, {0, 0, 0}, 0);
  moveTo(target, .25, -.125, 30.5, 180);
  expectVector(see().motion, {.25, -.125, -.5});
  expectVector(see().motion, {0, 0, 0}, 0);
}

TEST_F(FirstHits, ImagesMoveWithTheirMirrors) {
  const RTid plane = placeAt(0, namedSquare(1, mirror()));
  placeAt(30, namedSquare(2, painted()), true);
  see();
  moveTo(plane, .5, 0, .125); // along its plane, and by 1/8 across it
  expectVector(see().motion, {0, 0, .25});
  moveTo(plane, 0, 0, 0);
  see();
  const double angle = 2 * pi / 180;
  moveTo(plane, 0, 0, 0, 0, 2);
  see();
  moveTo(plane, 0, 0, 0);
  const Surface s = see();
  // The image of the same point in the mirror as it was
  const Vec n{std::sin(angle), 0, std::cos(angle)}, x{s.position.x, s.position.y, 30};
  const double along = n.x * x.x + n.z * x.z;
  const Vec before{x.x - 2 * n.x * along, x.y, x.z - 2 * n.z * along};
  expectVector(s.motion,
               {s.position.x - before.x, s.position.y - before.y, s.position.z - before.z}, 1e-4);
  EXPECT_GT(std::fabs(s.motion.x), 1);
}

TEST_F(FirstHits, ImagesInANewMirrorAreNew) {
  placeAt(30, namedSquare(2, painted()), true);
  see();
  placeAt(0, namedSquare(1, mirror()));
  EXPECT_TRUE(std::isnan(see().motion.y));
  expectVector(see().motion, {0, 0, 0}, 0);
}

TEST_F(FirstHits, AMirrorBallThatTurnsLeavesItsImagesWhereTheyAre) {
  const RTid placed = place(drawing::ball(mirror(), 1));
  placeAt(30, namedSquare(2, painted(), 1000), true);
  see(0, 0);
  moveTo(placed, 0, 0, 0, 0, 30);
  expectVector(see(0, 0).motion, {0, 0, 0}, 1e-4);
}

TEST_F(FirstHits, MotionSeenThroughGlassIsThatOfTheShape) {
  const RTid face = namedSquare(1, Shader("Glass"));
  const RTid pane = rtBeginObject(0);
  placeAt(2, face);
  placeAt(1, face, true);
  rtEndObject();
  const RTid placed = place(pane), target = placeAt(0, namedSquare(2, painted()));
  see();
  moveTo(target, .5, .25, -.125);
  moveTo(placed, 1, 1, .5);
  expectVector(see().motion, {.5, .25, -.125});
}

// Pictures of a scene with mirrors, glass and light of all kinds.
class PicturesWithFirstHits : public testing::Test {
 protected:
  static constexpr int width = 30, height = 24;

  struct Look {
    int threads = 1, transport = RT_TRANSPORT_PATH, samples = 16, follow = 0, frames = 2;
    uint32_t channels = RT_RGBA;
    bool progressive = false, jitter = false;
    int stride = 1, seed = 0;
    int sheets = 0; // that are transparent
  };
  // Returns the channels of the last of some frames, one after the other, and its statistics.
  static std::vector<float> picture(const Look& look, uint32_t wanted, RTstats* stats = nullptr) {
    std::vector<float> all;
    drawing::drawIn(drawing::contextWith(look.threads), [&] {
      draw(look);
      all = drawing::readChannels(wanted, width, height);
      if (!stats) return;
      stats->size = sizeof *stats;
      rtGetStats(stats);
    });
    return all;
  }
  static void draw(const Look& look) {
    using namespace drawing;
    rtLoadIdentity();
    at(0, -1, 0, square(Shader("Diffuse").set("reflectance", {.8, .3, .2}), 4), -90);
    at(0, 2.5, 0, square(Shader("Diffuse").set("emission", {9, 9, 8}), .3f), 90);
    at(-1, 0, -1, square(Shader("Mirror"), .8f), 10);
    at(.6, 0, 0, ball(Shader("Glass").set("abbe", {30}), .6f));
    const RTid moving = at(-.6, -.6, .8, ball(Shader("VRML97").set("transparency", {.7}), .4f));
    at(1.2, -.6, 1, square(Shader("VRML97").set("diffuseColor", {.2, .6, .3}), .4f), -30);
    for (int i = 0; i < look.sheets; i++) // one behind the other, of which any may count most
      at(-.3 + .2 * i, .2, 2 - .2 * i,
         square(Shader("VRML97").set("transparency", {.9 - .2 * i}), .7f), 3 * i);
    Shader lamp("VRML97DirectionalLight");
    lamp.set("direction", {-.3, -1, -.4}).set("intensity", {.5});
    rtUseLight(lamp);
    lookFrom(0, .5, 5);
    rtFrameBuffer(width, height, look.channels);
    rtQuality(RT_SAMPLES_PER_PIXEL, look.samples);
    rtQuality(RT_TRANSPORT, look.transport);
    rtQuality(RT_FOLLOW_IMAGES, look.follow);
    rtQuality(RT_PROGRESSIVE, look.progressive);
    rtQuality(RT_SEED, look.seed);
    rtQuality(RT_LIGHT_STRIDE, look.stride);
    rtQuality(RT_JITTER, look.jitter); // else a single sample lies in the middle of its pixel
    for (int i = 0; i < look.frames; i++) {
      const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -.6 + .1 * i, -.6, .8, 1};
      rtInstanceMatrix(moving, m);
      rtRender();
    }
  }
  static void expectSame(const std::vector<float>& a, const std::vector<float>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
  }
};

TEST_F(PicturesWithFirstHits, HaveTheLightOfPicturesWithoutThem) {
  constexpr uint32_t light = RT_RGBA | RT_SAMPLES | RT_VARIANCE | RT_ERROR | RT_TRUST;
  for (const int transport :
       {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
    const Look plain{.transport = transport, .samples = 32, .channels = light | features};
    Look followed = plain;
    followed.follow = 1;
    expectSame(picture(followed, light), picture(plain, light));
    EXPECT_NE(picture(followed, features), picture(plain, features));
  }
}

TEST_F(PicturesWithFirstHits, HaveTheSameBytesOnAnyNumberOfThreads) {
  const Look one{.samples = 40, .follow = 1, .frames = 3, .channels = RT_RGBA | features};
  const std::vector<float> expected = picture(one, one.channels);
  for (const int threads : {2, 5}) {
    Look more = one;
    more.threads = threads;
    expectSame(picture(more, one.channels), expected);
    more.progressive = true;
    expectSame(picture(more, one.channels), expected);
  }
}

TEST_F(PicturesWithFirstHits, OfOneSampleDescribeTheFirstSample) {
  const Look one{.samples = 1, .follow = 1, .channels = RT_RGBA | ofFirstSample, .jitter = true};
  Look many = one;
  many.samples = 8;
  expectSame(picture(many, ofFirstSample), picture(one, ofFirstSample));
}

// Every pixel gets light in one of stride x stride frames of consecutive seeds, as much as
// it has in a frame with light everywhere, and what it shows is described in all of them.
TEST_F(PicturesWithFirstHits, WithSparseLightHaveLightInTurn) {
  constexpr int pixels = width * height;
  for (const int stride : {2, 3, 4}) {
    SCOPED_TRACE(stride);
    std::vector<int> lit(pixels);
    for (int seed = 0; seed < stride * stride; seed++) {
      Look dense{.samples = 1,
                 .follow = 1,
                 .channels = RT_RGBA | RT_SAMPLES | features,
                 .seed = 1000 + seed};
      Look sparse = dense;
      sparse.stride = stride;
      expectSame(picture(sparse, features), picture(dense, features));
      const std::vector<float> colours = picture(dense, RT_RGBA), thin = picture(sparse, RT_RGBA),
                               samples = picture(sparse, RT_SAMPLES);
      for (int pixel = 0; pixel < pixels; pixel++) {
        const bool light = samples[size_t(pixel)] > 0;
        lit[size_t(pixel)] += light;
        for (int k = 0; k < 3; k++) {
          const auto i = size_t(4 * pixel + k);
          const float expected = light ? colours[i] : 0;
          EXPECT_NEAR(thin[i], expected, 1e-5 * (1 + expected)); // sums have another order
        }
      }
    }
    for (const int times : lit) EXPECT_TRUE(times == 1 || times == stride * stride) << times;
  }
}

// Whoever shades surfaces, the light of pixels that get none costs nothing.
TEST_F(PicturesWithFirstHits, WithSparseLightTraceFewShadowRays) {
  for (const int transport :
       {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
    SCOPED_TRACE(transport);
    Look look{.transport = transport, .samples = 1, .channels = RT_RGBA | features};
    RTstats plain{}, dense{}, sparse{};
    picture(look, RT_RGBA, &plain);
    look.follow = 1;
    picture(look, RT_RGBA, &dense);
    look.stride = 3;
    picture(look, RT_RGBA, &sparse);
    EXPECT_EQ(dense.rays.shadow, plain.rays.shadow);
    EXPECT_GT(sparse.rays.shadow, 0u);
    EXPECT_LT(sparse.rays.shadow, dense.rays.shadow / 6);
  }
}

// Pixels without light ask the shaders of transparent surfaces in another way than pixels with
// light, and must find the same.
TEST_F(PicturesWithFirstHits, WithSparseLightAreDescribedAsWithAllLight) {
  for (const int transport :
       {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT})
    for (const int follow : {0, 1})
      for (const int samples : {1, 5}) {
        SCOPED_TRACE(testing::Message() << transport << ' ' << follow << ' ' << samples);
        const Look dense{.transport = transport,
                         .samples = samples,
                         .follow = follow,
                         .channels = RT_RGBA | features,
                         .jitter = true,
                         .sheets = 4};
        for (const int stride : {2, 3, 4}) {
          Look sparse = dense;
          sparse.stride = stride;
          expectSame(picture(sparse, ofFirstSample), picture(dense, ofFirstSample));
        }
      }
}

// Normals and albedos are means over the samples of a pixel. A pixel without light has one sample,
// at a silhouette too, where other samples would see the environment.
TEST_F(PicturesWithFirstHits, WithSparseLightHaveOneSampleInPixelsWithoutLight) {
  const Look one{.samples = 1, .channels = RT_RGBA | RT_SAMPLES | features, .jitter = true};
  Look sparse = one;
  sparse.stride = 3;
  sparse.samples = 40; // several leaves
  const std::vector<float> samples = picture(sparse, RT_SAMPLES),
                           colours = picture(sparse, RT_RGBA), depth = picture(sparse, RT_DEPTH);
  for (const uint32_t channel : {RT_NORMAL, RT_ALBEDO}) {
    const std::vector<float> got = picture(sparse, channel), expected = picture(one, channel);
    int compared = 0;
    for (size_t i = 0; i < got.size(); i++) {
      if (samples[i / 3] == sparse.samples) continue;
      EXPECT_EQ(got[i], expected[i]) << i;
      EXPECT_EQ(samples[i / 3], std::isinf(depth[i / 3]) ? 1 : 0);
      if (samples[i / 3] == 0) { EXPECT_EQ(colours[4 * (i / 3) + i % 3], 0); }
      compared++;
    }
    EXPECT_GT(compared, int(got.size()) / 2);
  }
}

TEST_F(PicturesWithFirstHits, FramesWithoutLightHaveAllSamplesWithAnyStride) {
  Look dense{.samples = 5, .channels = features, .jitter = true}, sparse = dense;
  sparse.stride = 3;
  expectSame(picture(sparse, features), picture(dense, features));
}

TEST_F(PicturesWithFirstHits, WithoutLightFollowNone) {
  for (const int follow : {0, 1})
    for (const int transport :
         {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
      SCOPED_TRACE(transport);
      const Look lit{.transport = transport, .follow = follow, .channels = RT_RGBA | features};
      Look dark = lit;
      dark.channels = features;
      RTstats stats{};
      expectSame(picture(dark, features, &stats), picture(lit, features));
      EXPECT_EQ(stats.rays.shadow, 0u);
      EXPECT_EQ(stats.rays.camera, uint64_t(width * height * lit.samples));
      EXPECT_EQ(stats.rays.secondary == 0, follow == 0);
    }
}

} // namespace
} // namespace numeric
