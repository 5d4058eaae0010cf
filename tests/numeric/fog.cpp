// fog.cpp: fog in front of surfaces that send on light of other surfaces. It belongs to what is
// seen: it dims the light on its way from the first surface that scatters it to the eye, and no
// other (lights/environment.h).
#include <cmath>
#include <string>
#include <vector>

#include "numeric/lamp_scene.h"

namespace numeric {
namespace {

class FogOfPaths : public Lamps {
 protected:
  // Linear fog from the eye to a distance.
  static Shader air(double range, double grey = 0) {
    return Shader("VRML97Environment")
        .setInt("fogType", 1)
        .set("fogRange", {range})
        .set("fogColor", {grey, grey, grey});
  }
  static void fog(double range, double grey = 0) { rtUseEnvironment(air(range, grey)); }
  static std::vector<float> picture(int edge, int samples) {
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    return Scene::picture(edge);
  }
  // A matt ceiling over a mirror, and between them a lamp that lights the mirror alone. A parallel
  // view from below sees a part of the ceiling, one unit away. Returns the ceiling.
  static RTid lampOverMirror(double width) {
    placeAt(0, square(Shader("Mirror"), 2));
    placeAt(1, square(matt(0, 100), .05));
    placeAt(1.01, square(matt(0), .1));
    const RTid ceiling = placeAt(2, square(matt(.5), 10), true);
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(.7, 0, 1, .7, 0, 2, 0, 1, 0);
    rtOrtho(width);
    rtPopMatrix();
    return ceiling;
  }
  // Expects of pictures of width 1 that one is the other behind a fog that ends at 2.5. Camera
  // paths and light paths have the same random numbers in both. Returns the number of lit pixels.
  static int expectDimmed(const std::vector<float>& clear, const std::vector<float>& dim) {
    int lit = 0;
    for (size_t i = 0; i < size_t(edge) * edge; i++) {
      const double x = (double(i % edge) + .5) / edge - .5, y = (double(i / edge) + .5) / edge - .5,
                   left = 1 - std::sqrt(1 + x * x + y * y) / 2.5, before = double(clear[4 * i]);
      lit += before > 0;
      EXPECT_NEAR(double(dim[4 * i]), left * before, .01 * before) << i;
    }
    return lit;
  }
  static constexpr int edge = 32, fewSamples = 15; // too few samples for photons and trials
};

TEST_F(FogOfPaths, ItDimsLightByTheDistanceFromTheEye) {
  lampOverMirror(1);
  rtQuality(RT_MAX_DEPTH, 3);
  for (const int transport : {RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
    rtQuality(RT_TRANSPORT, transport);
    fog(1e30);
    const std::vector<float> clear = picture(edge, fewSamples);
    fog(2.5);
    const int lit = expectDimmed(clear, picture(edge, fewSamples));
    EXPECT_EQ(stats().transport.chosen, RTenum(transport));
    EXPECT_GT(lit, transport == RT_TRANSPORT_LIGHT ? 100 : 2);
  }
}

// The fog of an instance dims the light that light paths bring there, too.
TEST_F(FogOfPaths, TheFogOfAnInstanceDimsTheLightOfLightPaths) {
  const RTid ceiling = lampOverMirror(1);
  rtQuality(RT_MAX_DEPTH, 3);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  const std::vector<float> clear = picture(edge, fewSamples);
  rtInstanceFog(ceiling, air(2.5));
  EXPECT_GT(expectDimmed(clear, picture(edge, fewSamples)), 100);
}

// The same where photons guide rays to the mirror: pixels have other random numbers then.
TEST_F(FogOfPaths, ItDimsTheLightOfGuidedRays) {
  lampOverMirror(.01);
  rtQuality(RT_MAX_DEPTH, 2);
  const double clear = Scene::mean(picture(4, 1024));
  fog(2.5);
  const double dim = Scene::mean(picture(4, 1024));
  EXPECT_NE(std::string(stats().transport.reason).find("guided"), std::string::npos);
  EXPECT_NEAR(dim, .6 * clear, .01 * clear);
}

// Inside a furnace everything has the radiance 1, however often light is reflected.
TEST_F(FogOfPaths, AFurnaceHasItsRadianceBehindTheFog) {
  const RTid furnace = rtBeginObject(0);
  rtBindShader(matt(.5, .5));
  rtSphere(4);
  rtEndObject();
  rtBindShader(0);
  place(furnace);
  rtQuality(RT_MAX_DEPTH, 30);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  rtPushMatrix();
  rtLoadIdentity();
  rtPerspective(1e-3);
  rtPopMatrix();
  fog(10, .25);
  expectGrey(render(), .6 + .4 * .25, .01);
  fog(4, .25); // hides all, also what the wall reflects
  expectGrey(render(), .25);
}

// Mirror images have the fog of the whole path.
TEST_F(FogOfPaths, AMirrorShowsTheFogOfTheWholePath) {
  placeAt(0, square(Shader("Mirror").set("reflectance", {1, 1, 1}), 2));
  placeAt(3, square(matt(0, 1), 20), true);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4);
  fog(10, .25);
  expectGrey(lookFrom(2), .5 + .5 * .25);
}

} // namespace
} // namespace numeric
