// backs.cpp: culled back faces are not there, whatever else lies in the same place.
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

class Backs : public Scene {
 protected:
  static Shader glowing(Vec color) {
    Shader s("VRML97");
    s.setInt("lit", 1)
        .set("emissiveColor", {color.x, color.y, color.z})
        .set("diffuseColor", {0, 0, 0});
    return s;
  }
  // Two triangles that are slightly askew, so that rounding decides which of two coincident ones is
  // hit.
  static void quad(RTid shader, bool reversed) {
    rtBindShader(shader);
    const float a[3] = {-3.1f, -2.7f, 0.13f}, b[3] = {3.3f, -2.9f, -0.29f},
                c[3] = {2.9f, 3.1f, 0.17f}, d[3] = {-2.8f, 2.6f, 0.41f};
    rtBegin(RT_TRIANGLES);
    for (const float* v : reversed ? std::vector<const float*>{c, b, a, d, c, a}
                                   : std::vector<const float*>{a, b, c, a, c, d})
      rtVertex3fv(v);
    rtEnd();
  }
  static std::vector<float> picture(int size) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0.1, -0.2, 9);
    rtPerspective(25);
    rtPopMatrix();
    rtFrameBuffer(size, size, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 4);
    rtRender();
    std::vector<float> pixels(size_t(size) * size * 4);
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    return pixels;
  }
  static void expectAll(const std::vector<float>& pixels, Vec color) {
    size_t wrong = 0;
    for (size_t i = 0; i < pixels.size(); i += 4)
      wrong += pixels[i] != float(color.x) || pixels[i + 1] != float(color.y) ||
               pixels[i + 2] != float(color.z);
    EXPECT_EQ(wrong, 0u) << "of " << pixels.size() / 4 << " pixels";
  }
};

TEST_F(Backs, aFaceAndABackInTheSamePlaceDoNotHideEachOther) {
  const Shader front = glowing({0, 1, 0}), back = glowing({1, 0, 0}), behind = glowing({0, 0, 1});
  const RTid object = rtBeginObject(0);
  rtEnable(RT_CULL_FACE);
  quad(back, true);
  quad(front, false);
  rtTranslatef(0, 0, -1);
  rtScalef(2, 2, 1);
  quad(behind, false);
  rtEndObject();
  rtInstantiateObject(object);
  expectAll(picture(64), {0, 1, 0});
}

TEST_F(Backs, manyBacksOneAfterTheOtherAreLookedThrough) {
  const Shader back = glowing({1, 0, 0}), last = glowing({0, 0, 1});
  const RTid object = rtBeginObject(0);
  rtEnable(RT_CULL_FACE);
  rtPushMatrix();
  for (int i = 0; i < 300; i++) {
    rtTranslatef(0, 0, -0.01f);
    quad(back, true);
  }
  rtPopMatrix();
  rtTranslatef(0, 0, -5);
  rtScalef(3, 3, 1);
  quad(last, false);
  rtEndObject();
  rtInstantiateObject(object);
  rtQuality(RT_MAX_DEPTH, 0); // back faces do not count as path vertices
  expectAll(picture(32), {0, 0, 1});
}

TEST_F(Backs, instancesAreLookedThroughToo) {
  const Shader back = glowing({1, 0, 0}), last = glowing({0, 0, 1});
  const RTid one = rtBeginObject(0);
  rtEnable(RT_CULL_FACE);
  for (int i = 0; i < 30000; i++) quad(back, true); // too many to be baked
  rtEndObject();
  for (int i = 0; i < 3; i++) {
    rtPushMatrix();
    rtTranslatef(0, 0, float(-i));
    rtScalef(i == 1 ? -1.0f : 1.0f, 1, 1); // a mirrored instance keeps its front
    rtInstantiateObject(one);
    rtPopMatrix();
  }
  rtTranslatef(0, 0, -6);
  rtScalef(3, 3, 1);
  const RTid two = rtBeginObject(0);
  quad(last, false);
  rtEndObject();
  rtInstantiateObject(two);
  expectAll(picture(16), {0, 0, 1});
}

TEST_F(Backs, anEyeWithinThePlaneOfAFace) {
  const Shader ground = glowing({0, 1, 0});
  const RTid object = rtBeginObject(0);
  rtEnable(RT_CULL_FACE);
  rtBindShader(ground);
  rtBegin(RT_QUADS);
  for (const auto& c : {Vec{-50, 0, -50}, Vec{-50, 0, 50}, Vec{50, 0, 50}, Vec{50, 0, -50}})
    rtVertex3d(c.x, c.y, c.z);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(0, 0, 10);
  rtPerspective(45);
  rtPopMatrix();
  rtFrameBuffer(16, 16, RT_RGBA);
  rtRender();
  float pixels[16 * 16 * 4];
  rtReadPixels(RT_RGBA, pixels, sizeof pixels / sizeof *pixels);
  EXPECT_EQ(pixels[4 * (2 * 16 + 8) + 1], 0);  // above the horizon: nothing
  EXPECT_EQ(pixels[4 * (13 * 16 + 8) + 1], 1); // below: the ground
}

// VRML's solid bodies have culled back faces. A glass body has an inside all the same.
TEST_F(Backs, bodiesOfGlassKeepTheirBacks) {
  Shader glass("Glass");
  glass.set("absorption", {0.1, 0.5, 2}).set("index", {1.0});
  const Shader behind = glowing({1, 1, 1});
  std::vector<float> pictures[2];
  for (const bool cull : {false, true}) {
    const RTid object = rtBeginObject(0);
    (cull ? rtEnable : rtDisable)(RT_CULL_FACE);
    rtBindShader(glass);
    rtBegin(RT_QUADS);
    for (const float z : {0.5f, -0.5f}) // a slab of thickness 1, wider than the picture
      for (int i = 0; i < 4; i++)
        rtVertex3f((i == 0 || i == 3) == (z > 0) ? -9.0f : 9.0f, i < 2 ? -9.0f : 9.0f, z);
    rtEnd();
    rtTranslatef(0, 0, -3);
    rtScalef(4, 4, 1);
    quad(behind, false);
    rtEndObject();
    const RTid instance = rtInstantiateObject(object);
    pictures[cull] = picture(8);
    rtDeleteInstance(instance);
  }
  EXPECT_EQ(pictures[0], pictures[1]);
  expectClose(pictures[1][4 * 36 + 1], std::exp(-0.5),
              1e-2); // near normal incidence, and the ray ends behind the slab
}

} // namespace
} // namespace numeric
