// rtgl_hostile_calls.cpp: Tests that numbers, sizes and names that no program means do no harm.
#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <vector>

#define OPENRT_GL_NO_RT_NAMES
#include "openrt/gl.h"

namespace {

constexpr GLuint largest = ~GLuint(0);

struct HostileGl : testing::Test {
  HostileGl() : context(rtNewContext("threads=2")) {
    rtglSamples(1);
    glViewport(0, 0, 8, 8);
  }
  ~HostileGl() override {
    rtglReset();
    rtDeleteContext(context);
  }
  // Expects that the last call had this error, and no other.
  static void expectError(int error) {
    EXPECT_EQ(glGetError(), GLenum(error));
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
  }
  RTcontext context;
};

TEST_F(HostileGl, NamesAtTheEndOfTheirRange) {
  for (const GLuint name : {GLuint(1), GLuint(2), GLuint(9), largest}) {
    glNewList(name, GL_COMPILE);
    glEndList();
  }
  EXPECT_EQ(glGenLists(3), 3u) << "the first gap";
  EXPECT_EQ(glGenLists(4), 10u);
  glDeleteLists(largest, 2);
  EXPECT_FALSE(glIsList(largest));
  EXPECT_TRUE(glIsList(1));
  glDeleteLists(2, INT_MAX);
  EXPECT_FALSE(glIsList(9));
  EXPECT_TRUE(glIsList(1));
  expectError(GL_NO_ERROR);
  EXPECT_EQ(glGenLists(INT_MAX), 0u);
  expectError(GL_OUT_OF_MEMORY);
  glBindTexture(GL_TEXTURE_2D, largest);
  GLuint names[2] = {};
  glGenTextures(2, names);
  EXPECT_NE(names[0], 0u);
  EXPECT_NE(names[1], 0u);
  EXPECT_NE(names[0], names[1]);
  expectError(GL_NO_ERROR);
}

TEST_F(HostileGl, SizesThatNothingHas) {
  glTexImage2D(GL_TEXTURE_2D, 0, 4, INT_MAX, INT_MAX, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  expectError(GL_INVALID_VALUE);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 3);
  expectError(GL_INVALID_VALUE);
  glViewport(0, 0, INT_MAX, INT_MAX);
  GLint viewport[4] = {};
  glGetIntegerv(GL_VIEWPORT, viewport);
  EXPECT_EQ(viewport[2], 8);
  expectError(GL_INVALID_VALUE);
  glViewport(0, 0, INT_MAX, 1);
  glGetIntegerv(GL_VIEWPORT, viewport);
  EXPECT_EQ(viewport[2], 65536);
  expectError(GL_NO_ERROR);
  RTUquadric* const quadric = rtuNewQuadric();
  rtuSphere(quadric, 1, INT_MAX, INT_MAX);
  expectError(GL_OUT_OF_MEMORY);
  rtuDeleteQuadric(quadric);
  rtuQuadricDrawStyle(nullptr, RTU_LINE);
  rtuSphere(nullptr, 1, 8, 8);
  expectError(GL_INVALID_VALUE);
}

TEST_F(HostileGl, PixelsOutsideOfThePictureAreLeftAlone) {
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ASSERT_TRUE(rtglEndFrame());
  std::vector<GLubyte> bytes(3 * 16 * 16, 7);
  glReadPixels(-4, -4, 16, 16, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
  EXPECT_EQ(bytes[0], 7);
  EXPECT_EQ(bytes[size_t(3) * (16 * 4 + 4)], 255);
  EXPECT_EQ(bytes[size_t(3) * (16 * 11 + 11)], 255);
  EXPECT_EQ(bytes[size_t(3) * (16 * 12 + 12)], 7);
  GLubyte one[3] = {7, 7, 7};
  for (const GLint at : {INT_MAX, INT_MIN}) {
    glReadPixels(at, at, INT_MAX, INT_MAX, GL_RGB, GL_UNSIGNED_BYTE, one);
    EXPECT_EQ(one[0], 7);
  }
  expectError(GL_NO_ERROR);
}

TEST_F(HostileGl, NumbersThatAreNoIntegers) {
  glFogf(GL_FOG_MODE, NAN);
  expectError(GL_INVALID_ENUM);
  glFogf(GL_FOG_MODE, -1e30f);
  expectError(GL_INVALID_ENUM);
  glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, INFINITY);
  expectError(GL_INVALID_ENUM);
  glTexEnvf(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, -INFINITY);
  const GLfloat lists[] = {NAN, INFINITY, -1};
  glCallLists(3, GL_FLOAT, lists);
  GLint number = 0;
  glFogf(GL_FOG_END, 1e30f);
  glGetIntegerv(GL_FOG_END, &number);
  EXPECT_EQ(number, INT_MAX);
  glFogf(GL_FOG_END, -1e30f);
  glGetIntegerv(GL_FOG_END, &number);
  EXPECT_EQ(number, INT_MIN);
  glFogf(GL_FOG_END, NAN);
  glGetIntegerv(GL_FOG_END, &number);
  EXPECT_EQ(number, 0);
  glLineWidth(1.75f);
  glGetIntegerv(GL_LINE_WIDTH, &number);
  EXPECT_EQ(number, 2) << "rounded";
  GLint color[4] = {};
  glColor4f(2, -3, 1, 0);
  glGetIntegerv(GL_CURRENT_COLOR, color);
  EXPECT_EQ(color[0], INT_MAX);
  EXPECT_EQ(color[1], INT_MIN);
  EXPECT_EQ(color[2], INT_MAX);
  EXPECT_EQ(color[3], 0);
  const GLfloat grey[] = {NAN, -1, 2};
  glTexImage2D(GL_TEXTURE_2D, 0, 1, 3, 1, 0, GL_LUMINANCE, GL_FLOAT, grey);
  expectError(GL_NO_ERROR);
}

TEST_F(HostileGl, ArraysMayStandAtAnyAddress) {
  std::vector<GLubyte> bytes(4 * 13 + 1);
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(3, GL_FLOAT, 13, bytes.data() + 1);
  glDrawArrays(GL_QUADS, 0, 4);
  expectError(GL_NO_ERROR);
}

TEST_F(HostileGl, ClientStateIsRestoredAsItsMaskSays) {
  const GLfloat a[4] = {}, b[4] = {};
  glVertexPointer(3, GL_FLOAT, 0, a);
  glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glVertexPointer(3, GL_FLOAT, 0, b);
  glPopClientAttrib();
  GLint alignment = 0;
  glGetIntegerv(GL_PACK_ALIGNMENT, &alignment);
  EXPECT_EQ(alignment, 4);
  GLvoid* pointer = nullptr;
  glGetPointerv(GL_VERTEX_ARRAY_POINTER, &pointer);
  EXPECT_EQ(pointer, b);
}

TEST_F(HostileGl, ValuesThatNoEnumerationHas) {
  glPolygonMode(GL_LINE, GL_LINE);
  expectError(GL_INVALID_ENUM);
  glColorMaterial(GL_LINE, GL_DIFFUSE);
  expectError(GL_INVALID_ENUM);
  glColorMaterial(GL_FRONT, GL_LINE);
  expectError(GL_INVALID_ENUM);
}

TEST_F(HostileGl, ListsThatCallThemselvesEnd) {
  glNewList(1, GL_COMPILE);
  glTranslatef(1, 0, 0);
  glCallList(1);
  glEndList();
  for (int i = 0; i < 3; i++) {
    glLoadIdentity();
    glCallList(1);
    GLdouble m[16];
    glGetDoublev(GL_MODELVIEW_MATRIX, m);
    EXPECT_EQ(m[12], 64);
  }
}

} // namespace
