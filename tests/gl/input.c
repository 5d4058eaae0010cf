/* input.c: Prints the events of a window. tests/python/test_rtut_window.py sends them. */
#include <openrt/rtut.h>
#include <stdio.h>

static void display(void) {
  glClear(GL_COLOR_BUFFER_BIT);
  rtutSwapBuffers();
  printf("ready\n");
}
static void down(unsigned char key, int x, int y) {
  (void)x, (void)y;
  printf("down %d\n", key);
  if (key == 27) rtutLeaveMainLoop();
}
static void up(unsigned char key, int x, int y) {
  (void)x, (void)y;
  printf("up %d\n", key);
}
static void special(int key, int x, int y) {
  (void)x, (void)y;
  printf("special %d\n", key);
}
static void specialUp(int key, int x, int y) {
  (void)x, (void)y;
  printf("special up %d\n", key);
}
static void mouse(int button, int state, int x, int y) {
  printf("button %d %d at %d %d\n", button, state, x, y);
}

int main(int argc, char** argv) {
  setvbuf(stdout, NULL, _IOLBF, 0);
  rtutInit(&argc, argv);
  rtutInitDisplayMode(RTUT_DOUBLE);
  rtutInitWindowSize(200, 100);
  if (!rtutCreateWindow("Input")) return 1;
  rtutIgnoreKeyRepeat(1);
  rtutDisplayFunc(display);
  rtutKeyboardFunc(down), rtutKeyboardUpFunc(up);
  rtutSpecialFunc(special), rtutSpecialUpFunc(specialUp);
  rtutMouseFunc(mouse);
  return rtutMainLoop();
}
