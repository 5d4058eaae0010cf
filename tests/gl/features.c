/* features.c: One small picture for each feature of OpenGL's fixed functions.
 * tests/python/test_gl.py draws them by OpenGL and by OpenRT, and compares them frame by frame. */
#include "capture.h"

#include <math.h>
#include <stdlib.h>

static GLUquadric* quadric;
static int frame = 0;

static void useLight(float x, float y, float z, float w) {
  const float position[4] = {x, y, z, w};
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glLightfv(GL_LIGHT0, GL_POSITION, position);
}

static void useMaterial(float r, float g, float b, float specular, float shininess) {
  const float diffuse[4] = {r, g, b, 1}, highlight[4] = {specular, specular, specular, 1};
  glMaterialfv(GL_FRONT, GL_AMBIENT_AND_DIFFUSE, diffuse);
  glMaterialfv(GL_FRONT, GL_SPECULAR, highlight);
  glMaterialf(GL_FRONT, GL_SHININESS, shininess);
}

static void
grid(int n) { /* a square of small ones, so that light at vertices is as that in pixels */
  glNormal3f(0, 0, 1);
  for (int i = 0; i < n; i++) {
    glBegin(GL_TRIANGLE_STRIP);
    for (int k = 0; k <= n; k++)
      for (int j = 0; j < 2; j++)
        glVertex2f(2.0f * (float)(i + j) / (float)n - 1, 1 - 2.0f * (float)k / (float)n);
    glEnd();
  }
}

static void spot(void) {
  const float down[3] = {0, 0, -1};
  useLight(0, 0, 2, 1);
  glLightfv(GL_LIGHT0, GL_SPOT_DIRECTION, down);
  glLightf(GL_LIGHT0, GL_SPOT_CUTOFF, 20);
  grid(60);
}

static void softSpot(void) {
  const float down[3] = {0, 0, -1};
  useLight(0, 0, 2, 1);
  glLightfv(GL_LIGHT0, GL_SPOT_DIRECTION, down);
  glLightf(GL_LIGHT0, GL_SPOT_EXPONENT, 30);
  grid(60);
}

static void attenuated(void) {
  useLight(0.5f, 0, 0.7f, 1);
  glLightf(GL_LIGHT0, GL_CONSTANT_ATTENUATION, 0.6f);
  glLightf(GL_LIGHT0, GL_QUADRATIC_ATTENUATION, 1);
  grid(60);
}

static void highlights(void) {
  useLight(1, 1, 1, 0);
  useMaterial(0.2f, 0.3f, 0.6f, 0.8f, 30);
  gluSphere(quadric, 0.9, 80, 80);
}

static void twoLights(void) {
  const float red[4] = {1, 0.2f, 0.1f, 1}, left[4] = {-1, 0, 0.3f, 0},
              dim[4] = {0.1f, 0.2f, 0.4f, 1};
  useLight(1, 0.5f, 0.5f, 0);
  glEnable(GL_LIGHT3);
  glLightfv(GL_LIGHT3, GL_DIFFUSE, red);
  glLightfv(GL_LIGHT3, GL_POSITION, left);
  glLightModelfv(GL_LIGHT_MODEL_AMBIENT, dim);
  useMaterial(0.8f, 0.8f, 0.8f, 0, 0);
  gluSphere(quadric, 0.9, 60, 60);
}

static void twoSides(void) {
  const float back[4] = {0.9f, 0.3f, 0.1f, 1};
  useLight(0, 0, 1, 0);
  glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, 1);
  useMaterial(0.1f, 0.4f, 0.9f, 0, 0);
  glMaterialfv(GL_BACK, GL_AMBIENT_AND_DIFFUSE, back);
  glRotatef(60, 1, 0, 0);
  gluCylinder(quadric, 0.7, 0.7, 1, 40, 10);
}

static void oneSide(void) {
  useLight(0, 0, 1, 0);
  useMaterial(0.1f, 0.4f, 0.9f, 0, 0);
  glRotatef(60, 1, 0, 0);
  gluCylinder(quadric, 0.7, 0.7, 1, 40, 10);
}

static void flat(void) {
  useLight(1, 1, 1, 0);
  glShadeModel(GL_FLAT);
  useMaterial(0.9f, 0.7f, 0.2f, 0, 0);
  gluSphere(quadric, 0.9, 10, 8);
}

static void flatColours(void) {
  glShadeModel(GL_FLAT);
  glBegin(GL_TRIANGLE_FAN);
  for (int i = 0; i < 9; i++) {
    const double a = i * acos(-1) / 4;
    glColor3ub((GLubyte)(30 * i), (GLubyte)(255 - 30 * i), 128);
    glVertex2d(i ? 0.9 * cos(a) : 0, i ? 0.9 * sin(a) : 0);
  }
  glEnd();
}

static void modes(void) {
  static const GLenum all[10] = {GL_POINTS,     GL_LINES,          GL_LINE_LOOP,    GL_LINE_STRIP,
                                 GL_TRIANGLES,  GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN, GL_QUADS,
                                 GL_QUAD_STRIP, GL_POLYGON};
  static const float places[8][2] = {{0, 0},      {.3f, 0},     {.35f, .2f}, {.3f, .4f},
                                     {.1f, .45f}, {-.05f, .4f}, {-.1f, .2f}, {-.05f, .1f}};
  glPointSize(4);
  glLineWidth(3);
  for (int i = 0; i < 10; i++) {
    glPushMatrix();
    glTranslatef(-0.9f + 0.38f * (float)(i % 5), i < 5 ? 0.2f : -0.8f, 0);
    glColor3f(0.2f + 0.08f * (float)i, 0.9f - 0.05f * (float)i, 0.5f);
    glBegin(all[i]);
    for (int k = 0; k < 8; k++) glVertex2fv(places[k]);
    glEnd();
    glPopMatrix();
  }
}

static void wires(void) {
  glLineWidth(2);
  glColor3f(1, 1, 0);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glRotatef(30, 1, 1, 0);
  glRectf(-0.6f, -0.6f, 0.6f, 0.6f);
  glTranslatef(0, 0, 0.5f);
  glRecti(0, 0, 1, 1);
}

static void picture(int n, int alpha) {
  static GLubyte texels[16 * 16 * 4];
  for (int i = 0; i < n * n; i++) {
    texels[4 * i] = (GLubyte)(255 * (i % n) / n);
    texels[4 * i + 1] = (GLubyte)(255 * (i / n) / n);
    texels[4 * i + 2] = 100;
    texels[4 * i + 3] = (GLubyte)(alpha ? 255 * ((i % n / 4 + i / n / 4) % 2) : 255);
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, n, n, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
  glEnable(GL_TEXTURE_2D);
}

static void card(float z) {
  glBegin(GL_QUADS);
  glNormal3f(0, 0, 1);
  glTexCoord2f(0, 0), glVertex3f(-0.8f, -0.8f, z);
  glTexCoord2f(2, 0), glVertex3f(0.8f, -0.8f, z);
  glTexCoord2f(2, 2), glVertex3f(0.8f, 0.8f, z);
  glTexCoord2f(0, 2), glVertex3f(-0.8f, 0.8f, z);
  glEnd();
}

static void litTexture(void) {
  useLight(0, 0.6f, 0.8f, 0);
  picture(16, 0);
  useMaterial(0.9f, 0.9f, 0.5f, 0, 0);
  card(0);
}

static void decal(void) {
  useLight(0, 0.6f, 0.8f, 0);
  picture(16, 0);
  glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
  card(0);
}

static void clamped(void) {
  picture(16, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
  glMatrixMode(GL_TEXTURE);
  glTranslatef(-0.5f, 0, 0);
  glMatrixMode(GL_MODELVIEW);
  card(0);
  glMatrixMode(GL_TEXTURE);
  glLoadIdentity();
  glMatrixMode(GL_MODELVIEW);
}

static void alphaTest(void) {
  glColor3f(0, 0.4f, 0);
  glRectf(-1, -0.3f, 1, 0.3f);
  picture(16, 1);
  glEnable(GL_ALPHA_TEST);
  glAlphaFunc(GL_GREATER, 0.5f);
  glColor3f(1, 1, 1);
  card(0.1f);
}

static void blended(void) {
  glColor3f(0, 0.4f, 0);
  glRectf(-1, -0.3f, 1, 0.3f);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glBegin(GL_QUADS);
  for (int i = 0; i < 4; i++) {
    glColor4f(1, 0, (float)(i % 2), i < 2 ? 0.9f : 0.1f);
    glVertex3f(i == 0 || i == 3 ? -0.5f : 0.5f, i < 2 ? -0.8f : 0.8f, 0.2f);
  }
  glEnd();
}

static void blendedLight(void) {
  const float clear[4] = {0.9f, 0.9f, 0.2f, 0.4f};
  useLight(0, 0, 1, 0);
  useMaterial(0.1f, 0.2f, 0.9f, 0, 0);
  gluDisk(quadric, 0.3, 0.9, 40, 4);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glMaterialfv(GL_FRONT, GL_AMBIENT_AND_DIFFUSE, clear);
  glTranslatef(0.2f, 0.2f, 0.3f);
  gluDisk(quadric, 0, 0.6, 40, 4);
}

static void lists(void) {
  const GLuint base = glGenLists(3);
  GLubyte names[6] = {0, 1, 0, 1, 2, 0};
  glNewList(base, GL_COMPILE);
  glRectf(-0.1f, -0.1f, 0.1f, 0.1f);
  glTranslatef(0.3f, 0.1f, 0);
  glEndList();
  glNewList(base + 1, GL_COMPILE);
  glColor3f(1, 0.5f, 0);
  glRotatef(20, 0, 0, 1);
  glCallList(base);
  glEndList();
  glNewList(base + 2, GL_COMPILE);
  glPushAttrib(GL_CURRENT_BIT);
  glColor3f(0, 0.5f, 1);
  glCallList(base);
  glPopAttrib();
  glEndList();
  glColor3f(0, 1, 0);
  glTranslatef(-0.7f, -0.5f, 0);
  glListBase(base);
  glCallLists(6, GL_UNSIGNED_BYTE, names);
  glDeleteLists(base, 3);
}

static void arrays(void) {
  static const float data[5][8] = {{0, 0, 1, 0, 0, -.9f, -.9f, 0},
                                   {0, 0, 0, 1, 0, .9f, -.9f, 0},
                                   {0, 0, 0, 0, 1, .9f, .9f, 0},
                                   {0, 0, 1, 1, 0, -.9f, .9f, 0},
                                   {0, 0, 1, 1, 1, 0, 0, 0}};
  static const GLushort order[] = {4, 0, 1, 4, 2, 3};
  glInterleavedArrays(GL_T2F_C3F_V3F, 0, data);
  glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, order);
  glDisableClientState(GL_COLOR_ARRAY);
  glDisableClientState(GL_TEXTURE_COORD_ARRAY);
  glColor3f(0.5f, 0.5f, 0.5f);
  glTranslatef(0, 0, 0.1f);
  glScalef(0.4f, 0.4f, 1);
  glDrawArrays(GL_TRIANGLE_FAN, 0, 4);
  glDisableClientState(GL_VERTEX_ARRAY);
}

static void painter(void) {
  glDisable(GL_DEPTH_TEST);
  for (int i = 0; i < 5; i++) {
    glColor3f(0.2f * (float)i, 1 - 0.2f * (float)i, 0.3f);
    glRectf(-0.9f + 0.3f * (float)i, -0.9f + 0.2f * (float)i, 0.1f + 0.2f * (float)i,
            0.1f + 0.2f * (float)i);
  }
}

static void skewed(void) { /* an asymmetric frustum, and a view on the projection's stack */
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glFrustum(-0.3, 0.7, -0.5, 0.3, 1, 20);
  gluLookAt(1, 1, 3, 0, 0, 0, 0, 1, 0);
  glMatrixMode(GL_MODELVIEW);
  for (int i = 0; i < 3; i++) {
    glColor3f((float)(i == 0), (float)(i == 1), (float)(i == 2));
    glPushMatrix();
    glRotatef(90, (float)(i == 0), (float)(i == 1), (float)(i == 2));
    glRectf(0, 0, 0.8f, 0.8f);
    glPopMatrix();
  }
}

static void winding(void) { /* clockwise fronts, a mirror, culled fronts */
  useLight(0, 0.3f, 1, 0);
  useMaterial(0.3f, 0.8f, 0.6f, 0, 0);
  glEnable(GL_CULL_FACE);
  glTranslatef(-0.5f, 0, 0);
  gluSphere(quadric, 0.4, 30, 30);
  glTranslatef(1, 0, 0);
  glScalef(1, -1, 1);
  glFrontFace(GL_CW);
  gluSphere(quadric, 0.4, 30, 30);
}

static void colourMaterial(void) {
  useLight(0.3f, 0.3f, 1, 0);
  glEnable(GL_COLOR_MATERIAL);
  glColorMaterial(GL_FRONT_AND_BACK, GL_DIFFUSE);
  for (int i = 0; i < 3; i++) {
    glColor3f(0.9f, 0.4f * (float)i, 0.1f);
    glPushMatrix();
    glTranslatef(0.6f * (float)(i - 1), 0, 0);
    gluSphere(quadric, 0.28, 30, 30);
    glPopMatrix();
  }
}

static void inPixels(void) { /* the idiom of displays over a scene */
  glDisable(GL_LIGHTING);
  glDisable(GL_DEPTH_TEST);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  gluOrtho2D(0, 160, 160, 0); /* y points down */
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
}

static void overlay(void) {
  useLight(0.3f, 0.4f, 1, 0);
  useMaterial(0.3f, 0.6f, 0.9f, 0, 0);
  gluSphere(quadric, 1, 60, 60);
  inPixels();
  glColor3f(0.9f, 0.2f, 0.1f);
  glRectf(10, 10, 60, 40);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glBegin(GL_TRIANGLES);
  glColor4f(1, 1, 0, 0.8f), glVertex2f(30, 20);
  glColor4f(0, 1, 0, 0.2f), glVertex2f(110, 30);
  glColor4f(0, 0, 1, 0.5f), glVertex2f(70, 90);
  glEnd();
  glColor4f(1, 1, 1, 1);
  glLineWidth(3);
  glBegin(GL_LINES);
  glVertex2f(10, 150), glVertex2f(150, 150);
  glVertex2f(140, 20), glVertex2f(150, 140);
  glEnd();
  glPointSize(6);
  glBegin(GL_POINTS);
  glVertex2f(20, 60);
  glEnd();
  picture(16, 1);
  glBegin(GL_QUADS);
  glTexCoord2f(0, 0), glVertex2f(90, 100);
  glTexCoord2f(0, 1), glVertex2f(90, 140);
  glTexCoord2f(1, 1), glVertex2f(130, 140);
  glTexCoord2f(1, 0), glVertex2f(130, 100);
  glEnd();
}

static void culledOverlay(void) { /* in a viewport of its own */
  glRectf(-1, -1, 0, 0);
  inPixels();
  glViewport(80, 80, 80, 80);
  glEnable(GL_CULL_FACE);
  glColor3f(0, 1, 1);
  glRectf(10, 10, 150, 60); /* clockwise, because y points down */
  glColor3f(1, 0, 1);
  glRectf(10, 150, 150, 90);
}

static void solids(void) {
  static void (*const all[4])(void) = {glutSolidTetrahedron, glutSolidOctahedron,
                                       glutSolidDodecahedron, glutSolidIcosahedron};
  useLight(0.3f, 0.4f, 1, 0);
  useMaterial(0.9f, 0.6f, 0.3f, 0, 0);
  for (int i = 0; i < 6; i++) {
    glPushMatrix();
    glTranslatef(0.75f * (float)(i % 3 - 1), i < 3 ? 0.5f : -0.5f, 0);
    glRotatef(25, 1, 1, 0);
    glScalef(0.3f, 0.3f, 0.3f);
    glEnable(GL_NORMALIZE);
    if (i < 4) all[i]();
    if (i == 4) glutSolidTorus(0.3, 0.9, 20, 30);
    if (i == 5) glutSolidCube(1.4);
    glPopMatrix();
  }
}

static void teapot(void) {
  useLight(0.3f, 0.4f, 1, 0);
  useMaterial(0.8f, 0.3f, 0.3f, 0, 0);
  glRotatef(30, 1, 0, 0);
  glRotatef(40, 0, 1, 0);
  glutSolidTeapot(0.65);
}

static void silhouettes(void) {
  gluQuadricDrawStyle(quadric, GLU_SILHOUETTE);
  glLineWidth(2);
  gluDisk(quadric, 0.2, 0.5, 12, 3);
  gluPartialDisk(quadric, 0.6, 1, 12, 3, 20, 120);
  glRotatef(-70, 1, 0, 0);
  glTranslatef(-0.6f, -0.2f, -1);
  gluCylinder(quadric, 0.4, 0.2, 0.7, 8, 4);
  gluQuadricDrawStyle(quadric, GLU_FILL);
}

static void (*const features[])(void) = {
    spot,           attenuated,   highlights, twoLights,     twoSides, oneSide, flat,
    flatColours,    modes,        wires,      litTexture,    decal,    clamped, alphaTest,
    blended,        blendedLight, lists,      arrays,        painter,  skewed,  winding,
    colourMaterial, softSpot,     overlay,    culledOverlay, solids,   teapot,  silhouettes};

static void display(void) {
  glPushAttrib(GL_ALL_ATTRIB_BITS);
  glViewport(0, 0, 160, 160);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glOrtho(-1.2, 1.2, -1.2, 1.2, -3, 3);
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
  glEnable(GL_DEPTH_TEST);
  features[frame++ % (int)(sizeof(features) / sizeof(*features))]();
  capture();
  glPopAttrib();
  glutSwapBuffers();
}

int main(int argc, char** argv) {
  glutInit(&argc, argv);
  glutInitDisplayMode(GLUT_RGB | GLUT_DEPTH | GLUT_DOUBLE);
  glutInitWindowSize(160, 160);
  if (!glutCreateWindow("Features")) return 1;
  glClearColor(0.1f, 0.1f, 0.2f, 1);
  quadric = gluNewQuadric();
  glutDisplayFunc(display);
  glutIdleFunc(glutPostRedisplay);
  glutMainLoop();
  return 0;
}
