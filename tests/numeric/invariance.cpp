// invariance.cpp: the same scene, moved or scaled, gives the same picture: N1, N2 and G10 of the
// accuracy catalogue. Lights measure distances in their own space, so their attenuation scales with
// the scene.
#include <algorithm>
#include <functional>

#include "numeric/support.h"

namespace numeric {
namespace {

class Invariance : public Scene {
 protected:
  static constexpr int size = 32;

  // Renders a floor, a tilted square with a shadow, a sphere, a near lamp and fog, all under the
  // current matrix.
  static std::vector<float> picture(const std::function<void()>& placement) {
    std::vector<RTid> made;
    rtLoadIdentity();
    placement();
    const auto put = [&](RTid object, double x, double y, double z, double turn, double scale) {
      rtPushMatrix();
      rtTranslated(x, y, z);
      rtRotated(turn, 1, .3, 0);
      rtScaled(scale, scale, scale);
      made.push_back(place(object));
      rtPopMatrix();
    };
    put(square(Shader("VRML97").set("diffuseColor", {.9, .6, .3})), 0, -1, 0, -90, 1);
    put(square(Shader("VRML97").set("specularColor", {.5, .5, .5}), 1), .8, .5, .2, -25, .6);
    const RTid ball = rtBeginObject(0);
    rtBindShader(Shader("VRML97").set("diffuseColor", {.2, .4, .9}));
    rtSphere(.7f);
    rtEndObject();
    rtBindShader(0);
    put(ball, -.7, -.3, 0, 0, 1);
    const RTid lamp = use(point({1, 3, 2}, {0, 0, .1}).set("intensity", {1.5}));
    const RTid sun =
        use(directional({-.3, -1, -.4}).set("intensity", {.3}).set("ambientIntensity", {.3}));
    rtTranslated(0, .5, 5);
    rtPerspective(40);
    rtFrameBuffer(size, size, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtRender();
    std::vector<float> pixels(size_t(4 * size * size));
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    for (RTid instance : made) rtDeleteInstance(instance);
    rtRemoveLight(lamp);
    rtRemoveLight(sun);
    return pixels;
  }

  // Returns the number of pixels that differ by more than the tolerance. A sample at the edge of a
  // silhouette or shadow may fall to the other side.
  static int different(const std::vector<float>& a, const std::vector<float>& b, double relative) {
    int count = 0;
    for (size_t i = 0; i < a.size(); i += 4) {
      bool same = true;
      for (size_t c = 0; c < 4; c++)
        same = same &&
               std::fabs(a[i + c] - b[i + c]) <=
                   relative * std::max(.1f, std::max(std::fabs(a[i + c]), std::fabs(b[i + c])));
      count += !same;
    }
    return count;
  }
};

TEST_F(Invariance, TheSceneIsNotEmpty) {
  const std::vector<float> base = picture([] {});
  int shapes = 0;
  for (size_t i = 0; i < base.size(); i += 4) shapes += base[i + 3] > 0;
  EXPECT_GT(shapes, size * size / 3);
  EXPECT_LT(shapes, size * size);
}

TEST_F(Invariance, N1ScaleLadder) {
  const std::vector<float> base = picture([] {});
  for (const double s : {1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6, 1e8}) {
    const std::vector<float> scaled = picture([s] { rtScaled(s, s, s); });
    EXPECT_LE(different(base, scaled, 1e-4), 2) << s;
  }
}

TEST_F(Invariance, N2OffsetLadder) {
  const std::vector<float> base = picture([] {});
  for (const double d : {1e1, 1e3, 1e5, 1e6, 1e7, 1e9}) {
    const std::vector<float> moved = picture([d] { rtTranslated(d, -d, d / 3); });
    EXPECT_LE(different(base, moved, 1e-4), 2) << d;
  }
}

TEST_F(Invariance, TurnedAndMirrored) {
  const std::vector<float> base = picture([] {});
  for (const double angle : {30., 117., 250.}) {
    const std::vector<float> turned = picture([angle] { rtRotated(angle, 1, 2, -.5); });
    EXPECT_LE(different(base, turned, 1e-4), 2) << angle;
  }
  const std::vector<float> mirrored = picture([] { rtScaled(1, 1, -1); });
  EXPECT_LE(different(base, mirrored, 1e-4), 2);
}

} // namespace
} // namespace numeric
