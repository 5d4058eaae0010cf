// prepare.cpp: shaders with prepare(): it is called once for each new set of parameters and undone
// when the set goes. Also the values that a class refuses. Uses the C API and the plug-in
// prepared.cc.
#include <dlfcn.h>

#include <string>

#include <gtest/gtest.h>

#include "openrt/openrt.h"

namespace {

std::string logged;

class Prepare : public testing::Test {
 protected:
  void SetUp() override {
    logged.clear();
    const std::string config = "threads=1 shaderpath=" + std::string(OPENRT_TEST_PLUGINS);
    context_ = rtNewContext(config.c_str());
    ASSERT_NE(context_, nullptr);
    rtLogCallback([](int, const char* text, void*) { logged += std::string(text) + "\n"; },
                  nullptr);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtFrameBuffer(1, 1, RT_RGBA);
    shader_ = rtNewShader(rtNewShaderClass("Tripled", "prepared"));
    const RTid object = rtBeginObject(0);
    rtBindShader(shader_);
    rtSphere(1);
    rtEndObject();
    rtInstantiateObject(object);
    rtPushMatrix();
    rtTranslated(0, 0, 5);
    rtOrtho(.1);
    rtPopMatrix();
  }
  void TearDown() override {
    if (!context_) return;
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(context_);
  }
  void gain(float value) {
    rtBindShader(shader_);
    rtParameter1f(rtParameterHandle("gain"), value);
    rtBindShader(0);
  }
  static float render(int component) {
    rtRender();
    float rgba[4];
    rtReadPixels(RT_RGBA, rgba, 4);
    return rgba[component];
  }
  RTcontext context_ = nullptr;
  RTid shader_ = 0;
};

TEST_F(Prepare, ComesBeforeAnythingElseAndAnewForNewValues) {
  EXPECT_EQ(render(0), 3);
  gain(2);
  EXPECT_EQ(render(0), 6);
  EXPECT_EQ(render(0), 6);
}

TEST_F(Prepare, WhatAClassRefusesIsSaidAndNotRendered) {
  gain(-1);
  const float unlit = render(0);
  EXPECT_EQ(unlit, 0) << "the default surface without lights";
  EXPECT_NE(logged.find("Tripled: gain: negative"), std::string::npos) << logged;
  gain(1);
  EXPECT_EQ(render(0), 3) << "and comes back with better values";
}

TEST_F(Prepare, IsUndoneWhenTheValuesGo) {
  for (int k = 1; k <= 5; k++) {
    gain(float(k));
    EXPECT_LE(render(1), 3) << "blocks that no picture uses any more are kept";
  }
  void* library = dlopen(OPENRT_TEST_PLUGINS "/prepared.so", RTLD_NOW | RTLD_NOLOAD);
  ASSERT_NE(library, nullptr);
  const auto alive = reinterpret_cast<int (*)()>(dlsym(library, "preparedAndNotReleased"));
  ASSERT_NE(alive, nullptr);
  EXPECT_GE(alive(), 1);
  rtDeleteContext(context_);
  context_ = nullptr;
  EXPECT_EQ(alive(), 0);
  dlclose(library);
}

} // namespace
