// rtgl_frames.cpp: Tests of OpenGL's calls on top of the C API: what frames build, what is refused,
// and single pictures whose colours are known.
#include <cmath>

#include "unit/rtgl_fixture.h"

namespace {

TEST_F(Gl, UnlitColoursAreThoseOfTheProgram) {
  glClearColor(0.2f, 0.4f, 0.6f, 1);
  clear();
  glColor3ub(250, 100, 50);
  square(0.5f);
  ASSERT_TRUE(rtglEndFrame());
  expectNear(pixel(16, 16), {250, 100, 50});
  expectNear(pixel(1, 1), {51, 102, 153});
}

TEST_F(Gl, TheLightingEquationIsOpenGls) {
  const float light[4] = {0, 0, 1, 0}, ambient[4] = {.5f, .5f, .5f, 1},
              diffuse[4] = {.4f, .2f, .1f, 1}, scene[4] = {.2f, .2f, .2f, 1},
              lightAmbient[4] = {.1f, .1f, .1f, 1}, emission[4] = {.05f, 0, 0, 1},
              lightDiffuse[4] = {.5f, 1, 1, 1};
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glLightfv(GL_LIGHT0, GL_POSITION, light);
  glLightfv(GL_LIGHT0, GL_AMBIENT, lightAmbient);
  glLightfv(GL_LIGHT0, GL_DIFFUSE, lightDiffuse);
  glLightModelfv(GL_LIGHT_MODEL_AMBIENT, scene);
  glMaterialfv(GL_FRONT, GL_AMBIENT, ambient);
  glMaterialfv(GL_FRONT, GL_DIFFUSE, diffuse);
  glMaterialfv(GL_FRONT, GL_EMISSION, emission);
  clear();
  glNormal3f(0, 0.6f, 0.8f);
  square(0.5f);
  ASSERT_TRUE(rtglEndFrame());
  // emission + ambient (.2 + .1) + .8 diffuse light
  expectNear(pixel(16, 16), {int(255 * (.05 + .15 + .8 * .4 * .5)), int(255 * (.15 + .8 * .2)),
                             int(255 * (.15 + .8 * .1))});
}

TEST_F(Gl, ColoursOfVerticesTrackAmbientAndDiffuse) {
  const float light[4] = {0, 0, 1, 0};
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glEnable(GL_COLOR_MATERIAL);
  glLightfv(GL_LIGHT0, GL_POSITION, light);
  clear();
  glBegin(GL_QUADS);
  for (int i = 0; i < 4; i++) {
    i < 2 ? glColor3f(.5f, 0, 0) : glColor3f(0, .5f, 0);
    glVertex2f(i == 0 || i == 3 ? -1 : 1, i < 2 ? -1 : 1);
  }
  glEnd();
  ASSERT_TRUE(rtglEndFrame());
  const std::vector<int> low = pixel(16, 0), high = pixel(16, 31);
  EXPECT_NEAR(low[0], 255 * .5 * 1.2 * 63 / 64, 2);
  EXPECT_NEAR(high[1], 255 * .5 * 1.2 * 63 / 64, 2);
}

TEST_F(Gl, AFrameWithOtherMatricesAndColoursBuildsNothing) {
  const GLuint list = glGenLists(1);
  glNewList(list, GL_COMPILE);
  square(0.1f);
  glEndList();
  const auto draw = [&](float shift, float red) {
    clear();
    for (int i = 0; i < 3; i++) {
      glPushMatrix();
      glTranslatef(shift + 0.3f * static_cast<float>(i), 0, 0);
      glColor3f(red, 0, 1);
      glCallList(list);
      glPopMatrix();
    }
    glBegin(GL_TRIANGLES); // the same bytes, although it is recorded again
    glVertex2f(0, 0.5f);
    glVertex2f(0.5f, 0.5f);
    glVertex2f(0, 1);
    glEnd();
    ASSERT_TRUE(rtglEndFrame());
  };
  draw(0, 0);
  draw(0.1f, 0.5f);
  const RTstats before = stats();
  EXPECT_EQ(before.scene.instances, 4u);
  for (int i = 0; i < 5; i++) draw(0.1f * static_cast<float>(i), 1);
  const RTstats after = stats();
  EXPECT_EQ(after.bvh.objectBuilds, before.bvh.objectBuilds);
  EXPECT_EQ(after.scene.instances, 4u);
  expectNear(pixel(16 + 7, 16), {255, 0, 255});
}

TEST_F(Gl, AnObjectThatIsNotDrawnIsNotSeen) {
  for (int frame = 0; frame < 12; frame++) {
    clear();
    glColor3f(1, 1, 1);
    if (frame == 0) square(0.5f);
    ASSERT_TRUE(rtglEndFrame());
    expectNear(pixel(16, 16),
               frame == 0 ? std::vector<int>{255, 255, 255} : std::vector<int>{0, 0, 0});
  }
  EXPECT_EQ(stats().scene.instances, 0u); // its object is gone
}

TEST_F(Gl, WithoutDepthTestTheLastOneIsSeen) {
  glDisable(GL_DEPTH_TEST);
  clear();
  glColor3f(1, 0, 0);
  square(0.5f);
  glColor3f(0, 1, 0);
  square(0.5f);
  ASSERT_TRUE(rtglEndFrame());
  expectNear(pixel(16, 16), {0, 255, 0});
}

TEST_F(Gl, TexturesModulateAndReplace) {
  const GLubyte texel[4] = {100, 200, 50, 255};
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, texel);
  glEnable(GL_TEXTURE_2D);
  glColor3f(0.5f, 0.5f, 1);
  clear();
  square(0.5f);
  ASSERT_TRUE(rtglEndFrame());
  expectNear(pixel(16, 16), {50, 100, 50});
  glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
  clear();
  square(0.5f);
  ASSERT_TRUE(rtglEndFrame());
  expectNear(pixel(16, 16), {100, 200, 50});
}

TEST_F(Gl, FogOfEachKind) {
  const float white[4] = {1, 1, 1, 1};
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  rtuPerspective(60, 1, 1, 100);
  glMatrixMode(GL_MODELVIEW);
  glEnable(GL_FOG);
  glFogfv(GL_FOG_COLOR, white);
  glFogf(GL_FOG_START, 2);
  glFogf(GL_FOG_END, 12);
  glFogf(GL_FOG_DENSITY, 0.1f);
  glColor3f(0, 0, 0);
  const GLint modes[3] = {GL_LINEAR, GL_EXP, GL_EXP2};
  const double seen[3] = {(12 - 7) / 10.0, std::exp(-0.7), std::exp(-0.49)};
  for (int i = 0; i < 3; i++) {
    glFogi(GL_FOG_MODE, modes[i]);
    glLoadIdentity();
    glTranslatef(0, 0, -7);
    clear();
    square(8);
    ASSERT_TRUE(rtglEndFrame());
    const int wanted = static_cast<int>(255 * (1 - seen[i]) + .5);
    expectNear(pixel(16, 16), {wanted, wanted, wanted});
    expectNear(pixel(1, 30), {wanted, wanted, wanted}); // the depth counts, not the distance
  }
}

TEST_F(Gl, BlendingShowsWhatIsBehind) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  clear();
  glColor4f(0, 0, 1, 1);
  square(0.5f);
  glTranslatef(0, 0, 0.5f);
  glColor4f(1, 0, 0, 0.25f);
  square(0.5f);
  ASSERT_TRUE(rtglEndFrame());
  expectNear(pixel(16, 16), {64, 0, 191});
}

TEST_F(Gl, CullingLeavesOutOneSide) {
  glEnable(GL_CULL_FACE);
  for (const GLenum face : {GL_BACK, GL_FRONT}) {
    glCullFace(face);
    clear();
    glColor3f(1, 1, 1);
    square(0.5f);
    ASSERT_TRUE(rtglEndFrame());
    expectNear(pixel(16, 16),
               face == GL_BACK ? std::vector<int>{255, 255, 255} : std::vector<int>{0, 0, 0});
  }
}

TEST_F(Gl, CullingLooksAtCornersInThePicture) {
  glEnable(GL_CULL_FACE);
  glScalef(-1, 1, 1);
  for (const GLenum front : {GL_CCW, GL_CW}) {
    glFrontFace(front);
    clear();
    glColor3f(1, 1, 1);
    square(0.5f);
    ASSERT_TRUE(rtglEndFrame());
    expectNear(pixel(16, 16),
               front == GL_CW ? std::vector<int>{255, 255, 255} : std::vector<int>{0, 0, 0});
  }
}

TEST_F(Gl, NormalsChooseTheLitSideAlsoUnderMirrors) {
  const float light[4] = {0, 0, 1, 0};
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glLightfv(GL_LIGHT0, GL_POSITION, light);
  for (const float mirror : {1.0f, -1.0f}) {
    glLoadIdentity();
    glScalef(mirror, 1, 1);
    for (const float side : {1.0f, -1.0f}) {
      clear();
      glNormal3f(0, 0, side);
      square(0.5f);
      ASSERT_TRUE(rtglEndFrame());
      const int wanted = side > 0 ? int(255 * (.8 + .04)) : int(255 * .04);
      expectNear(pixel(16, 16), {wanted, wanted, wanted});
    }
  }
}

TEST_F(Gl, AbsentCallsAreRefusedOnceByName) {
  glStencilFunc(GL_ALWAYS, 0, 1);
  glStencilFunc(GL_ALWAYS, 0, 1);
  glAccum(GL_ACCUM, 1);
  glBlendFunc(GL_ONE, GL_ONE);
  glEnable(GL_STENCIL_TEST);
  ASSERT_EQ(messages.size(), 4u);
  EXPECT_NE(messages[0].find("glStencilFunc"), std::string::npos);
  EXPECT_NE(messages[1].find("glAccum"), std::string::npos);
  EXPECT_EQ(glGetError(), GLenum(GL_INVALID_OPERATION));
  EXPECT_NE(std::string(rtglGetErrorMessage()).find("glStencilFunc"), std::string::npos);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_F(Gl, MatricesListsAndAttributesAreKept) {
  glTranslatef(1, 2, 3);
  glPushMatrix();
  glScalef(2, 2, 2);
  GLfloat m[16];
  glGetFloatv(GL_MODELVIEW_MATRIX, m);
  EXPECT_EQ(m[0], 2);
  EXPECT_EQ(m[13], 2);
  glPopMatrix();
  glPopMatrix();
  EXPECT_EQ(glGetError(), GLenum(GL_STACK_UNDERFLOW));
  glPushAttrib(GL_CURRENT_BIT | GL_ENABLE_BIT);
  glColor3f(.5f, .5f, .5f);
  glEnable(GL_LIGHTING);
  glPopAttrib();
  EXPECT_FALSE(glIsEnabled(GL_LIGHTING));
  glGetFloatv(GL_CURRENT_COLOR, m);
  EXPECT_EQ(m[0], 1);
  const GLuint lists = glGenLists(2);
  glNewList(lists, GL_COMPILE);
  glColor3f(.25f, 0, 0);
  glEndList();
  glNewList(lists + 1, GL_COMPILE);
  glCallList(lists);
  glEndList();
  glGetFloatv(GL_CURRENT_COLOR, m);
  EXPECT_EQ(m[0], 1); // compiled only
  glCallList(lists + 1);
  glGetFloatv(GL_CURRENT_COLOR, m);
  EXPECT_EQ(m[0], .25f);
}

TEST_F(Gl, VertexArraysDrawAsVerticesDo) {
  const GLshort places[] = {-1, -1, 1, -1, 1, 1, -1, 1};
  const GLubyte order[] = {0, 1, 2, 3};
  glColor3f(0, 1, 1);
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(2, GL_SHORT, 0, places);
  clear();
  glDrawElements(GL_QUADS, 4, GL_UNSIGNED_BYTE, order);
  ASSERT_TRUE(rtglEndFrame());
  expectNear(pixel(3, 28), {0, 255, 255});
}

TEST_F(Gl, PixelsAreReadWithinAFrame) {
  clear();
  glColor3f(1, 0, 0);
  square(0.5f);
  expectNear(pixel(16, 16), {255, 0, 0});
  const uint64_t frames = stats().frame;
  expectNear(pixel(16, 16), {255, 0, 0});
  EXPECT_EQ(stats().frame, frames) << "nothing was drawn since";
  glTranslatef(0.75f, 0.75f, 0);
  glColor3f(0, 1, 0);
  square(0.2f);
  expectNear(pixel(28, 28), {0, 255, 0});
  EXPECT_TRUE(rtglEndFrame());
  expectNear(pixel(16, 16), {255, 0, 0});
  expectNear(pixel(28, 28), {0, 255, 0});
  clear();
  expectNear(pixel(16, 16), {0, 0, 0});
}

TEST_F(Gl, NumbersOutOfTheirRangesAreErrors) {
  const auto expectError = [](GLenum wanted, const char* call) {
    EXPECT_EQ(glGetError(), wanted) << call;
  };
  glLightf(GL_LIGHT0, GL_SPOT_EXPONENT, 129);
  expectError(GL_INVALID_VALUE, "exponent");
  glLightf(GL_LIGHT0, GL_LINEAR_ATTENUATION, -1);
  expectError(GL_INVALID_VALUE, "attenuation");
  const GLubyte white[4] = {255, 255, 255, 255};
  glTexImage2D(GL_TEXTURE_2D, -1, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, white);
  expectError(GL_INVALID_VALUE, "level");
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 2, GL_RGBA, GL_UNSIGNED_BYTE, white);
  expectError(GL_INVALID_VALUE, "border");
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_NEAREST);
  expectError(GL_INVALID_ENUM, "wrap");
  glClear(1);
  expectError(GL_INVALID_VALUE, "clear");
  GLint depth = -1, mode = 0;
  glPushAttrib(GL_ENABLE_BIT);
  glGetIntegerv(GL_ATTRIB_STACK_DEPTH, &depth);
  glPopAttrib();
  EXPECT_EQ(depth, 1);
  glGetIntegerv(GL_COLOR_MATERIAL_PARAMETER, &mode);
  EXPECT_EQ(GLenum(mode), GLenum(GL_AMBIENT_AND_DIFFUSE));
  expectError(GL_NO_ERROR, "glGet");
}

TEST_F(Gl, RefiningAddsSamples) {
  clear();
  square(0.52f);
  ASSERT_TRUE(rtglEndFrame());
  EXPECT_EQ(rtglRefine(), 2);
  EXPECT_EQ(rtglRefine(), 3);
}

} // namespace
