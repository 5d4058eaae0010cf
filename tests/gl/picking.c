/* picking.c: Selects primitives by names, and prints the hit records. tests/python/test_gl.py
 * compares what OpenGL and OpenRT print. */
#include "capture.h"

#include <stdio.h>
#include <stdlib.h>

static GLuint buffer[256];

static void square(float x, float y, float z, float size) {
  glBegin(GL_QUADS);
  glVertex3f(x - size, y - size, z);
  glVertex3f(x + size, y - size, z);
  glVertex3f(x + size, y + size, z);
  glVertex3f(x - size, y + size, z);
  glEnd();
}

static void scene(void) {
  glInitNames();
  glPushName(1);
  square(0, 0, -3, 0.5f);
  glPushName(10);
  square(0, 0, -5, 0.5f); /* hidden, but in the view */
  glLoadName(11);
  square(0.2f, 0.2f, -4, 0.1f);
  glPushMatrix();
  glTranslatef(0, 0, -6);
  glRotatef(60, 1, 0, 0);
  square(0, 0, 0, 0.5f); /* slanted: in several depths */
  glPopMatrix();
  glPopName();
  glLoadName(2);
  glBegin(GL_LINES);
  glVertex3f(-2, 0, -3);
  glVertex3f(2, 0.1f, -19);
  glEnd();
  glLoadName(3);
  glPointSize(9);
  glBegin(GL_POINTS);
  glVertex3f(0.01f, 0, -6);
  glVertex3f(3, 0, -6);
  glEnd();
  glLoadName(4);
  glFrontFace(GL_CW);
  square(0, 0, -2, 0.1f);
  glFrontFace(GL_CCW);
  glPopName();
}

static void pick(const char* what, double x, double y, double size, GLsizei room) {
  GLint viewport[4];
  glGetIntegerv(GL_VIEWPORT, viewport);
  glSelectBuffer(room, buffer);
  glRenderMode(GL_SELECT);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  gluPickMatrix(x, y, size, size, viewport);
  gluPerspective(50, 1.25, 1, 20);
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
  scene();
  const GLint hits = glRenderMode(GL_RENDER);
  printf("%s: %d\n", what, hits);
  const GLuint* at = buffer;
  for (GLint i = 0; i < hits; i++) {
    const GLuint names = *at++;
    printf(" %.4f %.4f", *at / 4294967295.0, at[1] / 4294967295.0);
    at += 2;
    for (GLuint k = 0; k < names; k++) printf(" %u", *at++);
    printf("\n");
  }
}

static void display(void) {
  glViewport(0, 0, 250, 200);
  pick("middle", 125, 100, 4, 256);
  pick("aside", 136, 111, 4, 256);
  pick("nothing", 2, 2, 2, 256);
  pick("everything", 125, 100, 200, 256);
  pick("little room", 125, 100, 4, 6);
  glEnable(GL_CULL_FACE);
  pick("culled", 125, 100, 4, 256);
  fflush(stdout);
  glClear(GL_COLOR_BUFFER_BIT);
  capture();
  glutSwapBuffers();
}

int main(int argc, char** argv) {
  glutInit(&argc, argv);
  glutInitDisplayMode(GLUT_RGB | GLUT_DOUBLE);
  glutInitWindowSize(250, 200);
  if (!glutCreateWindow("Picking")) return 1;
  glutDisplayFunc(display);
  glutMainLoop();
  return 0;
}
