/* viewer.c: Shows a mesh from vertex arrays: a knotted tube, with colours or one material. Compile
 * it as gears.c. The left button turns, the right one zooms; c, w and s choose colours, wires and
 * smooth shading, Escape ends. */
#include "capture.h"

#include <math.h>
#include <stdlib.h>

enum { rings = 240, sides = 24 };

static float points[rings][sides][3], normals[rings][sides][3], colors[rings][sides][4];
static unsigned int indices[rings * sides * 4];
static float turnX = 30, turnY = -20, distance = 9;
static const float gold[4] = {0.8f, 0.6f, 0.2f, 1};
static int lastX, lastY, button = -1, colored = 1, wires = 0, smooth = 1;

static void cross(const double a[3], const double b[3], double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void normalise(double v[3]) {
  const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int i = 0; i < 3; i++) v[i] /= length;
}

/* Writes a point of the (2, 3) knot on a torus. */
static void knot(double t, double out[3]) {
  const double r = 2 + cos(3 * t);
  out[0] = r * cos(2 * t);
  out[1] = r * sin(2 * t);
  out[2] = -sin(3 * t);
}

static void makeMesh(void) {
  const double pi = acos(-1);
  unsigned int* index = indices;
  for (int i = 0; i < rings; i++) {
    double at[3], next[3], along[3], outward[3], side[3];
    knot(2 * pi * i / rings, at);
    knot(2 * pi * i / rings + 1e-4, next);
    for (int k = 0; k < 3; k++) along[k] = next[k] - at[k], outward[k] = k < 2 ? at[k] : 0;
    normalise(along);
    cross(along, outward, side);
    normalise(side);
    cross(side, along, outward);
    for (int j = 0; j < sides; j++) {
      const double a = 2 * pi * j / sides;
      for (int k = 0; k < 3; k++) {
        const double n = cos(a) * outward[k] + sin(a) * side[k];
        normals[i][j][k] = (float)n;
        points[i][j][k] = (float)(at[k] + 0.4 * n);
        colors[i][j][k] = (float)(0.55 + 0.45 * sin(2 * pi * (3.0 * i / rings + k / 3.0)));
      }
      colors[i][j][3] = 1;
      *index++ = (unsigned int)(i * sides + j);
      *index++ = (unsigned int)(i * sides + (j + 1) % sides);
      *index++ = (unsigned int)((i + 1) % rings * sides + (j + 1) % sides);
      *index++ = (unsigned int)((i + 1) % rings * sides + j);
    }
  }
}

static void display(void) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glLoadIdentity();
  glTranslatef(0, 0, -distance);
  glRotatef(turnX, 1, 0, 0);
  glRotatef(turnY, 0, 1, 0);
  glPolygonMode(GL_FRONT_AND_BACK, wires ? GL_LINE : GL_FILL);
  glShadeModel(smooth ? GL_SMOOTH : GL_FLAT);
  if (colored) {
    glEnable(GL_COLOR_MATERIAL);
    glEnableClientState(GL_COLOR_ARRAY);
  } else {
    glDisable(GL_COLOR_MATERIAL);
    glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE, gold);
    glDisableClientState(GL_COLOR_ARRAY);
  }
  glDrawElements(GL_QUADS, rings * sides * 4, GL_UNSIGNED_INT, indices);
  capture();
  glutSwapBuffers();
}

static void reshape(int width, int height) {
  glViewport(0, 0, width, height);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  gluPerspective(45, (double)width / height, 1, 100);
  glMatrixMode(GL_MODELVIEW);
}

static void mouse(int which, int state, int x, int y) {
  button = state == GLUT_DOWN ? which : -1;
  lastX = x;
  lastY = y;
}

static void motion(int x, int y) {
  if (button == GLUT_LEFT_BUTTON) {
    turnX += (float)(y - lastY);
    turnY += (float)(x - lastX);
  } else if (button == GLUT_RIGHT_BUTTON) {
    distance *= powf(1.01f, (float)(y - lastY));
  }
  lastX = x;
  lastY = y;
  glutPostRedisplay();
}

static void keyboard(unsigned char key, int x, int y) {
  (void)x, (void)y;
  if (key == 27) exit(0);
  if (key == 'c') colored = !colored;
  if (key == 'w') wires = !wires;
  if (key == 's') smooth = !smooth;
  glutPostRedisplay();
}

static void idle(void) { /* each frame shows the mesh from another side, then with one material */
  static int frame = 0;
  turnY += 40;
  if (++frame == 2) colored = 0;
  glutPostRedisplay();
}

int main(int argc, char** argv) {
  const float light[4] = {2, 3, 4, 0}, white[4] = {1, 1, 1, 1};
  glutInit(&argc, argv);
  glutInitDisplayMode(GLUT_RGB | GLUT_DEPTH | GLUT_DOUBLE);
  glutInitWindowSize(400, 300);
  if (!glutCreateWindow("Viewer")) return 1;
  glClearColor(0.2f, 0.2f, 0.25f, 1);
  glLightfv(GL_LIGHT0, GL_POSITION, light);
  glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, white);
  glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, 40);
  glColorMaterial(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE);
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glEnable(GL_DEPTH_TEST);
  makeMesh();
  glEnableClientState(GL_VERTEX_ARRAY);
  glEnableClientState(GL_NORMAL_ARRAY);
  glVertexPointer(3, GL_FLOAT, 0, points);
  glNormalPointer(GL_FLOAT, 0, normals);
  glColorPointer(4, GL_FLOAT, 0, colors);
  glutDisplayFunc(display);
  glutReshapeFunc(reshape);
  glutMouseFunc(mouse);
  glutMotionFunc(motion);
  glutKeyboardFunc(keyboard);
  glutIdleFunc(getenv("OPENRT_UT_FRAMES") ? idle : NULL);
  glutMainLoop();
  return 0;
}
