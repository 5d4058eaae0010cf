// older_minors.cpp: plug-ins built for ABI 1.0 and 1.1 still render the same.
#include "small_scene.h"

namespace {

using namespace abi_test;

class OlderMinors : public SmallScene, public testing::WithParamInterface<const char*> {};

TEST_P(OlderMinors, DrawAsEver) {
  for (const int transport : {RT_TRANSPORT_AUTO, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, transport);
    shader("Example", GetParam());
    rtParameter1f(rtParameterHandle("b"), 1);
    const RTid object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    squareVertices();
    rtEnd();
    rtEndObject();
    rtInstantiateObject(object);
    const std::vector<float> pixel = picture(1);
    EXPECT_EQ(pixel[0], 0.0f);
    EXPECT_EQ(pixel[1], 0.5f) << transport;
    EXPECT_EQ(stats().shaderFaults, 0u);
  }
  EXPECT_TRUE(log.lines.empty()) << log.lines.front();
}

TEST_F(SmallScene, AMirrorOfAbi11IsFollowed) {
  shader("Mirror11", "mirror11");
  const RTid object = rtBeginObject(0);
  rtBegin(RT_QUADS);
  squareVertices();
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  rtTranslated(0, 0, 20);
  shader("Example", "minor_0"); // an emissive shader for the square behind the camera
  const RTid lamp = rtBeginObject(0);
  rtBegin(RT_QUADS);
  squareVertices();
  rtEnd();
  rtEndObject();
  rtInstantiateObject(lamp);
  rtLoadIdentity();
  EXPECT_EQ(picture(1)[1], 0.5f);
  EXPECT_EQ(stats().transport, RTenum(RT_TRANSPORT_WHITTED));
}

INSTANTIATE_TEST_SUITE_P(Abi, OlderMinors,
                         testing::Values("older_class", "minor_0", "minor_1", "class_truncated"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
