// rtgl_lists.cpp: Tests display lists: vertices and colours in lists that are called between
// glBegin and glEnd, and lists that call each other (OpenGL 1.1, section 5.4).
#include "unit/rtgl_fixture.h"

namespace {

const std::vector<int> red = {255, 0, 0}, green = {0, 255, 0}, black = {0, 0, 0};

void corners() {
  glVertex2f(-.9f, -.9f);
  glVertex2f(.9f, -.9f);
  glVertex2f(.9f, .9f);
}

TEST_F(Gl, AListGivesVerticesAndColoursToAnOpenPrimitive) {
  glNewList(1, GL_COMPILE);
  glColor3f(0, 1, 0);
  corners();
  glEndList();
  clear();
  glColor3f(1, 0, 0);
  glBegin(GL_TRIANGLES);
  glCallList(1);
  glEnd();
  expectNear(pixel(24, 8), green);
  square(.2f); // its colour is current behind the primitive, too
  expectNear(pixel(16, 16), green);
  EXPECT_TRUE(messages.empty());
}

// A list that is called within a primitive of another list is looked up when that one is executed.
TEST_F(Gl, AListIsCalledWithinAPrimitiveOfAnother) {
  for (const GLenum mode : {GL_COMPILE, GL_COMPILE_AND_EXECUTE}) {
    glDeleteLists(1, 2);
    clear();
    glColor3f(1, 0, 0);
    glNewList(1, GL_COMPILE);
    corners();
    glEndList();
    glNewList(2, mode);
    glBegin(GL_POLYGON);
    glCallList(1);
    glVertex2f(-.9f, .9f);
    glEnd();
    glEndList();
    if (mode == GLenum(GL_COMPILE)) {
      expectNear(pixel(8, 24), black);
      glColor3f(1, 0, 0);
      glCallList(2);
    }
    expectNear(pixel(8, 24), red);
    expectNear(pixel(24, 8), red);
    glNewList(1, GL_COMPILE);
    glColor3f(0, 1, 0);
    corners();
    glEndList();
    clear();
    glShadeModel(GL_FLAT); // a polygon has the colour of its first vertex
    glCallList(2);
    expectNear(pixel(24, 8), green);
    expectNear(pixel(8, 24), green);
    glShadeModel(GL_SMOOTH);
  }
  EXPECT_TRUE(messages.empty());
}

TEST_F(Gl, WhatStandsBeforeTheCallIsKept) {
  glNewList(1, GL_COMPILE);
  glVertex2f(.9f, .9f);
  glEndList();
  glNewList(2, GL_COMPILE);
  glBegin(GL_TRIANGLES);
  glColor3f(0, 1, 0);
  glVertex2f(-.9f, -.9f);
  glVertex2f(.9f, -.9f);
  glCallList(1);
  glEnd();
  glEndList();
  clear();
  glColor3f(1, 0, 0);
  glCallList(2);
  expectNear(pixel(24, 8), green);
  EXPECT_TRUE(messages.empty());
}

TEST_F(Gl, APrimitiveOfAListWithinAnotherIsAnError) {
  glNewList(1, GL_COMPILE);
  square(.5f);
  glEndList();
  glBegin(GL_TRIANGLES);
  glCallList(1);
  glEnd();
  EXPECT_EQ(glGetError(), GLenum(GL_INVALID_OPERATION));
}

// Each list calls the one before twice: 2^40 commands.
TEST_F(Gl, ListsThatGrowWithAPowerOfTheirDepthEnd) {
  glNewList(1, GL_COMPILE);
  glColor3f(1, 0, 0);
  glEndList();
  for (GLuint list = 2; list <= 41; list++) {
    glNewList(list, GL_COMPILE);
    glCallList(list - 1);
    glCallList(list - 1);
    glEndList();
  }
  glCallList(41);
  EXPECT_EQ(glGetError(), GLenum(GL_OUT_OF_MEMORY));
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("10000000 commands"), std::string::npos) << messages[0];
  glCallList(10); // few enough
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

} // namespace
