/* columns.c: A hall of columns in fog, with two textures. Compile it as gears.c. Keys: arrows walk,
 * f changes the kind of fog, Escape ends. */
#include "capture.h"

#include <math.h>
#include <stdlib.h>

enum { size = 64, columns = 6 };

static GLuint textures[2], hall;
static float eyeX = 0, eyeZ = 0, heading = 8;
static int kind = 0;

/* Makes tiles with joints (0) or bands (1). */
static void makeTexture(int which) {
  static unsigned char texels[size][size][3];
  for (int t = 0; t < size; t++)
    for (int s = 0; s < size; s++) {
      const int tile = (s / 32 + t / 32) % 2, joint = s % 32 < 2 || t % 32 < 2;
      const double band = 0.5 + 0.5 * sin(2 * acos(-1) * (4 * s + t) / size);
      texels[t][s][0] = (unsigned char)(which ? 190 + 50 * band : joint ? 90 : tile ? 220 : 160);
      texels[t][s][1] = (unsigned char)(which ? 170 + 40 * band : joint ? 80 : tile ? 210 : 90);
      texels[t][s][2] = (unsigned char)(which ? 150 + 20 * band : joint ? 70 : tile ? 190 : 60);
    }
  glBindTexture(GL_TEXTURE_2D, textures[which]);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, size, size, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
}

static GLuint makeHall(void) {
  GLUquadric* column = gluNewQuadric();
  const GLuint list = glGenLists(1);
  gluQuadricTexture(column, GL_TRUE);
  glNewList(list, GL_COMPILE);
  glBindTexture(GL_TEXTURE_2D, textures[0]);
  glNormal3f(0, 1, 0);
  glBegin(GL_QUADS);
  for (int z = 0; z < 40; z++)
    for (int x = -6; x < 6; x++)
      for (int k = 0; k < 4; k++) {
        const int right = k == 1 || k == 2, back = k >= 2;
        glTexCoord2i(right, back);
        glVertex3f((float)(x + right), -1, (float)(2 - z - back));
      }
  glEnd();
  glBindTexture(GL_TEXTURE_2D, textures[1]);
  for (int i = 0; i < 2 * columns; i++) {
    glPushMatrix();
    glTranslatef(i % 2 ? 2.0f : -2.0f, -1, (float)(-3 - 4 * (i / 2)));
    glRotatef(-90, 1, 0, 0);
    gluCylinder(column, 0.5, 0.4, 3, 32, 8);
    glPopMatrix();
  }
  glEndList();
  gluDeleteQuadric(column);
  return list;
}

static void setFog(void) {
  const GLint modes[3] = {GL_LINEAR, GL_EXP, GL_EXP2};
  const float color[4] = {0.6f, 0.65f, 0.7f, 1};
  glFogi(GL_FOG_MODE, modes[kind]);
  glFogfv(GL_FOG_COLOR, color);
  glFogf(GL_FOG_START, 3);
  glFogf(GL_FOG_END, 25);
  glFogf(GL_FOG_DENSITY, 0.08f);
}

static void display(void) {
  const float lamp[4] = {1, 3, 0, 1};
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glLoadIdentity();
  glRotatef(heading, 0, 1, 0);
  glTranslatef(-eyeX, -0.4f, -eyeZ);
  glLightfv(GL_LIGHT0, GL_POSITION, lamp);
  setFog();
  glCallList(hall);
  capture();
  glutSwapBuffers();
}

static void reshape(int width, int height) {
  glViewport(0, 0, width, height);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  gluPerspective(60, (double)width / height, 0.1, 100);
  glMatrixMode(GL_MODELVIEW);
}

static void keyboard(unsigned char key, int x, int y) {
  (void)x, (void)y;
  if (key == 27) exit(0);
  if (key == 'f') kind = (kind + 1) % 3;
  glutPostRedisplay();
}

static void special(int key, int x, int y) {
  const double turn = heading * acos(-1) / 180;
  const float step = key == GLUT_KEY_UP ? 0.5f : key == GLUT_KEY_DOWN ? -0.5f : 0;
  (void)x, (void)y;
  heading += key == GLUT_KEY_LEFT ? -5.0f : key == GLUT_KEY_RIGHT ? 5.0f : 0;
  eyeX += step * (float)sin(turn);
  eyeZ -= step * (float)cos(turn);
  glutPostRedisplay();
}

static void idle(void) { /* each frame shows the next kind of fog */
  if (getenv("OPENRT_UT_FRAMES")) keyboard('f', 0, 0);
}

int main(int argc, char** argv) {
  glutInit(&argc, argv);
  glutInitDisplayMode(GLUT_RGB | GLUT_DEPTH | GLUT_DOUBLE);
  glutInitWindowSize(400, 300);
  if (!glutCreateWindow("Columns")) return 1;
  glClearColor(0.6f, 0.65f, 0.7f, 1);
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_TEXTURE_2D);
  glEnable(GL_FOG);
  glGenTextures(2, textures);
  for (int i = 0; i < 2; i++) makeTexture(i);
  hall = makeHall();
  glutDisplayFunc(display);
  glutReshapeFunc(reshape);
  glutKeyboardFunc(keyboard);
  glutSpecialFunc(special);
  glutIdleFunc(getenv("OPENRT_UT_FRAMES") ? idle : NULL);
  glutMainLoop();
  return 0;
}
