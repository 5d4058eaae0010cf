// debug_rules.cpp: backend=debug:NAME. Each rule reports its misuse once and is silent about
// correct use.
#include "small_scene.h"

namespace {

using namespace abi_test;

class DebugRules : public SmallScene {
 protected:
  std::string config() const override { return "backend=debug:local threads=1"; }
  RTid square(bool texCoords = false) {
    const RTid object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    if (texCoords) rtTexCoord2f(0.5f, 0.5f);
    squareVertices();
    rtEnd();
    rtEndObject();
    return object;
  }
  RTid placed() { return rtInstantiateObject(square()); }
  // Checks that the rule has reported once so far, with this text.
  void expect(const char* rule, const char* part) {
    picture(1);
    picture(1);
    EXPECT_EQ(log.count(std::string("debug: ") + rule + ": "), 1u) << all();
    EXPECT_TRUE(log.has(part)) << all();
  }
  void expectSilence() {
    picture(1);
    EXPECT_TRUE(log.lines.empty()) << all();
  }
  std::string all() const {
    std::string text;
    for (const std::string& line : log.lines) text += line + "\n";
    return text;
  }
};

TEST_F(DebugRules, SilentWhereNothingIsWrong) {
  shader("Varying", "varying");
  rtInstantiateObject(square());
  rtUseLight(shader("VRML97PointLight", nullptr));
  rtBindShader(0);
  RTid sphere = rtBeginObject(0);
  rtEnable(RT_CULL_FACE);
  rtSphere(0.25f);
  rtEndObject();
  rtScaled(-1, 1, 1); // mirrored, which is valid
  rtInstantiateObject(sphere);
  rtLoadIdentity();
  expectSilence();
}

TEST_F(DebugRules, NoCamera) {
  placed();
  rtUseCamera(0);
  expect("no-camera", "call rtPerspective");
}

TEST_F(DebugRules, ChannelsThatHoldNothing) {
  placed();
  rtFrameBuffer(1, 1, RT_RGBA | RT_VARIANCE | RT_ERROR);
  rtRender();
  EXPECT_EQ(log.count("debug: channels: "), 2u) << all();
  rtFrameBuffer(1, 1, RT_SAMPLES);
  rtRender();
  EXPECT_EQ(log.count("debug: channels: "), 3u) << all();
}

TEST_F(DebugRules, EmptyInstance) {
  RTid object = 0;
  rtGenObjects(1, &object);
  rtInstantiateObject(object);
  expect("empty-instance", "which is empty");
}

TEST_F(DebugRules, SingularMatrix) {
  rtScaled(1, 0, 1);
  placed();
  rtLoadIdentity();
  expect("singular-matrix", "rtInstanceVisible");
}

TEST_F(DebugRules, NeverPlaced) {
  placed();
  square();
  expect("never-placed", "rtInstantiateObject");
}

TEST_F(DebugRules, Redefined) {
  const RTid plain = square(), hinted = rtBeginObject(0);
  rtEndObject();
  rtObjectHint(hinted, RT_DYNAMIC);
  rtInstantiateObject(plain);
  rtInstantiateObject(hinted);
  for (int i = 0; i < 6; i++) {
    for (RTid object : {plain, hinted}) {
      rtBeginObject(object);
      rtBegin(RT_QUADS);
      squareVertices(float(i + 1));
      rtEnd();
      rtEndObject();
    }
    picture(1);
  }
  EXPECT_EQ(log.count("debug: redefined: object " + std::to_string(plain)), 1u) << all();
  EXPECT_EQ(log.lines.size(), 1u) << all();
}

TEST_F(DebugRules, UnusedShaders) {
  placed();
  shader("Everything", "everything");
  shader("Lamp", "everything");
  shader("Sky", "everything");
  picture(1);
  EXPECT_EQ(log.count("debug: unused-shader: "), 3u) << all();
  EXPECT_TRUE(log.has("(Everything) is used by no geometry: call rtBindShader")) << all();
  EXPECT_TRUE(log.has("rtUseLight") && log.has("rtUseEnvironment")) << all();
}

TEST_F(DebugRules, TextureWithoutImage) {
  RTid texture = 0;
  rtGenTextures(1, &texture);
  shader("Everything", "everything");
  rtParameterTexture(rtParameterHandle("texture"), texture);
  rtInstantiateObject(square(true));
  expect("texture-without-image", "rtTexImage2D");
}

TEST_F(DebugRules, TextureOnGeometryWithoutCoordinates) {
  RTid texture = 0;
  rtGenTextures(1, &texture);
  rtBindTexture(texture);
  const unsigned char grey = 128;
  rtTexImage2D(1, 1, 1, RT_UNSIGNED_BYTE, &grey);
  shader("Everything", "everything");
  rtParameterTexture(rtParameterHandle("texture"), texture);
  rtInstantiateObject(square(true));
  expectSilence();
  placed();
  expect("no-texture-coordinates", "rtTexCoord");
}

TEST_F(DebugRules, ParametersUnderAnOverrideOfAnotherClass) {
  shader("Varying", "varying");
  const RTid object = rtBeginObject(0);
  rtBegin(RT_QUADS);
  rtParameter3f(rtParameterHandle("color"), 1, 0, 0);
  squareVertices();
  rtEnd();
  rtEndObject();
  const RTid instance = rtInstantiateObject(object);
  expectSilence();
  rtInstanceShader(instance, shader("Everything", "everything"));
  expect("parameters-ignored", "are ignored");
}

TEST_F(DebugRules, LightsThatReachNothing) {
  const RTid instance = placed();
  const RTid lamp = shader("VRML97PointLight", nullptr);
  rtParameter1f(rtParameterHandle("radius"), 3);
  rtParameter3f(rtParameterHandle("location"), 0, 0, 2);
  const RTid light = rtUseLight(lamp);
  rtBindShader(0);
  expectSilence();
  const double away[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 2, 1};
  rtLightMatrix(light, away);
  expect("useless-light", "its radius is 3.0");
  rtLightScope(rtUseLight(lamp), instance);
  rtDeleteInstance(instance);
  placed();
  picture(1);
  EXPECT_TRUE(log.has("rtLightScope was deleted")) << all();
}

TEST_F(DebugRules, FarFromTheOrigin) {
  const RTid doubles = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3d(1e6, 0, 0.1);
  rtVertex3d(1e6 + 1, 0, 0);
  rtVertex3d(1e6, 1, 0);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(doubles);
  expectSilence();
  const RTid floats = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(1e6f, 0, 0);
  rtVertex3f(1e6f + 1, 0, 0);
  rtVertex3f(1e6f, 1, 0);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(floats);
  expect("far-from-origin", "rtVertex3d");
}

TEST_F(DebugRules, NormalsOnTheOtherSide) {
  for (const float z : {1.0f, -1.0f}) {
    const RTid object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    rtNormal3f(0, 0, z);
    squareVertices();
    rtEnd();
    rtEndObject();
    rtInstantiateObject(object);
    if (z > 0) expectSilence();
  }
  expect("wrong-side", "2 of 2 triangles");
}

TEST_F(DebugRules, ClosedAndInsideOut) {
  const float p[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const uint32_t outwards[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  rtVertexPointer(3, RT_FLOAT, 0, p);
  rtEnable(RT_CULL_FACE);
  for (const bool inwards : {false, true}) {
    const RTid object = rtBeginObject(0);
    if (inwards) rtEnable(RT_CW_FRONT);
    rtDrawElements(RT_TRIANGLES, 12, outwards, 4);
    rtEndObject();
    rtInstantiateObject(object);
    if (!inwards) expectSilence();
  }
  expect("wrong-side", "look inwards");
}

TEST_F(DebugRules, ThePictureIsTheOtherBackends) {
  shader("Nan", "faulty");
  rtInstantiateObject(square());
  EXPECT_EQ(picture(2)[4 + 2], 0.5f);
  EXPECT_EQ(log.count("shader Nan of faulty returned NaN"), 1u);
  RThit hit{};
  EXPECT_EQ(rtPick(1, 1, &hit), 1);
  EXPECT_EQ(stats().leftOut.shaderFaults, 2u);
}

TEST(DebugConfiguration, WrapsAnyBackend) {
  for (const char* good : {"backend=debug:null", "backend=debug:local threads=1"}) {
    const RTcontext context = rtNewContext(good);
    EXPECT_NE(context, nullptr) << good;
    rtDeleteContext(context);
  }
  for (const char* bad :
       {"backend=debug", "backend=debug:", "backend=debug:debug:local", "backend=debug:x"}) {
    EXPECT_EQ(rtNewContext(bad), nullptr) << bad;
    EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE)) << bad;
  }
}

} // namespace
