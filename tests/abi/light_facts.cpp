// light_facts.cpp: a light reads the same facts about its hits whether it is evaluated for all of
// them or sampled. Path tracing samples lights when there are more than 16.
#include "small_scene.h"

namespace {

using namespace abi_test;

void corner(float x, float y) {
  rtTexCoord2f(x, y);
  rtVertex3f(x - 0.5f, y, 0);
}

class LightFacts : public SmallScene, public testing::WithParamInterface<int> {};

TEST_P(LightFacts, AreThoseOfItsOwnHits) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH); // the others evaluate every light
  const RTid lamp = rtNewShaderClass("LightFacts", "light_facts");
  rtTranslated(0, 0, 3);
  for (int i = 0; i < GetParam(); i++) rtUseLight(rtNewShader(lamp));
  rtLoadIdentity();
  shader("SumOfLights", "light_facts");

  rtLoadName(77);
  const RTid square = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  corner(-1, -1);
  corner(1, -1);
  corner(1, 1);
  corner(-1, -1);
  corner(1, 1);
  corner(-1, 1);
  rtEnd();
  rtEndObject();
  rtTranslated(0.5, 0, 0);
  rtInstantiateObject(square);
  rtLoadIdentity();

  rtLoadName(78);
  const RTid wall = rtBeginObject(0);
  rtBegin(RT_QUADS);
  rtVertex3f(2, -5, -1);
  rtVertex3f(2, 0, -1);
  rtVertex3f(2, 0, 9);
  rtVertex3f(2, -5, 9);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(wall);

  const std::vector<float> pixels = picture(16);
  for (size_t i = 0; i < pixels.size(); i += 4) {
    EXPECT_EQ(pixels[i], 0.0f) << "wrong facts, pixel " << i / 4;
    EXPECT_GT(pixels[i + 1], 0.0f) << "no light, pixel " << i / 4;
  }
  EXPECT_EQ(stats().leftOut.shaderFaults, 0u);
}

INSTANTIATE_TEST_SUITE_P(Lights, LightFacts, testing::Values(1, 16, 17, 40));

} // namespace
