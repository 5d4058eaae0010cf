// small_scene.h: a context with the test plug-ins and the stock shaders. It shoots one ray down -z
// per pixel and keeps what the library logs. Uses only the public C API.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "openrt/openrt.h"

namespace abi_test {

struct Log {
  std::vector<std::string> lines;
  bool has(const std::string& part) const { return count(part) > 0; }
  size_t count(const std::string& part) const {
    size_t n = 0;
    for (const std::string& line : lines) n += line.find(part) != line.npos;
    return n;
  }
  static void take(int, const char* text, void* self) {
    static_cast<Log*>(self)->lines.emplace_back(text);
  }
};

class SmallScene : public testing::Test {
 protected:
  virtual std::string config() const { return "threads=1"; }
  virtual std::string folders() const { return OPENRT_TEST_PLUGINS; }
  void SetUp() override {
    context = rtNewContext((config() + " shaderpath=\"" + folders() + "\"").c_str());
    ASSERT_NE(context, nullptr) << (rtGetError(), rtGetErrorMessage());
    rtLogCallback(Log::take, &log);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtTranslated(0, 0, 10);
    rtOrtho(2); // the view covers the square from -1 to 1
    rtLoadIdentity();
  }
  void TearDown() override {
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(context);
  }
  RTid shader(const char* name, const char* library) {
    const RTid id = rtNewShader(rtNewShaderClass(name, library));
    EXPECT_NE(id, 0u) << (rtGetError(), rtGetErrorMessage());
    rtBindShader(id);
    return id;
  }
  // Returns the picture: n x n RGBA pixels from the top left corner.
  std::vector<float> picture(int n) {
    rtFrameBuffer(n, n, RT_RGBA);
    rtRender();
    return read(n);
  }
  std::vector<float> read(int n) {
    std::vector<float> pixels(size_t(4) * n * n);
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    return pixels;
  }
  RTstats stats() {
    RTstats s{};
    s.size = sizeof s;
    rtGetStats(&s);
    return s;
  }

  RTcontext context = nullptr;
  Log log;
};

inline void squareVertices(float half = 1) {
  const float corners[4][2] = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  for (const auto& c : corners) rtVertex3f(c[0], c[1], 0);
}

} // namespace abi_test
