// luminaire.cpp: the stock classes Luminaire and EnvironmentMap against closed forms. Uses the C
// API.
#include "numeric/support.h"

namespace numeric {
namespace {

class StockLights : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    Shader white("Diffuse");
    white.set("reflectance", {1, 1, 1});
    place(square(white, 100));
  }
  // Vertical angles 0, 60, 120; horizontal angles 0, 90, 180, 270.
  static Shader luminaire(const std::string& candela) {
    Shader s("Luminaire");
    const std::string text =
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 4 1 2 0 0 0\n1 1 100\n0 60 120\n0 90 180 270\n" +
        candela;
    rtBindShader(s);
    rtParameterString(rtParameterHandle("profile"), text.c_str());
    rtBindShader(0);
    return s;
  }
};

const char* const even = "100 100 100\n100 100 100\n100 100 100\n100 100 100";

TEST_F(StockLights, ALuminaireOfOneIntensityIsAPointLight) {
  Shader s = luminaire(even);
  s.set("location", {0, 0, 2});
  use(s);
  // R1: irradiance I h / d^3; a white surface shows 1/pi of it
  for (const double x : {0., 1., 3.}) {
    const double d = std::sqrt(4 + x * x);
    expectGrey(look(x), 100 * 2 / (d * d * d) / pi);
  }
}

TEST_F(StockLights, IntensityBetweenMeasuredAngles) {
  Shader s = luminaire("100 0 0\n100 0 0\n100 0 0\n100 0 0");
  s.set("location", {0, 0, 2});
  use(s);
  const double x = 2 * std::tan(30 * pi / 180), d = 2 / std::cos(30 * pi / 180);
  expectGrey(look(x), 50 * 2 / (d * d * d) / pi, 1e-4);
  expectGrey(look(4), 0);
}

TEST_F(StockLights, TheFluxOfALuminaireCanBeGiven) {
  Shader s = luminaire(even); // 100 cd everywhere up to 120 degrees: 300 pi lumen
  s.set("location", {0, 0, 2}).set("lumen", {600 * pi});
  use(s);
  expectGrey(look(), 200 / 4. / pi, 1e-3);
}

TEST_F(StockLights, AnEulumdatFileIsALuminaire) {
  std::string text = "maker\n1\n1\n1\n0\n2\n90\n\nname\n\n\n\n600\n600\n50\n600\n600\n0\n0\n0\n0\n"
                     "100\n80\n1\n0\n1\n1\nlamp\n2000\n3000\n80\n20\n";
  for (int i = 0; i < 10; i++) text += ".5\n";
  text += "0\n0\n90\n100\n0\n"; // gamma 0: 100 cd for 1000 lm
  Shader s("Luminaire");
  rtBindShader(s);
  rtParameterString(rtParameterHandle("profile"), text.c_str());
  rtBindShader(0);
  s.set("location", {0, 0, 2});
  use(s);
  expectGrey(look(), 200 / 4. / pi);
}

TEST_F(StockLights, HorizontalAnglesGrowCounterClockwiseFromTheReference) {
  Shader s = luminaire("10 10 10\n20 20 20\n30 30 30\n40 40 40");
  s.set("location", {0, 0, 2}).set("direction", {0, 0, -3}).set("reference", {1, 0, .5});
  use(s);
  const double d = std::sqrt(5), scale = 2 / (d * d * d) / pi;
  expectGrey(look(1, 0), 10 * scale, 1e-4);
  expectGrey(look(0, 1), 20 * scale, 1e-4);
  expectGrey(look(-1, 0), 30 * scale, 1e-4);
  expectGrey(look(0, -1), 40 * scale, 1e-4);
}

TEST_F(StockLights, ATextThatIsNoProfileIsNotRenderedAndSaidSo) {
  static std::string said;
  said.clear();
  rtLogCallback([](int, const char* text, void*) { said += text; }, nullptr);
  Shader s("Luminaire");
  rtBindShader(s);
  rtParameterString(rtParameterHandle("profile"), "IESNA91\nTILT=INCLUDE\n9 2 3");
  rtBindShader(0);
  use(s);
  expectGrey(look(), 0);
  EXPECT_NE(said.find("Luminaire"), std::string::npos) << said;
  EXPECT_NE(said.find("line 3: TILT=INCLUDE"), std::string::npos) << said;
  rtBindShader(s); // with another value the light is there again
  rtParameterString(rtParameterHandle("profile"),
                    "IESNA91\nTILT=NONE\n1 1 1 1 1 1 1 0 0 0 1 1 1 0 0 3.14159265");
  rtBindShader(0);
  rtPushMatrix();
  rtTranslated(0, 0, 1);
  use(s);
  rtPopMatrix();
  expectGrey(look(), 1);
}

// A small bright spot in a dark environment map, found by importance sampling.
TEST_F(StockLights, ASmallSunInAPictureOfTheSky) {
  constexpr int width = 1024, height = 512;
  // The direction is 45 degrees from +z and 45 degrees below +y. It lies at -z turned by half a
  // turn; rows run from the bottom up.
  constexpr int row = 383, column = 0;
  std::vector<float> texels(size_t(width) * height * 3, 0.0f);
  for (int k = 0; k < 3; k++) texels[size_t(3 * (row * width + column) + k)] = 1e5f;
  RTid picture = 0;
  rtGenTextures(1, &picture);
  rtBindTexture(picture);
  rtTexImage2D(3, width, height, RT_FLOAT, texels.data());
  rtUseEnvironment(Shader("EnvironmentMap").setTexture("texture", picture));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_MAX_DEPTH, 1);
  rtQuality(RT_SAMPLES_PER_PIXEL, 16384);
  // Bilinear lookup turns the texel into a tent of the same energy. theta: from +y; phi: from -z
  // towards +x.
  const double theta = pi * (1 - (row + .5) / height), phi = 2 * pi * ((column + .5) / width - .5);
  const double solidAngle = 2 * pi / width * pi / height * std::sin(theta);
  const double expected =
      1e5 * solidAngle / pi * (-std::sin(theta) * std::cos(phi)); // the floor faces +z
  ASSERT_GT(expected, .1);
  expectGrey(look(0, 0, .001), expected, 2e-3);
}

// The spot has less of the sky's light than what is left to BSDF sampling where no place is bright.
TEST_F(StockLights, ASmallSunThatHasLittleOfTheLightIsFound) {
  constexpr int width = 1024, height = 512, row = 383, column = 0; // as above
  const double theta = pi * (1 - (row + .5) / height), phi = 2 * pi * ((column + .5) / width - .5);
  const double solidAngle = 2 * pi / width * pi / height * std::sin(theta), share = 1. / 128;
  std::vector<float> texels(size_t(width) * height * 3, 1.0f);
  for (int k = 0; k < 3; k++)
    texels[size_t(3 * (row * width + column) + k)] += float(share * 4 * pi / solidAngle);
  RTid picture = 0;
  rtGenTextures(1, &picture);
  rtBindTexture(picture);
  rtTexImage2D(3, width, height, RT_FLOAT, texels.data());
  rtUseEnvironment(Shader("EnvironmentMap").setTexture("texture", picture));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_MAX_DEPTH, 1);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  const double cosine = -std::sin(theta) * std::cos(phi); // the floor faces +z
  expectGrey(look(0, 0, .001), 1 + 4 * share * cosine, 2e-3);
}

TEST_F(StockLights, APictureOfTheSkyIsTurnedAndScaled) {
  constexpr int width = 8, height = 4;
  std::vector<float> texels;
  for (int i = 0; i < width * height; i++)
    for (int k = 0; k < 3; k++)
      texels.push_back(i % width < width / 2 ? 1.0f : 3.0f); // left half, right half
  RTid picture = 0;
  rtGenTextures(1, &picture);
  rtBindTexture(picture);
  rtTexImage2D(3, width, height, RT_FLOAT, texels.data());
  Shader s("EnvironmentMap");
  s.setTexture("texture", picture).set("intensity", {2});
  const auto towards = [&](double angle) { // clockwise from -z, seen from above
    rtUseEnvironment(s);
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 500, 0);
    rtRotated(-angle, 0, 1, 0);
    rtPerspective(1e-3);
    rtPopMatrix();
    return render();
  };
  expectGrey(towards(90), 6);
  expectGrey(towards(-90), 2);
  s.set("rotation", {pi}); // half a turn
  expectGrey(towards(90), 2);
  EXPECT_EQ(towards(90).a, 1);
}

TEST_F(StockLights, TheSkyIsReadAnewWhenItChangesAndOnlyThen) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_MAX_DEPTH, 1);
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {1, 1, 1});
  rtUseEnvironment(sky);
  for (const double radiance : {1., 2., 0., 3.}) {
    const float r = float(radiance);
    sky.setList("skyColor", {r, r, r});
    expectGrey(look(0, 0, .001), radiance, 2e-2);
    expectGrey(look(1, 0, .001), radiance, 2e-2); // only the camera has moved
  }
}

} // namespace
} // namespace numeric
