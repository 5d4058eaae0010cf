// mapper_history.h: compares a world that was mapped once and then changed many times with the same
// world mapped from scratch.
#pragma once

#include <cstring>
#include <random>

#include "unit/mapper_fixture.h"

namespace xvrml::test {

class MapHistory : public MapRunning {
 protected:
  static constexpr int width = 48, height = 36;

  static std::vector<float> picture(OpenRTMapper& mapper, const CameraSettings& camera) {
    mapper.map(camera);
    rtFrameBuffer(width, height, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 2);
    rtRender();
    std::vector<float> pixels(size_t(4) * width * height);
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    return pixels;
  }

  // sameObjects: objects must be the same, too. The level of an LOD that is not chosen keeps its
  // object, so they differ where the distance to an LOD changes.
  void expectAsFromNothing(const std::string& what, bool sameObjects = true) {
    mapper_->update(engine_->takeChanges());
    const CameraSettings camera = mapper_->viewpointCamera(0);
    const std::vector<float> changed = picture(*mapper_, camera);
    const std::vector<std::string> structureChanged = structure(*mapper_);
    RTcontext other = rtNewContext("threads=1");
    {
      OpenRTMapper fresh(*world_, MapOptions());
      const std::vector<float> scratch = picture(fresh, camera);
      if (sameObjects) { EXPECT_EQ(structureChanged, structure(fresh)) << what; }
      size_t different = 0;
      float largest = 0;
      for (size_t i = 0; i < scratch.size(); ++i) {
        different += std::memcmp(&scratch[i], &changed[i], sizeof(float)) != 0;
        largest = std::max(largest, std::abs(scratch[i] - changed[i]));
      }
      EXPECT_EQ(different, 0u) << what << ", by at most " << largest;
      EXPECT_EQ(mapper_->stats().triangles, fresh.stats().triangles) << what;
      EXPECT_EQ(mapper_->stats().lights, fresh.stats().lights) << what;
      EXPECT_EQ(mapper_->viewpoints().size(), fresh.viewpoints().size()) << what;
    }
    rtDeleteContext(other);
    rtMakeCurrent(context_);
  }

  std::mt19937 random_;
  float number(double low, double high) {
    return float(std::uniform_real_distribution<double>(low, high)(random_));
  }
  size_t below(size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random_); }
  Vec3f vector(double reach) {
    return {number(-reach, reach), number(-reach, reach), number(-reach, reach)};
  }
  Color color() { return {number(0, 1), number(0, 1), number(0, 1)}; }
};

} // namespace xvrml::test
