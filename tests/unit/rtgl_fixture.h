// rtgl_fixture.h: A context with the calls of OpenGL, a picture of 32 x 32 pixels and a parallel
// view of -1 to 1, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#define OPENRT_GL_NO_RT_NAMES
#include "openrt/gl.h"

class Gl : public testing::Test {
 protected:
  void SetUp() override {
    context_ = rtNewContext("threads=2");
    ASSERT_NE(context_, nullptr);
    rtglErrorCallback(
        [](RTenum, const char* message, void* user) {
          static_cast<std::vector<std::string>*>(user)->push_back(message);
        },
        &messages);
    rtglLight(RTGL_OPENGL);
    rtglSamples(1);
    glViewport(0, 0, 32, 32);
    glEnable(GL_DEPTH_TEST);
    glMatrixMode(GL_PROJECTION);
    glOrtho(-1, 1, -1, 1, -1, 1);
    glMatrixMode(GL_MODELVIEW);
  }
  void TearDown() override {
    rtglReset();
    rtDeleteContext(context_);
  }
  static void clear() { glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT); }
  static std::vector<int> pixel(int x, int y) {
    GLubyte rgb[3];
    glReadPixels(x, y, 1, 1, GL_RGB, GL_UNSIGNED_BYTE, rgb);
    return {rgb[0], rgb[1], rgb[2]};
  }
  static RTstats stats() {
    RTstats s{};
    s.size = sizeof(s);
    rtGetStats(&s);
    return s;
  }
  static void expectNear(const std::vector<int>& is, const std::vector<int>& wanted) {
    for (size_t c = 0; c < 3; c++) EXPECT_NEAR(is[c], wanted[c], 1) << "colour " << c;
  }
  std::vector<std::string> messages;

 private:
  RTcontext context_ = nullptr;
};

inline void square(float size) { glRectf(-size, -size, size, size); }
