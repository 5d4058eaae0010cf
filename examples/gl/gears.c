/* gears.c: Three gears turn. Each is a display list with a material, so that from the second frame
 * on only matrices change. OpenGL: cc -DUSE_GL gears.c -lglut -lGLU -lGL -lm. OpenRT: cc gears.c
 * -lrtut -lrtgl -lopenrt -lm. Keys: arrows turn the view, Escape ends. */
#include "capture.h"

#include <math.h>
#include <stdlib.h>

enum { maxPoints = 4 * 64 };

static GLuint gears[3];
static float viewX = 20, viewY = 30, angle = 0;

/* Writes the outline of a gear: four points a tooth, counter-clockwise. */
static int outline(double root, double tip, int teeth, double points[][2]) {
  const double share[4] = {0.0, 0.2, 0.5, 0.7}, radius[4] = {root, tip, tip, root};
  for (int i = 0; i < 4 * teeth; i++) {
    const double a = 2 * acos(-1) * (i / 4 + share[i % 4]) / teeth;
    points[i][0] = radius[i % 4] * cos(a);
    points[i][1] = radius[i % 4] * sin(a);
  }
  return 4 * teeth;
}

/* Draws the ring between the hole and the outline, at the height z. side: 1 faces up, -1 down. */
static void face(double hole, double points[][2], int count, double z, int side) {
  glNormal3d(0, 0, side);
  glBegin(GL_QUAD_STRIP);
  for (int i = 0; i <= count; i++) {
    const double* p = points[side > 0 ? i % count : (count - i) % count];
    const double inward = hole / sqrt(p[0] * p[0] + p[1] * p[1]);
    glVertex3d(inward * p[0], inward * p[1], z);
    glVertex3d(p[0], p[1], z);
  }
  glEnd();
}

static GLuint makeGear(double hole, double radius, double width, int teeth, double depth,
                       const float color[4]) {
  double points[maxPoints][2];
  const int count = outline(radius - depth / 2, radius + depth / 2, teeth, points);
  const GLuint list = glGenLists(1);
  glNewList(list, GL_COMPILE);
  glMaterialfv(GL_FRONT, GL_AMBIENT_AND_DIFFUSE, color);
  glShadeModel(GL_FLAT);
  face(hole, points, count, width / 2, 1);
  face(hole, points, count, -width / 2, -1);
  glBegin(GL_QUADS); /* the flanks of the teeth */
  for (int i = 0; i < count; i++) {
    const double *p = points[i], *q = points[(i + 1) % count];
    glNormal3d(q[1] - p[1], p[0] - q[0], 0);
    glVertex3d(p[0], p[1], -width / 2);
    glVertex3d(q[0], q[1], -width / 2);
    glVertex3d(q[0], q[1], width / 2);
    glVertex3d(p[0], p[1], width / 2);
  }
  glEnd();
  glShadeModel(GL_SMOOTH);
  glBegin(GL_QUAD_STRIP); /* the wall of the hole */
  for (int i = 0; i <= count; i++) {
    const double* p = points[i % count];
    const double inward = hole / sqrt(p[0] * p[0] + p[1] * p[1]);
    glNormal3d(-p[0], -p[1], 0);
    glVertex3d(inward * p[0], inward * p[1], -width / 2);
    glVertex3d(inward * p[0], inward * p[1], width / 2);
  }
  glEnd();
  glEndList();
  return list;
}

static void placeGear(GLuint gear, float x, float y, float turn) {
  glPushMatrix();
  glTranslatef(x, y, 0);
  glRotatef(turn, 0, 0, 1);
  glCallList(gear);
  glPopMatrix();
}

static void display(void) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glPushMatrix();
  glRotatef(viewX, 1, 0, 0);
  glRotatef(viewY, 0, 1, 0);
  placeGear(gears[0], -3, -2, angle);
  placeGear(gears[1], 3.1f, -2, -2 * angle - 7.2f);
  placeGear(gears[2], -3.1f, 4.2f, -2 * angle - 25.2f);
  glPopMatrix();
  capture();
  glutSwapBuffers();
}

static void reshape(int width, int height) {
  const double ratio = (double)height / width;
  glViewport(0, 0, width, height);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glFrustum(-1, 1, -ratio, ratio, 5, 60);
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
  glTranslatef(0, 0, -40);
}

static void idle(void) {
  angle += 2;
  glutPostRedisplay();
}

static void special(int key, int x, int y) {
  (void)x, (void)y;
  if (key == GLUT_KEY_UP) viewX += 5;
  if (key == GLUT_KEY_DOWN) viewX -= 5;
  if (key == GLUT_KEY_LEFT) viewY += 5;
  if (key == GLUT_KEY_RIGHT) viewY -= 5;
  glutPostRedisplay();
}

static void keyboard(unsigned char key, int x, int y) {
  (void)x, (void)y;
  if (key == 27) exit(0);
}

int main(int argc, char** argv) {
  const float light[4] = {5, 5, 10, 0};
  const float red[4] = {0.8f, 0.1f, 0, 1}, green[4] = {0, 0.8f, 0.2f, 1},
              blue[4] = {0.2f, 0.2f, 1, 1};
  glutInit(&argc, argv);
  glutInitDisplayMode(GLUT_RGB | GLUT_DEPTH | GLUT_DOUBLE);
  glutInitWindowSize(300, 300);
  if (!glutCreateWindow("Gears")) return 1;
  glLightfv(GL_LIGHT0, GL_POSITION, light);
  glEnable(GL_CULL_FACE);
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_NORMALIZE);
  gears[0] = makeGear(1, 4, 1, 20, 0.7, red);
  gears[1] = makeGear(0.5, 2, 2, 10, 0.7, green);
  gears[2] = makeGear(1.3, 2, 0.5, 10, 0.7, blue);
  glutDisplayFunc(display);
  glutReshapeFunc(reshape);
  glutIdleFunc(idle);
  glutSpecialFunc(special);
  glutKeyboardFunc(keyboard);
  glutMainLoop();
  return 0;
}
