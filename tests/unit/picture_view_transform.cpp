// picture_view_transform.cpp: Tests exposure and view curves against the published formulas, and
// what files for screens and OpenEXR files do with them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "libpicture/files/formats.h"
#include "openrt/openrt.h"

using namespace picture;

namespace {

using Colour = std::array<float, 3>;

Colour shown(const ViewTransform& view, const Colour& radiance) {
  Colour out{};
  toScreen(view, radiance.data(), out.data());
  return out;
}

Picture pictureOf(const std::vector<Colour>& colours, const ViewTransform& view = {}) {
  Picture picture;
  picture.width = int(colours.size());
  picture.height = 1;
  picture.view = view;
  for (const Colour& c : colours)
    picture.planes[RT_RGBA].insert(picture.planes[RT_RGBA].end(), {c[0], c[1], c[2], 1});
  return picture;
}

Colour grey(double v) { return {float(v), float(v), float(v)}; }

} // namespace

// The numbers are those of "Filmic Tonemapping Operators" (J. Hable, 2010): its curve with exposure
// bias 2 and white point 11.2, computed apart from this program.
TEST(ViewTransform, filmicIsHablesCurve) {
  const ViewTransform view{0, ViewCurve::filmic};
  const std::pair<double, double> known[] = {{.01, .007663655}, {.18, .128338449}, {1, .492918546},
                                             {2, .713238011},   {5.6, 1},          {10, 1}};
  for (const auto& [light, value] : known)
    EXPECT_NEAR(double(shown(view, grey(light))[1]), value, 1e-6) << light;
  // each colour by itself
  const Colour mixed = shown(view, {.18f, 1, 5.6f});
  EXPECT_NEAR(double(mixed[0]), .128338449, 1e-6);
  EXPECT_NEAR(double(mixed[1]), .492918546, 1e-6);
}

// The numbers were computed from the listing of three.js (tonemapping_pars_fragment), with NumPy.
TEST(ViewTransform, agxIsThatOfThreeJs) {
  const ViewTransform view{0, ViewCurve::agx};
  const std::pair<Colour, Colour> known[] = {{grey(.18), {.214549f, .214502f, .214499f}},
                                             {grey(1), {.590229f, .590136f, .590102f}},
                                             {grey(16), {.995212f, .995098f, .995009f}},
                                             {{1, 0, 0}, {.723276f, .105847f, .066736f}},
                                             {{.1f, .4f, .8f}, {.195934f, .397137f, .561988f}},
                                             {{20, 2, .5f}, {1, .847093f, .737493f}},
                                             {{0, 0, 64}, {.859980f, .927404f, 1}}};
  for (const auto& [light, value] : known) {
    const Colour got = shown(view, light);
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(double(got[k]), double(value[k]), 2e-6) << light[0];
  }
}

TEST(ViewTransform, curvesBeginAtBlackAndRise) {
  for (const ViewCurve curve : {ViewCurve::standard, ViewCurve::filmic, ViewCurve::agx}) {
    EXPECT_EQ(shown({0, curve}, grey(0)), grey(0));
    float before = 0;
    for (double stops = -14; stops < 8; stops += .05) {
      const Colour now = shown({0, curve}, grey(std::exp2(stops)));
      EXPECT_GE(now[1], before) << curveName(curve) << " at " << stops;
      EXPECT_LE(now[1], 1);
      before = now[1];
    }
    EXPECT_GT(before, .99f);
  }
}

TEST(ViewTransform, whatIsNoNumberIsDarkAndWhatIsInfiniteIsBright) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  for (const ViewCurve curve : {ViewCurve::standard, ViewCurve::filmic, ViewCurve::agx})
    for (const double stops : {-32.0, 0.0, 32.0}) {
      const ViewTransform view{stops, curve};
      EXPECT_EQ(shown(view, {nan, nan, nan}), grey(0));
      EXPECT_EQ(shown(view, {-inf, -1, -0.0f}), grey(0));
      for (const float v : shown(view, {inf, inf, inf})) EXPECT_GT(v, .99f);
      for (const float v : shown(view, {inf, nan, -inf})) EXPECT_TRUE(v >= 0 && v <= 1);
      for (const float v : shown(view, {3e38f, 1, 0})) EXPECT_TRUE(v >= 0 && v <= 1);
    }
}

TEST(ViewTransform, anExposureMultipliesLight) {
  EXPECT_EQ(shown({2, ViewCurve::standard}, grey(.125)), grey(.5));
  EXPECT_EQ(shown({-3, ViewCurve::standard}, grey(4)), grey(.5));
  for (const ViewCurve curve : {ViewCurve::filmic, ViewCurve::agx})
    EXPECT_EQ(shown({3, curve}, grey(.125)), shown({0, curve}, grey(1)));
}

TEST(ViewTransform, filesForScreensHaveIt) {
  const Picture plain = pictureOf({grey(.5), {4, 2, 1}, {.1f, .2f, .3f}});
  Picture brighter = plain, twice = plain;
  brighter.view.exposure = 1;
  for (float& v : twice.planes[RT_RGBA]) v *= 2; // alpha, too
  EXPECT_EQ(displayBytes(brighter), displayBytes(twice));
  EXPECT_NE(displayBytes(brighter), displayBytes(plain));
  Picture filmic = plain;
  filmic.view.curve = ViewCurve::filmic;
  // The bytes are those of a picture that holds the values of the curve.
  Picture values = plain;
  for (size_t i = 0; i < 3; ++i)
    toScreen(filmic.view, &plain.planes.at(RT_RGBA)[4 * i], &values.planes[RT_RGBA][4 * i]);
  EXPECT_EQ(displayBytes(filmic), displayBytes(values));
  for (const Format& format : formatTable())
    EXPECT_EQ(format.encode(plain) != format.encode(filmic),
              format.appliesCurve || format.encode == encodeExr)
        << format.name;
}

TEST(ViewTransform, transparentColoursAreExposedWithoutTheirAlpha) {
  Picture half = pictureOf({grey(.25)});
  half.planes[RT_RGBA][3] = .5f; // .5, premultiplied
  half.view = {1, ViewCurve::standard};
  EXPECT_EQ(displayBytesAlpha(half), (std::vector<uint8_t>{255, 255, 255, 128}));
  half.planes[RT_RGBA][3] = 0;
  EXPECT_EQ(displayBytesAlpha(half), (std::vector<uint8_t>{0, 0, 0, 0}));
}

TEST(ViewTransform, picturesWithoutLinearLightHaveNone) {
  Picture values = pictureOf({grey(.25), grey(.5)});
  values.linear = false;
  Picture with = values;
  with.view = {3, ViewCurve::agx};
  EXPECT_EQ(displayBytes(with), displayBytes(values));
  EXPECT_EQ(encodeExr(with), encodeExr(values));
}

TEST(FittingExposure, aUniformPictureBecomesMiddleGrey) {
  for (const double light : {1e-3, .18, 7.0, 4000.0}) {
    const double stops = fittingExposure(pictureOf(std::vector<Colour>(100, grey(light))));
    EXPECT_NEAR(light * std::exp2(stops), .18, .18 * .006) << "a 64th of a stop is 1.1 %";
    EXPECT_EQ(stops * 64, std::round(stops * 64));
  }
}

// E. Reinhard, JGT 7(1), 2002: the key is .18 * 4^((2 m - l - u) / (u - l)) of the logarithms.
TEST(FittingExposure, brightPicturesStayBright) {
  const auto scene = [](int bright) { // 100 pixels; the others have a sixteenth of their light
    std::vector<Colour> colours(100, grey(1.0 / 16));
    std::fill_n(colours.begin(), bright, grey(1));
    return fittingExposure(pictureOf(colours));
  };
  for (const int bright : {10, 50, 90}) {
    const double mean = -4 * (1 - bright / 100.0), place = (2 * mean + 4) / 4;
    EXPECT_NEAR(scene(bright), std::log2(.18) + 2 * place - mean, 1.0 / 128) << bright;
  }
}

TEST(FittingExposure, blackPixelsAndOddOnesDoNotCount) {
  const double alone = fittingExposure(pictureOf(std::vector<Colour>(50, grey(3))));
  std::vector<Colour> colours(50, grey(3));
  colours.insert(colours.end(), 500, grey(0));
  colours.insert(colours.end(), 50, grey(1e-9));
  colours.push_back(grey(std::nan("")));
  colours.push_back(grey(std::numeric_limits<float>::infinity()));
  colours.push_back(grey(-1));
  EXPECT_EQ(fittingExposure(pictureOf(colours)), alone);
  EXPECT_EQ(fittingExposure(pictureOf(std::vector<Colour>(10, grey(0)))), 0);
  EXPECT_EQ(fittingExposure(pictureOf(std::vector<Colour>(10, grey(1e-37)))), mostExposure);
}

TEST(ViewTransform, curvesHaveNames) {
  for (const ViewCurve curve : {ViewCurve::standard, ViewCurve::filmic, ViewCurve::agx})
    EXPECT_EQ(curveNamed(curveName(curve)), curve);
  EXPECT_FALSE(curveNamed("Filmic"));
  EXPECT_FALSE(curveNamed(""));
}
