// pick.cpp: rtPick uses the camera's ray: the result equals a ray query along it and matches the
// picture.
#include <memory>

#include "small_scene.h"

namespace {

using namespace abi_test;

class Pick : public SmallScene {
 protected:
  void SetUp() override {
    SmallScene::SetUp();
    const RTid object = rtBeginObject(0);
    rtLoadName(7);
    rtBegin(RT_QUADS);
    squareVertices(0.5f);
    rtEnd();
    rtEndObject();
    place = rtInstantiateObject(object);
    rtInstanceUserData(place, 99);
  }
  RTid place = 0;
};

TEST_F(Pick, AgreesWithARayQuery) {
  rtTranslated(0.3, -0.2, 3);
  rtRotated(10, 0, 1, 0);
  rtPerspective(40);
  rtFrameBuffer(40, 20, RT_RGBA);
  rtRender();
  double m[16];
  rtGetMatrixd(m);
  const double scale = std::tan(20 * 3.14159265358979 / 180);
  int met = 0;
  for (double y = 0.5; y < 20; y += 2.75)
    for (double x = 0.25; x < 40; x += 3.5) {
      const double d[3] = {(2 * x / 40 - 1) * scale * 2, (1 - 2 * y / 20) * scale, -1};
      const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + 1);
      RTray ray{};
      for (int k = 0; k < 3; k++) {
        ray.origin[k] = float(m[12 + k]);
        ray.direction[k] = float((m[k] * d[0] + m[4 + k] * d[1] + m[8 + k] * d[2]) / length);
      }
      ray.tfar = INFINITY;
      RThit cast{}, picked{};
      rtCastRays(1, &ray, &cast);
      EXPECT_EQ(rtPick(x, y, &picked), std::isfinite(cast.t) ? 1 : 0) << x << " " << y;
      if (!std::isfinite(cast.t)) {
        EXPECT_TRUE(std::isinf(picked.t) && picked.instance == 0);
        continue;
      }
      met++;
      EXPECT_NEAR(picked.t, cast.t, 1e-5f * cast.t);
      EXPECT_NEAR(picked.u, cast.u, 1e-5f);
      EXPECT_NEAR(picked.v, cast.v, 1e-5f);
      EXPECT_EQ(picked.instance, place);
      EXPECT_EQ(picked.name, 7u);
      EXPECT_EQ(picked.userData, 99u);
      EXPECT_EQ(picked.primitive, cast.primitive);
      for (int k = 0; k < 3; k++) EXPECT_NEAR(picked.normal[k], cast.normal[k], 1e-6f);
    }
  EXPECT_GT(met, 5);
}

TEST_F(Pick, SeesThroughBacksThatAreNotThere) {
  const RTid object = rtBeginObject(0);
  rtEnable(RT_CULL_FACE);
  rtEnable(RT_CW_FRONT);
  rtLoadName(8);
  rtTranslated(0, 0, 1);
  rtBegin(RT_QUADS);
  squareVertices();
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  rtFrameBuffer(4, 4, RT_RGBA);
  rtRender();
  RThit hit{};
  EXPECT_EQ(rtPick(2, 2, &hit), 1);
  EXPECT_EQ(hit.name, 7u);
  EXPECT_EQ(rtPick(0.5, 0.5, &hit), 0);
  EXPECT_TRUE(std::isinf(hit.t));
}

TEST_F(Pick, FarFromTheWorldsOriginItIsAsExactAsThePicture) {
  rtTranslated(1e7, 0, 0);
  const RTid object = rtBeginObject(0);
  rtBegin(RT_QUADS);
  squareVertices(0.5f);
  rtEnd();
  rtEndObject();
  const RTid far = rtInstantiateObject(object);
  rtTranslated(0, 0, 10);
  rtOrtho(2);
  rtFrameBuffer(16, 16, RT_RGBA);
  rtRender();
  RThit hit{};
  for (int x = 0; x < 16; x++) {
    const bool inside = x >= 4 && x < 12;
    EXPECT_EQ(rtPick(x + 0.5, 8.5, &hit), inside ? 1 : 0) << x;
    if (!inside) continue;
    EXPECT_EQ(hit.instance, far);
    EXPECT_NEAR(hit.t, 10, 1e-4);
  }
}

TEST_F(Pick, ThinLensesLookThroughTheirMiddle) {
  const RTid lens = rtNewShader(rtNewShaderClass("ThinLens", nullptr));
  if (lens == 0) GTEST_SKIP() << (rtGetError(), rtGetErrorMessage());
  rtTranslated(0, 0, 5);
  rtUseCamera(lens);
  rtFrameBuffer(8, 8, RT_RGBA);
  rtRender();
  RThit hit{}, again{};
  EXPECT_EQ(rtPick(4, 4, &hit), 1);
  EXPECT_NEAR(hit.t, 5, 1e-4);
  EXPECT_EQ(rtPick(4, 4, &again), 1);
  EXPECT_EQ(hit.u, again.u);
}

TEST_F(Pick, NeedsAFrameBufferACameraAndACommit) {
  RThit hit{};
  hit.t = 5;
  const auto fails = [&](double x, double y, RThit* to, RTenum code) {
    EXPECT_EQ(rtPick(x, y, to), 0);
    EXPECT_EQ(rtGetError(), code) << rtGetErrorMessage();
    EXPECT_NE(std::string(rtGetErrorMessage()).find("rtPick"), std::string::npos);
    EXPECT_EQ(hit.t, 5);
  };
  fails(1, 1, &hit, RT_INVALID_OPERATION); // no frame buffer
  rtFrameBuffer(4, 4, RT_RGBA);
  fails(1, 1, &hit, RT_INVALID_OPERATION); // nothing committed
  rtRender();
  fails(NAN, 1, &hit, RT_INVALID_VALUE);
  fails(1, INFINITY, &hit, RT_INVALID_VALUE);
  fails(1, 1, nullptr, RT_INVALID_VALUE);
  rtUseCamera(0);
  fails(1, 1, &hit, RT_INVALID_OPERATION);
}

} // namespace
