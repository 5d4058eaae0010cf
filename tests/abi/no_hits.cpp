// no_hits.cpp: host functions that describe hits write the promised values for batches without
// hits: of transports, cameras and environments.
#include "small_scene.h"

namespace {

using namespace abi_test;

class NoHits : public SmallScene {
 protected:
  RTid named(const char* name) {
    const RTid id = rtNewShader(rtNewShaderClass(name, "no_hits"));
    EXPECT_NE(id, 0u) << (rtGetError(), rtGetErrorMessage());
    return id;
  }
};

TEST_F(NoHits, ATransportReadsTheValuesOfAPathThatBegins) {
  rtUseTransport(named("NoHitsTransport"));
  const std::vector<float> pixels = picture(5); // not a multiple of RTS_LANES
  for (size_t i = 0; i < pixels.size(); i++) EXPECT_EQ(pixels[i], 1.0f) << i;
  EXPECT_EQ(stats().leftOut.shaderFaults, 0u);
}

TEST_F(NoHits, ACameraAndAnEnvironmentReadThemToo) {
  rtUseCamera(named("NoHitsCamera"));
  rtUseEnvironment(named("NoHitsEnvironment"));
  const std::vector<float> pixels = picture(5);
  for (size_t i = 0; i < pixels.size(); i += 4) {
    EXPECT_EQ(pixels[i], 1.0f) << "facts in miss, pixel " << i / 4;
    EXPECT_EQ(pixels[i + 1], 1.0f) << "facts in generate, pixel " << i / 4;
    EXPECT_EQ(pixels[i + 2], 1.0f) << "random points in miss, pixel " << i / 4;
  }
  EXPECT_EQ(stats().leftOut.shaderFaults, 0u);
}

} // namespace
