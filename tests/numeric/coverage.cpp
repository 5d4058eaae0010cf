// coverage.cpp: RT_COVERAGE against closed forms: strips that cover known parts of a pixel.
#include <cstring>
#include <utility>
#include <vector>

#include "drawing.h"
#include "numeric/support.h"

namespace numeric {
namespace {

constexpr size_t names = 8;
using Pairs = std::vector<std::pair<float, float>>; // name and share

class Coverage : public Scene {
 protected:
  // Places a strip of a pixel that reaches from -1 to 1.
  static void strip(RTid name, double from, double to) {
    rtLoadName(name);
    const RTid object = rtBeginObject(0);
    rtBindShader(drawing::colored("Diffuse", "reflectance", {.5f, .5f, .5f}));
    rtBegin(RT_QUADS);
    rtNormal3f(0, 0, 1);
    rtVertex3d(from, -2, 0);
    rtVertex3d(to, -2, 0);
    rtVertex3d(to, 2, 0);
    rtVertex3d(from, 2, 0);
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    rtLoadName(0);
    place(object);
  }
  static Pairs see(int samples, uint32_t channels = RT_RGBA | RT_COVERAGE, int edge = 1) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, 5);
    rtOrtho(2);
    rtPopMatrix();
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    rtFrameBuffer(edge, edge, channels);
    rtRender();
    std::vector<float> values(size_t(edge * edge) * 2 * names);
    rtReadPixels(RT_COVERAGE, values.data(), values.size());
    Pairs pairs;
    for (size_t i = 0; i < values.size(); i += 2) pairs.emplace_back(values[i], values[i + 1]);
    return pairs;
  }
};

TEST_F(Coverage, SharesAreThoseOfAreas) {
  strip(3, -1, -.25);
  strip(9, -.25, .75);
  const Pairs pairs = see(1024);
  EXPECT_EQ(pairs[0].first, 9);
  EXPECT_NEAR(pairs[0].second, .5, .005);
  EXPECT_EQ(pairs[1].first, 3);
  EXPECT_NEAR(pairs[1].second, .375, .005);
  for (size_t i = 2; i < names; i++) EXPECT_EQ(pairs[i], std::make_pair(0.f, 0.f));
}

TEST_F(Coverage, SurfacesWithoutANameAreNotCounted) {
  strip(0, -1, 0);
  strip(5, 0, 1);
  const Pairs pairs = see(1024);
  EXPECT_EQ(pairs[0].first, 5);
  EXPECT_NEAR(pairs[0].second, .5, .005);
  EXPECT_EQ(pairs[1].second, 0);
}

TEST_F(Coverage, ItIsThatOfTheNearestSurface) {
  strip(3, -1, 1);
  rtPushMatrix();
  rtTranslated(0, 0, 1);
  strip(4, -1, 0);
  rtPopMatrix();
  const Pairs pairs = see(1024);
  EXPECT_NEAR(pairs[0].second, .5, .005);
  EXPECT_NEAR(pairs[1].second, .5, .005);
  EXPECT_NEAR(pairs[0].second + pairs[1].second, 1, 1e-6);
}

// Equal shares are sorted by name.
TEST_F(Coverage, OneSampleHasOneName) {
  strip(4, -1, 1);
  EXPECT_EQ(see(1)[0], std::make_pair(4.f, 1.f));
  EXPECT_EQ(see(1, RT_COVERAGE)[0], std::make_pair(4.f, 1.f)) << "without light";
  EXPECT_EQ(see(64, RT_COVERAGE)[0], std::make_pair(4.f, 1.f));
}

TEST_F(Coverage, ManySmallOnesDoNotHideALargeOne) {
  for (RTid i = 0; i < 90; i++) strip(100 + i, -1 + i / 900.0, -1 + (i + 1) / 900.0);
  strip(900, -.9, 1);
  const Pairs pairs = see(8192);
  EXPECT_EQ(pairs[0].first, 900);
  EXPECT_NEAR(pairs[0].second, .95, .003);
}

TEST_F(Coverage, APixelCountsEightNames) {
  for (RTid i = 0; i < 12; i++) strip(100 + i, -1 + i / 6.0, -1 + (i + 1) / 6.0);
  const Pairs pairs = see(4096);
  double sum = 0;
  for (size_t i = 0; i < names; i++) {
    EXPECT_GE(pairs[i].first, 100);
    EXPECT_LT(pairs[i].first, 112);
    EXPECT_NEAR(pairs[i].second, 1.0 / 12, .005);
    if (i > 0) {
      const auto& [name, share] = pairs[i - 1];
      EXPECT_LE(pairs[i].second, share);
      if (pairs[i].second == share) { EXPECT_GT(pairs[i].first, name); }
    }
    sum += double(pairs[i].second);
  }
  EXPECT_NEAR(sum, 8.0 / 12, .01);
}

// A thing of many parts has one share, whatever is beside it.
TEST_F(Coverage, UnitedNamesAreOne) {
  for (RTid i = 0; i < 40; i++) strip(100 + i, -1 + i / 40.0, -1 + (i + 1) / 40.0);
  strip(7, 0, 1);
  std::vector<uint32_t> united(200);
  for (uint32_t i = 0; i < united.size(); i++) united[i] = i < 100 ? i : 100 + i % 2;
  rtUniteNames(united.data(), united.size());
  Pairs pairs = see(4096);
  EXPECT_EQ(pairs[0].first, 7);
  EXPECT_NEAR(pairs[0].second, .5, .005);
  for (size_t i = 1; i < 3; i++) {
    EXPECT_TRUE(pairs[i].first == 100 || pairs[i].first == 101);
    EXPECT_NEAR(pairs[i].second, .25, .005);
  }
  EXPECT_EQ(pairs[3].second, 0);
  united.assign(200, 0); // none of them counts, and those beyond the table are themselves
  united.resize(101);
  rtUniteNames(united.data(), united.size());
  pairs = see(4096);
  EXPECT_NEAR(pairs[0].second, 1.0 / 80, .005);
  EXPECT_GE(pairs[0].first, 101);
  rtUniteNames(nullptr, 0);
  EXPECT_EQ(see(64)[0].first, 7);
}

TEST_F(Coverage, LightChangesNothing) {
  for (RTid i = 0; i < 7; i++) strip(100 + i, -1 + i / 5.0, -1 + (i + 1) / 5.0);
  const Pairs expected = see(100, RT_COVERAGE, 5);
  EXPECT_EQ(see(100, RT_COVERAGE | RT_RGBA, 5), expected);
  EXPECT_EQ(see(100, RT_COVERAGE | RT_RGBA | RT_NAME | RT_NORMAL | RT_MOTION, 5), expected);
}

// Pixels whose light is not followed have one sample.
TEST_F(Coverage, PixelsWithoutLightHaveNames) {
  strip(6, -2, 2);
  rtQuality(RT_LIGHT_STRIDE, 3);
  const Pairs pairs = see(1, RT_COVERAGE | RT_RGBA, 6);
  for (size_t i = 0; i < pairs.size(); i += names)
    EXPECT_EQ(pairs[i], std::make_pair(6.f, 1.f)) << i / names;
}

// A ball of fog about the eye scatters most rays before they reach the strip.
TEST_F(Coverage, FogHidesNoNames) {
  strip(6, -2, 2);
  const RTid fog = Shader("Fog").set("scattering", {2, 2, 2});
  const RTid ball = rtBeginObject(0);
  rtBindShader(fog);
  rtSphere(7);
  rtEndObject();
  rtBindShader(0);
  place(ball);
  const Pairs pairs = see(16);
  EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_PATH));
  EXPECT_EQ(pairs[0], std::make_pair(6.f, 1.f));
}

} // namespace
} // namespace numeric
