// rtgl_selection.cpp: Tests of what does not come into the scene: the selection mode, what lies
// over the picture, and calls that ask for too much.
#include <climits>

#include "unit/rtgl_fixture.h"

namespace {

TEST_F(Gl, SelectionWritesNamesAndDepthsAndDrawsNothing) {
  GLuint hits[16] = {};
  glRenderMode(GL_SELECT); // has no buffer
  EXPECT_EQ(glGetError(), GLenum(GL_INVALID_OPERATION));
  glSelectBuffer(16, hits);
  EXPECT_EQ(glRenderMode(GL_SELECT), 0);
  GLint mode = 0, depth = 0;
  glInitNames();
  glLoadName(7); // the stack is empty
  EXPECT_EQ(glGetError(), GLenum(GL_INVALID_OPERATION));
  glPushName(5);
  glGetIntegerv(GL_RENDER_MODE, &mode);
  glGetIntegerv(GL_NAME_STACK_DEPTH, &depth);
  EXPECT_EQ(mode, GL_SELECT);
  EXPECT_EQ(depth, 1);
  clear();
  square(0.5f);
  glTranslatef(0, 0, 0.5f);
  square(0.5f);
  glLoadName(6);
  glTranslatef(5, 0, 0);
  square(0.5f); // outside of the view
  EXPECT_EQ(glRenderMode(GL_RENDER), 1);
  EXPECT_EQ(hits[0], 1u);
  EXPECT_NEAR(hits[1] / 4294967295.0, 0.25, 1e-6); // z = 0.5 is nearer to the eye
  EXPECT_NEAR(hits[2] / 4294967295.0, 0.5, 1e-6);
  EXPECT_EQ(hits[3], 5u);
  EXPECT_EQ(hits[4], 0u);
  ASSERT_TRUE(rtglEndFrame());
  EXPECT_EQ(stats().scene.instances, 0u);
  EXPECT_EQ(messages.size(), 2u);
}

TEST_F(Gl, NamesAndPrimitivesOfDisplayListsAreSelected) {
  GLuint hits[8];
  const GLuint list = glGenLists(1);
  glNewList(list, GL_COMPILE);
  glPushName(3);
  square(0.5f);
  glPopName();
  glEndList();
  glSelectBuffer(8, hits);
  glRenderMode(GL_SELECT);
  glCallList(list);
  EXPECT_EQ(glRenderMode(GL_RENDER), 1);
  EXPECT_EQ(hits[0], 1u);
  EXPECT_EQ(hits[3], 3u);
}

TEST_F(Gl, FeedbackIsRefusedOnceAndDrawsNothing) {
  clear();
  for (int i = 0; i < 2; i++) {
    glRenderMode(GL_FEEDBACK);
    square(0.5f);
    EXPECT_EQ(glRenderMode(GL_RENDER), 0);
  }
  ASSERT_TRUE(rtglEndFrame());
  EXPECT_EQ(stats().scene.instances, 0u);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("glRenderMode(GL_FEEDBACK)"), std::string::npos);
}

// Draws a square over the whole picture, then what `overlay` draws in pixels.
template <class Overlay> void drawUnder(const Overlay& overlay) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glColor3f(0, 0, 1);
  square(1);
  glMatrixMode(GL_PROJECTION);
  glPushMatrix();
  glLoadIdentity();
  rtuOrtho2D(0, 32, 0, 32);
  glMatrixMode(GL_MODELVIEW);
  overlay();
  glMatrixMode(GL_PROJECTION);
  glPopMatrix();
  glMatrixMode(GL_MODELVIEW);
}

TEST_F(Gl, ASecondProjectionLiesOverThePicture) {
  drawUnder([] {
    glColor3f(1, 0, 0);
    glRectf(4, 4, 12, 12);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glColor4f(0, 1, 0, 0.5f);
    glRectf(8, 4, 20, 12);
    glDisable(GL_BLEND);
  });
  ASSERT_TRUE(rtglEndFrame());
  EXPECT_TRUE(messages.empty());
  expectNear(pixel(3, 8), {0, 0, 255});
  expectNear(pixel(4, 4), {255, 0, 0});
  expectNear(pixel(11, 11), {128, 128, 0}); // each pixel of the common edges of triangles once
  expectNear(pixel(19, 8), {0, 128, 128});
  expectNear(pixel(20, 8), {0, 0, 255});
  EXPECT_EQ(stats().scene.instances, 1u);
  EXPECT_EQ(rtglRefine(), 2);
  expectNear(pixel(4, 4), {255, 0, 0});
}

TEST_F(Gl, TheNextFrameHasNoOverlayOfTheLast) {
  drawUnder([] { glRectf(0, 0, 32, 32); });
  ASSERT_TRUE(rtglEndFrame());
  clear();
  glColor3f(0, 1, 0);
  square(1);
  ASSERT_TRUE(rtglEndFrame());
  expectNear(pixel(16, 16), {0, 255, 0});
}

TEST_F(Gl, ASecondPerspectiveIsRefused) {
  drawUnder([] {
    glMatrixMode(GL_PROJECTION);
    rtuPerspective(60, 1, 1, 10);
    square(1);
  });
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("a second perspective"), std::string::npos);
}

TEST_F(Gl, CallsThatAskForTooMuchFailAtOnce) {
  const auto failsWith = [](GLenum error) { EXPECT_EQ(glGetError(), error); };
  EXPECT_EQ(glGenLists(INT_MAX), 0u);
  failsWith(GL_OUT_OF_MEMORY);
  GLuint name = 0;
  glGenTextures(INT_MAX, &name);
  failsWith(GL_OUT_OF_MEMORY);
  glGenTextures(-1, &name);
  failsWith(GL_INVALID_VALUE);
  EXPECT_EQ(name, 0u);
  RTUquadric* quadric = rtuNewQuadric();
  rtuSphere(quadric, 1, 100000, 100000);
  failsWith(GL_OUT_OF_MEMORY);
  rtuDeleteQuadric(quadric);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 16385, 1, 0, GL_RGB, GL_UNSIGNED_BYTE, nullptr);
  failsWith(GL_INVALID_VALUE);
  const GLfloat corner[3] = {0, 0, 0};
  glVertexPointer(3, GL_FLOAT, 0, corner);
  glDrawArrays(GL_POINTS, 0, INT_MAX); // without an array
  failsWith(GL_OUT_OF_MEMORY);
  glViewport(0, 0, INT_MAX, INT_MAX);
  failsWith(GL_INVALID_VALUE);
  glMapGrid2f(INT_MAX, 0, 1, INT_MAX, 0, 1);
  failsWith(GL_INVALID_OPERATION);
  glEvalMesh2(GL_FILL, 0, INT_MAX, 0, INT_MAX);
  failsWith(GL_INVALID_OPERATION);
  EXPECT_EQ(messages.size(), 9u);
}

TEST_F(Gl, NamesEndWithTheNumbers) {
  glNewList(UINT_MAX, GL_COMPILE);
  glEndList();
  EXPECT_EQ(glGenLists(3), 1u);
  EXPECT_EQ(glGenLists(1), 4u);
  glDeleteLists(UINT_MAX - 5, 100);
  EXPECT_FALSE(glIsList(UINT_MAX));
  EXPECT_TRUE(glIsList(4));
  glBindTexture(GL_TEXTURE_2D, UINT_MAX);
  GLuint names[2] = {};
  glGenTextures(2, names);
  EXPECT_EQ(names[0], 1u);
  EXPECT_EQ(names[1], 2u);
}

TEST_F(Gl, PixelsBeyondThePictureAreLeftAsTheyAre) {
  clear();
  ASSERT_TRUE(rtglEndFrame());
  GLubyte rows[2][4] = {{9, 9, 9, 9}, {9, 9, 9, 9}};
  glPixelStorei(GL_PACK_ROW_LENGTH, 1);
  glReadPixels(31, INT_MAX - 1, 1, 2, GL_LUMINANCE, GL_UNSIGNED_BYTE, rows);
  EXPECT_EQ(rows[0][0], 9);
  glReadPixels(31, 31, 1, 2, GL_LUMINANCE, GL_UNSIGNED_BYTE, rows);
  EXPECT_EQ(rows[0][0], 0);
  EXPECT_EQ(rows[1][0], 9);
  glPixelStorei(GL_PACK_ALIGNMENT, 3);
  EXPECT_EQ(glGetError(), GLenum(GL_INVALID_VALUE));
}

} // namespace
