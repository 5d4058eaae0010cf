// scattering_media.cpp: media that scatter, against closed forms: transmittance, the white furnace,
// single scattering, the reflectance of a half-space, and the flux out of a body. Uses the C API.
#include <algorithm>
#include <functional>

#include "numeric/sensor_scene.h"

namespace numeric {
namespace {

class ScatteringMedia : public Sensors {
 protected:
  void SetUp() override {
    Sensors::SetUp();
    rtQuality(RT_MAX_DEPTH, 10000);
    rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  }
  static Shader fog(Vec scattering, Vec absorption = {}, double g = 0) {
    Shader s("Fog");
    return s.set("scattering", {scattering.x, scattering.y, scattering.z})
        .set("absorption", {absorption.x, absorption.y, absorption.z})
        .set("anisotropy", {g});
  }
  static Shader grey(double scattering, double absorption = 0, double g = 0) {
    return fog({scattering, scattering, scattering}, {absorption, absorption, absorption}, g);
  }
  static Shader glowing(double radiance) {
    return Shader("Diffuse")
        .set("reflectance", {0, 0, 0})
        .set("emission", {radiance, radiance, radiance});
  }
  static void environment(double radiance) {
    Shader sky("VRML97Environment");
    const float r = float(radiance);
    sky.setList("skyColor", {r, r, r});
    rtUseEnvironment(sky);
  }
  // A box around (0, 0, 0) whose faces point outwards; inwards: to the middle.
  static RTid box(const Shader& shader, Vec half, bool inwards = false) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtBegin(RT_QUADS);
    for (int axis = 0; axis < 3; axis++)
      for (int side = -1; side <= 1; side += 2)
        for (int corner = 0; corner < 4; corner++) {
          const int turned = (side > 0) != inwards ? corner : 3 - corner;
          const double u = turned == 0 || turned == 3 ? -1 : 1, v = turned < 2 ? -1 : 1;
          double p[3];
          p[axis] = side;
          p[(axis + 1) % 3] = u;
          p[(axis + 2) % 3] = v;
          rtVertex3d(p[0] * half.x, p[1] * half.y, p[2] * half.z);
        }
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    return place(object);
  }
  static void perspectiveAt(Vec eye, double degrees = 60) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(eye.x, eye.y, eye.z);
    rtPerspective(degrees);
    rtPopMatrix();
  }
  // The mean of each colour over a small picture of the current camera, with the half-width of its
  // 95 % interval.
  struct Mean {
    double value[3], halfWidth[3];
  };
  static Mean means(int edge = 8) {
    rtFrameBuffer(uint32_t(edge), uint32_t(edge), RT_RGBA | RT_ERROR);
    rtRender();
    const size_t pixels = size_t(edge) * size_t(edge);
    std::vector<float> rgba(4 * pixels), error(3 * pixels);
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    rtReadPixels(RT_ERROR, error.data(), error.size());
    Mean m{};
    for (size_t k = 0; k < 3; k++) {
      for (size_t i = 0; i < pixels; i++) {
        m.value[k] += double(rgba[4 * i + k]) / double(pixels);
        m.halfWidth[k] += double(error[3 * i + k]) * double(error[3 * i + k]);
      }
      m.halfWidth[k] = std::sqrt(m.halfWidth[k]) / double(pixels);
    }
    return m;
  }
  // Expects the mean to be within its interval, widened from 95 % to 99.99 %, and the interval to
  // be narrow.
  static void expectMean(const Mean& got, Vec expected, double narrow) {
    const double e[3] = {expected.x, expected.y, expected.z};
    for (int k = 0; k < 3; k++) {
      EXPECT_NEAR(got.value[k], e[k], 2 * got.halfWidth[k] + 2e-5 * e[k]) << "colour " << k;
      EXPECT_LT(got.halfWidth[k], narrow * e[k]) << "colour " << k;
    }
  }
};

TEST_F(ScatteringMedia, AbsorptionAloneFollowsBeerAndLambert) {
  const Shader smoke = fog({0, 0, 0}, {1, .5, 0});
  for (const double depth : {1e-6, .5, 2.}) {
    const RTid body = box(smoke, {5, 5, depth / 2}), lamp = placeAt(-3, square(glowing(1)));
    for (const double height : {10., 0.}) // the camera is above the body, or in its middle
      expectColor(look(0, 0, height), {std::exp(-depth * (height > 0 ? 1 : .5)),
                                       std::exp(-depth / 2 * (height > 0 ? 1 : .5)), 1});
    rtDeleteInstance(body);
    rtDeleteInstance(lamp);
  }
}

// Without paths scattering is a loss.
TEST_F(ScatteringMedia, WhittedCountsScatteringAsLoss) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
  box(fog({.2, .4, .8}, {.1, 0, .3}), {5, 5, 1});
  placeAt(-3, square(glowing(1)));
  expectColor(look(0, 0, 10), {std::exp(-.6), std::exp(-.8), std::exp(-2.2)});
  EXPECT_TRUE(stats().transport.leavesOut & RT_LEAVES_BETWEEN);
}

// A lamp that is seen through a medium. It is so small that light which is scattered towards the
// camera does not count: the solid angle is below 1e-9.
TEST_F(ScatteringMedia, TransmittanceOfEachColour) {
  box(fog({.4, .2, 1.6}, {.1, 0, .4}), {5, 5, 1});
  placeAt(-100, square(glowing(1), .001));
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  for (const double height : {10., 0.}) {
    const double depth = height > 0 ? 2 : 1;
    rtPushMatrix();
    rtTranslated(0, 0, height);
    rtOrtho(1e-6);
    rtPopMatrix();
    expectMean(means(), {std::exp(-.5 * depth), std::exp(-.2 * depth), std::exp(-2 * depth)}, .03);
  }
}

// A body that loses no light cannot be seen in an even environment. Colours of equal extinction
// have no noise at all.
TEST_F(ScatteringMedia, WhiteFurnaceIsExact) {
  environment(1);
  for (const double scattering : {.1, 1., 30.})
    for (const double g : {-.7, 0., .9}) {
      const RTid body = box(grey(scattering, 0, g), {1, 1, 1});
      perspectiveAt({0, 0, 3});
      rtQuality(RT_SAMPLES_PER_PIXEL, 4);
      for (const float value : picture(8)) EXPECT_NEAR(value, 1, 2e-5) << scattering << " " << g;
      rtDeleteInstance(body);
    }
}

TEST_F(ScatteringMedia, WhiteFurnaceWithColours) {
  environment(1);
  box(fog({.3, 1, 5}, {}, .5), {1, 1, 1});
  perspectiveAt({0, 0, 3});
  expectMean(means(), {1, 1, 1}, .02);
}

// Walls that glow are light samples, which pass the boundary of the fog. Rays that hit the walls
// have the rest of the weight.
TEST_F(ScatteringMedia, WhiteFurnaceOfGlowingWalls) {
  box(glowing(1), {3, 3, 3}, true);
  box(grey(1.5, 0, .6), {1, 1, 1});
  perspectiveAt({0, 0, 2.5});
  expectMean(means(), {1, 1, 1}, .01);
  perspectiveAt({0, 0, .5}); // the camera is in the fog
  expectMean(means(), {1, 1, 1}, .01);
}

TEST_F(ScatteringMedia, WhiteFurnaceOfRefractingBodies) {
  environment(1);
  for (const char* name : {"Glass", "RoughGlass"}) {
    Shader plastic(name);
    plastic.set("index", {1.5}).set("scattering", {3, 3, 3}).set("anisotropy", {.3});
    if (std::string(name) == "RoughGlass") plastic.set("roughness", {.001});
    const RTid body = ball(plastic, 1);
    perspectiveAt({0, 0, 3}, 40);
    expectMean(means(), {1, 1, 1}, .02);
    rtDeleteInstance(body);
  }
}

// A ball of clear glass in a box of fog, and one that reaches out of it.
TEST_F(ScatteringMedia, WhiteFurnaceOfGlassInFog) {
  environment(1);
  box(grey(1), {1, 1, 1});
  Shader glass("Glass");
  glass.setInt("priority", 1);
  ball(glass, .6);
  rtPushMatrix();
  rtTranslated(1, 0, 0);
  ball(glass, .35);
  rtPopMatrix();
  perspectiveAt({0, 0, 3});
  expectMean(means(), {1, 1, 1}, .02);
}

double phase(double g, double cosine) {
  return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

// Simpson's rule.
double integrate(const std::function<double(double)>& f, double from, double to, int n = 4000) {
  double sum = f(from) + f(to);
  for (int i = 1; i < n; i++) sum += f(from + (to - from) * i / n) * (i % 2 ? 4 : 2);
  return sum * (to - from) / (3 * n);
}

// The light of a point lamp that is scattered once along a ray: L = int scattering p(angle) E(r)
// exp(-extinction (t + r)) dt, where the irradiance at the distance r is pi / r^2 (B. Sun et al.,
// "A Practical Analytic Single Scattering Model for Real Time Rendering", SIGGRAPH 2005, before it
// is tabulated). The ray is `aside` away from the lamp, which is `ahead` of the camera.
double airlight(double scattering, double extinction, double g, double ahead, double aside,
                double length) {
  return integrate(
      [&](double t) {
        const double along = ahead - t, r = std::hypot(along, aside);
        // The ray goes from the camera; light goes from the lamp to the point and back to the
        // camera. The path turns by the same angle in both directions.
        return scattering * phase(g, along / r) * pi / (r * r) * std::exp(-extinction * (t + r));
      },
      0, length);
}

TEST_F(ScatteringMedia, AirlightOfAPointLamp) {
  constexpr double g = .6, ahead = 4, aside = 1.5, far = 10;
  box(fog({.05, .1, .2}, {.02, 0, .1}, g), {20, 20, 20});
  // The ray goes down from the height `far` to a black floor at 0.
  placeAt(0, square(matt(0), 15));
  use(point({aside, 0, far - ahead}, {0, 0, 1}));
  rtQuality(RT_MAX_DEPTH, 0);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  rtPushMatrix();
  rtTranslated(0, 0, far);
  rtOrtho(1e-6);
  rtPopMatrix();
  expectMean(means(4),
             {airlight(.05, .07, g, ahead, aside, far), airlight(.1, .1, g, ahead, aside, far),
              airlight(.2, .3, g, ahead, aside, far)},
             .03);
}

// In thin fog few rays collide. The ray passes so near to the lamp that its light differs by a
// factor of 50 along it; places at equal angles cancel that, so few samples have a narrow interval.
TEST_F(ScatteringMedia, AirlightNearALampHasLittleNoise) {
  constexpr double ahead = 4, aside = 1.2, far = 10, s = 1e-3;
  box(grey(s), {20, 20, 20});
  placeAt(0, square(matt(0), 15));
  use(point({aside, 0, far - ahead}, {0, 0, 1}));
  rtQuality(RT_MAX_DEPTH, 0);
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  rtPushMatrix();
  rtTranslated(0, 0, far);
  rtOrtho(1e-6);
  rtPopMatrix();
  const double expected = airlight(s, s, 0, ahead, aside, far);
  expectMean(means(4), {expected, expected, expected}, .005);
}

// Several lamps: one behind the camera, one beside the ray, one hidden by the floor.
TEST_F(ScatteringMedia, AirlightOfSeveralLamps) {
  constexpr double far = 6, s = .2, a = .1, g = -.4;
  box(grey(s, a, g), {20, 20, 20});
  placeAt(0, square(matt(0), 15));
  const double lamps[3][2] = {{-2, 1.5}, {3, 2}, {8, 3}}; // ahead of the camera, aside
  double expected = 0;
  for (const auto& lamp : lamps) {
    use(point({lamp[1], 0, far - lamp[0]}, {0, 0, 1}));
    if (lamp[0] < far) expected += airlight(s, s + a, g, lamp[0], lamp[1], far);
  }
  rtQuality(RT_MAX_DEPTH, 0);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  rtPushMatrix();
  rtTranslated(0, 0, far);
  rtOrtho(1e-6);
  rtPopMatrix();
  expectMean(means(4), {expected, expected, expected}, .02);
}

// A parallel beam from the side crosses a layer of fog: L = scattering p(90 degrees) E int
// exp(-extinction (t + aside)) dt. Camera and lamp are outside.
TEST_F(ScatteringMedia, SingleScatteringOfAParallelBeam) {
  constexpr double s = .3, a = .1, g = .4, half = 1;
  box(grey(s, a, g), {half, half, half});
  use(directional({1, 0, 0}));
  rtQuality(RT_MAX_DEPTH, 0); // the boundary of the fog does not count
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  rtPushMatrix();
  rtTranslated(.25, 0, 5);
  rtOrtho(1e-6);
  rtPopMatrix();
  const double through = std::exp(-(s + a) * (half + .25)),
               sum = (1 - std::exp(-(s + a) * 2 * half)) / (s + a),
               expected = s * phase(g, 0) * pi * through * sum;
  expectMean(means(4), {expected, expected, expected}, .02);
}

// Chandrasekhar's H function for isotropic scattering: 1 / H(m) = sqrt(1 - a) + a / 2 int_0^1 x
// H(x) / (x + m) dx (S. Chandrasekhar, "Radiative Transfer", 1950, chapter V), by iteration.
class HFunction {
 public:
  explicit HFunction(double albedo) : albedo_(albedo) {
    for (int i = 0; i < n; i++) { // the midpoint rule in x = y^2, dense near 0
      const double y = (i + .5) / n;
      x_[i] = y * y;
      weight_[i] = 2 * y / n;
      h_[i] = 1;
    }
    for (int round = 0; round < 200; round++) {
      std::array<double, n> next;
      for (int i = 0; i < n; i++) next[i] = (*this)(x_[i]);
      h_ = next;
    }
  }
  double operator()(double m) const {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += weight_[i] * x_[i] * h_[i] / (x_[i] + m);
    return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * sum);
  }

 private:
  static constexpr int n = 400;
  double albedo_;
  std::array<double, n> x_, weight_, h_;
};

// The mean of H over the cosines is 2 / a (1 - sqrt(1 - a)) (Chandrasekhar, chapter V, theorem 1).
TEST_F(ScatteringMedia, HFunctionHasItsMean) {
  for (const double albedo : {.5, .9, .99}) {
    const HFunction h(albedo);
    EXPECT_NEAR(integrate(h, 0, 1, 400), 2 / albedo * (1 - std::sqrt(1 - albedo)), 1e-3);
  }
}

// A half-space in an even sky has the radiance 1 - sqrt(1 - a) H(m), where m is the cosine of the
// angle of view (the plane albedo, and reciprocity). The body is 400 mean free paths deep.
class HalfSpace : public ScatteringMedia, public testing::WithParamInterface<double> {};

TEST_P(HalfSpace, ReflectsAsChandrasekharComputed) {
  const double albedo = GetParam();
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  environment(1);
  rtPushMatrix();
  rtTranslated(0, 0, -200);
  box(grey(albedo, 1 - albedo), {2000, 2000, 200});
  rtPopMatrix();
  const HFunction h(albedo);
  for (const double cosine : {1., .5, .15}) {
    rtPushMatrix();
    rtRotated(std::acos(cosine) * 180 / pi, 0, 1, 0);
    rtTranslated(0, 0, 10);
    rtOrtho(1e-3);
    rtPopMatrix();
    const double expected = 1 - std::sqrt(1 - albedo) * h(cosine);
    expectMean(means(), {expected, expected, expected}, .03);
  }
}

INSTANTIATE_TEST_SUITE_P(Albedo, HalfSpace, testing::Values(.5, .9, .99));

// All light of a white ball that glows in the middle of a ball of fog leaves the fog, alike in all
// directions, because neither loses any: the illuminance around is that without fog.
TEST_F(ScatteringMedia, TheFluxOfALampLeavesItsFog) {
  constexpr double radiance = 100, radius = .4, away = 2;
  rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
  ball(matt(1, radiance), radius);
  for (const double scattering : {.5, 3.}) {
    const RTid body = ball(grey(scattering, 0, .4), 1);
    expectReading(read({0, 0, away}, below), pi * radiance * std::pow(radius / away, 2), .03);
    rtDeleteInstance(body);
  }
}

// A sensor in an absorbing and scattering medium that is so thin that light is scattered once:
// direct light is attenuated on its way.
TEST_F(ScatteringMedia, SensorsKnowWhatTheyAreIn) {
  box(grey(1e-6, .5), {4, 4, 4});
  use(bulb({0, 0, 2}, 1000));
  expectReading(read({0, 0, 0}, up), 1000 / (4 * pi * 4) * std::exp(-.5 * 2), .01);
}

// Smoke that only absorbs dims the light of lamps, whoever stands in it: nothing that light meets
// on its way tells.
TEST_F(ScatteringMedia, SmokeDimsTheLightOfLamps) {
  constexpr double candela = 1000 / (4 * pi), dimmed = .3;
  const auto reading = [&](Vec lampAt, Vec smokeAt, double half) {
    rtPushMatrix();
    rtTranslated(smokeAt.x, smokeAt.y, smokeAt.z);
    const RTid body = box(grey(0, dimmed), {half, half, half});
    rtPopMatrix();
    const RTid lamp = use(bulb(lampAt, 1000));
    const double lux = read({0, 0, 0}, up).value;
    rtRemoveLight(lamp);
    rtDeleteInstance(body);
    return lux;
  };
  EXPECT_NEAR(reading({0, 0, 2}, {}, 50), candela / 4 * std::exp(-dimmed * 2), 1e-3);
  EXPECT_NEAR(reading({0, 0, 3}, {}, 2), candela / 9 * std::exp(-dimmed * 2), 1e-3);
  EXPECT_NEAR(reading({0, 0, 3}, {0, 0, 3}, 2), candela / 9 * std::exp(-dimmed * 2), 1e-3);
  EXPECT_NEAR(reading({0, 0, 5}, {0, 0, 3}, 1), candela / 25 * std::exp(-dimmed * 2), 1e-3);
}

TEST_F(ScatteringMedia, SmokeDimsWhatALampLightsAndACameraSees) {
  box(grey(0, .3), {50, 50, 50});
  placeAt(-1, square(matt(1), 20));
  use(bulb({0, 0, 1}, 1000));
  const double lux = 1000 / (4 * pi * 4) * std::exp(-.3 * 2);
  expectGrey(look(0, 0, 0), lux / pi * std::exp(-.3), 1e-4);
  EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_PATH));
}

// The stack of media has four places: a body within four others is as if it were not there.
TEST_F(ScatteringMedia, WhiteFurnaceOfSixBodiesInEachOther) {
  environment(1);
  for (int i = 0; i < 6; i++) ball(grey(.1 * (i + 1)), 3 - .4 * i);
  perspectiveAt({0, 0, 5}, 20);
  expectMean(means(), {1, 1, 1}, .03);
}

// The channels of first surfaces show what is behind the fog, and the fog hides nothing there.
TEST_F(ScatteringMedia, ChannelsShowWhatIsBehindFog) {
  box(grey(2), {5, 5, 1});
  placeAt(-2, square(matt(.25), 20));
  environment(1);
  perspectiveAt({0, 0, 5}, 1);
  rtFrameBuffer(4, 4, RT_RGBA | RT_DEPTH | RT_ALBEDO | RT_NORMAL);
  rtRender();
  std::vector<float> depth(16), albedo(48), normal(48), rgba(64);
  rtReadPixels(RT_DEPTH, depth.data(), depth.size());
  rtReadPixels(RT_ALBEDO, albedo.data(), albedo.size());
  rtReadPixels(RT_NORMAL, normal.data(), normal.size());
  rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
  for (size_t i = 0; i < 16; i++) {
    EXPECT_NEAR(depth[i], 7, 1e-3);
    EXPECT_NEAR(albedo[3 * i], .25, 1e-5);
    EXPECT_NEAR(normal[3 * i + 2], 1, 1e-5);
    EXPECT_NEAR(rgba[4 * i + 3], 1, 2e-5); // fog and floor together are opaque
  }
}

TEST_F(ScatteringMedia, FogChoosesPathsFromTheCamera) {
  box(grey(.1), {5, 5, 1});
  placeAt(-2, square(matt(.5), 20));
  rtPushMatrix();
  rtTranslated(0, 0, -1);
  ball(Shader("Glass"), .3);
  rtPopMatrix();
  use(bulb({0, 0, 3}, 1000));
  perspectiveAt({0, 0, 5});
  for (const RTenum asked : {RT_TRANSPORT_AUTO, RT_TRANSPORT_LIGHT}) {
    rtQuality(RT_TRANSPORT, int(asked));
    picture(2);
    EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_PATH));
    EXPECT_NE(std::string(stats().transport.reason).find("Fog scatters or absorbs light inside"),
              std::string::npos)
        << stats().transport.reason;
  }
}

// A medium cannot amplify light and scatter it. The message says what was expected, and the body
// is clear of scattering.
TEST_F(ScatteringMedia, GainWithScatteringIsRefused) {
  static std::string said;
  said.clear();
  rtLogCallback([](int, const char* text, void*) { said += text; }, nullptr);
  Shader gain("Glass");
  gain.set("index", {1}).set("absorption", {-.5, 0, 0}).set("scattering", {1, 1, 1});
  box(gain, {5, 5, 1});
  placeAt(-3, square(glowing(1)));
  expectColor(look(0, 0, 10), {std::exp(1.), 1, 1});
  rtLogCallback(nullptr, nullptr);
  EXPECT_NE(said.find("a medium that scatters needs absorption >= 0"), std::string::npos) << said;
}

// A fixture without a context, for tests that make several.
class ScatteringThreads : public ScatteringMedia {
 protected:
  void SetUp() override {}
  void TearDown() override {}
};

TEST_F(ScatteringThreads, DoNotChangePictures) {
  std::vector<std::vector<float>> pictures;
  for (const char* options : {"threads=1", "threads=4"}) {
    const RTcontext context = rtNewContext(options);
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtQuality(RT_SAMPLES_PER_PIXEL, 8);
    rtLoadIdentity();
    environment(.2);
    box(fog({.5, 1, 2}, {.1, .1, 0}, .5), {1, 1, 1});
    ball(glowing(5), .2);
    use(point({0, 2, 0}, {0, 0, 1}));
    perspectiveAt({0, 0, 3});
    pictures.push_back(picture(64));
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(context);
  }
  EXPECT_EQ(pictures[0], pictures[1]);
}

} // namespace
} // namespace numeric
